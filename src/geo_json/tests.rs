use super::*;

const SQUARE: &str = "[[0,0],[10,0],[10,10],[0,10],[0,0]]";
const HOLE: &str = "[[2,2],[2,4],[4,4],[2,2]]";

fn polygon(rings: &str) -> String {
    format!(r#"{{"type":"Polygon","coordinates":[{rings}]}}"#)
}

fn feature(geometry: &str) -> String {
    format!(r#"{{"type":"Feature","properties":null,"geometry":{geometry}}}"#)
}

fn collection(features: &[String]) -> String {
    let features = features.join(",\n");
    format!("{{\"type\":\"FeatureCollection\",\"features\":[\n{features}]}}")
}

fn error(text: &str) -> String {
    let message = regions_from_geojson(text).unwrap_err().to_string();
    assert!(!message.contains('\n'), "one line: {message:?}");
    message
}

/// The error of a collection whose second feature has this geometry.
fn second_error(geometry: &str) -> String {
    error(&collection(&[feature(&polygon(SQUARE)), feature(geometry)]))
}

#[test]
fn polygons_and_multipolygons_keep_every_ring() {
    let multi = format!(r#"{{"type":"MultiPolygon","coordinates":[[{SQUARE},{HOLE}],[{HOLE}]]}}"#);
    let text = collection(&[feature(&polygon(SQUARE)), feature(&multi)]);
    let regions = regions_from_geojson(&text).unwrap();
    let shapes: Vec<Vec<_>> = regions
        .iter()
        .map(|named| {
            let polygons = named.region.polygons.iter();
            polygons.map(|p| (p.shell.len(), p.holes.len())).collect()
        })
        .collect();
    assert_eq!(shapes, [vec![(5, 0)], vec![(5, 1), (4, 0)]]);
    assert_eq!(
        regions[0].region.polygons[0].shell[2],
        LonLat::new(10.0, 10.0)
    );
    assert_eq!(regions[0].region.edges, EdgeKind::Straight);
    assert_eq!(regions[0].region.inside, Inside::Smaller);
}

#[test]
fn a_feature_a_geometry_and_a_collection_are_one_region() {
    let square = polygon(SQUARE);
    let nested = format!(
        r#"{{"type":"GeometryCollection","geometries":[{square},
            {{"type":"GeometryCollection","geometries":[{square}]}}]}}"#
    );
    for (text, polygons) in [
        (square.clone(), 1),
        (feature(&square), 1),
        (format!("\u{feff}{square}"), 1),
        (nested.clone(), 2),
        (feature(&nested), 2),
    ] {
        let regions = regions_from_geojson(&text).unwrap();
        assert_eq!(regions.len(), 1, "{text}");
        assert_eq!(regions[0].region.polygons.len(), polygons, "{text}");
    }
    assert_eq!(regions_from_geojson(&collection(&[])), Ok(vec![]));
}

#[test]
fn names_and_ids_are_kept() {
    let square = polygon(SQUARE);
    for (members, id, name) in [
        (
            r#""id":7,"properties":{"name":"A","NAME":"B"}"#,
            Some("7"),
            Some("A"),
        ),
        (
            r#""id":"x","properties":{"name":null,"ADMIN":"C"}"#,
            Some("x"),
            Some("C"),
        ),
        (r#""properties":{"name":5}"#, None, None),
        (r#""id":null,"properties":null"#, None, None),
    ] {
        let text = format!(r#"{{"type":"Feature",{members},"geometry":{square}}}"#);
        let named = regions_from_geojson(&text).unwrap().remove(0);
        assert_eq!((named.id.as_deref(), named.name.as_deref()), (id, name));
    }
}

#[test]
fn properties_are_kept_as_they_are() {
    let square = polygon(SQUARE);
    let text = collection(&[
        format!(
            r##"{{"type":"Feature","geometry":{square},"properties":
                {{"name":"A","fill":"#f00","fill-opacity":0.25,"tags":[1,null,{{"a":true}}]}}}}"##
        ),
        feature(&square),
        format!(r#"{{"type":"Feature","geometry":{square}}}"#),
    ]);
    let regions = regions_from_geojson(&text).unwrap();
    let properties = &regions[0].properties;
    assert_eq!(properties.len(), 4);
    assert_eq!(properties["name"], JsonValue::from("A"));
    assert_eq!(properties["fill"], JsonValue::from("#f00"));
    assert_eq!(properties["fill-opacity"], JsonValue::from(0.25));
    assert_eq!(properties["tags"][2]["a"], JsonValue::from(true));
    assert!(regions[1].properties.is_empty() && regions[2].properties.is_empty());
    assert!(
        regions_from_geojson(&square).unwrap()[0]
            .properties
            .is_empty()
    );
}

#[test]
fn altitudes_are_left_out() {
    let text = polygon("[[0,0,5],[10,0,5,1],[10,10,5],[0,0,5]]");
    let regions = regions_from_geojson(&text).unwrap();
    assert_eq!(
        regions[0].region.polygons[0].shell[1],
        LonLat::new(10.0, 0.0)
    );
}

#[test]
fn numbers_are_read_exactly_however_written() {
    // Borders are shared by equality, so 1 ulp more or less would tear neighbours apart.
    let numbers: Vec<f64> = (1..2000)
        .map(|i| f64::from(i) * 0.087_712_345_678_9)
        .collect();
    let position = |x: &f64| format!("[{x}000000, {}E-1]", -x * 10.0);
    let ring = numbers.iter().map(position).collect::<Vec<_>>().join(",");
    let regions = regions_from_geojson(&polygon(&format!("[{ring}]"))).unwrap();
    let shell = &regions[0].region.polygons[0].shell;
    for (vertex, x) in shell.iter().zip(&numbers) {
        let y: f64 = format!("{}E-1", -x * 10.0).parse().unwrap();
        assert_eq!(*vertex, LonLat::new(*x, y));
    }
}

#[test]
fn what_the_mesher_reports_is_passed_on() {
    for rings in ["", "[]", "[[0,0],[1,1]]", "[[0,91],[1,91],[1,92],[0,91]]"] {
        let regions = regions_from_geojson(&polygon(rings)).unwrap();
        assert_eq!(regions[0].region.polygons.len(), 1, "{rings}");
    }
}

#[test]
fn geometries_that_cannot_be_filled_are_named() {
    for (geometry, expected) in [
        ("null", "feature 1: the geometry is null or missing"),
        (
            r#"{"type":"Point","coordinates":[1,2]}"#,
            "feature 1: a Point cannot be filled, only Polygon and MultiPolygon can",
        ),
        (
            r#"{"type":"LineString","coordinates":[[1,2],[3,4]]}"#,
            "feature 1: a LineString cannot be filled, only Polygon and MultiPolygon can",
        ),
        (
            r#"{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2]}]}"#,
            "feature 1: a Point cannot be filled, only Polygon and MultiPolygon can",
        ),
        (
            r#"{"type":"GeometryCollection","geometries":[]}"#,
            "feature 1: the geometry has no polygon",
        ),
        (
            r#"{"type":"MultiPolygon","coordinates":[]}"#,
            "feature 1: the geometry has no polygon",
        ),
        (
            r#"{"type":"Polygon","coordinates":[[[0,0],[1],[2,2],[0,0]]]}"#,
            "feature 1, polygon 0, ring 0, vertex 1: the position has fewer than two numbers",
        ),
    ] {
        assert_eq!(second_error(geometry), expected);
    }
    assert_eq!(
        error(r#"{"type":"Feature"}"#),
        "feature 0: the geometry is null or missing"
    );
}

#[test]
fn bad_numbers_are_placed() {
    let vertex = "feature 1, polygon 0, ring 1, vertex 2: ";
    for bad in [
        "NaN", "1e400", "-1e999", "null", "\"3\"", "Infinity", "[1]", "{}", "0x1", "--1", "]",
    ] {
        let rings = format!("{SQUARE},[[0,0],[1,0],[2,{bad}],[0,0]]");
        let message = second_error(&polygon(&rings));
        assert!(message.starts_with(vertex), "{bad}: {message}");
        assert!(message.contains(" at line 3 column "), "{bad}: {message}");

        let multi = polygon(&format!("[{SQUARE}],[{rings}]")).replace("Poly", "MultiPoly");
        let message = second_error(&multi);
        let vertex = vertex.replace("polygon 0", "polygon 1");
        assert!(message.starts_with(&vertex), "{bad}: {message}");
    }
}

#[test]
fn wrong_structure_names_the_feature() {
    for geometry in [
        r#"{"type":"Polygon"}"#,
        r#"{"type":"Polygon","coordinates":null}"#,
        r#"{"type":"Polygon","coordinates":7}"#,
        r#"{"type":"Polygon","coordinates":[1,2]}"#,
        r#"{"type":"Polygon","coordinates":[[0,0],[1,0],[1,1],[0,0]]}"#,
        r#"{"type":"MultiPolygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}"#,
        r#"{"type":"Polygon","coordinates":[[[[[0,0]]]]]}"#,
        r#"{"type":"Circle","coordinates":[[0,0]]}"#,
        r#"{"coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}"#,
        r#"{"type":"GeometryCollection"}"#,
        "[]",
        "3",
    ] {
        let message = second_error(geometry);
        assert!(message.starts_with("feature 1"), "{geometry}: {message}");
        assert!(!message.contains("line 0"), "{geometry}: {message}");
    }
}

#[test]
fn errors_outside_features_name_none() {
    for text in [
        r#"{"type":"Topology","arcs":[]}"#,
        r#"{"type":"FeatureCollection","features":7}"#,
        r#"{"type":"FeatureCollection","features":[],"bbox":[NaN]}"#,
        r#"{"type":"Polygon"}"#,
    ] {
        assert!(!error(text).contains("feature "), "{}", error(text));
    }
    let message = error(&polygon("[[0,0],[1,NaN]]"));
    assert!(
        message.starts_with("feature 0, polygon 0, ring 0, vertex 1: "),
        "{message}"
    );
}

#[test]
fn keys_are_read_past_escapes_and_other_members() {
    let text = format!(
        r#"{{"type":"FeatureCollection","x\"{{[":["]}}\"",{{"features":[[1]]}}],"features":[{}]}}"#,
        feature(&polygon("[[0,0],[1e999,0]]"))
    );
    let message = error(&text);
    assert!(
        message.starts_with("feature 0, polygon 0, ring 0, vertex 1: "),
        "{message}"
    );
}

#[test]
fn broken_json_tells_line_and_column() {
    for (text, expected) in [
        ("", "EOF while parsing a value at line 1 column 0"),
        (
            "{\n\"type\":",
            "EOF while parsing a value at line 2 column 7",
        ),
        ("nonsense", "expected ident at line 1 column 2"),
        (
            "[]",
            "invalid type: sequence, expected GeoJson object at line 1 column 0",
        ),
    ] {
        assert!(error(text).ends_with(expected), "{}", error(text));
    }
    let whole = collection(&[feature(&polygon(SQUARE)), feature(&polygon(HOLE))]);
    for length in 0..whole.len() {
        let message = error(&whole[..length]);
        assert!(message.contains(" at line "), "cut to {length}: {message}");
    }
}

#[test]
fn hostile_texts_are_errors() {
    // Deep enough to overflow the stack of a parser without a limit.
    assert!(error(&"[".repeat(200_000)).contains("invalid type: sequence"));
    for open in ["{\"geometry\":", "{\"properties\":{\"a\":["] {
        assert!(
            error(&open.repeat(200_000)).contains("recursion limit"),
            "{open}"
        );
    }
    let deep = format!("{}{}", "[".repeat(200_000), "]".repeat(200_000));
    let text = second_error(&format!(r#"{{"type":"Polygon","coordinates":{deep}}}"#));
    assert!(text.contains("recursion limit"), "{text}");
    let collections = r#"{"type":"GeometryCollection","geometries":["#.repeat(100_000);
    assert!(error(&collections).contains("recursion limit"));
    // The message neither breaks the line nor repeats a megabyte of input.
    let long = format!(r#"{{"type":"{}\n"}}"#, "x\\n".repeat(500_000));
    assert!(error(&long).len() < 400);
}
