// Styles of a layer and places of patterns where they are few: software and some GPUs read uniforms several
// times as fast as storage.

@group(1) @binding(0) var<uniform> styles: array<Style, 448>;
@group(1) @binding(1) var<uniform> places: array<Placed, 1024>;
