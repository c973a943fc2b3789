//! The surface that `render` measures fills on: its depth buffer against the ellipsoid in f64.

mod render_example;

use glam::{DMat3, DVec2, DVec3};
use globefill::{Ellipsoid, LonLat};
use render_example::Workplace;

const WIDTH: usize = 256;
const HEIGHT: usize = 144;

/// How far a surface point may lie above or below the ellipsoid, as a part of its distance from
/// the eye. Its ray is exact, so this is the depth value's error times the sine of the angle at
/// which the ray meets the ground. Single precision has 6·10⁻⁸ a rounding.
const HEIGHT_BOUND: f64 = 5e-7;

/// The camera of `--camera`, written down once more from its documentation.
struct Camera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    fov_deg: f64,
}

/// Longitude, latitude, height, heading, pitch, field of view.
type Setting = [f64; 6];

impl Camera {
    fn new([lon_deg, lat_deg, height_m, heading_deg, pitch_deg, fov_deg]: Setting) -> Self {
        let foot = LonLat::new(lon_deg, lat_deg);
        let east = DVec3::new(-lon_deg.to_radians().sin(), lon_deg.to_radians().cos(), 0.0);
        let zenith = Ellipsoid::WGS84.normal(foot);
        let north = zenith.cross(east);
        let to_heading = DMat3::from_axis_angle(zenith, -heading_deg.to_radians());
        let (ahead, right) = (to_heading * north, to_heading * east);
        let to_pitch = DMat3::from_axis_angle(right, pitch_deg.to_radians());
        Self {
            eye: Ellipsoid::WGS84.ecef(foot, height_m),
            right,
            up: to_pitch * zenith,
            forward: to_pitch * ahead,
            fov_deg,
        }
    }

    fn ray(&self, column: usize, row: usize) -> DVec3 {
        let half = (self.fov_deg.to_radians() / 2.0).tan();
        let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let place = (centre - DVec2::new(WIDTH as f64, HEIGHT as f64) / 2.0) * 2.0 / HEIGHT as f64;
        (self.forward + half * (place.x * self.right - place.y * self.up)).normalize()
    }

    /// Whether a ray meets the ellipsoid.
    fn meets(&self, ray: DVec3) -> bool {
        let scale = DVec3::ONE / Ellipsoid::WGS84.radii_m();
        let (eye, ray) = (self.eye * scale, ray * scale);
        let b = eye.dot(ray);
        b < 0.0 && b * b >= ray.length_squared() * (eye.length_squared() - 1.0)
    }
}

fn positions(name: &str, setting: &Setting, extra: &[&str]) -> Option<Vec<DVec3>> {
    let workplace = Workplace::new(name);
    workplace.write(
        "none.geojson",
        r#"{"type":"FeatureCollection","features":[]}"#,
    );
    let camera: Vec<String> = setting[..5].iter().map(f64::to_string).collect();
    let camera = camera.join(",");
    let fov = setting[5].to_string();
    let size = format!("{WIDTH}x{HEIGHT}");
    let arguments = [
        "--regions",
        "none.geojson",
        "--positions",
        "p.npy",
        "--size",
        &size,
        "--camera",
        &camera,
        "--fov",
        &fov,
    ];
    let run = workplace.render(&[&arguments[..], extra].concat());
    let said = String::from_utf8_lossy(&run.stderr);
    if said.contains("no graphics adapter") && std::env::var_os("CI").is_none() {
        eprintln!("NOT TESTED: {said}");
        return None;
    }
    assert!(run.status.success(), "{said}");
    let file = std::fs::read(workplace.path("p.npy")).expect("the positions");
    let numbers = &file[file.len() - WIDTH * HEIGHT * 24..];
    let (words, _) = numbers.as_chunks::<8>();
    let (points, _) = words.as_chunks::<3>();
    Some(
        points
            .iter()
            .map(|point| DVec3::from(point.map(f64::from_le_bytes)))
            .collect(),
    )
}

const SETTINGS: [Setting; 9] = [
    [10.0, 45.0, 1.0, 0.0, -90.0, 60.0],
    [10.0, 45.0, 1.0, 70.0, -5.0, 60.0],
    [-77.0, -12.0, 100.0, 200.0, -30.0, 60.0],
    [180.0, 0.0, 1e3, 90.0, -10.0, 60.0],
    [0.0, 90.0, 5e4, 0.0, -5.0, 60.0],
    [12.0, -89.9, 9e5, 10.0, -80.0, 60.0],
    [20.0, 20.0, 2e7, 0.0, -90.0, 60.0],
    [20.0, 20.0, 2e7, 33.0, -70.0, 90.0],
    [-120.0, 50.0, 4e8, 0.0, -90.0, 3.0],
];

#[test]
fn the_globe_is_the_ellipsoid() {
    for setting in &SETTINGS {
        let Some(points) = positions("globe", setting, &[]) else {
            return;
        };
        let worst = check(setting, &points);
        println!("{setting:?}: {worst:.1e}");
        assert!(worst < HEIGHT_BOUND, "{setting:?}: {worst:e}");
    }
}

#[test]
fn a_standard_depth_buffer_holds_it_too() {
    // A finite standard depth of single precision resolves distance² · 6·10⁻⁸ / near, and near is a
    // tenth of the height: at the nadir some 10⁻⁶ of the distance.
    for setting in [
        [10.0, 45.0, 1e3, 0.0, -90.0, 60.0],
        [12.0, -89.9, 9e5, 10.0, -80.0, 60.0],
        [20.0, 20.0, 2e7, 0.0, -90.0, 60.0],
    ] {
        let Some(points) = positions("standard", &setting, &["--depth", "standard"]) else {
            return;
        };
        let worst = check(&setting, &points);
        println!("{setting:?}: {worst:.1e}");
        assert!(worst < 3e-6, "{setting:?}: {worst:e}");
    }
}

/// A regular grid of hills up to 5 km, and what its surface is between the nodes.
fn hill_m(lon_deg: f64, lat_deg: f64) -> f64 {
    let node = |x: i64, y: i64| ((x * 7 + y * 13).rem_euclid(11) * 500) as f64;
    let (x, y) = ((lon_deg - 10.0) * 4.0, (50.0 - lat_deg) * 4.0);
    if !(0.0..=40.0).contains(&x) || !(0.0..=40.0).contains(&y) {
        return 0.0;
    }
    let (i, j) = ((x as i64).min(39), (y as i64).min(39));
    let (u, v) = (x - i as f64, y - j as f64);
    let upper = node(i, j) * (1.0 - u) + node(i + 1, j) * u;
    let lower = node(i, j + 1) * (1.0 - u) + node(i + 1, j + 1) * u;
    upper * (1.0 - v) + lower * v
}

fn write_hills(workplace: &Workplace) -> String {
    let grid = image::ImageBuffer::<image::Luma<u16>, _>::from_fn(41, 41, |x, y| {
        image::Luma([hill_m(10.0 + f64::from(x) / 4.0, 50.0 - f64::from(y) / 4.0) as u16 + 1000])
    });
    grid.save(workplace.path("hills.png")).expect("a picture");
    workplace.write(
        "hills.json",
        r#"{"west":10,"south":40,"east":20,"north":50,"scale":1,"offset":-1000}"#,
    );
    workplace.path("hills.png").to_string_lossy().into_owned()
}

#[test]
fn terrain_has_the_heights_of_its_file() {
    let files = Workplace::new("hills");
    let hills = write_hills(&files);
    // The foot lies inside a cell of the grid, whose bilinear surface is smooth.
    for (lon_deg, lat_deg, above_m, bound_m) in [
        (12.1, 45.1, 1.0, 2e-6),
        (12.1, 45.1, 100.0, 2e-4),
        (17.35, 41.4, 1e3, 2e-3),
    ] {
        let height_m = hill_m(lon_deg, lat_deg) + above_m;
        let setting = [lon_deg, lat_deg, height_m, 0.0, -90.0, 40.0];
        let Some(points) = positions("over-hills", &setting, &["--terrain", &hills]) else {
            return;
        };
        let mut worst_m = 0.0_f64;
        for point in points {
            let (foot, height_m) = Ellipsoid::WGS84.geodetic(point);
            assert!(!point.is_nan(), "{setting:?}: a hole");
            worst_m = worst_m.max((height_m - hill_m(foot.lon_deg, foot.lat_deg)).abs());
        }
        println!("{above_m} m above the hills: {worst_m:.1e} m");
        assert!(worst_m < bound_m, "{setting:?}: {worst_m} m");
    }
}

#[test]
fn terrain_has_no_cracks() {
    let files = Workplace::new("cracks");
    let hills = write_hills(&files);
    // Many levels of tiles in one picture that holds only ground; from outside the grid as well.
    for setting in [
        [15.0, 45.0, 1.2e4, 0.0, -60.0, 50.0],
        [15.0, 45.0, 5.6e3, 130.0, -50.0, 70.0],
        [9.9, 50.1, 8e3, 140.0, -50.0, 60.0],
        [179.999, 0.0, 2e3, 90.0, -50.0, 60.0],
        [10.0, 89.999, 2e4, 0.0, -60.0, 60.0],
        [-75.0, -40.0, 1e6, 10.0, -80.0, 60.0],
    ] {
        let Some(points) = positions("over-cracks", &setting, &["--terrain", &hills]) else {
            return;
        };
        let lowest_m = points
            .iter()
            .map(|point| Ellipsoid::WGS84.geodetic(*point).1)
            .fold(f64::MAX, f64::min);
        assert!(
            points.iter().all(|point| !point.is_nan()),
            "{setting:?}: a hole"
        );
        // Through a crack one would see the far side of the globe, thousands of km below.
        assert!(lowest_m > -2e4, "{setting:?}: {lowest_m} m");
    }
}

/// The greatest height error as a part of the distance. Checks that every pixel is sky or ground as
/// it must be, and on its own ray.
fn check(numbers: &Setting, points: &[DVec3]) -> f64 {
    let camera = Camera::new(*numbers);
    let mut worst = 0.0_f64;
    let mut seen = 0;
    for row in 1..HEIGHT - 1 {
        for column in 1..WIDTH - 1 {
            let around = [(0, 1), (1, 0), (1, 1), (1, 2), (2, 1)]
                .map(|(x, y)| camera.meets(camera.ray(column + x - 1, row + y - 1)));
            if around != [around[0]; 5] {
                continue; // the limb passes within a pixel
            }
            let point = points[row * WIDTH + column];
            assert_eq!(
                !point.is_nan(),
                around[0],
                "{numbers:?}: pixel {column}, {row}"
            );
            if !around[0] {
                continue;
            }
            seen += 1;
            let relative = point - camera.eye;
            let distance = relative.length();
            let beside = relative.cross(camera.ray(column, row)).length() / distance;
            // Subtracting ECEF coordinates of 4·10⁸ m leaves 10⁻⁷ m.
            assert!(
                beside < 1e-12 + 2e-7 / distance,
                "{numbers:?}: off its ray by {beside:e}"
            );
            let (_, height_m) = Ellipsoid::WGS84.geodetic(point);
            let error = (height_m.abs() - 2e-7).max(0.0) / distance;
            worst = worst.max(error);
        }
    }
    assert!(seen > 20, "{numbers:?}: {seen} pixels of ground");
    worst
}
