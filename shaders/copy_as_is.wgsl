fn copied(depth: f32) -> f32 {
    return depth;
}

