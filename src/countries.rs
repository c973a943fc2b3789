//! The embedded boundaries: Natural Earth's countries and the US states.
//!
//! Coordinates are geodetic degrees on WGS84, within 4·10⁻¹³° (0.04 µm) of the source's. Where they
//! come from, their licence and the file format are told in `assets/boundaries/SOURCE.md`.

use crate::{
    geodetic::LonLat,
    region::{EdgeKind, Inside, Polygon, Region, Ring},
};

/// Steps of a stored coordinate per degree. Half a turn stays below 2⁵³, so a step count is an
/// exact `f64` and one division by this rounds to the nearest `f64` of the degree.
const STEPS_PER_DEG: f64 = (5_u64 << 38) as f64;

/// An embedded set of boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dataset {
    /// Natural Earth countries, 1:110 000 000: 177 countries, 10 365 ring vertices.
    Countries110m,
    /// Natural Earth countries, 1:50 000 000: 242 countries, 97 981 ring vertices.
    Countries50m,
    /// The US states, the District of Columbia and five territories (Census Bureau, as simplified by
    /// us-atlas for 1:10 000 000): 56 features, 14 148 ring vertices.
    UsStates,
}

/// One country or state of a [`Dataset`].
#[derive(Clone, Debug, PartialEq)]
pub struct Country {
    /// Short name, as on a map: "Dem. Rep. Congo".
    pub name: &'static str,
    /// Full name: "Democratic Republic of the Congo". Equal to `name` for most.
    pub long_name: &'static str,
    /// ISO 3166-1 alpha-2 ("XK" for Kosovo), of a state its postal code ("CA"). `None` for the five
    /// territories that have none.
    pub short_code: Option<&'static str>,
    /// ISO 3166-1 alpha-3, or Natural Earth's own three letters where ISO has none; of a state its
    /// two-digit FIPS 5-2 code ("06").
    pub long_code: &'static str,
    /// The boundary: edges [`EdgeKind::Straight`], inside [`Inside::Smaller`], every ring closed.
    /// Vertices that neighbours share are equal bit for bit.
    pub region: Region,
}

impl Country {
    /// Whether this country goes by `name_or_code`: either name or either code, in any letter case.
    pub fn is_called(&self, name_or_code: &str) -> bool {
        let wanted = name_or_code.trim();
        let is_code = |code: &str| code.eq_ignore_ascii_case(wanted);
        // Names have letters beyond ASCII ("Åland"); lowercase both only if the cheap test fails.
        let is_name = |name: &str| {
            name.eq_ignore_ascii_case(wanted) || name.to_lowercase() == wanted.to_lowercase()
        };
        self.short_code.is_some_and(is_code)
            || is_code(self.long_code)
            || is_name(self.name)
            || is_name(self.long_name)
    }
}

impl Dataset {
    /// Decodes every country, in the source's order (states by FIPS code).
    pub fn countries(self) -> Vec<Country> {
        let bytes: &'static [u8] = match self {
            Self::Countries110m => include_bytes!("../assets/boundaries/countries-110m.arcs"),
            Self::Countries50m => include_bytes!("../assets/boundaries/countries-50m.arcs"),
            Self::UsStates => include_bytes!("../assets/boundaries/us-states-10m.arcs"),
        };
        decode(bytes).expect("the embedded files decode: tests decode each of them")
    }

    /// The country that goes by a name or a code, see [`Country::is_called`].
    pub fn country(self, name_or_code: &str) -> Option<Country> {
        let mut countries = self.countries();
        let found = countries
            .iter()
            .position(|country| country.is_called(name_or_code))?;
        Some(countries.swap_remove(found))
    }
}

/// Decodes a file of boundaries; `None` if it is malformed.
fn decode(bytes: &'static [u8]) -> Option<Vec<Country>> {
    let mut reader = Reader {
        bytes: bytes.strip_prefix(b"GFB1")?,
    };
    let arcs = Arcs::decode(&mut reader)?;
    let count = reader.count()?;
    let countries = (0..count)
        .map(|_| country(&mut reader, &arcs))
        .collect::<Option<_>>()?;
    reader.bytes.is_empty().then_some(countries)
}

fn country(reader: &mut Reader, arcs: &Arcs) -> Option<Country> {
    let [name, long_name, short_code, long_code] = [
        reader.text()?,
        reader.text()?,
        reader.text()?,
        reader.text()?,
    ];
    let count = reader.count()?;
    let polygons = (0..count)
        .map(|_| polygon(reader, arcs))
        .collect::<Option<_>>()?;
    Some(Country {
        name,
        long_name,
        short_code: (!short_code.is_empty()).then_some(short_code),
        long_code,
        region: Region {
            polygons,
            edges: EdgeKind::Straight,
            inside: Inside::Smaller,
            zones: Vec::new(),
        },
    })
}

fn polygon(reader: &mut Reader, arcs: &Arcs) -> Option<Polygon> {
    let holes = reader.count()?.checked_sub(1)?;
    Some(Polygon {
        shell: ring(reader, arcs)?,
        holes: (0..holes)
            .map(|_| ring(reader, arcs))
            .collect::<Option<_>>()?,
    })
}

fn ring(reader: &mut Reader, arcs: &Arcs) -> Option<Ring> {
    let count = reader.count()?;
    // A ring of one arc is the common case; borders of several grow the vector.
    let mut ring = Ring::new();
    for _ in 0..count {
        let reference = usize::try_from(reader.varint()?).ok()?;
        let arc = arcs.get(reference >> 1)?;
        ring.reserve(arc.len());
        // An arc begins where the last one ended.
        ring.pop();
        if reference & 1 == 0 {
            ring.extend_from_slice(arc);
        } else {
            ring.extend(arc.iter().rev());
        }
    }
    Some(ring)
}

/// Every arc's vertices, one after the other.
struct Arcs {
    vertices: Vec<LonLat>,
    /// Where each arc ends in `vertices`; it begins where the one before ends.
    ends: Vec<usize>,
}

impl Arcs {
    fn decode(reader: &mut Reader) -> Option<Self> {
        let count = reader.count()?;
        let mut arcs = Self {
            // Two bytes a coordinate is the smallest mean of the embedded files.
            vertices: Vec::with_capacity(reader.bytes.len() / 4),
            ends: Vec::with_capacity(count),
        };
        for _ in 0..count {
            let shift = u32::from(reader.byte()?);
            let length = reader.count()?;
            let (mut lon, mut lat) = (0_i64, 0_i64);
            for _ in 0..length {
                lon = lon.checked_add(reader.zigzag(shift)?)?;
                lat = lat.checked_add(reader.zigzag(shift)?)?;
                let [lon_deg, lat_deg] = [lon, lat].map(|steps| steps as f64 / STEPS_PER_DEG);
                arcs.vertices.push(LonLat::new(lon_deg, lat_deg));
            }
            arcs.ends.push(arcs.vertices.len());
        }
        Some(arcs)
    }

    fn get(&self, index: usize) -> Option<&[LonLat]> {
        let start = match index.checked_sub(1) {
            Some(before) => *self.ends.get(before)?,
            None => 0,
        };
        self.vertices.get(start..*self.ends.get(index)?)
    }
}

/// What is left to read of a file.
struct Reader {
    bytes: &'static [u8],
}

impl Reader {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(first)
    }

    /// An unsigned LEB128 number.
    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    /// A number of things that follow, each at least a byte: never more than bytes are left.
    fn count(&mut self) -> Option<usize> {
        let count = usize::try_from(self.varint()?).ok()?;
        (count <= self.bytes.len()).then_some(count)
    }

    /// A signed number in units of 2^`shift`.
    fn zigzag(&mut self, shift: u32) -> Option<i64> {
        let folded = self.varint()?;
        let value = (folded >> 1) as i64 ^ -((folded & 1) as i64);
        value.checked_mul(1_i64.checked_shl(shift)?)
    }

    fn text(&mut self) -> Option<&'static str> {
        let length = usize::from(self.byte()?);
        let (text, rest) = self.bytes.split_at_checked(length)?;
        self.bytes = rest;
        std::str::from_utf8(text).ok()
    }
}

#[cfg(test)]
mod tests;
