//! The few flags.

use glam::UVec2;

use crate::host::camera::Viewpoint;

pub const USAGE: &str = "viewer [--camera LON,LAT,HEIGHT[,HEADING,PITCH]] [--size WxH] [--satellites] \
    [--coverage] [--terrain] [--screenshot FILE] [FILE.geojson ...]";

/// What the command line asks for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flags {
    pub camera: Option<Viewpoint>,
    pub size_px: Option<UVec2>,
    pub satellites: bool,
    pub coverage: bool,
    pub terrain: bool,
    /// Draw until all is loaded, save, and leave.
    pub screenshot: Option<String>,
    pub files: Vec<String>,
}

impl Flags {
    pub fn parse(words: Vec<String>) -> Result<Self, String> {
        let mut flags = Self::default();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} needs a value"));
            match word.as_str() {
                "--camera" => flags.camera = Some(value()?.parse()?),
                "--size" => flags.size_px = Some(size(&value()?)?),
                "--screenshot" => flags.screenshot = Some(value()?),
                "--satellites" => flags.satellites = true,
                "--coverage" => (flags.satellites, flags.coverage) = (true, true),
                "--terrain" => flags.terrain = true,
                other if other.starts_with('-') => return Err(format!("{other}?\n{USAGE}")),
                _ => flags.files.push(word),
            }
        }
        Ok(flags)
    }
}

fn size(text: &str) -> Result<UVec2, String> {
    let (width, height) = text.split_once('x').ok_or("--size needs WxH")?;
    let side = |text: &str| match text.parse() {
        Ok(side @ 1..=8192) => Ok(side),
        _ => Err(format!("--size: {text:?} is not within 1 … 8192")),
    };
    Ok(UVec2::new(side(width)?, side(height)?))
}
