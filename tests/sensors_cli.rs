//! The example `sensors`: every kind of picture, the stats file, and bad input.

mod render_example;

use std::collections::HashSet;

use image::RgbImage;
use render_example::Workplace;
use serde_json::Value;

/// Frames of a quarter of the usual size, small enough for a software adapter.
const SMALL: [&str; 2] = ["--size", "160x90"];

/// Runs `sensors`, which must succeed, and returns what it says besides.
fn succeed(workplace: &Workplace, arguments: &[&str]) -> String {
    let run = workplace.run("sensors", &[&SMALL, arguments].concat());
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{arguments:?}: {said}");
    said
}

/// The first frame that `sensors` draws.
fn first_frame(workplace: &Workplace, arguments: &[&str]) -> RgbImage {
    succeed(
        workplace,
        &[arguments, &["--frames", "1", "--out", "p"]].concat(),
    );
    picture(workplace, "p/frame-0000.png")
}

fn picture(workplace: &Workplace, name: &str) -> RgbImage {
    image::open(workplace.path(name))
        .expect("a picture")
        .into_rgb8()
}

fn stats(workplace: &Workplace, arguments: &[&str]) -> Value {
    succeed(workplace, &[arguments, &["--stats", "s.json"]].concat());
    let text = std::fs::read_to_string(workplace.path("s.json")).expect("the stats");
    serde_json::from_str(&text).expect("JSON")
}

/// Runs `sensors`, checks that it fails as promised, and returns its error.
fn refused(workplace: &Workplace, arguments: &[&str]) -> String {
    let before = workplace.files();
    let usual = [
        ["--frames", "1"],
        ["--size", "160x90"],
        ["--out", "p"],
        ["--stats", "s.json"],
    ];
    // Given twice, a flag would be refused for that.
    let unsaid = usual.iter().filter(|[flag, _]| !arguments.contains(flag));
    let rest: Vec<&str> = unsaid.flatten().copied().collect();
    let run = workplace.run("sensors", &[arguments, &rest].concat());
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(1), "{arguments:?}: {said}");
    assert_eq!(said.lines().count(), 1, "{arguments:?}: {said}");
    assert!(said.starts_with("error: "), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(run.stdout.is_empty());
    assert_eq!(workplace.files(), before, "{arguments:?} left something");
    said
}

fn differing_pixels(a: &RgbImage, b: &RgbImage) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
}

/// Pixels that are redder in `a` than in `b`.
fn redder_pixels(a: &RgbImage, b: &RgbImage) -> usize {
    a.pixels()
        .zip(b.pixels())
        .filter(|(a, b)| a.0[0] > b.0[0] + 20)
        .count()
}

#[test]
fn kinds_of_sensors_differ_and_extrusions_do_not_on_the_ellipsoid() {
    let workplace = Workplace::new("sensor-kinds");
    let mut pictures = Vec::new();
    for sensor in ["conic", "rectangular", "custom"] {
        let of = |extrusion| {
            first_frame(
                &workplace,
                &[
                    "--count",
                    "100",
                    "--sensor",
                    sensor,
                    "--extrusion",
                    extrusion,
                ],
            )
        };
        let (normal, apex) = (of("normal"), of("apex"));
        // The same set of points, tested at a surface that the depth buffer rounds.
        assert!(differing_pixels(&normal, &apex) < 20, "{sensor}");
        pictures.push(normal);
    }
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        assert!(differing_pixels(&pictures[a], &pictures[b]) > 200);
    }
}

#[test]
fn frames_move() {
    let workplace = Workplace::new("sensor-frames");
    succeed(
        &workplace,
        &[
            "--count", "20", "--frames", "3", "--step", "60", "--out", "d/e",
        ],
    );
    let frame = |index| picture(&workplace, &format!("d/e/frame-000{index}.png"));
    assert!(differing_pixels(&frame(0), &frame(1)) > 80);
    assert!(differing_pixels(&frame(1), &frame(2)) > 80);
    assert!(!workplace.path("d/e/frame-0003.png").exists());
}

/// A shell whose cones reach the limb leaves no gap; one of narrow cones leaves hardly anything else.
#[test]
fn gaps_are_highlighted() {
    let workplace = Workplace::new("sensor-gaps");
    let ground = first_frame(
        &workplace,
        &["--count", "1", "--no-countries", "--color", "00000000"],
    );
    let with = |half_angle| {
        let shell = [
            "--count",
            "400",
            "--half-angle",
            half_angle,
            "--no-countries",
        ];
        let threshold = ["--inclination", "90", "--threshold", "1"];
        first_frame(&workplace, &[&shell[..], &threshold].concat())
    };
    assert_eq!(redder_pixels(&with("70"), &ground), 0);
    // The globe is 69 px high.
    assert!(redder_pixels(&with("1"), &ground) > 3_000);
    let everywhere = first_frame(
        &workplace,
        &[
            "--count",
            "400",
            "--half-angle",
            "70",
            "--no-countries",
            "--coverage",
        ],
    );
    assert!(differing_pixels(&everywhere, &ground) > 3_000);
}

#[test]
fn stats_hold_what_they_promise_and_draws_do_not_grow() {
    let workplace = Workplace::new("sensor-stats");
    let of = |count, mode: &[&str]| {
        let shell = ["--count", count, "--frames", "3"];
        stats(&workplace, &[&shell, mode].concat())
    };
    for mode in [&[][..], &["--coverage"]] {
        let (few, many) = (of("10", mode), of("300", mode));
        for stats in [&few, &many] {
            for field in [
                "sensors",
                "update_us_per_sensor",
                "upload_bytes",
                "upload_bytes_per_frame",
                "draws",
                "frame_ms",
                "globe_ms",
                "script_ms",
            ] {
                let number = stats[field].as_f64();
                assert!(number.is_some_and(|number| number > 0.0), "{field} {stats}");
            }
            assert!(stats["adapter"].is_string());
            let [script_ms, frame_ms] =
                ["script_ms", "frame_ms"].map(|field| stats[field].as_f64().expect("a number"));
            assert!(script_ms <= frame_ms, "{stats}");
        }
        assert_eq!(few["sensors"], 10);
        assert_eq!(many["sensors"], 300);
        assert_eq!(few["draws"], many["draws"]);
        let upload_bytes = many["upload_bytes"].as_f64().expect("a number");
        assert!(upload_bytes <= 1024.0, "{upload_bytes} bytes");
    }
    assert!(!workplace.path("out").exists(), "pictures nobody asked for");
}

/// A satellite that hangs over the Pacific at the first frame, another over Africa.
fn messages() -> String {
    let message = |id: u32, node_deg: f64| {
        format!(
            r#"{{"OBJECT_NAME":"TEST {id}","OBJECT_ID":"2026-001A","EPOCH":"2026-01-01T00:00:00",
            "MEAN_MOTION":15.0,"ECCENTRICITY":0.001,"INCLINATION":10,"RA_OF_ASC_NODE":{node_deg},
            "ARG_OF_PERICENTER":0,"MEAN_ANOMALY":0,"EPHEMERIS_TYPE":0,"CLASSIFICATION_TYPE":"U",
            "NORAD_CAT_ID":{id},"ELEMENT_SET_NO":1,"REV_AT_EPOCH":1,"BSTAR":0,
            "MEAN_MOTION_DOT":0,"MEAN_MOTION_DDOT":0}}"#
        )
    };
    // Greenwich lies 100.7° east of the equinox at that midnight: in January the Sun at noon stands
    // about 280° from it, and midnight is half a turn from noon.
    format!("[{},{}]", message(1, 110.7), message(2, 280.7))
}

#[test]
fn satellites_of_a_file_are_where_they_should_be() {
    let workplace = Workplace::new("sensor-elements");
    workplace.write("two.json", &messages());
    let file = [
        "--elements",
        "two.json",
        "--color",
        "ff0000ff",
        "--no-countries",
    ];
    let seen = |camera| {
        let with = |color| {
            let arguments = [&file[..3], &[color], &file[4..], &["--camera", camera]].concat();
            first_frame(&workplace, &arguments)
        };
        let (red, none) = (with("ff0000ff"), with("00000000"));
        let middle = red.get_pixel(80, 45);
        (
            middle.0[0] > 200 && middle.0[1] < 40,
            differing_pixels(&red, &none),
        )
    };
    // The first stands over 10° E on the equator, the second over 180°.
    let (middle_is_red, area) = seen("10,0,2e7");
    assert!(middle_is_red && area > 30, "{area}");
    let (middle_is_red, area) = seen("180,0,2e7");
    assert!(middle_is_red && area > 30, "{area}");
    let (middle_is_red, area) = seen("95,0,2e7");
    assert!(!middle_is_red && area == 0, "{area}");

    let stats = stats(
        &workplace,
        &[&file[..], &["--count", "1", "--frames", "1"]].concat(),
    );
    assert_eq!(stats["sensors"], 1);
}

/// With the checksum that its last digit must be.
fn line(text: &str) -> String {
    let sum: u32 = text
        .chars()
        .map(|c| {
            if c == '-' {
                1
            } else {
                c.to_digit(10).unwrap_or(0)
            }
        })
        .sum();
    format!("{text}{}", sum % 10)
}

#[test]
fn element_sets_of_two_and_of_three_lines() {
    let workplace = Workplace::new("sensor-lines");
    let one = line("1 00001U 26001A   26001.00000000  .00000000  00000-0  00000-0 0  999");
    let two = line("2 00001  10.0000 110.7000 0010000   0.0000   0.0000 15.00000000    1");
    workplace.write("pair.tle", &format!("{one}\n{two}\n"));
    workplace.write("named.tle", &format!("\nTEST ÄÖ\r\n{one}\r\n{two}\r\n\r\n"));
    workplace.write(
        "one.json",
        messages()[1..].split_inclusive("}").next().unwrap(),
    );
    let of = |file| first_frame(&workplace, &["--elements", file]);
    let message = of("one.json");
    assert_eq!(differing_pixels(&of("pair.tle"), &message), 0);
    assert_eq!(differing_pixels(&of("named.tle"), &message), 0);

    // One digit has changed, the sum has not.
    let wrong = one.replacen("26001.0", "26001.1", 1);
    for (text, part) in [
        (String::new(), "no element sets"),
        ("hello\nworld\n".into(), "no element sets"),
        (one.clone(), "lacks its line 2"),
        (format!("{one}\n{one}\n"), "line 2: "),
        (format!("{two}\n"), "line 1: "),
        (format!("A\n{one}\n{}\n", &two[..60]), "line 3: "),
        (format!("{wrong}\n{two}\n"), "checksum"),
        (
            format!("{}ÄÄ{}\n{two}\n", &one[..30], &one[34..]),
            "line 1: ",
        ),
        ("[{}]".into(), "missing field"),
        ("[".into(), "line 1"),
        (messages().replace("0.001", "1.5"), "satellite 1"),
    ] {
        workplace.write("bad", &text);
        let said = refused(&workplace, &["--elements", "bad"]);
        assert!(said.starts_with("error: bad: "), "{said}");
        assert!(
            said.to_lowercase().contains(part),
            "{part} is not in: {said}"
        );
    }
    assert!(refused(&workplace, &["--elements", "none"]).contains("cannot read"));
}

/// A satellite that has come down is left out, not drawn where it fell.
#[test]
fn what_has_decayed_is_left_out() {
    let workplace = Workplace::new("sensor-decayed");
    let decaying = messages()
        .replacen("\"BSTAR\":0", "\"BSTAR\":0.1", 1)
        .replacen("2026-01-01", "2025-01-01", 1);
    workplace.write("two.json", &decaying);
    let said = succeed(
        &workplace,
        &["--elements", "two.json", "--frames", "1", "--out", "p"],
    );
    assert!(said.contains("1 of 2 satellites"), "{said}");
}

#[test]
fn circles_drift() {
    let workplace = Workplace::new("sensor-circles");
    let circles = ["--scene", "circles", "--count", "20", "--no-countries"];
    let stats = stats(
        &workplace,
        &[&circles[..], &["--frames", "2", "--out", "p"]].concat(),
    );
    assert_eq!(stats["sensors"], 20);
    assert_eq!(stats["visible"], 20);
    let frame = |index| picture(&workplace, &format!("p/frame-000{index}.png"));
    assert!(differing_pixels(&frame(0), &frame(1)) > 10);
    let colors: HashSet<_> = frame(0).pixels().map(|pixel| pixel.0).collect();
    assert!(colors.len() > 100);
}

#[test]
fn impossible_options() {
    let workplace = Workplace::new("sensor-options");
    for arguments in [
        &["--count", "0"][..],
        &["--count", "-1"],
        &["--count", "many"],
        &["--frames", "0"],
        &["--sensor", "radar"],
        &["--extrusion", "sideways"],
        &["--step", "NaN"],
        &["--half-angle", "0"],
        &["--half-angle", "181"],
        &["--half-angle", "90", "--sensor", "rectangular"],
        &["--min-elevation", "91"],
        &["--min-elevation", "nan"],
        &["--height", "-1"],
        &["--inclination", "181"],
        &["--planes", "7"],
        &["--planes", "0"],
        &["--threshold", "0"],
        &["--threshold", "1", "--coverage"],
        &["--color", "red"],
        &["--color", "ff00ÿ"],
        &["--camera", "0,91,1e7"],
        &["--size", "0x5"],
        &["--fov", "0"],
        &["--terrain", "none.png"],
        &["--scene", "chaos"],
        &["--nonsense"],
    ] {
        let said = refused(&workplace, arguments);
        let named = arguments[0].trim_start_matches('-');
        assert!(said.contains(named) || said.contains("none.png"), "{said}");
    }
}

#[test]
fn nowhere_to_write() {
    let workplace = Workplace::new("sensor-nowhere");
    workplace.write("file", "");
    let run = workplace.run("sensors", &["--out", "file", "--frames", "1"]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: file: "), "{said}");
}
