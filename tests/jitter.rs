//! Slow moves close to a boundary: how far what stands still on the ground moves beside it from frame to
//! frame.
//!
//! Where the drawn boundary lies is known between pixel centres on either side of it: the true distance of
//! each centre says how far it is displaced at least, or at most. Some hundred of them bound the
//! displacement to a hundredth of a pixel or two.

mod common;

use common::{
    camera::Pose,
    draw::IdPainter,
    headless::{Gpu, gpu},
    oracle::Oracle,
    pair_mesh::Pair,
    score::{boundary_distance_px, expected_ids},
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::{DVec2, UVec2};
use globefill::{CountTechnique, EdgeKind, Ellipsoid, LonLat, View};

const SIZE: UVec2 = UVec2::new(320, 180);
/// Cells of the picture in which a boundary is taken to be displaced alike.
const CELL_PX: UVec2 = UVec2::new(160, 180);
const FRAMES: u32 = 6;
/// Pixels that the camera moves from frame to frame.
const STEP_PX: f64 = 0.37;
const MOST_PX: f64 = 0.05;
/// Displacements count that are known as well as this: not where a boundary meets pixels in a row alike.
const KNOWN_PX: f64 = 0.024;

/// Bounds of a displacement to the left, pixels.
#[derive(Clone, Copy, Debug)]
struct Displaced {
    least: f64,
    most: f64,
}

impl Displaced {
    const UNKNOWN: Self = Self {
        least: f64::NEG_INFINITY,
        most: f64::INFINITY,
    };

    /// How far two displacements differ at least.
    fn apart(self, other: Self) -> f64 {
        (self.least - other.most)
            .max(other.least - self.most)
            .max(0.0)
    }

    /// How far they differ at most.
    fn apart_at_most(self, other: Self) -> f64 {
        (self.most - other.least).max(other.most - self.least)
    }

    fn width(self) -> f64 {
        self.most - self.least
    }
}

/// The displacement of the boundary between the fills 1, on its left, and 2, cell by cell.
fn displaced(
    oracle: &Oracle,
    surface: &Surface,
    expected: &[u32],
    drawn: &[u32],
) -> Vec<Displaced> {
    let cells = SIZE / CELL_PX;
    let mut found = vec![Displaced::UNKNOWN; (cells.x * cells.y) as usize];
    for y in 1..SIZE.y - 1 {
        for x in 1..SIZE.x - 1 {
            let pixel = (y * SIZE.x + x) as usize;
            let around = [
                pixel - 1,
                pixel + 1,
                pixel - SIZE.x as usize,
                pixel + SIZE.x as usize,
            ];
            let differs =
                |&other: &usize| expected[other] != expected[pixel] || drawn[other] != drawn[pixel];
            let Some(point_m) = surface.points_m[pixel].filter(|_| around.iter().any(differs))
            else {
                continue;
            };
            let at_px = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
            let (_, height_m) = oracle.figure.geodetic(point_m);
            let off_px = boundary_distance_px(oracle, surface, 0, at_px, point_m, height_m);
            let left_px = if expected[pixel] == 1 {
                off_px
            } else {
                -off_px
            };
            let cell = UVec2::new(x, y) / CELL_PX;
            let cell = &mut found[(cell.y * cells.x + cell.x) as usize];
            match drawn[pixel] {
                1 => cell.most = cell.most.min(left_px),
                2 => cell.least = cell.least.max(left_px),
                other => panic!("neither side at {x}, {y}: {other}"),
            }
        }
    }
    found
}

/// The greatest displacement, and the greatest between consecutive frames at least and at most, pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Jitter {
    off_px: f64,
    between_px: f64,
    at_most_px: f64,
    cells: usize,
}

impl Jitter {
    /// With what two consecutive frames show of one cell.
    fn add(&mut self, before: Option<Displaced>, now: Displaced) {
        let known = |cell: &Displaced| cell.width() < KNOWN_PX;
        if !known(&now) {
            return;
        }
        self.off_px = self.off_px.max(now.least).max(-now.most);
        if let Some(before) = before.filter(known) {
            self.between_px = self.between_px.max(before.apart(now));
            self.at_most_px = self.at_most_px.max(before.apart_at_most(now));
            self.cells += 1;
        }
    }
}

/// How the same frames are drawn: the technique and the budget, pixels.
const WAYS: [(CountTechnique, f64); 4] = [
    (CountTechnique::Winding, 0.0),
    (CountTechnique::Winding, 0.25),
    (CountTechnique::Stencil, 0.0),
    (CountTechnique::Stencil, 0.25),
];

/// One of the ways through a move.
struct Watched {
    view: View,
    painter: IdPainter,
    last: Option<Vec<Displaced>>,
    jitter: Jitter,
}

fn watch(gpu: &Gpu, pair: Pair, terrain: Terrain, height_m: f64) -> [Jitter; 4] {
    let oracle = Oracle::new(&pair.regions(), Ellipsoid::WGS84);
    let edge = oracle.boundary(0).next().expect("a triangle");
    let middle = edge.point(&oracle.figure, 0.5);
    let ground_m = terrain.height_m(oracle.figure.normal(middle));
    let pixel_m = height_m * 2.0 * 30f64.to_radians().tan() / f64::from(SIZE.y);
    let surface_at = |frame: u32| {
        let moved_deg = f64::from(frame) * STEP_PX * pixel_m / 111e3;
        let at = LonLat::new(middle.lon_deg + 0.6 * moved_deg, middle.lat_deg - moved_deg);
        let up_m = ground_m + height_m * (1.0 + 1e-4 * f64::from(frame));
        let pose = Pose::nadir(at.lon_deg, at.lat_deg, up_m).turned(17.0, -62.0);
        let cast = Cast::new(&oracle.figure, &pose, SIZE, 1, terrain);
        Surface::new(&cast, DepthKind::Reversed)
    };
    let first = surface_at(0);
    let mut ways = WAYS.map(|(count, _)| Watched {
        view: View::default(),
        painter: IdPainter::new(gpu, pair.mesh(), &first, count),
        last: None,
        jitter: Jitter::default(),
    });
    for frame in 0..FRAMES {
        let surface = surface_at(frame);
        let expected = expected_ids(&oracle, &surface);
        for (way, (_, budget_px)) in ways.iter_mut().zip(WAYS) {
            let picture = way.painter.draw(gpu, &mut way.view, &surface, budget_px);
            let now = displaced(&oracle, &surface, &expected, &picture.ids);
            for (cell, &known) in now.iter().enumerate() {
                way.jitter
                    .add(way.last.as_ref().map(|last| last[cell]), known);
            }
            way.last = Some(now);
        }
    }
    ways.map(|way| way.jitter)
}

fn pairs() -> [(&'static str, Pair); 4] {
    let at = |lon_deg| LonLat::new(lon_deg, 89.55);
    let over_the_pole = Pair {
        kind: EdgeKind::Geodesic,
        a: at(20.0),
        b: at(-160.0),
        left: at(-70.0),
        right: at(110.0),
    };
    [
        (
            "straight",
            Pair::about(EdgeKind::Straight, 11.0, 47.0, 65.0, 0.9),
        ),
        (
            "rhumb",
            Pair::about(EdgeKind::Rhumb, -75.3, -33.0, 58.0, 0.9),
        ),
        (
            "antimeridian",
            Pair::about(EdgeKind::Straight, 180.0, -17.0, 67.0, 0.9),
        ),
        ("pole", over_the_pole),
    ]
}

#[test]
fn boundaries_stand_still_under_slow_moves() {
    let Some(gpu) = gpu() else { return };
    let mut worst = 0.0f64;
    for (name, pair) in pairs() {
        let plateau = Terrain::Plateau { height_m: 4000.0 };
        for (terrain, height_m) in [(Terrain::Bare, 1.0), (Terrain::Bare, 10.0), (plateau, 2.3)] {
            let ways = watch(gpu, pair, terrain, height_m);
            for ((count, budget_px), jitter) in WAYS.into_iter().zip(ways) {
                println!(
                    "{name} {terrain:?} {height_m} m {count:?} budget {budget_px}: {jitter:.4?}"
                );
                assert!(jitter.cells > 1, "{jitter:?}");
                assert!(jitter.at_most_px <= MOST_PX, "{jitter:?}");
                worst = worst.max(jitter.at_most_px);
            }
        }
    }
    println!("between frames: {worst:.4} px at most");
}

/// The instrument tells a jump: a boundary drawn a fifth of a pixel aside.
#[test]
fn a_jump_is_seen() {
    let Some(gpu) = gpu() else { return };
    let pair = Pair::about(EdgeKind::Straight, 11.0, 47.0, 0.0, 0.9);
    let oracle = Oracle::new(&pair.regions(), Ellipsoid::WGS84);
    let pose = Pose::nadir(11.0, 47.0, 10.0).turned(17.0, -90.0);
    let cast = Cast::new(&oracle.figure, &pose, SIZE, 1, Terrain::Bare);
    let surface = Surface::new(&cast, DepthKind::Reversed);
    let pixel_m = 10.0 * 2.0 * 30f64.to_radians().tan() / f64::from(SIZE.y);
    let east_deg = 0.2 * pixel_m / (oracle.figure.a_m * 47f64.to_radians().cos()).to_radians();
    let aside = |p: LonLat| LonLat::new(p.lon_deg + east_deg, p.lat_deg);
    let moved = Pair {
        a: aside(pair.a),
        b: aside(pair.b),
        ..pair
    };
    let expected = expected_ids(&oracle, &surface);
    let [still, moved] = [pair, moved].map(|drawn| {
        let mut painter = IdPainter::new(gpu, drawn.mesh(), &surface, CountTechnique::Winding);
        let ids = painter.draw(gpu, &mut View::default(), &surface, 0.0).ids;
        displaced(&oracle, &surface, &expected, &ids)
    });
    let known = |cell: &Displaced| cell.width() < 0.1;
    let pairs: Vec<_> = still
        .iter()
        .zip(&moved)
        .filter(|(a, b)| known(a) && known(b))
        .collect();
    assert!(pairs.len() > 1);
    for (still, moved) in pairs {
        let apart = still.apart(*moved);
        assert!((0.15..=0.21).contains(&apart), "{still:?} {moved:?}");
    }
}
