// What is known of a square of pixels before looking at each.
struct Tile {
    // Sums of the weights of sensors that cover all of its surface.
    weight: vec4<u32>,
    // Number of those sensors.
    covering: u32,
    // Sensors that may cover some of it: the length of its list, or UNLISTED.
    partly: u32,
    // Whether any pixel shows the surface.
    surface: u32,
    unused: u32,
}

// Pixels across a tile.
const TILE: u32 = 16u;
// More sensors than the list holds: all are to be looked at, and none is summed up.
const UNLISTED: u32 = 0xffffffffu;
