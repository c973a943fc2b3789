//! Heights on a grid of longitude and latitude, read from a picture.

use std::path::Path;

use glam::UVec2;
use globefill::LonLat;
use serde_json::Value;

/// Heights that no planet's terrain exceeds, metres: a wrong scale is found before it is drawn.
const GREATEST_HEIGHT_M: f64 = 1e5;

/// Heights above the ellipsoid at the nodes of a grid; the first row lies at `north_deg`, the last
/// at `south_deg`, the first column at `west_deg`, the last at `east_deg`.
pub struct Elevation {
    west_deg: f64,
    south_deg: f64,
    east_deg: f64,
    north_deg: f64,
    size: UVec2,
    heights_m: Vec<f32>,
}

impl Elevation {
    /// Reads a 16-bit grey PNG and the JSON of the same stem.
    pub fn read(path: &Path) -> Result<Self, String> {
        let named = |path: &Path, error: String| format!("{}: {error}", path.display());
        let read = |path: &Path, what: &str| {
            std::fs::read(path).map_err(|error| named(path, format!("cannot read {what}: {error}")))
        };
        let grid = Grid::decode(&read(path, "the terrain")?).map_err(|error| named(path, error))?;
        let json = path.with_extension("json");
        let placement = read(&json, "the terrain's placement")?;
        let place = Placement::parse(&placement).map_err(|error| named(&json, error))?;
        Self::new(grid, &place).map_err(|error| named(path, error))
    }

    /// Puts a picture where it belongs.
    pub fn new(Grid(image): Grid, place: &Placement) -> Result<Self, String> {
        let size = UVec2::new(image.width(), image.height());
        let heights_m: Vec<f32> = image
            .into_raw()
            .into_iter()
            .map(|value| (place.offset + place.scale * f64::from(value)) as f32)
            .collect();
        let extremes = heights_m
            .iter()
            .fold((f32::MAX, f32::MIN), |(low, high), &height| {
                (low.min(height), high.max(height))
            });
        if f64::from(extremes.0) < -GREATEST_HEIGHT_M || f64::from(extremes.1) > GREATEST_HEIGHT_M {
            return Err(format!(
                "heights from {} to {} m: scale or offset is wrong",
                extremes.0, extremes.1
            ));
        }
        let [west_deg, south_deg, east_deg, north_deg] = place.bounds_deg;
        Ok(Self {
            west_deg,
            south_deg,
            east_deg,
            north_deg,
            size,
            heights_m,
        })
    }

    /// Columns and rows of nodes.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Height at a node.
    pub fn node_m(&self, column: u32, row: u32) -> f64 {
        f64::from(self.heights_m[(row * self.size.x + column) as usize])
    }

    /// Latitude of a row of nodes.
    pub fn row_lat_deg(&self, row: u32) -> f64 {
        let part = f64::from(row) / f64::from(self.size.y - 1);
        self.north_deg + (self.south_deg - self.north_deg) * part
    }

    /// Longitude and latitude steps between nodes, degrees.
    pub fn step_deg(&self) -> (f64, f64) {
        (
            (self.east_deg - self.west_deg) / f64::from(self.size.x - 1),
            (self.north_deg - self.south_deg) / f64::from(self.size.y - 1),
        )
    }

    /// Whether the grid leaves nothing out.
    pub fn is_whole_globe(&self) -> bool {
        let bounds = (
            self.east_deg - self.west_deg,
            self.south_deg,
            self.north_deg,
        );
        bounds == (360.0, -90.0, 90.0)
    }

    /// Greatest height, at least 0: outside the grid lies the ellipsoid.
    pub fn highest_m(&self) -> f64 {
        f64::from(self.heights_m.iter().copied().fold(0.0, f32::max))
    }

    /// Position in the grid, 0 … 1 from west to east and from north to south; beyond that, outside.
    /// Of the longitudes a turn apart, that one counts which brings `middle_lon_deg` nearest to the
    /// grid's middle: places with one such middle are continuous.
    pub fn place(&self, position: LonLat, middle_lon_deg: f64) -> (f64, f64) {
        let width_deg = self.east_deg - self.west_deg;
        let grid_middle_deg = self.west_deg + 0.5 * width_deg;
        let turns = ((grid_middle_deg - middle_lon_deg) / 360.0).round();
        (
            (position.lon_deg + 360.0 * turns - self.west_deg) / width_deg,
            (self.north_deg - position.lat_deg) / (self.north_deg - self.south_deg),
        )
    }

    /// Height above the ellipsoid: bilinear between nodes, 0 outside the grid. A pole has one
    /// height, the mean of its row.
    pub fn height_m(&self, position: LonLat) -> f64 {
        let (u, v) = self.place(position, position.lon_deg);
        if !(0.0..=1.0).contains(&u) || !(0.0..=1.0).contains(&v) {
            return 0.0;
        }
        if position.is_pole() {
            let row = if v < 0.5 { 0 } else { self.size.y - 1 };
            let sum: f64 = (0..self.size.x)
                .map(|column| self.node_m(column, row))
                .sum();
            return sum / f64::from(self.size.x);
        }
        let cell = |part: f64, nodes: u32| {
            let place = part * f64::from(nodes - 1);
            let index = (place as u32).min(nodes - 2);
            (index, place - f64::from(index))
        };
        let ((column, x), (row, y)) = (cell(u, self.size.x), cell(v, self.size.y));
        let along = |row: u32| {
            let (from, to) = (self.node_m(column, row), self.node_m(column + 1, row));
            from + (to - from) * x
        };
        let (upper, lower) = (along(row), along(row + 1));
        upper + (lower - upper) * y
    }
}

/// What the picture says: heights as 16-bit grey.
pub struct Grid(image::ImageBuffer<image::Luma<u16>, Vec<u16>>);

impl Grid {
    pub fn decode(png: &[u8]) -> Result<Self, String> {
        let image = image::load_from_memory_with_format(png, image::ImageFormat::Png)
            .map_err(|error| format!("cannot read the terrain: {error}"))?;
        let image::DynamicImage::ImageLuma16(image) = image else {
            return Err("terrain must be a grey PNG of 16 bits a pixel".into());
        };
        if image.width().min(image.height()) < 2 {
            return Err("terrain needs at least two rows and two columns".into());
        }
        Ok(Self(image))
    }
}

/// What the JSON says.
pub struct Placement {
    /// West, south, east, north.
    bounds_deg: [f64; 4],
    scale: f64,
    offset: f64,
}

impl Placement {
    pub fn parse(text: &[u8]) -> Result<Self, String> {
        let json: Value = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        let number = |name: &str| {
            json.get(name)
                .and_then(Value::as_f64)
                .ok_or_else(|| format!("{name:?} must be a number"))
        };
        let bounds_deg = [
            number("west")?,
            number("south")?,
            number("east")?,
            number("north")?,
        ];
        let [west, south, east, north] = bounds_deg;
        if !(west < east && east - west <= 360.0) {
            return Err(format!(
                "west {west} must lie less than a turn before east {east}"
            ));
        }
        if !(-90.0 <= south && south < north && north <= 90.0) {
            return Err(format!(
                "south {south} must lie below north {north}, within ±90"
            ));
        }
        let (scale, offset) = (number("scale")?, number("offset")?);
        Ok(Self {
            bounds_deg,
            scale,
            offset,
        })
    }
}
