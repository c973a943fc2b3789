@group(1) @binding(0) var<storage, read> tiles: array<Tile>;
@group(1) @binding(1) var<storage, read> blocks: array<Tile>;
@group(1) @binding(2) var<storage, read> pages: array<u32>;
