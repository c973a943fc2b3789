// What is known of a square of pixels before looking at each: blocks hold tiles, tiles hold pixels.
struct Tile {
    // Sums of the weights of sensors that cover all of its surface.
    weight: vec4<u32>,
    // Number of those sensors.
    covering: u32,
    // Sensors that may cover some of it: the length of its list, or UNLISTED.
    partly: u32,
    // The first page of its list.
    page: u32,
    // Whether some of what its pixels show may stray from the surface.
    strays: u32,
    // Nearest and farthest depth of its surface in distances along the view axis; the nearest is farther
    // than the farthest if there is only sky.
    nearest: f32,
    farthest: f32,
}

// Pixels across a tile, and tiles across a block.
const TILE: u32 = 8u;
const BLOCK: u32 = 8u;
// There was no page left for the list: ask the block's instead, or all sensors.
const UNLISTED: u32 = 0xffffffffu;
// A list is a chain of pages of this many entries. Behind all pages stands the next of each.
const PAGE: u32 = 32u;

fn shows_surface(tile: Tile) -> bool {
    return tile.nearest <= tile.farthest;
}

fn tile_at(index: u32) -> vec2<u32> {
    return vec2<u32>(index % sight.tiles.x, index / sight.tiles.x);
}

fn block_at(index: u32) -> vec2<u32> {
    return vec2<u32>(index % sight.blocks.x, index / sight.blocks.x);
}

fn block_of(tile: vec2<u32>) -> u32 {
    let block = tile / BLOCK;
    return block.y * sight.blocks.x + block.x;
}
