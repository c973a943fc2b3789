//! The world's countries: coloured, found under the pointer, chosen by a click.

use globefill::{
    FillMesh, FillStyle, Locator, LonLat, MeshId, MeshOptions, Region, Renderer,
    countries::{Country, Dataset},
};

use crate::host::palette;

const UNDER_POINTER: [f32; 4] = [1.0, 1.0, 1.0, 0.28];
const CHOSEN: [f32; 4] = [1.0, 0.85, 0.25, 0.55];

/// The layer of countries.
pub struct Countries {
    pub shown: bool,
    /// 0 … 1.
    pub opacity: f32,
    pub under_pointer: Option<u32>,
    pub chosen: Option<u32>,
    countries: Vec<Country>,
    areas_m2: Vec<f64>,
    /// Of their largest parts: overseas ones would draw a common middle out to sea.
    middles: Vec<LonLat>,
    colors: Vec<[f32; 4]>,
    locator: Locator,
    mesh: MeshId,
    /// What was last given to the renderer.
    styles: Vec<FillStyle>,
}

impl Countries {
    pub fn new(renderer: &mut Renderer) -> Result<Self, String> {
        let countries = Dataset::Countries50m.countries();
        let regions: Vec<Region> = countries.iter().map(|it| it.region.clone()).collect();
        let mesh = FillMesh::build(&regions, &MeshOptions::default())
            .map_err(|error| error.to_string())?;
        let measures = mesh.all_measures();
        Ok(Self {
            shown: true,
            opacity: 0.9,
            under_pointer: None,
            chosen: None,
            areas_m2: measures.iter().map(|it| it.area_m2).collect(),
            middles: mesh.fills.iter().map(|fill| middle(&mesh, fill)).collect(),
            colors: palette::colors(&mesh),
            locator: Locator::new(&mesh),
            styles: Vec::new(),
            mesh: renderer.insert(mesh),
            countries,
        })
    }

    /// Gives the renderer what changed.
    pub fn restyle(&mut self, renderer: &mut Renderer) -> Result<(), String> {
        let style = |(fill, &color): (u32, &[f32; 4])| FillStyle {
            color,
            opacity: self.opacity,
            visible: self.shown,
            highlight: if self.chosen == Some(fill) {
                CHOSEN
            } else if self.under_pointer == Some(fill) {
                UNDER_POINTER
            } else {
                [0.0; 4]
            },
            ..Default::default()
        };
        let styles: Vec<FillStyle> = (0..).zip(&self.colors).map(style).collect();
        for (fill, style) in (0..).zip(&styles) {
            if self.styles.get(fill as usize) != Some(style) {
                renderer
                    .set_style(self.mesh, fill, *style)
                    .map_err(|error| error.to_string())?;
            }
        }
        self.styles = styles;
        Ok(())
    }

    /// The country at a place, if countries are shown.
    pub fn at(&self, place: LonLat) -> Option<u32> {
        let found = self.shown.then(|| self.locator.fills_at(place));
        found.and_then(|fills| fills.first().copied())
    }

    pub fn name(&self, country: u32) -> &'static str {
        self.countries[country as usize].name
    }

    /// As people say it: "357 022 km²".
    pub fn area(&self, country: u32) -> String {
        let square_km = self.areas_m2[country as usize] * 1e-6;
        let digits = format!("{square_km:.0}");
        let groups: Vec<&str> = digits
            .as_bytes()
            .rchunks(3)
            .rev()
            .filter_map(|group| std::str::from_utf8(group).ok())
            .collect();
        format!("{} km²", groups.join("\u{2009}"))
    }

    /// Names with the places to write them, the largest countries first, and their areas, m².
    pub fn names(&self) -> Vec<(&'static str, LonLat, f64)> {
        let named = self.countries.iter().zip(&self.middles).zip(&self.areas_m2);
        let mut names: Vec<_> = named
            .map(|((country, &middle), &area_m2)| (country.name, middle, area_m2))
            .collect();
        names.sort_by(|a, b| b.2.total_cmp(&a.2));
        names
    }
}

/// The middle of the largest part of a fill.
fn middle(mesh: &FillMesh, fill: &globefill::fill_mesh::Fill) -> LonLat {
    let first = fill.first_piece as usize;
    let pieces = mesh.pieces[first..first + fill.piece_count as usize].iter();
    let bounds = pieces.map(|piece| piece.bounds);
    let widest = bounds.max_by(|a, b| a.radius_rad.total_cmp(&b.radius_rad));
    let axis = widest.unwrap_or_default().axis;
    mesh.ellipsoid.geodetic(axis * mesh.ellipsoid.radii_m()).0
}
