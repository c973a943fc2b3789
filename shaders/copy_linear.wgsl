// Depth d lies at distance (2^(x d) - 1) y + z along the view axis; w: distance of the near plane.
@group(0) @binding(1) var<uniform> logarithm: vec4<f32>;

// Logarithmic depths become reversed ones without a far plane. The sky has none.
fn copied(depth: f32) -> f32 {
    let distance = (exp2(depth * logarithm.x) - 1.0) * logarithm.y + logarithm.z;
    return select(saturate(logarithm.w / distance), 0.0, depth >= 1.0);
}

