// What shaders know of the eye.
@group(2) @binding(1) var<uniform> sight: Sight;
