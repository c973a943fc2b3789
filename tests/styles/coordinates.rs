//! Pictures lie where they should: their coordinates against those of the surface points.

use glam::DVec2;
use globefill::{Extents, FillStyle, ImageFill, ImageId, LonLat, Pattern, Placement, Wrap};

use crate::{
    HEIGHTS_M, PLACES, SMALL,
    chart::{Layout, Spot},
    common::{
        headless::gpu,
        surface::{Surface, Terrain},
    },
    ramps::{Ramps, STEP},
    stage::{Stage, figure, ground, middle_px, over, pixel_m, pose},
};

/// A picture in its place as the crate is asked for it.
pub fn fill_of(image: ImageId, layout: &Layout, wrap: Wrap) -> ImageFill {
    let placement = match layout.spot {
        Spot::Local { center, size_m } => Placement::Local {
            center,
            size_m: size_m.as_vec2().to_array(),
        },
        Spot::Angles {
            extents,
            geocentric: false,
        } => Placement::Geodetic(Some(extents)),
        Spot::Angles {
            extents,
            geocentric: true,
        } => Placement::Spherical(Some(extents)),
    };
    ImageFill {
        image,
        placement,
        wrap,
        rotation_rad: layout.rotation_rad as f32,
        repeats: layout.repeats.as_vec2().to_array(),
        opacity: 1.0,
    }
}

pub fn style_of(fill: ImageFill) -> FillStyle {
    FillStyle {
        color: [0.0, 0.0, 0.0, 1.0],
        pattern: Some(Pattern::Image(fill)),
        ..Default::default()
    }
}

/// How far coordinates are off.
#[derive(Clone, Copy, Debug, Default)]
pub struct Off {
    pub texels: f64,
    pub px: f64,
    /// The less of both, in quarters: the gate is 1.
    pub gate: f64,
    /// Pixels judged, and those that show the ground.
    pub judged: usize,
    pub ground: usize,
}

impl Off {
    pub fn with(self, other: Self) -> Self {
        Self {
            texels: self.texels.max(other.texels),
            px: self.px.max(other.px),
            gate: self.gate.max(other.gate),
            judged: self.judged + other.judged,
            ground: self.ground + other.ground,
        }
    }
}

/// Compares a drawn picture with its coordinates, where it is enlarged and its waves are straight.
pub fn judge(
    surface: &Surface,
    drawn: &[[u8; 4]],
    ramps: &Ramps,
    layout: &Layout,
    wrap: Wrap,
) -> Off {
    let width = surface.size_px().x as usize;
    let uv_at = |pixel: usize| {
        let point_m = surface.points_m.get(pixel).copied().flatten()?;
        Some(layout.uv(&figure(), point_m))
    };
    let mut off = Off::default();
    for (pixel, texel) in drawn.iter().enumerate() {
        let Some(uv) = uv_at(pixel) else { continue };
        off.ground += 1;
        let inner = pixel % width > 0 && pixel % width + 1 < width && pixel > width;
        if !inner || surface.at_discontinuity(pixel) {
            continue;
        }
        let neighbours = [pixel - 1, pixel + 1, pixel - width, pixel + width].map(uv_at);
        let [Some(left), Some(right), Some(above), Some(below)] = neighbours else {
            continue;
        };
        let across = 0.5 * (right - left) * ramps.size();
        let down = 0.5 * (below - above) * ramps.size();
        let level = level_texels(surface, pixel, ramps, layout);
        let reach = (across.length() + down.length()).max(level);
        if reach > 0.9 || !ramps.is_straight(uv, reach + 0.05, wrap) {
            continue;
        }
        off.judged += 1;
        let wanted = ramps.level(uv, wrap);
        let found = texel.map(f64::from);
        assert!(
            (found[2] - wanted[2]).abs() < 12.0 || wrap == Wrap::Repeat,
            "{layout:?} {:?}: {found:?}, not {wanted:?}",
            middle_px(surface, pixel)
        );
        for axis in 0..2 {
            let texels = (found[axis] - wanted[axis]).abs() / STEP;
            let px = texels / DVec2::new(across[axis], down[axis]).length();
            off.texels = off.texels.max(texels);
            off.px = off.px.max(px);
            off.gate = off.gate.max(4.0 * texels.min(px));
        }
    }
    off
}

/// How many texels a pixel of level ground spans at most, by which smaller copies of the image are taken.
fn level_texels(surface: &Surface, pixel: usize, ramps: &Ramps, layout: &Layout) -> f64 {
    let Some(point_m) = surface.points_m[pixel] else {
        return f64::INFINITY;
    };
    let ray = surface.lens.ray(middle_px(surface, pixel));
    let distance_m = surface.lens.distance_m(surface.depths[pixel]);
    let [here, beside] = [DVec2::ZERO, DVec2::X]
        .map(|step| (surface.lens).point_m(middle_px(surface, pixel) + step, distance_m));
    let pixel_m = here.distance(beside);
    let (foot, _) = figure().geodetic(point_m);
    let up = figure().normal(foot);
    // Terrain is taken as no more oblique than that.
    let least = if surface.terrain == Terrain::Bare {
        1e-4
    } else {
        0.2
    };
    let sine = (ray.dot(up).abs() / ray.length()).max(least);
    let here = layout.uv(&figure(), point_m);
    let ways = [
        up.any_orthonormal_vector(),
        up.cross(up.any_orthonormal_vector()),
    ];
    let texels = ways.map(|way| {
        let there = layout.uv(&figure(), point_m + pixel_m * way);
        ((there - here) * ramps.size()).length()
    });
    texels[0].hypot(texels[1]) / sine
}

/// Extents of `side_m` about a place; round a pole, all longitudes.
fn about(at: LonLat, side_m: f64) -> Extents {
    let half_deg = (0.5 * side_m / 111_000.0).min(40.0);
    let shrunk = at.lat_deg.to_radians().cos();
    if at.lat_deg.abs() + half_deg > 89.9 {
        let (south_deg, north_deg) = if at.lat_deg > 0.0 {
            (90.0 - half_deg, 90.0)
        } else {
            (-90.0, half_deg - 90.0)
        };
        return Extents {
            west_deg: at.lon_deg - 100.0,
            east_deg: at.lon_deg + 260.0,
            south_deg,
            north_deg,
        };
    }
    let half_lon_deg = (half_deg / shrunk).min(170.0);
    Extents {
        west_deg: at.lon_deg - half_lon_deg,
        east_deg: at.lon_deg + half_lon_deg,
        south_deg: at.lat_deg - half_deg,
        north_deg: at.lat_deg + half_deg,
    }
}

/// Layouts about a place, of which a texel takes some pixels.
pub fn layouts(at: LonLat, side_m: f64) -> Vec<(Layout, Wrap)> {
    let extents = about(at, side_m);
    let angles = |geocentric| Spot::Angles {
        extents,
        geocentric,
    };
    let local = Spot::Local {
        center: at,
        size_m: DVec2::new(side_m, 0.7 * side_m).min(DVec2::splat(1.5e7)),
    };
    let turned = |spot, rotation_rad: f64, repeats: DVec2| Layout {
        spot,
        rotation_rad: f64::from(rotation_rad as f32),
        repeats,
    };
    vec![
        (Layout::new(angles(false)), Wrap::Clamp),
        (Layout::new(angles(true)), Wrap::Clip),
        (Layout::new(local), Wrap::Clip),
        (
            turned(angles(false), 0.7, DVec2::new(1.5, 0.75)),
            Wrap::Repeat,
        ),
        (
            turned(angles(true), -2.0, DVec2::new(0.5, 2.0)),
            Wrap::Clamp,
        ),
        (turned(local, 2.6, DVec2::new(2.0, 1.25)), Wrap::Repeat),
    ]
}

/// Judges pictures at a place from some heights.
fn place(at: LonLat, heights_m: &[f64], shares: &[f64], terrain: Terrain, all: bool) -> Off {
    let Some(gpu) = gpu() else {
        return Off::default();
    };
    let mut worst = Off::default();
    let first = over(terrain, &pose(at, 2e4, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(at), &first);
    let sizes = [(250, 120), (1000, 500), (40, 20)];
    let ramps = sizes.map(|(width, height)| Ramps::new(width, height));
    let images = ramps.each_ref().map(|ramps| {
        let inserted = stage.renderer.insert_image(&gpu.queue, &ramps.image());
        inserted.expect("a small image")
    });
    let mut turn = 0;
    for &height_m in heights_m {
        for &share in shares {
            let surface = over(terrain, &pose(at, height_m, share), SMALL);
            let size = if height_m > 5e6 || at.is_pole() {
                2
            } else {
                turn % 2
            };
            let (ramps, image) = (&ramps[size], images[size]);
            // A texel takes five pixels of the middle, more where terrain is steep.
            let px = if terrain == Terrain::Bare { 5.0 } else { 20.0 };
            let side_m = px * pixel_m(&surface) * ramps.size().x;
            for (k, (layout, wrap)) in layouts(at, side_m).into_iter().enumerate() {
                if !all && (k + turn) % 3 != 0 {
                    continue;
                }
                stage.set(0, style_of(fill_of(image, &layout, wrap)));
                let drawn = stage.draw(&surface).texels;
                let off = judge(&surface, &drawn, ramps, &layout, wrap);
                if off.gate > 0.5 {
                    println!("{at:?} {height_m} m {share} {layout:?} {wrap:?}: {off:?}");
                }
                worst = worst.with(off);
            }
            turn += 1;
        }
    }
    println!("{at:?} {terrain:?}: {worst:?}");
    assert!(8 * worst.judged > worst.ground, "{worst:?}");
    worst
}

#[test]
fn pictures_lie_in_their_place() {
    for at in PLACES {
        let worst = place(at, &HEIGHTS_M, &[0.0, 0.8], Terrain::Bare, false);
        assert!(worst.gate <= 1.0, "{at:?}: {worst:?}");
    }
}

#[test]
fn pictures_lie_in_their_place_on_terrain() {
    let heights_m = [1.2e4, 1e5, 2e7];
    let at = PLACES[0];
    let worst = place(at, &heights_m, &[0.0, 0.8], Terrain::Rough, false);
    assert!(worst.gate <= 1.0, "{at:?}: {worst:?}");
}

#[test]
#[ignore = "minutes"]
fn pictures_lie_in_their_place_everywhere() {
    let heights_m: Vec<f64> = (0..30).map(|k| 1.3 * 1.94f64.powi(k)).collect();
    for at in PLACES {
        for terrain in [Terrain::Bare, Terrain::Rough] {
            let above: Vec<f64> = heights_m
                .iter()
                .copied()
                .filter(|&height_m| terrain == Terrain::Bare || height_m > 1e4)
                .collect();
            let worst = place(at, &above, &[0.0, 0.5, 0.9], terrain, true);
            assert!(worst.gate <= 1.0, "{at:?} {terrain:?}: {worst:?}");
        }
    }
}
