@group(1) @binding(0) var<storage, read_write> tiles: array<Tile>;
@group(1) @binding(1) var<storage, read_write> lists: array<u32>;
