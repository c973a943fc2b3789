// Styles of a layer and places of patterns where they are many.

@group(1) @binding(0) var<storage, read> styles: array<Style>;
@group(1) @binding(1) var<storage, read> places: array<Placed>;
