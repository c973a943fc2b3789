//! The surface that `render` measures fills on: its depth buffer against the ellipsoid in f64.

mod render_example;

use glam::{DMat3, DVec2, DVec3};
use globefill::{Ellipsoid, LonLat};
use render_example::Workplace;

const WIDTH: usize = 256;
const HEIGHT: usize = 144;
const FOV_DEG: f64 = 60.0;

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
}

impl Camera {
    fn new([lon_deg, lat_deg, height_m, heading_deg, pitch_deg]: [f64; 5]) -> Self {
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
        }
    }

    fn ray(&self, column: usize, row: usize) -> DVec3 {
        let half = (FOV_DEG.to_radians() / 2.0).tan();
        let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        let place = (centre - DVec2::new(WIDTH as f64, HEIGHT as f64) / 2.0) * 2.0 / HEIGHT as f64;
        (self.forward + half * (place.x * self.right - place.y * self.up)).normalize()
    }

    /// Whether a ray passes the ellipsoid by less than `margin_rad` at its outline, or meets it.
    fn meets(&self, ray: DVec3) -> bool {
        let scale = DVec3::ONE / Ellipsoid::WGS84.radii_m();
        let (eye, ray) = (self.eye * scale, ray * scale);
        let b = eye.dot(ray);
        b < 0.0 && b * b >= ray.length_squared() * (eye.length_squared() - 1.0)
    }
}

fn positions(camera: &[f64; 5], extra: &[&str]) -> Option<Vec<DVec3>> {
    let workplace = Workplace::new(&format!(
        "surface-{}",
        camera.map(|n| n.to_string()).join("_")
    ));
    workplace.write(
        "none.geojson",
        r#"{"type":"FeatureCollection","features":[]}"#,
    );
    let camera = camera.map(|number| number.to_string()).join(",");
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

#[test]
fn the_globe_is_the_ellipsoid() {
    let mut worst = 0.0_f64;
    for camera in [
        [10.0, 45.0, 1.0, 0.0, -90.0],
        [10.0, 45.0, 1.0, 70.0, -5.0],
        [-77.0, -12.0, 100.0, 200.0, -30.0],
        [180.0, 0.0, 1e3, 90.0, -10.0],
        [0.0, 90.0, 5e4, 0.0, -5.0],
        [12.0, -89.9, 9e5, 10.0, -80.0],
        [20.0, 20.0, 2e7, 0.0, -90.0],
        [20.0, 20.0, 2e7, 33.0, -70.0],
        [-120.0, 50.0, 4e8, 0.0, -90.0],
    ] {
        let Some(points) = positions(&camera, &[]) else {
            return;
        };
        worst = worst.max(check(&camera, &points));
    }
    println!("worst height error {worst:.1e} of the distance");
}

/// Returns the greatest height error as a part of the distance, having checked every pixel.
fn check(numbers: &[f64; 5], points: &[DVec3]) -> f64 {
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
            assert!(
                error < HEIGHT_BOUND,
                "{numbers:?}: pixel {column}, {row}: {error:e}"
            );
            worst = worst.max(error);
        }
    }
    assert!(seen > 20, "{numbers:?}: {seen} pixels of ground");
    println!("{numbers:?}: {seen} pixels, {worst:.1e}");
    worst
}
