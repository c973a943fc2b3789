//! The shapes that are turned round the globe, by kind.

use globefill::{EdgeKind, Ellipsoid};

use crate::shape::{GEODESIC, Rings, Shape, clockwise, local, polar, quad, regular};

const DEG_OF_M: f64 = 1.0 / 111_319.5;

/// Larger than maps can show.
pub fn great() -> Vec<Shape> {
    let one = |name, ring| Shape::new(name, vec![Rings::new(ring)]);
    let octant = || vec![local(-45.0, -35.0), local(45.0, -35.0), polar(0.0, 55.0)];
    let right = || {
        // Three right angles: the corners are orthogonal.
        let up = 1.0_f64.atan2(2.0_f64.sqrt()).to_degrees();
        vec![
            polar(0.0, 90.0 - up),
            polar(240.0, 90.0 - up),
            polar(120.0, 90.0 - up),
        ]
    };
    vec![
        one("disc of 85°", regular(72, 85.0)),
        one("disc of 100°", regular(72, 100.0)).left(),
        one("all but a cap of 30°", clockwise(regular(36, 30.0))).left(),
        one(
            "globe less a hole of 1 km",
            clockwise(regular(12, 1e3 * DEG_OF_M)),
        )
        .left(),
        one("octant", right()),
        one("all but an octant", clockwise(right())).left(),
        one("triangle of 90°", octant()),
        one("hexagon of 20°", regular(6, 20.0)),
    ]
}

/// Edges whose ends are nearly antipodal, as near as each figure allows.
pub fn antipodal() -> Vec<Shape> {
    let with_edge = |name, length_deg: f64| {
        let half = 0.5 * length_deg;
        let ring = vec![local(-half, 0.0), local(half, 0.0), local(10.0, 60.0)];
        Shape::new(name, vec![Rings::new(ring)]).with_edges(GEODESIC)
    };
    vec![
        with_edge("edge of 179.89° on a sphere", 179.89).on(Ellipsoid::sphere(6_371_000.0)),
        with_edge("edge of 178.6°", 178.6),
        with_edge("edge of 170°", 170.0),
    ]
}

/// Rings that cross themselves: even-odd, so that both ends of a bow-tie and the tips of a pentagram are
/// inside, and the middle of the pentagram, wound round twice, is not.
pub fn crossing() -> Vec<Shape> {
    let bow_tie = |d: f64| vec![local(-d, -d), local(d, d), local(d, -d), local(-d, d)];
    let pentagram = |d: f64| -> Vec<_> {
        (0..5)
            .map(|k| polar(5.0 + 144.0 * f64::from(k), d))
            .collect()
    };
    let knot: Vec<_> = (0..60)
        .map(|k| f64::from(k) * 6.0)
        .map(|azimuth_deg| {
            polar(
                2.0 * azimuth_deg,
                12.0 + 6.0 * (3.0 * azimuth_deg).to_radians().cos(),
            )
        })
        .collect();
    let one = |name, ring| Shape::new(name, vec![Rings::new(ring)]);
    vec![
        one("bow-tie of 20°", bow_tie(10.0)),
        one("bow-tie of 2 km", bow_tie(1e3 * DEG_OF_M)),
        one("pentagram of 30°", pentagram(15.0)),
        one("pentagram of 200 m", pentagram(100.0 * DEG_OF_M)),
        one("knot", knot).with_edges(&[EdgeKind::Geodesic, EdgeKind::Straight]),
    ]
}

/// Smaller than a pixel from most places, and what precision is needed for.
pub fn tiny() -> Vec<Shape> {
    let one = |name, ring| Shape::new(name, vec![Rings::new(ring)]);
    vec![
        one("circle of 100 m", regular(64, 100.0 * DEG_OF_M)),
        one("square of 10 cm", regular(4, 0.0707 * DEG_OF_M)),
    ]
}

/// Long and narrow.
pub fn thin() -> Vec<Shape> {
    let one = |name, ring| Shape::new(name, vec![Rings::new(ring)]);
    let half = 0.555 * DEG_OF_M;
    let needle = vec![local(-5.0, -half), local(5.0, 0.0), local(-5.0, half)];
    // 3 300 km long, 200 m wide, winding.
    let centre_line = |k: i32| local(f64::from(k), 4.0 * (0.4 * f64::from(k)).sin());
    let width = 100.0 * DEG_OF_M;
    let beside = |k: i32, side: f64| {
        let ahead = centre_line(k + 1) - centre_line(k - 1);
        let at = centre_line(k);
        (at + at.cross(ahead).normalize() * side * width.to_radians()).normalize()
    };
    let corridor: Vec<_> = (-15..=15)
        .map(|k| beside(k, -1.0))
        .chain((-15..=15).rev().map(|k| beside(k, 1.0)))
        .collect();
    let fan = |k: u32| {
        let azimuth_deg = 3.0 * f64::from(k);
        let sliver =
            [azimuth_deg + 0.02, azimuth_deg - 0.02].map(|azimuth_deg| polar(azimuth_deg, 8.0));
        vec![Rings::new(vec![polar(0.0, 0.0), sliver[0], sliver[1]])]
    };
    vec![
        one("needle of 1e-6", needle),
        one("corridor of 200 m", corridor),
        Shape::regions("fan of slivers", (0..120).map(fan).collect()),
    ]
}

/// Holes, islands in them, and what touches.
pub fn holes() -> Vec<Shape> {
    let nested = vec![
        Rings::new(regular(8, 10.0)).with(vec![regular(7, 7.0)]),
        Rings::new(regular(6, 5.0)).with(vec![clockwise(regular(5, 3.0))]),
        Rings::new(regular(4, 1.0)),
    ];
    let several: Vec<_> = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]
        .into_iter()
        .map(|(x, y)| quad(x - 1.0, y - 1.0, x + 1.0, y + 1.0))
        .collect();
    let shell = quad(-6.0, -6.0, 6.0, 6.0);
    let touching = vec![shell[0], local(2.0, 0.0), local(0.0, 2.0)];
    let keyhole_less = vec![
        local(-6.0, -6.0),
        local(6.0, -6.0),
        local(6.0, 6.0),
        local(-6.0, 6.0),
    ];
    let filled = quad(-2.0, -2.0, 2.0, 2.0);
    vec![
        Shape::new("islands in holes", nested),
        Shape::new("four holes", vec![Rings::new(shell.clone()).with(several)]),
        Shape::new(
            "hole at a vertex",
            vec![Rings::new(shell).with(vec![touching])],
        ),
        Shape::regions(
            "hole filled by another",
            vec![
                vec![Rings::new(keyhole_less).with(vec![filled.clone()])],
                vec![Rings::new(filled)],
            ],
        ),
    ]
}

/// Many parts, many neighbours.
pub fn many() -> Vec<Shape> {
    let parts: Vec<_> = (0..1024)
        .map(|k| (f64::from(k % 32) - 16.0, f64::from(k / 32) - 16.0))
        .map(|(x, y)| quad(0.5 * x, 0.5 * y, 0.5 * x + 0.3, 0.5 * y + 0.3))
        .map(Rings::new)
        .collect();
    let pie = |slices: u32, angle_deg: f64| -> Vec<Vec<Rings>> {
        let rim = regular(slices, angle_deg);
        (0..slices as usize)
            .map(|k| vec![polar(0.0, 0.0), rim[k], rim[(k + 1) % rim.len()]])
            .map(|ring| vec![Rings::new(ring)])
            .collect()
    };
    // Neighbours with a common border of fifty vertices.
    let border: Vec<_> = (0..=50)
        .map(|k| {
            local(
                0.2 * f64::from(k) - 5.0,
                0.5 * f64::from(k * 37 % 11) / 11.0,
            )
        })
        .collect();
    let with_apex = |mut ring: Vec<_>, north_deg: f64| {
        ring.push(local(0.0, north_deg));
        vec![Rings::new(ring)]
    };
    let neighbours = vec![
        with_apex(border.clone(), 6.0),
        with_apex(clockwise(border), -6.0),
    ];
    vec![
        Shape::new("1024 parts", parts),
        Shape::regions("pie of 12", pie(12, 10.0)),
        Shape::regions("pie of 40, 200 m", pie(40, 100.0 * DEG_OF_M)),
        Shape::regions("shared border", neighbours),
    ]
}

/// A few ordinary shapes on other figures.
pub fn figures() -> Vec<Shape> {
    let flat = Ellipsoid {
        a_m: 6_378_137.0,
        b_m: 6_378_137.0 * 0.980_001,
    };
    let figures = [
        (
            ["heptagon on a sphere", "pentagon on a sphere"],
            Ellipsoid::sphere(6_371_000.0),
        ),
        (
            ["heptagon on the Moon", "pentagon on the Moon"],
            Ellipsoid::MOON,
        ),
        (["heptagon on Mars", "pentagon on Mars"], Ellipsoid::MARS),
        (
            ["heptagon, flattening 1/50", "pentagon, flattening 1/50"],
            flat,
        ),
    ];
    figures
        .into_iter()
        .flat_map(|(name, ellipsoid)| {
            let heptagon = Rings::new(regular(7, 15.0)).with(vec![regular(5, 6.0)]);
            let county = Rings::new(regular(5, 0.4));
            let [great, small] = name;
            [
                Shape::new(great, vec![heptagon]).on(ellipsoid),
                Shape::new(small, vec![county])
                    .with_edges(GEODESIC)
                    .on(ellipsoid),
            ]
        })
        .collect()
}
