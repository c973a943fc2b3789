//! The viewer without a window: input in, picture and answers out, against double precision of the
//! tests' own.

use glam::{DMat3, DVec2, DVec3, UVec2};
use globefill::{FrameStats, LonLat, Ring, countries::Dataset, wgpu};

use crate::{
    graphics::Graphics,
    host::gpu::Gpu,
    layers::{countries, files::File, zones},
    viewer::{Button, Viewer},
};

const SIZE_PX: UVec2 = UVec2::new(320, 200);

fn viewer_at(camera: &str) -> Viewer {
    let mut viewer = Viewer::new(SIZE_PX);
    viewer.orbit.stand_at(&camera.parse().unwrap());
    viewer
}

fn graphics() -> Graphics {
    let gpu = Gpu::open().unwrap();
    Graphics::new(gpu, wgpu::TextureFormat::Rgba8UnormSrgb, SIZE_PX).unwrap()
}

fn draw(graphics: &mut Graphics, viewer: &mut Viewer) -> (FrameStats, Vec<u8>) {
    let stats = graphics.draw(viewer, None).unwrap();
    (
        stats,
        graphics.gpu.read_texture(&graphics.canvas.color).unwrap(),
    )
}

/// ECEF of a point on WGS84, by the defining numbers.
fn ecef_m(lon_deg: f64, lat_deg: f64, height_m: f64) -> DVec3 {
    let (a_m, f) = (6_378_137.0, 1.0 / 298.257_223_563);
    let e2 = f * (2.0 - f);
    let (lon, lat) = (lon_deg.to_radians(), lat_deg.to_radians());
    let n_m = a_m / (1.0 - e2 * lat.sin().powi(2)).sqrt();
    let level_m = (n_m + height_m) * lat.cos();
    DVec3::new(
        level_m * lon.cos(),
        level_m * lon.sin(),
        (n_m * (1.0 - e2) + height_m) * lat.sin(),
    )
}

/// The pixel position of a ground point for an eye that looks straight down, north up, 45° high.
fn seen_from_above_px(eye: (f64, f64, f64), lon_deg: f64, lat_deg: f64) -> DVec2 {
    let turn =
        DMat3::from_rotation_y(eye.1.to_radians()) * DMat3::from_rotation_z(-eye.0.to_radians());
    let local = turn * (ecef_m(lon_deg, lat_deg, 0.0) - ecef_m(eye.0, eye.1, eye.2));
    let scale = f64::from(SIZE_PX.y) / 2.0 / 22.5_f64.to_radians().tan();
    SIZE_PX.as_dvec2() / 2.0 + DVec2::new(local.y, -local.z) / -local.x * scale
}

fn is_in_ring(ring: &Ring, at: LonLat) -> bool {
    let next = ring.iter().cycle().skip(1);
    let crossed = ring.iter().zip(next).filter(|(a, b)| {
        (a.lat_deg > at.lat_deg) != (b.lat_deg > at.lat_deg)
            && at.lon_deg
                < a.lon_deg
                    + (b.lon_deg - a.lon_deg) * (at.lat_deg - a.lat_deg) / (b.lat_deg - a.lat_deg)
    });
    crossed.count() % 2 == 1
}

#[test]
fn a_click_picks_the_country_that_even_odd_finds() {
    let eye = (10.4, 51.2, 9e5);
    let mut viewer = viewer_at("10.4,51.2,900000");
    viewer.loaded("countries", countries::build());
    let all = Dataset::Countries50m.countries();
    let mut found = 0;
    for step in 0..200 {
        let at = LonLat::new(
            4.5 + 0.0597 * f64::from(step),
            49.0 + f64::from(step * 37 % 200) * 0.0221,
        );
        let px = seen_from_above_px(eye, at.lon_deg, at.lat_deg);
        viewer.point(px, 0.0);
        viewer.press(Button::Grab, px, 0.0);
        viewer.release(0.1);
        let name = viewer
            .picked
            .map(|hit| viewer.layers[0].facts[hit.fill as usize].name.clone());
        let expected = all.iter().find(|country| {
            let polygons = &country.region.polygons;
            polygons.iter().any(|polygon| {
                is_in_ring(&polygon.shell, at)
                    && !polygon.holes.iter().any(|hole| is_in_ring(hole, at))
            })
        });
        assert_eq!(
            name.as_deref(),
            expected.map(|country| country.name),
            "{at:?}"
        );
        found += usize::from(name.is_some());
    }
    assert!(found > 100, "{found}");
}

#[test]
fn a_still_view_uploads_nothing_and_a_drag_changes_it() {
    let mut graphics = graphics();
    let mut viewer = viewer_at("10.4,51.2,900000");
    viewer.loaded("countries", countries::build());
    viewer.loaded("zones", zones::build());
    let (first, picture) = draw(&mut graphics, &mut viewer);
    assert!(first.upload_bytes > 0);
    let (second, same) = draw(&mut graphics, &mut viewer);
    assert_eq!(second.upload_bytes, 0);
    assert!(picture == same);
    viewer.point(DVec2::new(100.0, 100.0), 0.0);
    viewer.press(Button::Grab, DVec2::new(100.0, 100.0), 0.0);
    viewer.point(DVec2::new(150.0, 100.0), 0.1);
    viewer.release(1.0);
    assert!(!viewer.orbit.is_moving(), "a rested pointer does not throw");
    let (_, moved) = draw(&mut graphics, &mut viewer);
    assert!(picture != moved);
}

#[test]
fn coverage_and_playing_change_the_picture() {
    let mut graphics = graphics();
    let mut viewer = Viewer::new(SIZE_PX);
    let (none, bare) = draw(&mut graphics, &mut viewer);
    assert_eq!(none.sensors, 0);
    viewer.satellites.settings.visible = true;
    let (shown, footprints) = draw(&mut graphics, &mut viewer);
    assert_eq!(shown.sensors, 60);
    assert!(bare != footprints);
    viewer.satellites.settings.coverage = true;
    let (_, coverage) = draw(&mut graphics, &mut viewer);
    assert!(footprints != coverage);
    viewer.satellites.playing = true;
    assert!(viewer.advance(1.0));
    let (moved, later) = draw(&mut graphics, &mut viewer);
    assert_eq!(moved.upload_bytes, 60 * 128);
    assert!(coverage != later);
}

#[test]
fn a_bad_file_is_shown_and_not_fatal() {
    let mut viewer = viewer_at("10,50,1e6");
    viewer.loads("bad.geojson", "reading");
    let layer = File::parse("bad.geojson", "{").and_then(File::build);
    viewer.loaded("bad.geojson", layer);
    assert!(viewer.loading.is_empty() && viewer.layers.is_empty());
    assert!(
        viewer.errors[0].starts_with("bad.geojson: "),
        "{:?}",
        viewer.errors
    );
}

#[test]
fn a_closed_file_is_gone() {
    let mut graphics = graphics();
    let mut viewer = viewer_at("10,50,1e6");
    let (_, bare) = draw(&mut graphics, &mut viewer);
    let square = r#"{"type":"Polygon","coordinates":[[[8,48],[12,48],[12,52],[8,52],[8,48]]]}"#;
    let file = File::parse("square.geojson", square).unwrap();
    assert_eq!(file.size(), "1 regions, 5 vertices");
    viewer.loaded("square.geojson", file.build());
    let (shown, filled) = draw(&mut graphics, &mut viewer);
    assert!(bare != filled);
    assert!(viewer.layers[0].can_be_closed);
    viewer.close(0);
    let (gone, after) = draw(&mut graphics, &mut viewer);
    assert!(bare == after);
    assert_eq!((shown.fills, gone.fills), (1, 0));
    assert!(gone.gpu_bytes < shown.gpu_bytes);
}
