//! Regions from GeoJSON text (RFC 7946).

use geojson::{Feature, GeoJson, Geometry, GeometryValue, Position, feature::Id};

use crate::{
    geodetic::LonLat,
    limits::{Excess, Limits, Quantity},
    region::{EdgeKind, Inside, Polygon, Region, Ring},
    repair::Place,
};

mod location;

/// Properties and their values, as `serde_json` has them.
pub use geojson::{JsonObject, JsonValue};
pub use location::Location;
use location::end_of_string;

/// The members of a feature's properties that may hold its name, in the order they are tried: the
/// common one, then those of Natural Earth's files.
const NAME_PROPERTIES: [&str; 3] = ["name", "NAME", "ADMIN"];

/// The longest message of the JSON parser that is passed on, characters: it quotes the input.
const MESSAGE_CHARS: usize = 200;

/// A feature of a GeoJSON text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedRegion {
    /// The feature's `id`; a number is written out.
    pub id: Option<String>,
    /// The first of the properties `name`, `NAME` and `ADMIN` that is a text.
    pub name: Option<String>,
    /// All of the feature's properties; empty where they are null or missing, and for a bare geometry.
    /// What they mean, styles for one, is the host's to say.
    pub properties: JsonObject,
    /// The feature's polygons: edges [`EdgeKind::Straight`], as RFC 7946 §3.1.1 has it, and inside
    /// [`Inside::Smaller`], since winding cannot be trusted (§3.1.6). Altitudes are left out.
    pub region: Region,
}

/// Why a text does not give regions. Every message is one line.
///
/// What is read here is not yet checked as a boundary: latitudes, lengths of rings and edges are
/// when the region is meshed, by [`RegionError`](crate::RegionError).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GeoJsonError {
    /// The text is not JSON or not GeoJSON. A number that no `f64` holds (`1e400`), `NaN`, `null`
    /// among coordinates and nesting deeper than 128 are errors of this kind.
    #[error("{location}{message} at line {line} column {column}")]
    Malformed {
        /// The part of the document that was being read.
        location: Location,
        /// Line of the text, from 1; 0 if unknown.
        line: usize,
        /// Byte in that line, from 1; 0 before its first byte.
        column: usize,
        /// What the parser says.
        message: String,
    },
    /// The text asks for more than [`Limits`] allow.
    #[error(transparent)]
    Limit(#[from] Excess),
    /// The feature's geometry is null or missing: it has no place on the globe.
    #[error("feature {feature}: the geometry is null or missing")]
    NoGeometry {
        /// Index of the feature.
        feature: usize,
    },
    /// The feature's geometry is a collection or a multi-polygon of nothing.
    #[error("feature {feature}: the geometry has no polygon")]
    NoPolygon {
        /// Index of the feature.
        feature: usize,
    },
    /// A geometry that has no area.
    #[error("feature {feature}: a {found} cannot be filled, only Polygon and MultiPolygon can")]
    NotAnArea {
        /// Index of the feature.
        feature: usize,
        /// The type of the geometry.
        found: &'static str,
    },
    /// A position of fewer than two numbers.
    #[error("{place}: the position has fewer than two numbers")]
    ShortPosition {
        /// The vertex.
        place: Place,
    },
}

/// Reads the regions of a GeoJSON text, one for each feature, in their order.
///
/// A FeatureCollection, a Feature or a bare geometry (one feature) of type Polygon, MultiPolygon or
/// GeometryCollection of these. The polygons of a collection are counted through.
pub fn regions_from_geojson(text: &str) -> Result<Vec<NamedRegion>, GeoJsonError> {
    regions_from_geojson_within(text, &Limits::default())
}

/// [`regions_from_geojson`] for texts up to other limits than the default:
/// [`text_bytes`](Limits::text_bytes) and [`json_values`](Limits::json_values), which are checked before
/// anything is read. (The others are [`FillMesh::build`](crate::FillMesh::build)'s.)
pub fn regions_from_geojson_within(
    text: &str,
    limits: &Limits,
) -> Result<Vec<NamedRegion>, GeoJsonError> {
    limits.check(Quantity::TextBytes, text.len())?;
    check_values(text, limits)?;
    // RFC 8259 §8.1 allows a parser to ignore a byte order mark; editors on Windows write one.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    match text.parse().map_err(|error| malformed(text, &error))? {
        GeoJson::FeatureCollection(collection) => collection
            .features
            .into_iter()
            .enumerate()
            .map(|(index, feature)| named_region(index, feature))
            .collect(),
        GeoJson::Feature(feature) => Ok(vec![named_region(0, feature)?]),
        GeoJson::Geometry(geometry) => Ok(vec![NamedRegion {
            region: region(0, geometry)?,
            ..NamedRegion::default()
        }]),
    }
}

/// Counts values up to the limit, without reading them.
fn check_values(text: &str, limits: &Limits) -> Result<(), Excess> {
    let most = limits.most(Quantity::JsonValues);
    // No text has more values than bytes.
    if text.len() <= most {
        return Ok(());
    }
    let bytes = text.as_bytes();
    let (mut at, mut count) = (0, 0);
    while let Some(&byte) = bytes.get(at) {
        at += 1;
        match byte {
            b'"' => at = end_of_string(bytes, at),
            b',' | b'[' | b'{' => {
                count += 1;
                limits.check(Quantity::JsonValues, count)?;
            }
            _ => {}
        }
    }
    Ok(())
}

fn malformed(text: &str, error: &geojson::Error) -> GeoJsonError {
    let (line, column, message) = match error {
        geojson::Error::MalformedGeoJson(json) => (json.line(), json.column(), json.to_string()),
        other => (0, 0, other.to_string()),
    };
    let position = format!(" at line {line} column {column}");
    let message = message.strip_suffix(&position).unwrap_or(&message);
    GeoJsonError::Malformed {
        location: Location::find(text, line, column),
        line,
        column,
        message: message
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .take(MESSAGE_CHARS)
            .collect(),
    }
}

fn named_region(index: usize, feature: Feature) -> Result<NamedRegion, GeoJsonError> {
    let geometry = feature
        .geometry
        .ok_or(GeoJsonError::NoGeometry { feature: index })?;
    let properties = feature.properties.unwrap_or_default();
    Ok(NamedRegion {
        id: feature.id.map(|id| match id {
            Id::String(text) => text,
            Id::Number(number) => number.to_string(),
        }),
        name: name(&properties),
        properties,
        region: region(index, geometry)?,
    })
}

fn name(properties: &JsonObject) -> Option<String> {
    NAME_PROPERTIES
        .iter()
        .find_map(|&key| properties.get(key)?.as_str())
        .map(str::to_owned)
}

fn region(feature: usize, geometry: Geometry) -> Result<Region, GeoJsonError> {
    let mut polygons = Vec::new();
    push_polygons(feature, geometry.value, &mut polygons)?;
    if polygons.is_empty() {
        return Err(GeoJsonError::NoPolygon { feature });
    }
    Ok(Region {
        polygons,
        edges: EdgeKind::Straight,
        inside: Inside::Smaller,
        zones: Vec::new(),
    })
}

/// Appends the polygons of a geometry. Recurses as deep as the parser lets collections nest (128).
fn push_polygons(
    feature: usize,
    geometry: GeometryValue,
    polygons: &mut Vec<Polygon>,
) -> Result<(), GeoJsonError> {
    match geometry {
        GeometryValue::Polygon { coordinates } => push_polygon(feature, coordinates, polygons),
        GeometryValue::MultiPolygon { coordinates } => coordinates
            .into_iter()
            .try_for_each(|rings| push_polygon(feature, rings, polygons)),
        GeometryValue::GeometryCollection { geometries } => geometries
            .into_iter()
            .try_for_each(|part| push_polygons(feature, part.value, polygons)),
        other => Err(GeoJsonError::NotAnArea {
            feature,
            found: other.type_name(),
        }),
    }
}

fn push_polygon(
    feature: usize,
    rings: Vec<Vec<Position>>,
    polygons: &mut Vec<Polygon>,
) -> Result<(), GeoJsonError> {
    let mut place = Place {
        region: feature,
        polygon: polygons.len(),
        ..Place::default()
    };
    let mut read = Vec::with_capacity(rings.len());
    for positions in rings {
        read.push(ring(place, &positions)?);
        place.ring += 1;
    }
    let mut read = read.into_iter();
    polygons.push(Polygon {
        // A polygon of no rings has an empty shell, which is told when it is meshed.
        shell: read.next().unwrap_or_default(),
        holes: read.collect(),
    });
    Ok(())
}

fn ring(place: Place, positions: &[Position]) -> Result<Ring, GeoJsonError> {
    positions
        .iter()
        .enumerate()
        .map(|(vertex, position)| match *position.as_slice() {
            [lon_deg, lat_deg, ..] => Ok(LonLat::new(lon_deg, lat_deg)),
            _ => Err(GeoJsonError::ShortPosition {
                place: Place { vertex, ..place },
            }),
        })
        .collect()
}

#[cfg(test)]
mod tests;
