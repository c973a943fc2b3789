// The corners of a window, as a strip. Its least corner is in the vertices' indices, its greatest in the
// instance's, in 2^-15 of the picture: what changes with every frame needs no buffer so.
fn window_corner(vertex: u32, instance: u32) -> vec4<f32> {
    let least = vec2<u32>((vertex >> 2u) & 0x7fffu, vertex >> 17u);
    let greatest = vec2<u32>(instance & 0xffffu, instance >> 16u);
    let at = select(least, greatest, vec2<bool>((vertex & 1u) == 1u, (vertex & 2u) == 2u));
    return vec4<f32>(vec2<f32>(at) / 16384.0 - 1.0, 0.0, 1.0);
}
