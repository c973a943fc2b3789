//! The WGSL sources, put together as the pipelines use them.

const EXTRUDE: &str = include_str!("../shaders/extrude.wgsl");
const FACE: &str = include_str!("../shaders/face.wgsl");
const FACE_UNCLIPPED: &str = include_str!("../shaders/face_unclipped.wgsl");
const COUNT: &str = include_str!("../shaders/count.wgsl");
const SCREEN: &str = include_str!("../shaders/screen.wgsl");
const COPY_DEPTH: &str = include_str!("../shaders/copy_depth.wgsl");
const COPY_DEPTH_MULTISAMPLED: &str = include_str!("../shaders/copy_depth_multisampled.wgsl");
const PLANES_PACKED: &str = include_str!("../shaders/planes_packed.wgsl");
const PLANES_SEPARATE: &str = include_str!("../shaders/planes_separate.wgsl");
const RESOLVE: &str = include_str!("../shaders/resolve.wgsl");

/// Extrusion and counting; `unclipped` where depth has a far plane.
pub fn count(unclipped: bool) -> String {
    if unclipped {
        ["enable clip_distances;\n", EXTRUDE, FACE_UNCLIPPED, COUNT].concat()
    } else {
        [EXTRUDE, FACE, COUNT].concat()
    }
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
        ("count", count(false)),
        ("count_unclipped", count(true)),
        ("copy_depth", copy_depth(1)),
        ("copy_depth_multisampled", copy_depth(4)),
        ("resolve", resolve(1)),
        ("resolve_multisampled", resolve(4)),
    ]
}

#[cfg(test)]
mod tests {
    use std::mem::{offset_of, size_of};

    use crate::{gpu::gpu_mesh::ArcRecord, gpu::layer_tables::LayerHead, view::FrameUniform};

    /// Members of a WGSL struct with their offsets, bytes, and the size of the whole.
    fn layout_of(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
        let module = naga::front::wgsl::parse_str(source).expect("valid WGSL");
        let (_, found) = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some(name))
            .expect("struct exists");
        let naga::TypeInner::Struct { members, span } = &found.inner else {
            panic!("{name} is not a struct");
        };
        let offsets = members
            .iter()
            .map(|member| {
                (
                    member.name.clone().unwrap_or_default(),
                    member.offset as usize,
                )
            })
            .collect();
        (offsets, *span as usize)
    }

    macro_rules! offsets {
        ($ty:ty: $($field:ident),+) => {
            vec![$((stringify!($field).to_owned(), offset_of!($ty, $field))),+]
        };
    }

    #[test]
    fn the_frame_uniform_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::count(false), "Frame");
        let expected = offsets!(
            FrameUniform: clip_from_relative, eye, eye_fraction, eye_remainder, normal_scale,
            heights, slack, depth
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<FrameUniform>());
    }

    #[test]
    fn the_arc_record_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::count(false), "Arc");
        assert_eq!(members, offsets!(ArcRecord: left, right, break_slot));
        assert_eq!(size, size_of::<ArcRecord>());
    }

    #[test]
    fn the_layer_head_has_the_layout_of_the_shader() {
        for samples in [1, 4] {
            let (members, _) = layout_of(&super::resolve(samples), "Layer");
            let expected = offsets!(LayerHead: fills, base, digits, planes, check_base);
            assert_eq!(members[..5], expected);
            assert_eq!(members[5], ("colors".to_owned(), size_of::<LayerHead>()));
        }
    }
}
