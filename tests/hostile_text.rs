//! Hostile GeoJSON is refused before it takes memory. One test, so that the peak is its own.

#![allow(missing_docs)]
#![cfg(feature = "geojson")]

use globefill::{
    Excess, Limits, Quantity,
    geo_json::{GeoJsonError, regions_from_geojson_within},
};

const MEGABYTE: usize = 1 << 20;

/// The most memory this process ever had, bytes, where the system tells.
fn peak_bytes() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: usize = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes << 10)
}

/// A text of 50 MB: `head`, then `part` over and over.
fn long(head: &str, part: &str) -> String {
    let mut text = part.repeat(50 * MEGABYTE / part.len());
    text.insert_str(0, head);
    text
}

#[test]
fn hostile_texts_are_refused_without_the_memory_they_ask_for() {
    let limits = Limits {
        json_values: 1_000_000,
        ..Limits::default()
    };
    let malformed = |error: &GeoJsonError| matches!(error, GeoJsonError::Malformed { .. });
    let many = |error: &GeoJsonError| {
        *error
            == GeoJsonError::Limit(Excess {
                what: Quantity::JsonValues,
                most: 1_000_000,
            })
    };
    type Check<'a> = &'a dyn Fn(&GeoJsonError) -> bool;
    let collections = r#"{"type":"GeometryCollection","geometries":["#;
    let unlimited = Limits {
        json_values: usize::MAX,
        ..Limits::default()
    };
    let cases: [(&str, &str, Limits, Check); 6] = [
        // The limit of depth is the parser's, the others are counted.
        ("", "[", unlimited, &malformed),
        ("", collections, unlimited, &malformed),
        (
            r#"{"type":"Polygon","coordinates":[[[0,0]"#,
            ",[0,0]",
            limits,
            &many,
        ),
        (
            r#"{"type":"Feature","properties":{"a":[0"#,
            ",[]",
            limits,
            &many,
        ),
        (
            r#"{"type":"FeatureCollection","features":[1"#,
            ",{}",
            limits,
            &many,
        ),
        // One value, however long.
        (
            r#"{"type":"Polygon","coordinates":""#,
            "[,{[,{[,{",
            limits,
            &malformed,
        ),
    ];
    for (head, part, limits, is_expected) in cases {
        let text = long(head, part);
        let before_bytes = peak_bytes();
        let error = regions_from_geojson_within(&text, &limits).unwrap_err();
        assert!(is_expected(&error), "{error}");
        assert!(error.to_string().len() < 500);
        if let (Some(before_bytes), Some(bytes)) = (before_bytes, peak_bytes()) {
            let taken_bytes = bytes - before_bytes;
            assert!(taken_bytes < 60 * MEGABYTE, "{taken_bytes} for {part}");
        }
    }

    let text = long(r#"{"type":"Polygon","coordinates":[[[0,0]"#, ",[0,0]");
    let limits = Limits {
        text_bytes: MEGABYTE,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::TextBytes,
        most: MEGABYTE,
    };
    assert_eq!(
        regions_from_geojson_within(&text, &limits),
        Err(GeoJsonError::Limit(excess))
    );
    assert_eq!(
        excess.to_string(),
        "more than 1048576 bytes of text, the limit that is set"
    );

    // What strings hold is not counted.
    let square = r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]}"#;
    let text = format!(
        r#"{{"type":"Feature","properties":{{"a":"[[[[,,,,{{\",,,,"}},"geometry":{square}}}"#
    );
    let within = |json_values| Limits {
        json_values,
        ..Limits::default()
    };
    assert!(regions_from_geojson_within(&text, &within(16)).is_ok());
    let excess = Excess {
        what: Quantity::JsonValues,
        most: 15,
    };
    assert_eq!(
        regions_from_geojson_within(&text, &within(15)),
        Err(GeoJsonError::Limit(excess))
    );
}
