use clap::Parser;
use globefill::{FillStyle, Hatch, HatchKind, Pattern, Stroke};

use super::*;
use crate::{cli::Arguments, style::Images};

const PALETTE: [f32; 4] = [0.1, 0.2, 0.3, 0.5];

fn look(arguments: &[&str]) -> Result<Look, String> {
    let arguments = [&["render"], arguments].concat();
    let parsed = Arguments::try_parse_from(&arguments).map_err(|error| error.to_string())?;
    parsed.style.look(false)
}

fn style(arguments: &[&str]) -> FillStyle {
    look(arguments).unwrap().style(PALETTE, &Images::new())
}

#[test]
fn nothing_said_is_nothing_styled() {
    assert_eq!(look(&[]), Ok(Look::default()));
    assert_eq!(look(&["--style", "solid"]), Ok(Look::default()));
}

#[test]
fn options_reach_the_style() {
    let found = style(&[
        "--style=cross",
        "--color=#00f8",
        "--pattern-color=white",
        "--opacity=0.5",
        "--spacing=50km",
        "--share=0.75",
        "--angle=-90",
        "--anchor=-10,20",
        "--highlight=#ff000000",
        "--blend=add",
        "--stroke=lime",
        "--stroke-width=5km",
        "--stroke-align=outer",
        "--dash=9px,0.25",
        "--fade-distance=1km,2km",
        "--fade-pixel=3,4km",
        "--fade-angle=90,0",
    ]);
    let turn_rad = std::f32::consts::FRAC_PI_2;
    let ramp = |full, gone| Some(Ramp { full, gone });
    let expected = FillStyle {
        color: [0.0, 0.0, 1.0, 136.0 / 255.0],
        pattern: Some(Pattern::Hatch(Hatch {
            kind: HatchKind::Cross,
            color: [1.0; 4],
            spacing: Length::Metres(50e3),
            share: 0.75,
            angle_rad: -turn_rad,
            anchor: Some(LonLat::new(-10.0, 20.0)),
        })),
        highlight: [1.0, 0.0, 0.0, 0.0],
        stroke: Some(Stroke {
            color: [0.0, 1.0, 0.0, 1.0],
            width: Length::Metres(5e3),
            align: Align::Outer,
            dash: Some(Dash {
                period: Length::Pixels(9.0),
                share: 0.25,
            }),
        }),
        opacity: 0.5,
        fade: Fade {
            distance_m: ramp(1e3, 2e3),
            pixel_m: ramp(3.0, 4e3),
            angle_rad: ramp(turn_rad, 0.0),
        },
        blend: Blend::Additive,
        z_index: 0,
        visible: true,
    };
    assert_eq!(found, expected);
}

#[test]
fn patterns_have_their_own_defaults() {
    for (name, kind, angle_rad) in [
        ("hatch", HatchKind::Lines, std::f32::consts::FRAC_PI_4),
        ("dots", HatchKind::Dots, 0.0),
        ("checker", HatchKind::Checker, 0.0),
    ] {
        let expected = Hatch {
            kind,
            angle_rad,
            ..Default::default()
        };
        let found = style(&["--style", name]);
        assert_eq!(found.pattern, Some(Pattern::Hatch(expected)), "{name}");
        assert_eq!(found.color, PALETTE);
    }
}

#[test]
fn images_have_their_place() {
    let image = |options: &[&str]| {
        look(&[&["--style=image=a.png"], options].concat())
            .unwrap()
            .image
    };
    assert_eq!(image(&[]), ImageLook::default());
    let extents = Extents {
        west_deg: 170.0,
        south_deg: -10.0,
        east_deg: -170.0,
        north_deg: 10.0,
    };
    let across = ["--mapping=spherical", "--extents=170,-10,-170,10"];
    assert_eq!(
        image(&across).placement,
        Placement::Spherical(Some(extents))
    );
    let local = [
        "--mapping=local",
        "--center=5,-85",
        "--image-size=2km,500",
        "--wrap=repeat",
        "--rotation=180",
        "--repeats=2,3",
        "--image-opacity=0.5",
    ];
    let expected = ImageLook {
        placement: Placement::Local {
            center: LonLat::new(5.0, -85.0),
            size_m: [2e3, 500.0],
        },
        wrap: Wrap::Repeat,
        rotation_rad: std::f32::consts::PI,
        repeats: [2.0, 3.0],
        opacity: 0.5,
    };
    assert_eq!(image(&local), expected);
}

#[test]
fn what_the_style_does_not_use_is_for_properties() {
    let arguments = ["render", "--regions=a.geojson", "--spacing=5px"];
    let style = Arguments::try_parse_from(arguments).unwrap().style;
    assert!(style.look(false).unwrap_err().starts_with("--spacing "));
    let look = style.look(true).unwrap();
    assert_eq!(look.hatch.spacing, Some(Length::Pixels(5.0)));
    assert!(look.is_solid());
}
