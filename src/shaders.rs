//! The WGSL sources, put together as the pipelines use them.

const EXTRUDE: &str = include_str!("../shaders/extrude.wgsl");
const COUNT: &str = include_str!("../shaders/count.wgsl");
const SCREEN: &str = include_str!("../shaders/screen.wgsl");
const COPY_DEPTH: &str = include_str!("../shaders/copy_depth.wgsl");
const COPY_DEPTH_MULTISAMPLED: &str = include_str!("../shaders/copy_depth_multisampled.wgsl");
const PLANES_PACKED: &str = include_str!("../shaders/planes_packed.wgsl");
const PLANES_SEPARATE: &str = include_str!("../shaders/planes_separate.wgsl");
const RESOLVE: &str = include_str!("../shaders/resolve.wgsl");

/// Extrusion and counting.
pub fn count() -> String {
    [EXTRUDE, COUNT].concat()
}

/// The copy of the host's depth that the stencil technique works on.
pub fn copy_depth(sample_count: u32) -> String {
    let copy = if sample_count > 1 {
        COPY_DEPTH_MULTISAMPLED
    } else {
        COPY_DEPTH
    };
    [SCREEN, copy].concat()
}

/// Decoding and colouring.
pub fn resolve(sample_count: u32) -> String {
    let planes = if sample_count > 1 {
        PLANES_SEPARATE
    } else {
        PLANES_PACKED
    };
    [SCREEN, planes, RESOLVE].concat()
}

/// Every program with its name, for validation without a GPU.
pub fn all() -> Vec<(&'static str, String)> {
    vec![
        ("count", count()),
        ("copy_depth", copy_depth(1)),
        ("copy_depth_multisampled", copy_depth(4)),
        ("resolve", resolve(1)),
        ("resolve_multisampled", resolve(4)),
    ]
}
