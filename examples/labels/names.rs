//! The names of countries, as glyphon draws them.

use glam::{UVec2, Vec2};
use globefill::{
    Ellipsoid, FillMesh, LonLat, MeshOptions, Region, RegionError, countries::Country, wgpu,
};
use glyphon::{
    Attrs, Buffer, Cache, Color, Family, FontSystem, Metrics, PrepareError, RenderError,
    Resolution, Shaping, SwashCache, TextArea, TextAtlas, TextBounds, TextRenderer, Viewport,
};

use crate::host::{camera::Eye, gpu::Gpu, ground::TargetFormat};

/// Heights of letters, pixels.
const LEAST_PX: f32 = 13.0;
const MOST_PX: f32 = 30.0;
/// Room between names, pixels.
const APART_PX: f32 = 4.0;

const INK: Color = Color::rgb(255, 255, 255);
const HALO: Color = Color::rgba(10, 16, 28, 150);

/// glyphon's state, and the names that it draws.
pub struct Names {
    fonts: FontSystem,
    glyphs: SwashCache,
    atlas: TextAtlas,
    viewport: Viewport,
    renderer: TextRenderer,
    names: Vec<Name>,
}

struct Name {
    text: Buffer,
    /// Top left corner and the one across, pixels.
    corners: [Vec2; 2],
}

/// A country on the screen.
struct Spot<'a> {
    name: &'a str,
    /// Pixels, down from the top left corner.
    middle: Vec2,
    /// The side of a square as large as its largest part, pixels.
    side_px: f32,
}

impl Names {
    /// No names yet.
    pub fn new(gpu: &Gpu, format: &TargetFormat) -> Result<Self, String> {
        let fonts = FontSystem::new();
        if fonts.db().is_empty() {
            return Err("no fonts found; on Debian and Ubuntu: fonts-dejavu-core".into());
        }
        let cache = Cache::new(&gpu.device);
        let mut atlas = TextAtlas::new(&gpu.device, &gpu.queue, &cache, format.color);
        let samples = wgpu::MultisampleState {
            count: format.sample_count,
            ..Default::default()
        };
        Ok(Self {
            renderer: TextRenderer::new(&mut atlas, &gpu.device, samples, None),
            viewport: Viewport::new(&gpu.device, &cache),
            glyphs: SwashCache::new(),
            fonts,
            atlas,
            names: Vec::new(),
        })
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Writes the names of the countries that can be seen: the large ones first, and none over another.
    pub fn place(
        &mut self,
        countries: &[Country],
        ellipsoid: &Ellipsoid,
        eye: &Eye,
    ) -> Result<(), RegionError> {
        let middles = largest_parts(countries)?;
        let mut spots: Vec<Spot<'_>> = countries
            .iter()
            .zip(middles)
            .filter_map(|(country, part)| spot(country.name, part?, ellipsoid, eye))
            .collect();
        spots.sort_by(|a, b| b.side_px.total_cmp(&a.side_px));
        for spot in spots {
            let name = self.write(&spot);
            let fits = name.corners[1].x - name.corners[0].x <= 1.6 * spot.side_px;
            let whole = name.is_within(eye.lens.size_px.as_vec2());
            if fits && whole && !self.names.iter().any(|other| name.touches(other)) {
                self.names.push(name);
            }
        }
        Ok(())
    }

    fn write(&mut self, spot: &Spot<'_>) -> Name {
        let letters = spot.name.chars().count() as f32;
        let height_px = (1.6 * spot.side_px / letters).clamp(LEAST_PX, MOST_PX);
        let metrics = Metrics::relative(height_px, 1.2);
        let mut text = Buffer::new(&mut self.fonts, metrics);
        let sans = Attrs::new().family(Family::SansSerif);
        text.set_text(spot.name, &sans, Shaping::Advanced, None);
        text.shape_until_scroll(&mut self.fonts, false);
        let width_px = text.layout_runs().map(|run| run.line_w).fold(0.0, f32::max);
        let half = 0.5 * Vec2::new(width_px, metrics.line_height);
        Name {
            text,
            corners: [spot.middle - half, spot.middle + half],
        }
    }

    /// Uploads what changed: glyphon's `prepare`, beside the fills'.
    pub fn prepare(&mut self, gpu: &Gpu, size_px: UVec2) -> Result<(), PrepareError> {
        let resolution = Resolution {
            width: size_px.x,
            height: size_px.y,
        };
        self.viewport.update(&gpu.queue, resolution);
        let size = size_px.as_ivec2();
        let around = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let halo = around.map(|(right, down)| (Vec2::new(right, down), HALO));
        let areas = self.names.iter().flat_map(|name| {
            let layers = halo.into_iter().chain([(Vec2::ZERO, INK)]);
            layers.map(|(offset, default_color)| TextArea {
                buffer: &name.text,
                left: name.corners[0].x + offset.x,
                top: name.corners[0].y + offset.y,
                scale: 1.0,
                bounds: TextBounds {
                    left: 0,
                    top: 0,
                    right: size.x,
                    bottom: size.y,
                },
                default_color,
                custom_glyphs: &[],
            })
        });
        self.renderer.prepare(
            &gpu.device,
            &gpu.queue,
            &mut self.fonts,
            &mut self.atlas,
            &self.viewport,
            areas,
            &mut self.glyphs,
        )
    }

    /// Draws into the host's pass.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), RenderError> {
        self.renderer.render(&self.atlas, &self.viewport, pass)
    }
}

impl Name {
    fn is_within(&self, size_px: Vec2) -> bool {
        let [first, last] = self.corners;
        first.cmpge(Vec2::splat(APART_PX)).all() && last.cmple(size_px - APART_PX).all()
    }

    fn touches(&self, other: &Self) -> bool {
        let [first, last] = self.corners;
        let near = (first - APART_PX).cmplt(other.corners[1]).all();
        near && (last + APART_PX).cmpgt(other.corners[0]).all()
    }
}

/// Middle and area, m², of the largest part of each country: France's name does not belong between
/// Europe and Guiana.
fn largest_parts(countries: &[Country]) -> Result<Vec<Option<(LonLat, f64)>>, RegionError> {
    let mut owners = Vec::new();
    let mut parts = Vec::new();
    for (owner, country) in countries.iter().enumerate() {
        for polygon in &country.region.polygons {
            owners.push(owner);
            parts.push(Region {
                polygons: vec![polygon.clone()],
                ..country.region.clone()
            });
        }
    }
    let mesh = FillMesh::build(&parts, &MeshOptions::default())?;
    let mut largest: Vec<Option<(LonLat, f64)>> = vec![None; countries.len()];
    for (owner, measures) in owners.into_iter().zip(mesh.all_measures()) {
        let known_m2 = largest[owner].map_or(0.0, |(_, area_m2)| area_m2);
        if let Some(middle) = measures.centroid()
            && measures.area_m2 > known_m2
        {
            largest[owner] = Some((middle, measures.area_m2));
        }
    }
    Ok(largest)
}

/// Where a country is on the screen; none behind the limb.
fn spot<'a>(
    name: &'a str,
    (middle, area_m2): (LonLat, f64),
    ellipsoid: &Ellipsoid,
    eye: &Eye,
) -> Option<Spot<'a>> {
    let point_ecef_m = ellipsoid.ecef(middle, 0.0);
    let from_eye_m = point_ecef_m - eye.camera.eye_ecef_m;
    let seen_at_sine = -ellipsoid.normal(middle).dot(from_eye_m.normalize());
    let view_m = eye.camera.view_from_ecef * from_eye_m;
    // Seen too obliquely, or behind the limb; or behind the eye.
    if seen_at_sine < 0.15 || view_m.z >= 0.0 {
        return None;
    }
    let clip = eye.camera.clip_from_view * view_m.extend(1.0);
    let size = eye.lens.size_px.as_dvec2();
    let middle = glam::DVec2::new(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * size;
    let side_m = (area_m2 * seen_at_sine).sqrt();
    Some(Spot {
        name,
        middle: middle.as_vec2(),
        side_px: (side_m / (-view_m.z * eye.pixel_size())) as f32,
    })
}
