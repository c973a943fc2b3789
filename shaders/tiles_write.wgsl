@group(1) @binding(0) var<storage, read_write> tiles: array<Tile>;
@group(1) @binding(1) var<storage, read_write> blocks: array<Tile>;
@group(1) @binding(2) var<storage, read_write> pages: array<u32>;
// Pages in use.
@group(1) @binding(3) var<storage, read_write> used: atomic<u32>;
