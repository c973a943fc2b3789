//! What is written with serde reads back as it was; what constructors refuse is refused on reading.

use std::fmt::Debug;

use globefill::{
    Align, Blend, Camera, CountTechnique, CoverageColors, Dash, DepthConvention, EdgeKind,
    Ellipsoid, Extents, Extrusion, Fade, FieldOfView, FillStyle, Frame, Hatch, HatchKind,
    HeightRange, ImageFill, ImageId, Inside, Length, Limits, LogDepth, LonLat, MeshOptions,
    Pattern, Placement, Polygon, Pose, Ramp, Region, RendererOptions, Sensor, SensorDisplay,
    SensorStyle, Stroke, Wrap, Zone,
    glam::{DMat3, DMat4, DVec3, UVec2},
    wgpu::TextureFormat,
};
use proptest::{
    array::{uniform2, uniform3, uniform4, uniform9, uniform16},
    collection::vec,
    num, option,
    prelude::*,
    sample::select,
    test_runner::RngSeed,
};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::json;

/// All numbers that JSON has.
fn single() -> impl Strategy<Value = f32> + Clone {
    use num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

/// All numbers that JSON has.
fn double() -> impl Strategy<Value = f64> + Clone {
    use num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn one_of<T: Clone + Debug + 'static>(values: &[T]) -> impl Strategy<Value = T> + use<T> {
    select(values.to_vec())
}

fn length() -> impl Strategy<Value = Length> {
    prop_oneof![
        single().prop_map(Length::Metres),
        single().prop_map(Length::Pixels)
    ]
}

fn lon_lat() -> impl Strategy<Value = LonLat> {
    (double(), double()).prop_map(|(lon_deg, lat_deg)| LonLat { lon_deg, lat_deg })
}

/// Numbers of images come from a renderer, or from a file.
fn image_id() -> impl Strategy<Value = ImageId> {
    any::<u32>().prop_map(|number| serde_json::from_value(json!(number)).unwrap())
}

fn hatch() -> impl Strategy<Value = Hatch> {
    let plain = one_of(&[
        HatchKind::Lines,
        HatchKind::Cross,
        HatchKind::Dots,
        HatchKind::Checker,
    ]);
    let kind = prop_oneof![plain, image_id().prop_map(HatchKind::Image)];
    let numbers = (uniform4(single()), single(), single());
    (kind, numbers, length(), option::of(lon_lat())).prop_map(
        |(kind, (color, share, angle_rad), spacing, anchor)| Hatch {
            kind,
            color,
            spacing,
            share,
            angle_rad,
            anchor,
        },
    )
}

fn placement() -> impl Strategy<Value = Placement> {
    let extents = || {
        uniform4(double()).prop_map(|[west_deg, south_deg, east_deg, north_deg]| Extents {
            west_deg,
            south_deg,
            east_deg,
            north_deg,
        })
    };
    prop_oneof![
        option::of(extents()).prop_map(Placement::Geodetic),
        option::of(extents()).prop_map(Placement::Spherical),
        (lon_lat(), uniform2(single()))
            .prop_map(|(center, size_m)| Placement::Local { center, size_m }),
    ]
}

fn image_fill() -> impl Strategy<Value = ImageFill> {
    let wrap = one_of(&[Wrap::Clip, Wrap::Clamp, Wrap::Repeat]);
    let numbers = (single(), uniform2(single()), single());
    (image_id(), placement(), wrap, numbers).prop_map(
        |(image, placement, wrap, (rotation_rad, repeats, opacity))| ImageFill {
            image,
            placement,
            wrap,
            rotation_rad,
            repeats,
            opacity,
        },
    )
}

fn stroke() -> impl Strategy<Value = Stroke> {
    let align = one_of(&[Align::Inner, Align::Center, Align::Outer]);
    let dash = (length(), single()).prop_map(|(period, share)| Dash { period, share });
    (uniform4(single()), length(), align, option::of(dash)).prop_map(
        |(color, width, align, dash)| Stroke {
            color,
            width,
            align,
            dash,
        },
    )
}

fn fade() -> impl Strategy<Value = Fade> {
    let ramp = (single(), single()).prop_map(|(full, gone)| Ramp { full, gone });
    uniform3(option::of(ramp)).prop_map(|[distance_m, pixel_m, angle_rad]| Fade {
        distance_m,
        pixel_m,
        angle_rad,
    })
}

fn fill_style() -> impl Strategy<Value = FillStyle> {
    let pattern = prop_oneof![
        hatch().prop_map(Pattern::Hatch),
        image_fill().prop_map(Pattern::Image)
    ];
    let colors = (uniform4(single()), uniform4(single()), single());
    let blend = one_of(&[Blend::Alpha, Blend::Additive]);
    let parts = (option::of(pattern), option::of(stroke()), fade());
    (colors, parts, blend, any::<i32>(), any::<bool>()).prop_map(
        |((color, highlight, opacity), (pattern, stroke, fade), blend, z_index, visible)| {
            FillStyle {
                color,
                pattern,
                highlight,
                stroke,
                opacity,
                fade,
                blend,
                z_index,
                visible,
            }
        },
    )
}

fn mesh_options() -> impl Strategy<Value = MeshOptions> {
    (uniform3(double()), vec(any::<usize>(), 7)).prop_map(|([a_m, b_m, tolerance_m], counts)| {
        MeshOptions {
            ellipsoid: Ellipsoid { a_m, b_m },
            tolerance_m,
            limits: Limits {
                text_bytes: counts[0],
                json_values: counts[1],
                vertices: counts[2],
                rings: counts[3],
                crossings: counts[4],
                overlaps: counts[5],
                mesh_vertices: counts[6],
            },
        }
    })
}

fn renderer_options() -> impl Strategy<Value = RendererOptions> {
    let formats = (
        one_of(&[
            TextureFormat::Rgba8UnormSrgb,
            TextureFormat::Bgra8Unorm,
            TextureFormat::Rgba16Float,
        ]),
        one_of(&[
            TextureFormat::Depth32Float,
            TextureFormat::Depth24PlusStencil8,
        ]),
    );
    let depth = one_of(&[DepthConvention::Reversed, DepthConvention::Standard]);
    let count = one_of(&[CountTechnique::Winding, CountTechnique::Stencil]);
    (formats, depth, any::<u32>(), count, any::<bool>()).prop_map(
        |((color_format, depth_format), depth, sample_count, count, smooth_edges)| {
            RendererOptions {
                color_format,
                depth_format,
                depth,
                sample_count,
                count,
                smooth_edges,
            }
        },
    )
}

fn vector() -> impl Strategy<Value = DVec3> {
    uniform3(double()).prop_map(DVec3::from_array)
}

fn frame() -> impl Strategy<Value = Frame> {
    let camera =
        (vector(), uniform9(double()), uniform16(double())).prop_map(|(eye_ecef_m, view, clip)| {
            Camera {
                eye_ecef_m,
                view_from_ecef: DMat3::from_cols_array(&view),
                clip_from_view: DMat4::from_cols_array(&clip),
            }
        });
    let log_depth = uniform4(double()).prop_map(|[near_m, far_m, from_m, per_m]| LogDepth {
        near_m,
        far_m,
        from_m,
        per_m,
    });
    let size_px = uniform2(any::<u32>()).prop_map(UVec2::from_array);
    (camera, size_px, uniform4(double()), option::of(log_depth)).prop_map(
        |(camera, size_px, [min_m, max_m, pixel_error, host_pixel_error], log_depth)| Frame {
            camera,
            size_px,
            terrain: HeightRange { min_m, max_m },
            pixel_error,
            host_pixel_error,
            log_depth,
        },
    )
}

fn zone() -> impl Strategy<Value = Zone> {
    prop_oneof![
        (lon_lat(), double()).prop_map(|(centre, radius_m)| Zone::circle(centre, radius_m)),
        (lon_lat(), double(), double())
            .prop_map(|(centre, min_m, max_m)| Zone::annulus(centre, min_m, max_m)),
        (lon_lat(), uniform4(double())).prop_map(|(centre, [min_m, max_m, from_deg, to_deg])| {
            Zone::sector(centre, min_m, max_m, from_deg, to_deg)
        }),
        (vec(lon_lat(), 0..5), double())
            .prop_map(|(points, width_m)| Zone::corridor(points, width_m)),
    ]
}

fn region() -> impl Strategy<Value = Region> {
    let ring = || vec(lon_lat(), 0..5);
    let polygon = (ring(), vec(ring(), 0..3)).prop_map(|(shell, holes)| Polygon { shell, holes });
    let edges = one_of(&[EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight]);
    let inside = one_of(&[Inside::Smaller, Inside::LeftOfRing]);
    (vec(polygon, 0..3), edges, inside, vec(zone(), 0..3)).prop_map(
        |(polygons, edges, inside, zones)| Region {
            polygons,
            edges,
            inside,
            zones,
        },
    )
}

/// All kinds; corners of a convex one as they fall, so that their lengths are not 1.
fn field_of_view() -> impl Strategy<Value = FieldOfView> {
    let turned = |(turn_rad, [right, up]): (f64, [f64; 2])| {
        let corners = [0.0_f64, 1.1, 2.5, 4.0, 5.2].map(|angle_rad| {
            let (sin, cos) = (angle_rad + turn_rad).sin_cos();
            DVec3::new(right * cos, up * sin, 1.0)
        });
        FieldOfView::convex(&corners).ok()
    };
    prop_oneof![
        (1e-6..3.1).prop_map(|half_angle_rad| FieldOfView::conic(half_angle_rad).unwrap()),
        (0.0..0.5, 0.6..3.1)
            .prop_map(|(inner_rad, outer_rad)| FieldOfView::annular(inner_rad, outer_rad).unwrap()),
        (0.01..1.5, 0.01..1.5)
            .prop_map(|(right_rad, up_rad)| FieldOfView::rectangular(right_rad, up_rad).unwrap()),
        (0.0..6.0, uniform2(0.01..10.0)).prop_filter_map("corners too far from the middle", turned),
    ]
}

fn sensor() -> impl Strategy<Value = Sensor> {
    let extrusion = one_of(&[Extrusion::Normal, Extrusion::Apex]);
    let pose = uniform3(vector()).prop_map(|[apex_ecef_m, boresight, up]| Pose {
        apex_ecef_m,
        boresight,
        up,
    });
    (pose, field_of_view(), option::of(double()), extrusion).prop_map(
        |(pose, field_of_view, min_elevation_rad, extrusion)| Sensor {
            pose,
            field_of_view,
            min_elevation_rad,
            extrusion,
        },
    )
}

fn display() -> impl Strategy<Value = SensorDisplay> {
    let colors = vec(uniform4(0.0_f32..=1.0), 1..20);
    prop_oneof![
        Just(SensorDisplay::Blended),
        colors.prop_map(|colors| SensorDisplay::Coverage(CoverageColors::table(colors).unwrap())),
    ]
}

fn round_trips<T>(value: &T) -> Result<(), TestCaseError>
where
    T: Serialize + DeserializeOwned + PartialEq + Debug,
{
    let text = serde_json::to_string(value).unwrap();
    let back: T = serde_json::from_str(&text)
        .map_err(|error| TestCaseError::fail(format!("{error} in {text}")))?;
    prop_assert_eq!(&back, value, "{}", text);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn styles_round_trip(style in fill_style()) {
        round_trips(&style)?;
    }

    #[test]
    fn options_round_trip(mesh in mesh_options(), renderer in renderer_options(), frame in frame()) {
        round_trips(&mesh)?;
        round_trips(&renderer)?;
        round_trips(&frame)?;
    }

    #[test]
    fn regions_round_trip(region in region()) {
        round_trips(&region)?;
    }

    #[test]
    fn sensors_round_trip(
        sensor in sensor(),
        color in uniform4(single()),
        visible in any::<bool>(),
        display in display(),
    ) {
        round_trips(&sensor)?;
        round_trips(&SensorStyle { color, visible })?;
        round_trips(&display)?;
    }
}

fn read<T: DeserializeOwned>(value: serde_json::Value) -> Result<T, String> {
    serde_json::from_value(value).map_err(|error| error.to_string())
}

/// What files look like does not change by renaming something in the code.
#[test]
fn the_notation_is_fixed() {
    let style = FillStyle {
        color: [0.25, 0.5, 0.75, 1.0],
        pattern: Some(Pattern::Hatch(Hatch {
            kind: HatchKind::Cross,
            spacing: Length::Metres(500.0),
            share: 0.25,
            angle_rad: 0.0,
            anchor: Some(LonLat::new(10.0, 50.0)),
            ..Default::default()
        })),
        stroke: Some(Stroke {
            align: Align::Center,
            ..Default::default()
        }),
        fade: Fade {
            distance_m: Some(Ramp {
                full: 2e6,
                gone: 8e6,
            }),
            ..Default::default()
        },
        blend: Blend::Additive,
        ..Default::default()
    };
    let written = json!({
        "color": [0.25, 0.5, 0.75, 1.0],
        "pattern": { "hatch": {
            "kind": "cross",
            "color": [0.0, 0.0, 0.0, 1.0],
            "spacing": { "metres": 500.0 },
            "share": 0.25,
            "angle_rad": 0.0,
            "anchor": { "lon_deg": 10.0, "lat_deg": 50.0 },
        } },
        "highlight": [0.0, 0.0, 0.0, 0.0],
        "stroke": {
            "color": [1.0, 1.0, 1.0, 1.0],
            "width": { "pixels": 2.0 },
            "align": "center",
            "dash": null,
        },
        "opacity": 1.0,
        "fade": {
            "distance_m": { "full": 2e6, "gone": 8e6 },
            "pixel_m": null,
            "angle_rad": null,
        },
        "blend": "additive",
        "z_index": 0,
        "visible": true,
    });
    assert_eq!(serde_json::to_value(style).unwrap(), written);
    assert_eq!(read(written), Ok(style));
    assert_eq!(
        serde_json::to_value(RendererOptions::default()).unwrap(),
        json!({
            "color_format": "rgba8unorm-srgb",
            "depth_format": "depth32float",
            "depth": "reversed",
            "sample_count": 1,
            "count": "winding",
            "smooth_edges": false,
        })
    );
    let zone = json!({ "zones": [
        { "circle": { "centre": { "lon_deg": 1.0, "lat_deg": 2.0 }, "radius_m": 3e4 } },
    ] });
    let circle = Zone::circle(LonLat::new(1.0, 2.0), 3e4);
    assert_eq!(read(zone), Ok(Region::from(circle)));
    let rectangle = json!({ "rectangular": { "right_rad": 0.2, "up_rad": 0.1 } });
    assert_eq!(
        read(rectangle),
        Ok(FieldOfView::rectangular(0.2, 0.1).unwrap())
    );
}

/// Files that know less than this version: what they leave out is as the defaults and constructors say.
#[test]
fn what_is_left_out_is_the_default() {
    assert_eq!(read(json!({})), Ok(FillStyle::default()));
    assert_eq!(read(json!({})), Ok(Hatch::default()));
    assert_eq!(read(json!({})), Ok(Stroke::default()));
    assert_eq!(read(json!({})), Ok(Fade::default()));
    assert_eq!(read(json!({})), Ok(SensorStyle::default()));
    assert_eq!(read(json!({})), Ok(MeshOptions::default()));
    assert_eq!(read(json!({})), Ok(Limits::default()));
    assert_eq!(read(json!({})), Ok(RendererOptions::default()));
    assert_eq!(read(json!({})), Ok(Region::default()));
    assert_eq!(read(json!({})), Ok(HeightRange::default()));
    let image: ImageId = read(json!(7)).unwrap();
    assert_eq!(read(json!({ "image": 7 })), Ok(ImageFill::new(image)));
    assert_eq!(
        read(json!({ "near_m": 0.1, "far_m": 1e9 })),
        Ok(LogDepth::new(0.1, 1e9))
    );
    let camera = Camera {
        eye_ecef_m: DVec3::new(7e6, 0.0, 0.0),
        view_from_ecef: DMat3::IDENTITY,
        clip_from_view: DMat4::IDENTITY,
    };
    assert_eq!(
        read(json!({ "camera": serde_json::to_value(camera).unwrap(), "size_px": [640, 480] })),
        Ok(Frame::new(camera, UVec2::new(640, 480)))
    );
    let pose = Pose::nadir(&Ellipsoid::WGS84, DVec3::new(7e6, 0.0, 0.0));
    let cone = json!({ "conic": { "half_angle_rad": 0.5 } });
    let sensor = json!({ "pose": serde_json::to_value(pose).unwrap(), "field_of_view": cone });
    let field_of_view = FieldOfView::conic(0.5).unwrap();
    assert_eq!(read(sensor), Ok(Sensor::new(pose, field_of_view)));
}

/// The fields that stand for nothing when they are left out.
#[test]
fn what_must_be_there_is_asked_for() {
    let asks = |error: Result<(), String>, field: &str| {
        let error = error.unwrap_err();
        assert!(
            error.contains(field) && error.contains("missing"),
            "{error}"
        );
    };
    asks(
        read::<LonLat>(json!({ "lon_deg": 1.0 })).map(drop),
        "lat_deg",
    );
    asks(read::<ImageFill>(json!({})).map(drop), "image");
    asks(read::<Ramp>(json!({ "full": 1.0 })).map(drop), "gone");
    asks(read::<Ellipsoid>(json!({ "a_m": 1.0 })).map(drop), "b_m");
    asks(read::<Polygon>(json!({ "holes": [] })).map(drop), "shell");
}

#[test]
fn misspelt_fields_are_named() {
    fn refuses<T: DeserializeOwned + Debug>(value: serde_json::Value) {
        let error = read::<T>(value).unwrap_err();
        assert!(
            error.contains("unknown") && error.contains("colour"),
            "{error}"
        );
    }
    refuses::<FillStyle>(json!({ "colour": [0, 0, 0, 1] }));
    refuses::<FillStyle>(json!({ "stroke": { "colour": [0, 0, 0, 1] } }));
    refuses::<FillStyle>(json!({ "pattern": { "hatch": { "colour": [0, 0, 0, 1] } } }));
    refuses::<FillStyle>(json!({ "pattern": { "image": { "image": 1, "colour": 1 } } }));
    refuses::<FillStyle>(json!({ "fade": { "colour": null } }));
    refuses::<Hatch>(json!({ "kind": "colour" }));
    refuses::<SensorStyle>(json!({ "colour": [0, 0, 0, 1] }));
    refuses::<MeshOptions>(json!({ "limits": { "colour": 1 } }));
    refuses::<RendererOptions>(json!({ "colour": "rgba8unorm" }));
    refuses::<Region>(json!({ "colour": 1 }));
    refuses::<Zone>(json!({ "circle": {
        "centre": { "lon_deg": 1.0, "lat_deg": 2.0 }, "radius_m": 1.0, "colour": 1,
    } }));
    refuses::<Placement>(json!({ "local": { "colour": 1 } }));
    refuses::<FieldOfView>(json!({ "conic": { "half_angle_rad": 0.5, "colour": 1 } }));
}

/// What a constructor checks cannot come in by a file.
#[test]
fn what_constructors_refuse_is_refused() {
    for (bad, why) in [
        (json!({ "conic": { "half_angle_rad": 0.0 } }), "the angle 0"),
        (
            json!({ "conic": { "half_angle_rad": 3.2 } }),
            "the angle 3.2",
        ),
        (
            json!({ "annular": { "inner_rad": 0.3, "half_angle_rad": 0.2 } }),
            "the angle 0.3",
        ),
        (
            json!({ "rectangular": { "right_rad": 0.3, "up_rad": 1.6 } }),
            "the angle 1.6",
        ),
        (
            json!({ "convex": { "corners": [[1, 0, 1], [0, 1, 1]] } }),
            "2 corners",
        ),
        (
            json!({ "convex": { "corners": [[1, 0, 1], [0, 1, 1], [0, 0, 0]] } }),
            "corner 2",
        ),
    ] {
        let error = read::<FieldOfView>(bad).unwrap_err();
        assert!(error.contains(why), "{error}");
    }
    for (bad, why) in [
        (json!({ "coverage": [] }), "0 colours"),
        (
            json!({ "coverage": [[0.0, 0.0, 0.0, 1.5]] }),
            "is not a colour",
        ),
        (
            json!({ "coverage": [[-0.1, 0.0, 0.0, 1.0]] }),
            "is not a colour",
        ),
    ] {
        let error = read::<SensorDisplay>(bad).unwrap_err();
        assert!(error.contains(why), "{error}");
    }
}

/// Images are numbers of the renderer that the styles were set in: they are exchanged on reading.
#[test]
fn images_are_exchanged() {
    let id = |number: u32| read::<ImageId>(json!(number)).unwrap();
    let shows = |pattern: serde_json::Value| {
        let style: FillStyle = read(json!({ "pattern": pattern })).unwrap();
        let other = style.map_image(|old| {
            assert_eq!(old, id(3));
            id(8)
        });
        other.pattern.and_then(|pattern| pattern.image())
    };
    assert_eq!(shows(json!({ "image": { "image": 3 } })), Some(id(8)));
    assert_eq!(
        shows(json!({ "hatch": { "kind": { "image": 3 } } })),
        Some(id(8))
    );
    assert_eq!(shows(json!({ "hatch": { "kind": "dots" } })), None);
    let plain = FillStyle::default();
    assert_eq!(plain.map_image(|_| unreachable!()), plain);
    // As keys of a map beside the styles.
    let files = std::collections::BTreeMap::from([(id(3), "flag.png")]);
    assert_eq!(
        serde_json::to_string(&files).unwrap(),
        r#"{"3":"flag.png"}"#
    );
}
