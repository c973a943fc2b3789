//! Bad input to `render`: one line that says what is wrong and where, exit code 1, no file written.

mod render_example;

use render_example::{Workplace, refused};

/// Runs `render` on a GeoJSON text and returns what it says.
fn complaint_about(name: &str, geojson: &str) -> String {
    let workplace = Workplace::new(name);
    workplace.write("bad.geojson", geojson);
    let line = refused(&workplace, &["--regions", "bad.geojson"]);
    assert!(line.starts_with("error: bad.geojson: "), "{line}");
    line
}

fn polygon(rings: &str) -> String {
    format!(
        r#"{{"type":"FeatureCollection","features":[
            {{"type":"Feature","properties":{{}},"geometry":
                {{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}}}},
            {{"type":"Feature","properties":{{}},"geometry":
                {{"type":"Polygon","coordinates":{rings}}}}}]}}"#
    )
}

#[test]
fn missing_regions() {
    let line = refused(&Workplace::new("missing"), &["--regions", "none.geojson"]);
    assert!(
        line.contains("none.geojson") && line.contains("cannot read"),
        "{line}"
    );
}

#[test]
fn broken_json() {
    let line = complaint_about("broken", r#"{"type":"FeatureCollection","features":["#);
    assert!(line.contains("line 1"), "{line}");
}

#[test]
fn not_json_at_all() {
    complaint_about("binary", "\u{1}\u{2}PNG");
    complaint_about("nothing", "");
}

#[test]
fn wrong_geometry() {
    let text = r#"{"type":"Feature","properties":{},
        "geometry":{"type":"LineString","coordinates":[[0,0],[1,1]]}}"#;
    let line = complaint_about("line", text);
    assert!(
        line.contains("feature 0") && line.contains("LineString"),
        "{line}"
    );
}

#[test]
fn not_a_number() {
    // JSON has no NaN; both ways of writing one must be refused, not read as something else.
    let line = complaint_about("nan", &polygon("[[[0,0],[1,0],[NaN,1],[0,0]]]"));
    assert!(line.contains("line"), "{line}");
    let line = complaint_about("null", &polygon("[[[0,0],[1,0],[null,1],[0,0]]]"));
    assert!(line.contains("feature 1"), "{line}");
}

#[test]
fn infinite() {
    complaint_about("infinite", &polygon("[[[0,0],[1,0],[1e999,1],[0,0]]]"));
}

#[test]
fn latitude_91() {
    let line = complaint_about("latitude", &polygon("[[[0,0],[1,0],[1,91],[0,0]]]"));
    for part in ["feature 1", "ring 0", "vertex 2", "91"] {
        assert!(line.contains(part), "{part} is not in: {line}");
    }
}

#[test]
fn latitude_91_in_a_hole() {
    let rings = "[[[0,0],[9,0],[9,9],[0,9],[0,0]],[[1,1],[2,1],[2,-91],[1,1]]]";
    let line = complaint_about("hole", &polygon(rings));
    for part in ["feature 1", "ring 1", "vertex 2"] {
        assert!(line.contains(part), "{part} is not in: {line}");
    }
}

#[test]
fn empty_ring() {
    let line = complaint_about("empty", &polygon("[[]]"));
    assert!(
        line.contains("feature 1") && line.contains("ring 0"),
        "{line}"
    );
}

#[test]
fn two_point_ring() {
    let line = complaint_about("two", &polygon("[[[0,0],[1,0],[0,0]]]"));
    for part in ["feature 1", "ring 0", "2 distinct"] {
        assert!(line.contains(part), "{part} is not in: {line}");
    }
}

#[test]
fn no_picture_size() {
    let workplace = Workplace::new("size");
    for size in [
        "0x0",
        "0x720",
        "1280x0",
        "-5x5",
        "1280",
        "axb",
        "99999x99999",
        "1e3x10",
    ] {
        let line = refused(&workplace, &["--size", size]);
        assert!(line.contains("--size"), "{line}");
    }
}

#[test]
fn impossible_camera() {
    let workplace = Workplace::new("camera");
    for camera in [
        "NaN,0,1e6",
        "0,nan,1e6",
        "0,0,NaN",
        "0,0,1e6,NaN,0",
        "0,0,1e6,0,NaN",
        "inf,0,1e6",
        "0,90.1,1e6",
        "0,-91,1e6",
        "0,0,-12001",
        "0,0,1e11",
        "0,0",
        "0,0,1,2",
        "0,0,1e6,0,-91",
        "0,0,1e6,0,-90,0",
        "",
        "a,b,c",
    ] {
        let line = refused(&workplace, &["--camera", camera]);
        assert!(line.contains("--camera"), "{line}");
    }
}

#[test]
fn impossible_options() {
    let workplace = Workplace::new("options");
    for arguments in [
        ["--fov", "0"],
        ["--fov", "180"],
        ["--fov", "NaN"],
        ["--pixel-error", "-1"],
        ["--pixel-error", "NaN"],
        ["--frames", "0"],
        ["--msaa", "3"],
        ["--edges", "round"],
        ["--orientation", "right"],
        ["--count", "fingers"],
        ["--countries", "10m"],
        ["--nonsense", "1"],
    ] {
        let line = refused(&workplace, &arguments);
        assert!(line.contains(arguments[0]), "{line}");
    }
}

#[test]
fn unusable_terrain() {
    let workplace = Workplace::new("terrain");
    let line = refused(&workplace, &["--terrain", "none.png"]);
    assert!(line.contains("none.png"), "{line}");
    workplace.write("text.png", "no picture");
    let line = refused(&workplace, &["--terrain", "text.png"]);
    assert!(line.contains("text.png"), "{line}");

    let grid = image::ImageBuffer::<image::Luma<u16>, _>::from_pixel(4, 4, image::Luma([7]));
    grid.save(workplace.path("grid.png")).expect("a picture");
    let line = refused(&workplace, &["--terrain", "grid.png"]);
    assert!(line.contains("grid.json"), "{line}");
    for (json, part) in [
        ("{", "grid.json"),
        (
            r#"{"west":0,"south":0,"east":1,"north":1,"scale":1}"#,
            "offset",
        ),
        (
            r#"{"west":1,"south":0,"east":0,"north":1,"scale":1,"offset":0}"#,
            "west",
        ),
        (
            r#"{"west":0,"south":0,"east":361,"north":1,"scale":1,"offset":0}"#,
            "west",
        ),
        (
            r#"{"west":0,"south":-91,"east":1,"north":1,"scale":1,"offset":0}"#,
            "south",
        ),
        (
            r#"{"west":0,"south":2,"east":1,"north":1,"scale":1,"offset":0}"#,
            "south",
        ),
        (
            r#"{"west":0,"south":0,"east":1,"north":1,"scale":1e6,"offset":0}"#,
            "scale",
        ),
        (
            r#"{"west":0,"south":0,"east":1,"north":"1","scale":1,"offset":0}"#,
            "north",
        ),
    ] {
        workplace.write("grid.json", json);
        let line = refused(&workplace, &["--terrain", "grid.png"]);
        assert!(line.contains(part), "{part} is not in: {line}");
    }
    let bytes = image::ImageBuffer::<image::Luma<u8>, _>::from_pixel(4, 4, image::Luma([7]));
    bytes.save(workplace.path("bytes.png")).expect("a picture");
    let line = refused(&workplace, &["--terrain", "bytes.png"]);
    assert!(line.contains("16 bits"), "{line}");
}

#[test]
fn nowhere_to_write() {
    let workplace = Workplace::new("nowhere");
    let run = workplace.render(&["--out", "none/o.png", "--stats", "s.json"]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(1), "{said}");
    assert!(
        said.contains("none/o.png") && said.lines().count() == 1,
        "{said}"
    );
    assert!(workplace.files().is_empty());
}

/// Below the terrain and looking down nothing is in sight: a picture of nothing, not a failure.
#[test]
fn a_camera_below_the_terrain_sees_nothing() {
    let workplace = Workplace::new("below");
    let root = env!("CARGO_MANIFEST_DIR");
    let terrain = format!("{root}/assets/demo/terrain-himalaya.png");
    let run = workplace.render(&[
        "--terrain",
        &terrain,
        "--camera",
        "87,30,1000",
        "--size",
        "32x32",
        "--mask",
        "m.png",
    ]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{said}");
}
