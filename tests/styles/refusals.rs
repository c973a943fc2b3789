//! What a style may not say.

use globefill::{
    Align, Dash, Extents, Fade, FillStyle, Hatch, HatchKind, Image, ImageFill, ImageId, Length,
    LonLat, Pattern, Placement, Ramp, RendererError, Stroke, StyleError,
};

use crate::{
    PLACES, SMALL,
    common::headless::gpu,
    stage::{Stage, bare, ground, pose},
};

const BAD_SHARES: [f32; 6] = [
    f32::NAN,
    -0.001,
    1.001,
    f32::INFINITY,
    f32::NEG_INFINITY,
    1e38,
];
const BAD_NUMBERS: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

fn bad_lengths() -> Vec<Length> {
    let metres = [f32::NAN, f32::INFINITY, -1.0, 0.0, 9e-6, 4.1e8].map(Length::Metres);
    let pixels = [f32::NAN, f32::INFINITY, -1.0, 0.0, 0.015, 65_537.0].map(Length::Pixels);
    [metres, pixels].concat()
}

fn bad_colors() -> Vec<[f32; 4]> {
    let alphas = BAD_SHARES.map(|alpha| [0.5, 0.5, 0.5, alpha]);
    let parts = BAD_NUMBERS.map(|part| [0.1, part, 0.2, 0.5]);
    [&alphas[..], &parts].concat()
}

pub fn hatched(hatch: Hatch) -> FillStyle {
    FillStyle {
        pattern: Some(Pattern::Hatch(hatch)),
        ..Default::default()
    }
}

fn stroked(stroke: Stroke) -> FillStyle {
    FillStyle {
        stroke: Some(stroke),
        ..Default::default()
    }
}

fn of_fills(bad: &mut Vec<(&'static str, FillStyle)>) {
    for color in bad_colors() {
        let plain = FillStyle::default();
        bad.push(("color", FillStyle { color, ..plain }));
        let highlight = color;
        bad.push(("highlight", FillStyle { highlight, ..plain }));
        bad.push((
            "stroke.color",
            stroked(Stroke {
                color,
                ..Default::default()
            }),
        ));
        bad.push((
            "pattern.color",
            hatched(Hatch {
                color,
                ..Default::default()
            }),
        ));
    }
    for opacity in BAD_SHARES {
        bad.push((
            "opacity",
            FillStyle {
                opacity,
                ..Default::default()
            },
        ));
    }
    for number in BAD_NUMBERS {
        for (full, gone) in [(number, 1.0), (1.0, number), (3.0, 3.0)] {
            let ramp = Some(Ramp { full, gone });
            let fades = [
                (
                    "fade.distance_m",
                    Fade {
                        distance_m: ramp,
                        ..Default::default()
                    },
                ),
                (
                    "fade.pixel_m",
                    Fade {
                        pixel_m: ramp,
                        ..Default::default()
                    },
                ),
                (
                    "fade.angle_rad",
                    Fade {
                        angle_rad: ramp,
                        ..Default::default()
                    },
                ),
            ];
            bad.extend(fades.map(|(name, fade)| {
                (
                    name,
                    FillStyle {
                        fade,
                        ..Default::default()
                    },
                )
            }));
        }
    }
}

fn of_lines(bad: &mut Vec<(&'static str, FillStyle)>) {
    let hatch = Hatch::default();
    let stroke = Stroke::default();
    for length in bad_lengths() {
        bad.push((
            "pattern.spacing",
            hatched(Hatch {
                spacing: length,
                ..hatch
            }),
        ));
        bad.push((
            "stroke.width",
            stroked(Stroke {
                width: length,
                ..stroke
            }),
        ));
        let dash = Some(Dash {
            period: length,
            share: 0.5,
        });
        bad.push(("stroke.dash.period", stroked(Stroke { dash, ..stroke })));
    }
    for share in BAD_SHARES {
        for kind in [HatchKind::Lines, HatchKind::Cross, HatchKind::Checker] {
            bad.push((
                "pattern.share",
                hatched(Hatch {
                    share,
                    kind,
                    ..hatch
                }),
            ));
        }
        let dash = Some(Dash {
            period: Length::Metres(5.0),
            share,
        });
        let align = Align::Outer;
        bad.push((
            "stroke.dash.share",
            stroked(Stroke {
                dash,
                align,
                ..stroke
            }),
        ));
    }
    let dots = Hatch {
        kind: HatchKind::Dots,
        share: 0.601,
        ..hatch
    };
    bad.push(("pattern.share", hatched(dots)));
    for angle_rad in BAD_NUMBERS {
        bad.push(("pattern.angle_rad", hatched(Hatch { angle_rad, ..hatch })));
    }
    for (lon_deg, lat_deg) in [
        (f64::NAN, 0.0),
        (0.0, f64::NAN),
        (f64::INFINITY, 0.0),
        (0.0, 90.1),
    ] {
        let anchor = Some(LonLat::new(lon_deg, lat_deg));
        bad.push(("pattern.anchor", hatched(Hatch { anchor, ..hatch })));
    }
}

fn of_images(image: ImageId, bad: &mut Vec<(&'static str, FillStyle)>) {
    let good = ImageFill::new(image);
    let mut push = |name, fill| {
        let pattern = Some(Pattern::Image(fill));
        bad.push((
            name,
            FillStyle {
                pattern,
                ..Default::default()
            },
        ));
    };
    for opacity in BAD_SHARES {
        push("pattern.opacity", ImageFill { opacity, ..good });
    }
    for rotation_rad in BAD_NUMBERS {
        push(
            "pattern.rotation_rad",
            ImageFill {
                rotation_rad,
                ..good
            },
        );
    }
    for count in [f32::NAN, f32::INFINITY, 0.0, -1.0, 9e-5, 1.1e4] {
        for repeats in [[count, 1.0], [1.0, count]] {
            push("pattern.repeats", ImageFill { repeats, ..good });
        }
    }
    let mut place = |placement| push("pattern.placement", ImageFill { placement, ..good });
    for side in [f32::NAN, f32::INFINITY, 0.0, -5.0, 9e-4, 4.1e8] {
        for size_m in [[side, 1.0], [1.0, side]] {
            let center = LonLat::new(5.0, 5.0);
            place(Placement::Local { center, size_m });
        }
    }
    for (lon_deg, lat_deg) in [(f64::NAN, 0.0), (0.0, -90.5)] {
        let center = LonLat::new(lon_deg, lat_deg);
        place(Placement::Local {
            center,
            size_m: [1.0; 2],
        });
    }
    for [west_deg, south_deg, east_deg, north_deg] in [
        [f64::NAN, 0.0, 1.0, 1.0],
        [0.0, f64::NAN, 1.0, 1.0],
        [0.0, 0.0, f64::INFINITY, 1.0],
        [0.0, 0.0, 1.0, 90.5],
        [0.0, 2.0, 1.0, 1.0],
        [3.0, 0.0, 3.0, 1.0],
        [0.0, 0.0, 900.0, 1.0],
    ] {
        let extents = Some(Extents {
            west_deg,
            south_deg,
            east_deg,
            north_deg,
        });
        place(Placement::Geodetic(extents));
        place(Placement::Spherical(extents));
    }
}

#[test]
fn nonsense_is_refused_by_name_and_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 1e4, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
    let texels = [255; 4 * 4];
    let image = Image::from_rgba8(2, 2, &texels).expect("an image");
    let image = stage
        .renderer
        .insert_image(&gpu.queue, &image)
        .expect("small");
    let mut bad = Vec::new();
    of_fills(&mut bad);
    of_lines(&mut bad);
    of_images(image, &mut bad);
    let good = hatched(Hatch {
        share: 0.4,
        ..Default::default()
    });
    stage.set(0, good);
    let before = stage.draw(&surface);
    for (name, style) in &bad {
        let error = stage.renderer.set_style(stage.mesh, 0, *style);
        let error = error.expect_err("nonsense");
        let named = RendererError::InvalidStyle {
            fill: 0,
            error: StyleError::OutOfRange(name),
        };
        assert_eq!(error, named, "{style:?}");
        assert!(error.to_string().contains(name), "{error}");
        assert_eq!(stage.renderer.style(stage.mesh, 0), Ok(good));
    }
    let after = stage.draw(&surface);
    assert_eq!(after.stats.upload_bytes, 0);
    assert!(after.texels == before.texels);
    println!("{} styles refused", bad.len());
}

#[test]
fn extremes_that_are_allowed_can_be_drawn() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 1e4, 0.7), SMALL);
    let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
    let lengths = [
        Length::Metres(1e-3),
        Length::Metres(4e8),
        Length::Pixels(1.0 / 64.0),
        Length::Pixels(65536.0),
    ];
    for kind in [
        HatchKind::Lines,
        HatchKind::Cross,
        HatchKind::Dots,
        HatchKind::Checker,
    ] {
        for spacing in lengths {
            for share in [0.0, 0.3, 0.6] {
                for angle_rad in [0.0, -1e6, 3e38] {
                    let hatch = Hatch {
                        kind,
                        spacing,
                        share,
                        angle_rad,
                        ..Default::default()
                    };
                    stage.set(
                        0,
                        FillStyle {
                            color: [1.0, 1.0, 1.0, 1.0],
                            ..hatched(hatch)
                        },
                    );
                    let texels = stage.draw(&surface).texels;
                    // Opaque, and grey: no pixel is left out or made of NaN.
                    let sound = |[r, g, b, a]: [u8; 4]| r == g && g == b && a == 255;
                    let shown = (0..texels.len()).filter(|&k| !surface.at_discontinuity(k));
                    let bad = shown.filter(|&k| !sound(texels[k])).count();
                    assert_eq!(bad, 0, "{hatch:?}");
                }
            }
        }
    }
}
