//! Styles of `render`: what is refused, and which of several styles wins.

mod render_example;

use render_example::{Workplace, refused};

#[test]
fn impossible_styles() {
    let workplace = Workplace::new("styles");
    for arguments in [
        ["--style", "stripes"],
        ["--style", "image="],
        ["--color", "reddish"],
        ["--color", "#12345"],
        ["--pattern-color", "ff0000"],
        ["--opacity", "1.5"],
        ["--opacity", "-0.5"],
        ["--spacing", "-12px"],
        ["--spacing", "0km"],
        ["--spacing", "5cm"],
        ["--share", "2"],
        ["--angle", "NaN"],
        ["--anchor", "0,91"],
        ["--blend", "multiply"],
        ["--mapping", "mercator"],
        ["--extents", "0,1,2"],
        ["--extents", "-10,5,10,-5"],
        ["--center", "0"],
        ["--image-size", "-5,5"],
        ["--wrap", "mirror"],
        ["--rotation", "inf"],
        ["--repeats", "0,1"],
        ["--image-opacity", "2"],
        ["--stroke", "#gg0000"],
        ["--stroke-width", "-2px"],
        ["--stroke-align", "left"],
        ["--dash", "9px,2"],
        ["--fade-distance", "5km,5000m"],
        ["--fade-pixel", "-1,5"],
        ["--fade-angle", "0,91"],
    ] {
        let line = refused(&workplace, &arguments);
        assert!(line.contains(arguments[0]), "{line}");
    }
}

#[test]
fn contradictory_styles() {
    let workplace = Workplace::new("contradictions");
    workplace.write("i.png", "");
    let image = "--style=image=i.png";
    for (arguments, option) in [
        (vec!["--ignore-properties"], "--ignore-properties"),
        (vec!["--spacing", "12px"], "--spacing"),
        (vec!["--pattern-color", "red", image], "--pattern-color"),
        (vec!["--share", "0.5", "--style", "checker"], "--share"),
        (vec!["--share", "0.7", "--style", "dots"], "--share"),
        (vec!["--color", "red", "--style", "outline"], "--color"),
        (vec!["--wrap", "clamp", "--style", "hatch"], "--wrap"),
        (vec!["--dash", "9px"], "--dash"),
        (vec!["--stroke-width", "2px"], "--stroke-width"),
        (vec!["--extents", "0,0,1,1"], "--extents"),
        (vec!["--center", "0,0", image], "--center"),
        (vec!["--image-size", "5,5", image], "--image-size"),
        (vec!["--mapping", "local", image], "--center"),
        (
            vec!["--mapping", "local", "--center", "0,0", image],
            "--image-size",
        ),
        (
            vec!["--mapping", "local", "--extents", "0,0,1,1", image],
            "--extents",
        ),
    ] {
        let line = refused(&workplace, &arguments);
        assert!(line.contains(option), "{arguments:?}: {line}");
    }
}

#[test]
fn unusable_images() {
    let workplace = Workplace::new("images");
    workplace.write("text.png", "no picture");
    for file in ["none.png", "text.png"] {
        for style in ["image", "pattern"] {
            let line = refused(&workplace, &["--style", &format!("{style}={file}")]);
            assert!(line.starts_with(&format!("error: {file}: ")), "{line}");
        }
    }
    let beside = with_properties(&[r#"{"fill-pattern":"image:none.png"}"#]);
    std::fs::create_dir(workplace.path("maps")).expect("a directory");
    workplace.write("maps/a.geojson", &beside);
    let line = refused(&workplace, &["--regions", "maps/a.geojson"]);
    assert!(line.contains("none.png: "), "{line}");
    assert!(line.contains("maps"), "{line}");
}

/// Features that cover the same square of 20°, with these properties.
fn with_properties(properties: &[&str]) -> String {
    let features: Vec<String> = properties
        .iter()
        .map(|properties| {
            format!(
                r#"{{"type":"Feature","properties":{properties},"geometry":{{"type":"Polygon",
                    "coordinates":[[[0,0],[20,0],[20,20],[0,20],[0,0]]]}}}}"#
            )
        })
        .collect();
    let features = features.join(",");
    format!(r#"{{"type":"FeatureCollection","features":[{features}]}}"#)
}

#[test]
fn nonsense_in_properties() {
    let workplace = Workplace::new("properties");
    for (name, value) in [
        ("fill", "\"reddish\""),
        ("fill-opacity", "\"much\""),
        ("stroke-width", "-1"),
        ("fill-pattern", "7"),
        ("fill-z", "0.5"),
    ] {
        let text = with_properties(&["{}", &format!("{{\"{name}\":{value}}}")]);
        workplace.write("bad.geojson", &text);
        let line = refused(&workplace, &["--regions", "bad.geojson"]);
        for part in ["bad.geojson: feature 1: ", &format!("\"{name}\"")] {
            assert!(line.contains(part), "{part} is not in: {line}");
        }
    }
}

/// A picture of the middle of that square, from so near that nothing else is in sight.
fn picture(workplace: &Workplace, arguments: &[&str]) -> image::RgbImage {
    let view = ["--camera", "10,10,1e5", "--size", "16x8", "--out", "o.png"];
    let run = workplace.render(&[arguments, &view].concat());
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{arguments:?}: {said}");
    let picture = image::open(workplace.path("o.png")).expect("a picture");
    picture.to_rgb8()
}

#[test]
fn properties_win_over_options_and_those_over_defaults() {
    let workplace = Workplace::new("precedence");
    workplace.write("plain.geojson", &with_properties(&[r#"{"name":"A"}"#]));
    let fill = r##"{"fill":"#ff0000","fill-opacity":1}"##;
    workplace.write("red.geojson", &with_properties(&[fill]));
    let all = |picture: &image::RgbImage, color: [u8; 3]| picture.pixels().all(|p| p.0 == color);

    let palette = picture(&workplace, &["--regions", "plain.geojson"]);
    assert!(
        !all(&palette, palette.get_pixel(0, 0).0),
        "the ground shows"
    );
    let solid = ["--regions", "plain.geojson", "--style", "solid"];
    let ignored = ["--regions", "red.geojson", "--ignore-properties"];
    for same in [&solid[..], &ignored] {
        assert!(picture(&workplace, same) == palette, "{same:?}");
    }
    let blue = ["--regions", "plain.geojson", "--color", "#0000ff"];
    assert!(all(&picture(&workplace, &blue), [0, 0, 255]));
    let red = ["--regions", "red.geojson", "--color", "#0000ff"];
    assert!(all(&picture(&workplace, &red), [255, 0, 0]));
    let ignored = [&red[..], &["--ignore-properties"]].concat();
    assert!(all(&picture(&workplace, &ignored), [0, 0, 255]));
}

#[test]
fn the_greater_fill_z_is_on_top() {
    let workplace = Workplace::new("order");
    for (properties, top) in [(["{}", "{}"], 2), ([r#"{"fill-z":"1"}"#, "{}"], 1)] {
        workplace.write("two.geojson", &with_properties(&properties));
        picture(
            &workplace,
            &[
                "--regions",
                "two.geojson",
                "--ids",
                "i.png",
                "--style=hatch",
            ],
        );
        let ids = image::open(workplace.path("i.png")).expect("a picture");
        assert!(ids.to_luma16().pixels().all(|id| id.0 == [top]), "{top}");
    }
}

#[test]
fn what_styles_cost_is_told_where_there_are_any() {
    let workplace = Workplace::new("cost");
    for (style, is_told) in [("solid", false), ("hatch", true)] {
        let stats = ["--style", style, "--stats", "s.json", "--frames", "1"];
        picture(&workplace, &[&stats[..], &["--countries", "110m"]].concat());
        let text = std::fs::read_to_string(workplace.path("s.json")).expect("statistics");
        let stats: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        for field in ["solid_ms", "style_extra_globes"] {
            assert_eq!(stats[field].is_number(), is_told, "{field}: {stats}");
            assert_eq!(stats[field].is_null(), !is_told, "{field}: {stats}");
        }
    }
}
