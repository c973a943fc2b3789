//! A layer of fills: their mesh, their names and areas, and how they look.

use globefill::{
    FillMesh, FillStyle, Hatch, HatchKind, Length, Locator, LonLat, MeshId, MeshOptions, Pattern,
    Region, RegionError, Renderer, RendererError, Stroke,
};

/// What a person can change about a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub visible: bool,
    pub opacity: f32,
    pub hatch: Option<HatchKind>,
    pub spacing_px: f32,
    /// Width of outlines; 0 for none.
    pub stroke_px: f32,
    pub z_index: i32,
}

/// What is told about a fill.
#[derive(Clone, Debug)]
pub struct Fact {
    pub name: String,
    pub area_m2: f64,
    /// Where its name is written: in its largest part.
    pub label_at: Option<LonLat>,
}

/// Fills with facts about them.
pub struct FillLayer {
    pub title: String,
    pub look: Look,
    pub facts: Vec<Fact>,
    /// Linear RGB and alpha of every fill.
    pub colors: Vec<[f32; 4]>,
    /// Whether a person brought it and may take it away.
    pub can_be_closed: bool,
    locator: Locator,
    /// Until it is on the GPU.
    mesh: Option<FillMesh>,
    id: Option<MeshId>,
    drawn: Vec<FillStyle>,
}

impl FillLayer {
    /// Meshes and measures regions. It takes its time: not for the thread that draws.
    pub fn build(
        title: impl Into<String>,
        named: Vec<(String, Region)>,
        look: Look,
        colors: impl FnOnce(&FillMesh) -> Vec<[f32; 4]>,
    ) -> Result<Self, RegionError> {
        let (names, regions): (Vec<_>, Vec<_>) = named.into_iter().unzip();
        let mesh = FillMesh::build(&regions, &MeshOptions::default())?;
        let measured = regions.iter().zip(mesh.all_measures());
        let facts = names
            .into_iter()
            .zip(measured)
            .map(|(name, (region, measures))| Fact {
                name,
                area_m2: measures.area_m2,
                label_at: middle_of_largest(region).or_else(|| measures.centroid()),
            })
            .collect();
        Ok(Self {
            title: title.into(),
            look,
            facts,
            colors: colors(&mesh),
            can_be_closed: false,
            locator: Locator::new(&mesh),
            mesh: Some(mesh),
            id: None,
            drawn: Vec::new(),
        })
    }

    /// Its mesh in the renderer.
    pub fn mesh_id(&self) -> Option<MeshId> {
        self.id
    }

    /// The topmost fill at a point, of those that are shown.
    pub fn fill_at(&self, at: LonLat) -> Option<u32> {
        if !self.look.visible {
            return None;
        }
        self.locator.fills_at(at).last().copied()
    }

    /// Uploads the mesh, and the styles that changed.
    pub fn sync(
        &mut self,
        renderer: &mut Renderer,
        hovered: Option<u32>,
        picked: Option<u32>,
    ) -> Result<(), RendererError> {
        if let Some(mesh) = self.mesh.take() {
            self.id = Some(renderer.insert(mesh));
            self.drawn = vec![FillStyle::default(); self.colors.len()];
        }
        let Some(id) = self.id else {
            return Ok(());
        };
        for (fill, color) in (0..).zip(&self.colors) {
            let light = match (picked == Some(fill), hovered == Some(fill)) {
                (true, _) => 0.4,
                (false, true) => 0.2,
                (false, false) => 0.0,
            };
            let style = self.look.style(*color, light);
            let drawn = &mut self.drawn[fill as usize];
            if *drawn != style {
                renderer.set_style(id, fill, style)?;
                *drawn = style;
            }
        }
        Ok(())
    }
}

impl Look {
    fn style(&self, [red, green, blue, alpha]: [f32; 4], light: f32) -> FillStyle {
        let hatch = |kind| {
            Pattern::Hatch(Hatch {
                kind,
                color: [red, green, blue, 0.95],
                spacing: Length::Pixels(self.spacing_px),
                share: 0.3,
                ..Default::default()
            })
        };
        let stroke = |width_px| Stroke {
            color: [red, green, blue, 1.0],
            width: Length::Pixels(width_px),
            ..Default::default()
        };
        FillStyle {
            color: [red, green, blue, alpha],
            pattern: self.hatch.map(hatch),
            highlight: [1.0, 1.0, 1.0, light],
            stroke: (self.stroke_px > 0.0).then(|| stroke(self.stroke_px)),
            opacity: self.opacity,
            z_index: self.z_index,
            visible: self.visible,
            ..Default::default()
        }
    }
}

/// The middle of the largest polygon: that of all of France lies in Spain. On a map of equal area,
/// longitude and sine of latitude, which is near enough for a name.
fn middle_of_largest(region: &Region) -> Option<LonLat> {
    let middles = region.polygons.iter().filter_map(|polygon| {
        let first = *polygon.shell.first()?;
        let place = |at: &LonLat| {
            let turns = ((at.lon_deg - first.lon_deg) / 360.0).round();
            let lon_deg = at.lon_deg - 360.0 * turns;
            (lon_deg - first.lon_deg, at.lat_deg.to_radians().sin())
        };
        let (mut area, mut x, mut y) = (0.0, 0.0, 0.0);
        let next = polygon.shell.iter().cycle().skip(1);
        for (from, to) in polygon.shell.iter().zip(next) {
            let ((from_x, from_y), (to_x, to_y)) = (place(from), place(to));
            let cross = from_x * to_y - to_x * from_y;
            area += cross;
            x += cross * (from_x + to_x);
            y += cross * (from_y + to_y);
        }
        let sin_lat = (y / (3.0 * area)).clamp(-1.0, 1.0);
        let lon_deg = first.lon_deg + x / (3.0 * area);
        let middle = LonLat::new(lon_deg, sin_lat.asin().to_degrees());
        (area != 0.0).then_some((area.abs(), middle))
    });
    middles
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, middle)| middle)
}
