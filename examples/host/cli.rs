//! What the command lines of the examples have in common.

use std::str::FromStr;

use clap::Parser;
use glam::UVec2;

/// Most pixels of a picture: what an ordinary machine can hold several targets of.
const MOST_PIXELS: u64 = 1 << 26;

/// The command line, or the one-line error that says what is wrong with it. Answers `--help` and
/// `--version` itself.
pub fn from_command_line<Arguments: Parser>() -> Result<Arguments, String> {
    Arguments::try_parse().map_err(|error| {
        if !error.use_stderr() {
            error.exit();
        }
        let text = error.to_string();
        let line = text.lines().next().unwrap_or_default();
        line.trim_start_matches("error: ").to_owned()
    })
}

pub fn parse_finite(text: &str) -> Result<f64, String> {
    let number = f64::from_str(text.trim()).map_err(|error| error.to_string())?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err("it must be finite".into())
    }
}

pub fn parse_fov(text: &str) -> Result<f64, String> {
    let fov_deg = parse_finite(text)?;
    if (0.001..=170.0).contains(&fov_deg) {
        Ok(fov_deg)
    } else {
        Err("it must lie within 0.001 … 170 degrees".into())
    }
}

pub fn parse_size(text: &str) -> Result<UVec2, String> {
    let (width, height) = text
        .split_once(['x', 'X'])
        .ok_or("expected WxH, as 1280x720")?;
    let side = |word: &str| {
        word.parse::<u32>()
            .map_err(|error| format!("{word:?}: {error}"))
    };
    let (width, height) = (side(width)?, side(height)?);
    if width == 0 || height == 0 {
        return Err("a picture needs at least one pixel each way".into());
    }
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!("a picture may have at most {MOST_PIXELS} pixels"));
    }
    Ok(UVec2::new(width, height))
}
