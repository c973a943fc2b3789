//! The WGSL sources, put together as the pipelines use them.

const HOST: &str = include_str!("../shaders/host.wgsl");
const EXTRUDE: &str = include_str!("../shaders/extrude.wgsl");
const FACE: &str = include_str!("../shaders/face.wgsl");
const FACE_UNCLIPPED: &str = include_str!("../shaders/face_unclipped.wgsl");
const COUNT: &str = include_str!("../shaders/count.wgsl");
const SCREEN: &str = include_str!("../shaders/screen.wgsl");
const COPY_AS_IS: &str = include_str!("../shaders/copy_as_is.wgsl");
const COPY_LINEAR: &str = include_str!("../shaders/copy_linear.wgsl");
const COPY_DEPTH: &str = include_str!("../shaders/copy_depth.wgsl");
const COPY_DEPTH_MULTISAMPLED: &str = include_str!("../shaders/copy_depth_multisampled.wgsl");
const PLANES_PACKED: &str = include_str!("../shaders/planes_packed.wgsl");
const PLANES_SEPARATE: &str = include_str!("../shaders/planes_separate.wgsl");
const LAYER: &str = include_str!("../shaders/layer.wgsl");
const PICK: &str = include_str!("../shaders/pick.wgsl");
const WINDOW: &str = include_str!("../shaders/window.wgsl");
const RESOLVE: &str = include_str!("../shaders/resolve.wgsl");
const RESOLVE_MIXTURE: &str = include_str!("../shaders/resolve_mixture.wgsl");
const ARCTANGENT: &str = include_str!("../shaders/arctangent.wgsl");
const STYLE: &str = include_str!("../shaders/style.wgsl");
const STYLES_STORAGE: &str = include_str!("../shaders/styles_storage.wgsl");
const STYLES_UNIFORM: &str = include_str!("../shaders/styles_uniform.wgsl");
const MAP: &str = include_str!("../shaders/map.wgsl");
const HATCH: &str = include_str!("../shaders/hatch.wgsl");
const PICTURE: &str = include_str!("../shaders/picture.wgsl");
const RESOLVE_STYLED: &str = include_str!("../shaders/resolve_styled.wgsl");
const SEEN: &str = include_str!("../shaders/seen.wgsl");
const SIGHT: &str = include_str!("../shaders/sight.wgsl");
const SURFACE: &str = include_str!("../shaders/surface.wgsl");
const PIXEL: &str = include_str!("../shaders/pixel.wgsl");
const EDGE: &str = include_str!("../shaders/edge.wgsl");
const EDGE_FLAT: &str = include_str!("../shaders/edge_flat.wgsl");
const STROKE: &str = include_str!("../shaders/stroke.wgsl");
const SENSOR: &str = include_str!("../shaders/sensor.wgsl");
const DEPTH: &str = include_str!("../shaders/depth.wgsl");
const DEPTH_MULTISAMPLED: &str = include_str!("../shaders/depth_multisampled.wgsl");
const TILE: &str = include_str!("../shaders/tile.wgsl");
const TILES_READ: &str = include_str!("../shaders/tiles_read.wgsl");
const TILES_WRITE: &str = include_str!("../shaders/tiles_write.wgsl");
const LIST: &str = include_str!("../shaders/list.wgsl");
const BIN_SENSORS: &str = include_str!("../shaders/bin_sensors.wgsl");
const COUNT_SENSORS: &str = include_str!("../shaders/count_sensors.wgsl");
const RESOLVE_SENSORS: &str = include_str!("../shaders/resolve_sensors.wgsl");

/// Extrusion and counting; `unclipped` where depth has a far plane.
pub fn count(unclipped: bool) -> String {
    if unclipped {
        [
            "enable clip_distances;\n",
            HOST,
            EXTRUDE,
            FACE_UNCLIPPED,
            COUNT,
        ]
        .concat()
    } else {
        [HOST, EXTRUDE, FACE, COUNT].concat()
    }
}

/// The copy of the host's depth that the stencil technique works on, and counting in logarithmic depths.
pub fn copy_depth(sample_count: u32, logarithmic: bool) -> String {
    let copied = if logarithmic { COPY_LINEAR } else { COPY_AS_IS };
    let copy = if sample_count > 1 {
        COPY_DEPTH_MULTISAMPLED
    } else {
        COPY_DEPTH
    };
    [SCREEN, copied, copy].concat()
}

/// Decoding and colouring.
pub fn resolve(sample_count: u32) -> String {
    [planes(sample_count), LAYER, WINDOW, RESOLVE].concat()
}

/// The colours of unordered fills.
pub fn resolve_mixture(sample_count: u32) -> String {
    [planes(sample_count), WINDOW, RESOLVE_MIXTURE].concat()
}

/// Decoding, surface positions, patterns; `few` where styles and places fit into uniforms.
pub fn resolve_styled(sample_count: u32, few: bool) -> String {
    let parts = [
        planes(sample_count),
        LAYER,
        depth(sample_count),
        HOST,
        SURFACE,
        SEEN,
        ARCTANGENT,
        STYLE,
        if few { STYLES_UNIFORM } else { STYLES_STORAGE },
        MAP,
        HATCH,
        PICTURE,
        STROKE,
        RESOLVE_STYLED,
    ];
    parts.concat()
}

/// The arctangent alone, for tests and benchmarks.
pub fn arctangent() -> String {
    ARCTANGENT.to_owned()
}

/// Which fill of a layer covers one pixel.
pub fn pick(sample_count: u32) -> String {
    [planes(sample_count), LAYER, PICK].concat()
}

fn planes(sample_count: u32) -> &'static str {
    if sample_count > 1 {
        PLANES_SEPARATE
    } else {
        PLANES_PACKED
    }
}

fn depth(sample_count: u32) -> &'static str {
    if sample_count > 1 {
        DEPTH_MULTISAMPLED
    } else {
        DEPTH
    }
}

/// The distances to the nearest boundaries.
pub fn edge(sample_count: u32) -> String {
    let parts = [
        HOST,
        EXTRUDE,
        FACE,
        SIGHT,
        SURFACE,
        PIXEL,
        depth(sample_count),
        EDGE,
        EDGE_FLAT,
    ];
    parts.concat()
}

/// Which sensors cover which tiles.
pub fn bin_sensors(sample_count: u32) -> String {
    let depth = depth(sample_count);
    let parts = [
        SIGHT,
        HOST,
        SURFACE,
        SENSOR,
        depth,
        TILE,
        TILES_WRITE,
        LIST,
        BIN_SENSORS,
    ];
    parts.concat()
}

/// How many sensors cover one pixel.
pub fn count_sensors(sample_count: u32) -> String {
    [
        HOST,
        SIGHT,
        SURFACE,
        SENSOR,
        depth(sample_count),
        COUNT_SENSORS,
    ]
    .concat()
}

/// The colour of the sensors that cover each pixel.
pub fn resolve_sensors(sample_count: u32) -> String {
    let depth = depth(sample_count);
    let parts = [
        SIGHT,
        HOST,
        SURFACE,
        SENSOR,
        depth,
        TILE,
        TILES_READ,
        LIST,
        RESOLVE_SENSORS,
    ];
    parts.concat()
}

/// Every program with its name, for validation without a GPU.
pub fn all() -> Vec<(&'static str, String)> {
    vec![
        ("count", count(false)),
        ("count_unclipped", count(true)),
        ("copy_depth", copy_depth(1, false)),
        ("copy_depth_multisampled", copy_depth(4, false)),
        ("copy_log_depth", copy_depth(1, true)),
        ("copy_log_depth_multisampled", copy_depth(4, true)),
        ("resolve", resolve(1)),
        ("resolve_multisampled", resolve(4)),
        ("resolve_mixture", resolve_mixture(1)),
        ("resolve_mixture_multisampled", resolve_mixture(4)),
        ("resolve_styled", resolve_styled(1, true)),
        ("resolve_styled_many", resolve_styled(1, false)),
        ("resolve_styled_multisampled", resolve_styled(4, true)),
        ("pick", pick(1)),
        ("pick_multisampled", pick(4)),
        ("edge", edge(1)),
        ("edge_multisampled", edge(4)),
        ("bin_sensors", bin_sensors(1)),
        ("bin_sensors_multisampled", bin_sensors(4)),
        ("count_sensors", count_sensors(1)),
        ("count_sensors_multisampled", count_sensors(4)),
        ("resolve_sensors", resolve_sensors(1)),
        ("resolve_sensors_multisampled", resolve_sensors(4)),
    ]
}

#[cfg(test)]
mod tests {
    use std::mem::{offset_of, size_of};

    use crate::{
        frame::edge_uniform::EdgeUniform, frame::placed::Placed,
        frame::sensor_record::SensorRecord, frame::sight_uniform::SightUniform,
        gpu::gpu_mesh::ArcRecord, gpu::layer_tables::LayerHead, gpu::pick_pipeline::AnswerHead,
        gpu::style_record::StyleRecord, view::FrameUniform,
    };

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
            heights, slack, depth, beyond
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<FrameUniform>());
    }

    #[test]
    fn the_arc_record_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::count(false), "Arc");
        assert_eq!(members, offsets!(ArcRecord: left, right));
        assert_eq!(size, size_of::<ArcRecord>());
    }

    #[test]
    fn the_sensor_record_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::bin_sensors(1), "Sensor");
        let expected = offsets!(
            SensorRecord: axis, across, cone, limb, line, rise, weight, planes
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<SensorRecord>());
    }

    #[test]
    fn tiles_and_pages_are_as_large_as_the_shader_says() {
        use crate::{
            frame::sight_uniform::{BLOCK, TILE},
            gpu::sensor_view::{PAGE_ENTRIES, TILE_BYTES, WORKGROUP},
        };
        let source = super::bin_sensors(1);
        assert_eq!(layout_of(&source, "Tile").1 as u64, TILE_BYTES);
        for expected in [
            format!("const TILE: u32 = {TILE}u;"),
            format!("const BLOCK: u32 = {BLOCK}u;"),
            format!("const PAGE: u32 = {PAGE_ENTRIES}u;"),
            format!("@workgroup_size({WORKGROUP})"),
        ] {
            assert!(source.contains(&expected), "{expected}");
        }
    }

    #[test]
    fn the_sight_uniform_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::bin_sensors(1), "Sight");
        let expected = offsets!(
            SightUniform: ray, right, down, depth, ellipsoid, eye_gradient, foot_gradient, size,
            tiles, blocks, counts, bounds, window
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<SightUniform>());
    }

    #[test]
    fn styles_and_places_have_the_layout_of_the_shader() {
        let source = super::resolve_styled(1, true);
        let (members, size) = layout_of(&source, "Style");
        let expected = offsets!(
            StyleRecord: pattern, paper, inked, tint, hatch, fade, fade_sine, stroke, stroke_size
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<StyleRecord>());
        let (members, size) = layout_of(&source, "Placed");
        assert_eq!(members, offsets!(Placed: u, v, fall, phase));
        assert_eq!(size, size_of::<Placed>());
    }

    #[test]
    fn styles_need_what_the_shader_says() {
        use crate::gpu::style_record as table;
        let source = super::resolve_styled(1, true);
        let needs = [
            ("LINES", table::LINES),
            ("ACROSS", table::ACROSS),
            ("DOTS", table::DOTS),
            ("CHECKER", table::CHECKER),
            ("TILES", table::TILES),
            ("CLAMPED", table::CLAMPED),
            ("REPEATED", table::REPEATED),
            ("ANGLES", table::ANGLES),
            ("FADES", table::FADES),
            ("STROKES", table::STROKES),
            ("SMOOTH", table::SMOOTH),
            ("ADDITIVE", table::ADDITIVE),
            ("MAPS", table::MAPS),
            ("INKED", table::INKED),
            ("ARRAYS", table::ARRAYS),
            ("SPHERES", table::SPHERES),
            ("TURNS", table::TURNS),
        ];
        for (name, bit) in needs {
            let expected = format!("const NEEDS_{name}: u32 = {bit}u;");
            assert!(source.contains(&expected), "{expected}");
        }
    }

    #[test]
    fn the_edge_uniform_has_the_layout_of_the_shader() {
        let (members, size) = layout_of(&super::edge(1), "EdgeSight");
        let expected = offsets!(
            EdgeUniform: foot, foot_fraction, foot_remainder, axis, surface, code
        );
        assert_eq!(members, expected);
        assert_eq!(size, size_of::<EdgeUniform>());
    }

    #[test]
    fn the_answer_of_a_pick_has_the_layout_of_the_shader() {
        let (members, _) = layout_of(&super::pick(1), "Answer");
        let mut expected = offsets!(AnswerHead: pixel, layers, unused);
        expected.push(("fills".to_owned(), size_of::<AnswerHead>()));
        assert_eq!(members, expected);
    }

    #[test]
    fn the_layer_head_has_the_layout_of_the_shader() {
        for samples in [1, 4] {
            let (members, _) = layout_of(&super::resolve(samples), "Layer");
            let expected = offsets!(LayerHead: fills, base, digits, planes, check_bits);
            assert_eq!(members, expected);
        }
    }
}
