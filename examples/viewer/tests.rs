//! The viewer as a person uses it, but without a window: events in, pictures out.

use std::{fs, time::Duration};

use egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2,
    vec2,
};
use glam::UVec2;
use globefill::{Ellipsoid, LonLat, wgpu};

use crate::{
    host::{camera::Viewpoint, gpu::Gpu},
    orbit::Picture,
    viewer::Viewer,
};

const SIZE_PX: UVec2 = UVec2::new(640, 480);

/// A person at the viewer.
struct Person {
    viewer: Viewer,
    seconds: f64,
}

impl Person {
    /// None where there is no adapter, which fails under CI.
    fn new(viewpoint: Viewpoint) -> Option<Self> {
        let gpu = match Gpu::open() {
            Ok(gpu) => gpu,
            Err(error) if std::env::var_os("CI").is_some() => panic!("{error}"),
            Err(error) => {
                eprintln!("skipped: {error}");
                return None;
            }
        };
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let mut viewer = Viewer::new(gpu, format, SIZE_PX, viewpoint).expect("it starts");
        viewer.show_panel = false;
        viewer.satellites.playing = false;
        let mut person = Self {
            viewer,
            seconds: 0.0,
        };
        person.wait();
        Some(person)
    }

    fn does(&mut self, events: Vec<Event>) {
        self.seconds += 1.0 / 60.0;
        let mut input = self.viewer.still_input(self.seconds);
        input.events = events;
        self.viewer.frame(input).expect("it draws");
    }

    /// Until nothing changes any more.
    fn wait(&mut self) {
        for _ in 0..600 {
            self.does(Vec::new());
            if self.viewer.is_settled() {
                return;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        panic!("it does not come to rest");
    }

    fn point(&mut self, at: Pos2) {
        self.does(vec![Event::PointerMoved(at)]);
        // egui knows what is under the pointer one frame later.
        self.does(vec![Event::PointerMoved(at)]);
    }

    fn press(&mut self, at: Pos2, pressed: bool) {
        self.does(vec![Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }]);
    }

    fn key(&mut self, key: Key) {
        self.does(vec![Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        }]);
    }

    /// Where a place is seen.
    fn pixel_of(&self, place: LonLat) -> Pos2 {
        let picture = Picture::new(SIZE_PX.as_dvec2(), crate::globe_view::FOV_DEG);
        let point_m = Ellipsoid::WGS84.ecef(place, 0.0);
        let at_px = self.viewer.orbit.pixel_of(&picture, point_m);
        let at_px = at_px.expect("it is seen");
        pos2(at_px.x as f32, at_px.y as f32)
    }

    fn texel(&self, at: Pos2) -> [u8; 4] {
        let texels = self.viewer.picture().expect("it is read back");
        let index = at.y as usize * SIZE_PX.x as usize + at.x as usize;
        texels.as_chunks::<4>().0[index]
    }
}

fn above(lon_deg: f64, lat_deg: f64, height_m: f64) -> Viewpoint {
    Viewpoint {
        foot: LonLat::new(lon_deg, lat_deg),
        height_m,
        heading_deg: 0.0,
        pitch_deg: -90.0,
    }
}

const MADRID: LonLat = LonLat::new(-3.7, 40.4);
const PARIS: LonLat = LonLat::new(2.35, 48.86);

#[test]
fn a_country_is_named_lit_and_chosen() {
    let Some(mut person) = Person::new(above(0.0, 44.0, 3e6)) else {
        return;
    };
    let (madrid, paris) = (person.pixel_of(MADRID), person.pixel_of(PARIS));
    person.point(paris);
    let before = person.texel(madrid);
    person.point(madrid);
    let countries = &person.viewer.scene.countries;
    let spain = countries.under_pointer.expect("a country");
    assert_eq!(countries.name(spain), "Spain");
    // Its area is 505 990 km²; the boundary is that of a map of 1 : 50 million.
    let digits: String = countries
        .area(spain)
        .chars()
        .filter(char::is_ascii_digit)
        .collect();
    let square_km: f64 = digits.parse().expect("a number");
    assert!((square_km / 505_990.0 - 1.0).abs() < 0.02, "{square_km}");
    let lit = person.texel(madrid);
    assert!(
        lit[..3]
            .iter()
            .zip(&before[..3])
            .all(|(lit, before)| lit > before)
    );
    person.press(madrid, true);
    person.press(madrid, false);
    person.point(paris);
    assert_eq!(person.viewer.scene.countries.chosen, Some(spain));
    let chosen = person.texel(madrid);
    // Yellow lies over it.
    assert!(
        chosen[0] > chosen[2] && chosen != before,
        "{chosen:?} {before:?}"
    );
}

#[test]
fn the_ground_goes_where_it_is_dragged_and_drifts_on() {
    let Some(mut person) = Person::new(above(0.0, 44.0, 3e6)) else {
        return;
    };
    let madrid = person.pixel_of(MADRID);
    person.point(madrid);
    person.press(madrid, true);
    for step in 1..=10 {
        let at = madrid + vec2(9.0, -6.0) * step as f32;
        person.does(vec![Event::PointerMoved(at)]);
    }
    let there = madrid + vec2(90.0, -60.0);
    let found = person.pixel_of(MADRID);
    assert!(found.distance(there) < 0.5, "{found} instead of {there}");
    person.press(there, false);
    assert!(!person.viewer.still_for().is_zero() || person.viewer.orbit.is_drifting());
    person.wait();
    assert!(person.pixel_of(MADRID).distance(there) > 5.0, "it drifted");
}

#[test]
fn the_wheel_zooms_to_the_pointer() {
    let Some(mut person) = Person::new(above(0.0, 44.0, 3e6)) else {
        return;
    };
    let madrid = person.pixel_of(MADRID);
    person.point(madrid);
    for _ in 0..20 {
        person.does(vec![Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            source: MouseWheelSource::Wheel,
            delta: vec2(0.0, 1.0),
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        }]);
    }
    person.wait();
    let height_m = person.viewer.orbit.viewpoint.height_m;
    assert!((1e3..1e6).contains(&height_m), "{height_m}");
    assert!(person.pixel_of(MADRID).distance(madrid) < 1.0);
    person.key(Key::Home);
    assert!(person.viewer.orbit.viewpoint.height_m > 1e7);
}

#[test]
fn a_still_frame_uploads_nothing() {
    let Some(mut person) = Person::new(above(10.0, 20.0, 1.5e7)) else {
        return;
    };
    person.wait();
    let still = person.viewer.scene.stats;
    assert_eq!(still.upload_bytes, 0);
    assert!(still.drawn > 50 && still.sensors > 0, "{still:?}");
    let before = person.viewer.picture();
    person.wait();
    assert!(person.viewer.picture() == before);
    person.key(Key::Space);
    person.does(Vec::new());
    assert!(person.viewer.scene.stats.upload_bytes > 0);
}

#[test]
fn coverage_is_toggled() {
    let Some(mut person) = Person::new(above(10.0, 20.0, 1.5e7)) else {
        return;
    };
    let colors = person.viewer.picture().expect("it is read back");
    person.viewer.satellites.look.coverage = true;
    person.wait();
    let coverage = person.viewer.picture().expect("it is read back");
    person.viewer.satellites.look.coverage = false;
    person.wait();
    assert!(coverage != colors && person.viewer.picture().as_ref() == Ok(&colors));
}

#[test]
fn bad_files_are_said_to_be_bad_and_good_ones_are_shown() {
    let Some(mut person) = Person::new(above(0.0, 44.0, 3e6)) else {
        return;
    };
    let folder = std::env::temp_dir().join(format!("globefill-viewer-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let (bad, good) = (folder.join("bad.geojson"), folder.join("good.geojson"));
    fs::write(&bad, "{ \"type\": \"Feature").expect("it is written");
    let ring = "[[-5,39],[-2,39],[-2,42],[-5,42],[-5,39]]";
    let text = format!("{{\"type\":\"Polygon\",\"coordinates\":[{ring}]}}");
    fs::write(&good, text).expect("it is written");
    let madrid = person.pixel_of(MADRID);
    let before = person.texel(madrid);
    person.viewer.open(&bad);
    person.viewer.open(&good);
    person.wait();
    fs::remove_dir_all(&folder).expect("the folder goes");
    let files = &person.viewer.scene.files;
    assert_eq!(
        (files.open.len(), files.errors.len()),
        (1, 1),
        "{:?}",
        files.errors
    );
    assert!(
        files.errors[0].starts_with("bad.geojson: "),
        "{:?}",
        files.errors
    );
    assert_ne!(person.texel(madrid), before);
}
