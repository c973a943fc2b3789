// Copies the host's depth beside a stencil of our own.
@group(0) @binding(0) var depth: texture_depth_2d;

@fragment
fn fs_copy_depth(@builtin(position) pixel: vec4<f32>) -> @builtin(frag_depth) f32 {
    return copied(textureLoad(depth, vec2<i32>(pixel.xy), 0));
}
