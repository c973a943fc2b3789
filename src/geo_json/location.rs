//! Where in a GeoJSON document a byte of its text lies.
//!
//! The parser reports a line and a column; a person wants the feature, the ring and the vertex.

use std::fmt;

use crate::repair::Place;

/// The part of a document in which an error was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Outside the features.
    Document,
    /// In the feature with this index.
    Feature(usize),
    /// In the coordinates of a vertex.
    Vertex(Place),
}

/// An array or object that is open at some byte of the text.
enum Open<'a> {
    /// An array, and the index of the element that is being read.
    Array(usize),
    /// An object, and the key whose value is being read.
    Object(&'a [u8]),
}

impl Location {
    /// The location of a byte given as a JSON parser does: both numbers from 1, 0 if unknown.
    pub(super) fn find(text: &str, line: usize, column: usize) -> Self {
        if line == 0 {
            return Self::Document;
        }
        let before: usize = text
            .split_inclusive('\n')
            .take(line - 1)
            .map(str::len)
            .sum();
        let end = (before + column.saturating_sub(1)).min(text.len());
        Self::of_path(&open_at_end(&text.as_bytes()[..end]))
    }

    fn of_path(path: &[Open]) -> Self {
        let (region, rest) = match path {
            [Open::Object(b"features"), Open::Array(index), rest @ ..] => (*index, rest),
            [
                Open::Object(b"geometry" | b"coordinates" | b"geometries"),
                ..,
            ] => (0, path),
            _ => return Self::Document,
        };
        let geometry = match rest {
            [Open::Object(b"geometry"), geometry @ ..] => geometry,
            geometry => geometry,
        };
        // Which polygon it is in a collection depends on the polygons before: only the feature is
        // told there. Four arrays deep is a MultiPolygon's number, three a Polygon's.
        let place = |polygon, ring, vertex| {
            Self::Vertex(Place {
                region,
                polygon,
                ring,
                vertex,
            })
        };
        match *geometry {
            [
                Open::Object(b"coordinates"),
                Open::Array(polygon),
                Open::Array(ring),
                Open::Array(vertex),
                Open::Array(_),
            ] => place(polygon, ring, vertex),
            [
                Open::Object(b"coordinates"),
                Open::Array(ring),
                Open::Array(vertex),
                Open::Array(_),
            ] => place(0, ring, vertex),
            _ => Self::Feature(region),
        }
    }
}

impl fmt::Display for Location {
    /// Written as a prefix: "feature 3: ", or nothing outside features.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Document => Ok(()),
            Self::Feature(index) => write!(f, "feature {index}: "),
            Self::Vertex(place) => write!(f, "{place}: "),
        }
    }
}

/// The arrays and objects that are open after these bytes, which are JSON up to there.
fn open_at_end(bytes: &[u8]) -> Vec<Open<'_>> {
    let mut open = Vec::new();
    // The last string read: a key if a colon follows.
    let mut string: &[u8] = &[];
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        at += 1;
        match byte {
            b'"' => {
                let start = at;
                at = end_of_string(bytes, at);
                string = &bytes[start..at.max(start + 1) - 1];
            }
            b'[' => open.push(Open::Array(0)),
            b'{' => open.push(Open::Object(&[])),
            b']' | b'}' => {
                open.pop();
            }
            b':' => {
                if let Some(Open::Object(key)) = open.last_mut() {
                    *key = string;
                }
            }
            b',' => match open.last_mut() {
                Some(Open::Array(index)) => *index += 1,
                Some(Open::Object(key)) => *key = &[],
                None => {}
            },
            _ => {}
        }
    }
    open
}

/// The byte after the quote that ends the string whose first byte is at `at`, or the end.
pub(super) fn end_of_string(bytes: &[u8], mut at: usize) -> usize {
    while let Some(&byte) = bytes.get(at) {
        at += 1;
        match byte {
            b'"' => return at,
            b'\\' => at += 1,
            _ => {}
        }
    }
    bytes.len()
}
