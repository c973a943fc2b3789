//! Every shader is valid WGSL, checked without a GPU.

#[test]
fn every_shader_validates() {
    for (name, source) in globefill::shaders::all() {
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(&source)));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::MULTISAMPLED_SHADING
                | naga::valid::Capabilities::CLIP_DISTANCES
                | naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        );
        if let Err(error) = validator.validate(&module) {
            panic!("{name}: {}", error.emit_to_string(&source));
        }
    }
}
