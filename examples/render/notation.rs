//! How numbers of a style are written, on the command line and in properties alike.

use globefill::{Dash, Extents, Length, LonLat, Ramp};

use crate::host::cli::parse_finite;

/// A length: `12px`, `500m`, `50km`; pixels without a unit.
pub fn length(text: &str) -> Result<Length, String> {
    let text = text.trim();
    let length = match text.strip_suffix("px") {
        Some(pixels) => Length::Pixels(number(pixels)?),
        None if text.ends_with('m') => Length::Metres(metres(text)? as f32),
        None => Length::Pixels(number(text)?),
    };
    if length.is_sound() {
        Ok(length)
    } else {
        Err("it must lie within 1/64 … 65536 px or 1e-5 … 4e8 m".into())
    }
}

/// Metres: `500m`, `50km`; metres without a unit.
fn metres(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if let Some(km) = text.strip_suffix("km") {
        return Ok(parse_unit(km)? * 1e3);
    }
    parse_unit(text.strip_suffix('m').unwrap_or(text))
}

fn parse_unit(number: &str) -> Result<f64, String> {
    parse_finite(number).map_err(|error| format!("{number:?}: {error}"))
}

fn number(text: &str) -> Result<f32, String> {
    parse_unit(text).map(|number| number as f32)
}

/// A share, 0 … 1.
pub fn share(text: &str) -> Result<f32, String> {
    let share = number(text)?;
    if (0.0..=1.0).contains(&share) {
        Ok(share)
    } else {
        Err("it must lie within 0 … 1".into())
    }
}

/// Degrees, as radians.
pub fn angle_rad(text: &str) -> Result<f32, String> {
    parse_finite(text).map(|angle_deg| angle_deg.to_radians() as f32)
}

/// A dash: its period, and the share of it that is drawn, one half if not told.
pub fn dash(text: &str) -> Result<Dash, String> {
    let (period, drawn) = match text.split_once(',') {
        Some((period, drawn)) => (period, share(drawn)?),
        None => (text, 0.5),
    };
    Ok(Dash {
        period: length(period)?,
        share: drawn,
    })
}

/// `LON,LAT`, degrees.
pub fn lon_lat(text: &str) -> Result<LonLat, String> {
    let [lon_deg, lat_deg] = list(text, parse_unit)?;
    let point = LonLat::new(lon_deg, lat_deg);
    if point.is_valid() {
        Ok(point)
    } else {
        Err("the latitude must lie within ±90".into())
    }
}

/// `W,S,E,N`, degrees.
pub fn extents(text: &str) -> Result<Extents, String> {
    let [west_deg, south_deg, east_deg, north_deg] = list(text, parse_unit)?;
    let extents = Extents {
        west_deg,
        south_deg,
        east_deg,
        north_deg,
    };
    if extents.is_valid() {
        Ok(extents)
    } else {
        Err("expected west and east that differ, within ±540, and south < north within ±90".into())
    }
}

/// Two numbers above zero.
pub fn counts(text: &str) -> Result<[f32; 2], String> {
    let counts: [f64; 2] = list(text, parse_unit)?;
    if counts.iter().all(|count| (1e-6..=1e6).contains(count)) {
        Ok(counts.map(|count| count as f32))
    } else {
        Err("both must lie within 1e-6 … 1e6".into())
    }
}

/// Width and height in metres; `m` and `km` are understood.
pub fn size_m(text: &str) -> Result<[f32; 2], String> {
    let size_m: [f64; 2] = list(text, metres)?;
    if size_m.iter().all(|side_m| (1e-3..=4e8).contains(side_m)) {
        Ok(size_m.map(|side_m| side_m as f32))
    } else {
        Err("both must lie within 1e-3 … 4e8 m".into())
    }
}

/// `FULL,GONE` in metres; `m` and `km` are understood.
pub fn ramp_m(text: &str) -> Result<Ramp, String> {
    let ends: [f64; 2] = list(text, metres)?;
    if ends.iter().any(|end| *end < 0.0) {
        return Err("neither may be negative".into());
    }
    ramp(ends)
}

/// `FULL,GONE` in degrees, as radians.
pub fn ramp_rad(text: &str) -> Result<Ramp, String> {
    let ends: [f64; 2] = list(text, parse_unit)?;
    if ends.iter().any(|end| !(0.0..=90.0).contains(end)) {
        return Err("both must lie within 0 … 90 degrees".into());
    }
    ramp(ends.map(f64::to_radians))
}

fn ramp([full, gone]: [f64; 2]) -> Result<Ramp, String> {
    let [full, gone] = [full as f32, gone as f32];
    if !(full.is_finite() && gone.is_finite()) {
        Err("that is too far".into())
    } else if full == gone {
        Err("FULL and GONE must differ".into())
    } else {
        Ok(Ramp { full, gone })
    }
}

/// As many values as asked for, between commas.
fn list<const COUNT: usize>(
    text: &str,
    parse: impl Fn(&str) -> Result<f64, String>,
) -> Result<[f64; COUNT], String> {
    let values = text.split(',').map(parse).collect::<Result<Vec<_>, _>>()?;
    let found = values.len();
    values
        .try_into()
        .map_err(|_| format!("expected {COUNT} numbers, found {found}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_and_their_units() {
        for (text, expected) in [
            ("12px", Length::Pixels(12.0)),
            ("1.5", Length::Pixels(1.5)),
            (" 3 px ", Length::Pixels(3.0)),
            ("500m", Length::Metres(500.0)),
            ("50km", Length::Metres(50e3)),
            ("1e-3km", Length::Metres(1.0)),
        ] {
            assert_eq!(length(text), Ok(expected), "{text}");
        }
        for text in [
            "", "px", "km", "-1px", "0", "0m", "-5km", "NaN", "infpx", "1e9km", "1e6px", "5cm",
            "5 miles",
        ] {
            assert!(length(text).is_err(), "{text}");
        }
    }

    #[test]
    fn places() {
        assert_eq!(lon_lat("-7.5, 52"), Ok(LonLat::new(-7.5, 52.0)));
        let across = extents("170,-10,-170,10").unwrap();
        assert_eq!(across.width_deg(), 20.0);
        for text in ["", "1", "1,2,3", "1,91", "NaN,1", "1,b", "1,,2"] {
            assert!(lon_lat(text).is_err(), "{text}");
        }
        for text in [
            "0,0,0,1",
            "0,1,1,1",
            "0,2,1,1",
            "0,-91,1,1",
            "0,0,1",
            "0,0,NaN,1",
            "0,0,541,1",
        ] {
            assert!(extents(text).is_err(), "{text}");
        }
    }

    #[test]
    fn dashes_sizes_and_counts() {
        let Dash { period, share } = dash("20px").unwrap();
        assert_eq!((period, share), (Length::Pixels(20.0), 0.5));
        let Dash { period, share } = dash("5km,0.25").unwrap();
        assert_eq!((period, share), (Length::Metres(5e3), 0.25));
        assert!(dash("5km,1.5").is_err() && dash("5km,").is_err() && dash("-5km").is_err());
        assert_eq!(size_m("2km,500"), Ok([2000.0, 500.0]));
        assert!(size_m("2km,0").is_err() && size_m("2km").is_err());
        assert_eq!(counts("2,0.5"), Ok([2.0, 0.5]));
        assert!(counts("2,-1").is_err() && counts("0,1").is_err());
    }

    #[test]
    fn ramps_run_either_way() {
        let Ramp { full, gone } = ramp_m("10km,2000").unwrap();
        assert_eq!((full, gone), (10e3, 2e3));
        let Ramp { full, gone } = ramp_rad("90,0").unwrap();
        assert_eq!((full, gone), (std::f32::consts::FRAC_PI_2, 0.0));
        for text in ["1,1", "-1,2", "1", "1,2,3", "1,NaN", "1,1e300"] {
            assert!(ramp_m(text).is_err(), "{text}");
        }
        assert!(ramp_rad("91,0").is_err() && ramp_rad("5,5").is_err());
    }
}
