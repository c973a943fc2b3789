//! Element sets from a file.

use std::{fs, path::Path};

use sgp4::Elements;

/// Reads TLE or 3LE text, or OMM JSON: one object or a list.
pub fn read(path: &Path) -> Result<Vec<Elements>, String> {
    let text = fs::read_to_string(path)
        .map_err(|error| format!("{}: cannot read the element sets: {error}", path.display()))?;
    let elements = match text.trim_start().as_bytes().first() {
        Some(b'[') => serde_json::from_str(&text).map_err(|error| error.to_string()),
        Some(b'{') => serde_json::from_str(&text)
            .map(|elements| vec![elements])
            .map_err(|error| error.to_string()),
        _ => from_lines(&text),
    };
    match elements {
        Ok(elements) if elements.is_empty() => Err("there are no element sets".into()),
        other => other,
    }
    .map_err(|error: String| format!("{}: {error}", path.display()))
}

/// Two lines a satellite, or three with its name in front.
fn from_lines(text: &str) -> Result<Vec<Elements>, String> {
    let mut elements = Vec::new();
    let mut first: Option<&str> = None;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim_end();
        let complaint = |what: &str| format!("line {}: {what}", index + 1);
        // The parser cuts lines at bytes without looking.
        if (is_line(1, line) || is_line(2, line)) && !line.is_ascii() {
            return Err(complaint("only a name can have letters beyond ASCII"));
        }
        match (first, line) {
            (Some(one), two) if two.starts_with("2 ") => {
                let set = Elements::from_tle(None, one.as_bytes(), two.as_bytes())
                    .map_err(|error| complaint(&error.to_string()))?;
                elements.push(set);
                first = None;
            }
            (Some(_), _) => return Err(complaint("expected line 2 of an element set")),
            (None, two) if two.starts_with("2 ") => {
                return Err(complaint("line 2 of an element set without its line 1"));
            }
            (None, one) if one.starts_with("1 ") => {
                first = Some(one);
            }
            // A name, or nothing.
            (None, _) => {}
        }
    }
    match first {
        Some(_) => Err("the last element set lacks its line 2".into()),
        None => Ok(elements),
    }
}

/// Whether a line of text is the line of an element set with that number, rather than a name.
fn is_line(number: u8, line: &str) -> bool {
    line.as_bytes().starts_with(&[b'0' + number, b' '])
}
