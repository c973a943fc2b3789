//! The viewer's page as a person uses it, in a headless browser: `scripts/web-test` builds the page and runs this.

#[path = "../common/mod.rs"]
mod common;

mod browser;

use std::{
    f64::consts::FRAC_PI_4,
    path::Path,
    time::{Duration, Instant},
};

use common::{
    camera::{DepthRange, Lens, Pose},
    figure::Figure,
    oracle::{Oracle, Scratch},
};
use glam::{DVec2, UVec2};
use globefill::{Ellipsoid, countries::Dataset};
use serde_json::json;

use browser::{Adapter, Browser, Server};

/// Tests run in the package's root.
const PAGE: &str = "target/web";
const EYE: (f64, f64, f64) = (10.4, 51.2, 9e5);
/// The viewer's.
const FOV_DEG: f64 = 45.0;
/// Pixels so near a boundary are not compared: half of the outline's width, and smooth edges.
const BAND_PX: f64 = 2.0;

/// Where the panels have what; the browser's default font size.
const LABELS: (f64, f64) = (26.0, 87.0);
const COUNTRIES: (f64, f64) = (26.0, 118.0);
const ZONES: (f64, f64) = (26.0, 164.0);
/// Where no layer is shown.
const SATELLITES: (f64, f64) = (26.0, 164.0);
/// Behind the name of the file that lies beside the page.
const CLOSE_FILE: (f64, f64) = (130.0, 210.0);
const OPEN_FILE: (f64, f64) = (78.0, 63.0);
const SCREENSHOT: (f64, f64) = (187.0, 63.0);

/// Keeps the canvas as it is now in `window[name]`.
const KEEP: &str = "(async name => {
    const globe = document.getElementById('globe');
    const image = new Image();
    image.src = globe.toDataURL();
    await image.decode();
    const copy = new OffscreenCanvas(globe.width, globe.height).getContext('2d');
    copy.drawImage(image, 0, 0);
    window[name] = copy.getImageData(0, 0, globe.width, globe.height);
    return [globe.width, globe.height];
})";

/// For each pixel whether two kept pictures differ.
const DIFFERENCE: &str = "(() => {
    const [a, b] = [before.data, after.data];
    let differs = '';
    for (let i = 0; i < a.length; i += 4) {
        const most = Math.max(Math.abs(a[i] - b[i]), Math.abs(a[i + 1] - b[i + 1]), Math.abs(a[i + 2] - b[i + 2]));
        differs += most > 3 ? '1' : '0';
    }
    return differs;
})()";

fn open(adapter: Adapter, query: &str) -> (Server, Browser) {
    let server = Server::start(PAGE);
    let mut browser = Browser::open(adapter);
    let url = format!("http://127.0.0.1:{}/{query}", server.port);
    browser.call("Page.navigate", json!({ "url": url }));
    (server, browser)
}

fn keep(browser: &mut Browser, name: &str) -> UVec2 {
    let size = browser.evaluate(&format!("{KEEP}('{name}')"));
    let side = |index: usize| size[index].as_u64().unwrap() as u32;
    UVec2::new(side(0), side(1))
}

/// Compares where countries are drawn with where they are, beside the panels.
fn compare(differs: &[u8], size_px: UVec2) -> (usize, usize) {
    let figure = Figure::new(Ellipsoid::WGS84);
    let pose = Pose {
        fov_deg: FOV_DEG,
        ..Pose::nadir(EYE.0, EYE.1, EYE.2)
    };
    let lens = Lens::new(
        &figure,
        &pose,
        size_px,
        DepthRange::ReversedInfinite { near_m: 1.0 },
    );
    let countries = Dataset::Countries50m.countries();
    let regions: Vec<_> = countries
        .into_iter()
        .map(|country| country.region)
        .collect();
    let oracle = Oracle::new(&regions, Ellipsoid::WGS84);
    let mut scratch = Scratch::default();
    let mut is_land = |at_px: DVec2| {
        let distance_m = figure.first_hit(lens.origin_m(at_px), lens.ray(at_px), 0.0);
        let (at, _) = figure.geodetic(lens.point_m(at_px, distance_m.unwrap()));
        !oracle.containing(at, &mut scratch).is_empty()
    };
    let (mut compared, mut wrong) = (0, 0);
    for y in (1..size_px.y - 60).step_by(3) {
        for x in (260..size_px.x - 260).step_by(3) {
            let middle = UVec2::new(x, y).as_dvec2() + 0.5;
            let land = is_land(middle);
            let mut around = (0..16).map(|k| {
                let radius_px = BAND_PX * [1.0, 0.5][k / 8];
                middle + DVec2::from_angle(FRAC_PI_4 * k as f64) * radius_px
            });
            if around.any(|at_px| is_land(at_px) != land) {
                continue;
            }
            compared += 1;
            wrong += usize::from((differs[(y * size_px.x + x) as usize] == b'1') != land);
        }
    }
    (compared, wrong)
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn a_person_looks_around() {
    let start = Instant::now();
    let (_server, mut browser) = open(Adapter::Software, "?log&camera=10.4,51.2,900000");
    browser.wait_for_line(&["errors=0"]);
    println!("first picture after {:.1} s", start.elapsed().as_secs_f64());
    browser.wait_for_line(&["loading=0", "shown=2"]);
    println!("all loaded after {:.1} s", start.elapsed().as_secs_f64());

    browser.click(640.0, 330.0);
    browser.wait_for_line(&["picked=Germany", "upload=0"]);
    // The sea: nothing stays highlighted.
    browser.click(330.0, 60.0);
    browser.wait_for_line(&["picked=-"]);

    browser.click(LABELS.0, LABELS.1);
    browser.click(ZONES.0, ZONES.1);
    browser.wait_for_line(&["shown=1"]);
    browser.mouse("mouseMoved", 300.0, 20.0, json!({}));
    browser.frames(4);
    keep(&mut browser, "before");
    browser.click(COUNTRIES.0, COUNTRIES.1);
    browser.wait_for_line(&["shown=0"]);
    browser.frames(4);
    let size_px = keep(&mut browser, "after");
    let differs = browser.evaluate(DIFFERENCE);
    let (compared, wrong) = compare(differs.as_str().unwrap().as_bytes(), size_px);
    println!("{compared} pixels of {size_px} compared, {wrong} wrong");
    assert!(compared > 10_000);
    assert_eq!(wrong, 0);

    browser.mouse("mouseMoved", 900.0, 500.0, json!({}));
    browser.mouse(
        "mouseWheel",
        900.0,
        500.0,
        json!({ "deltaX": 0, "deltaY": -480 }),
    );
    // Eight steps of e^(1/4).
    browser.wait_for_line(&["distance_m=121801.8"]);

    browser.click(SATELLITES.0, SATELLITES.1);
    browser.wait_for_line(&["sensors=60"]);
    assert_eq!(browser.complaints, [""; 0]);
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn coverage_is_switched_on() {
    let (_server, mut browser) = open(Adapter::Software, "?log&camera=10,50,2e7&satellites");
    browser.wait_for_line(&["loading=0", "sensors=60", "coverage=false"]);
    browser.click(26.0, 394.0);
    browser.wait_for_line(&["coverage=true"]);
    assert_eq!(browser.complaints, [""; 0]);
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn files_good_and_bad_are_opened_and_a_picture_is_downloaded() {
    let (_server, mut browser) = open(Adapter::Software, "?log&camera=10.4,51.2,900000");
    browser.wait_for_line(&["loading=0", "shown=2"]);
    browser.click(SCREENSHOT.0, SCREENSHOT.1);
    let file = browser.downloads().join("globefill.png");
    let until = Instant::now() + Duration::from_secs(20);
    while !file.exists() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(100));
    }
    let picture = image::open(&file).unwrap();
    assert_eq!(
        json!([picture.width(), picture.height()]),
        browser.evaluate("[globe.width, globe.height]")
    );

    let bad = browser.downloads().with_file_name("bad.geojson");
    std::fs::write(&bad, "{ not json").unwrap();
    choose(&mut browser, &bad.to_string_lossy());
    browser.wait_for_line(&["errors=1", "loading=0", "shown=2"]);
    let good = Path::new(PAGE)
        .join("zones.geojson")
        .canonicalize()
        .unwrap();
    choose(&mut browser, &good.to_string_lossy());
    browser.wait_for_line(&["errors=1", "loading=0", "shown=3"]);
    assert_eq!(browser.complaints, [""; 0]);
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn a_dropped_file_is_opened_and_closed() {
    let (_server, mut browser) = open(Adapter::Software, "?log&camera=10.4,51.2,900000");
    browser.wait_for_line(&["loading=0", "shown=2"]);
    let file = Path::new(PAGE)
        .join("zones.geojson")
        .canonicalize()
        .unwrap();
    let data = json!({ "items": [], "files": [file], "dragOperationsMask": 1 });
    for kind in ["dragEnter", "dragOver", "drop"] {
        let params = json!({ "type": kind, "x": 640, "y": 400, "data": data });
        browser.call("Input.dispatchDragEvent", params);
    }
    browser.wait_for_line(&["loading=0", "errors=0", "shown=3"]);
    browser.click(CLOSE_FILE.0, CLOSE_FILE.1);
    browser.wait_for_line(&["layers=2"]);
    assert_eq!(browser.complaints, [""; 0]);
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn fingers_tap_and_stretch() {
    let (_server, mut browser) = open(Adapter::Software, "?log&camera=10.4,51.2,900000");
    browser.wait_for_line(&["loading=0", "shown=2"]);
    let touch = |browser: &mut Browser, kind: &str, at: &[(f64, f64)]| {
        let points = (0..).zip(at);
        let points = points.map(|(id, (x, y))| json!({ "id": id, "x": x, "y": y }));
        let points: Vec<_> = points.collect();
        let params = json!({ "type": kind, "touchPoints": points });
        browser.call("Input.dispatchTouchEvent", params);
    };
    touch(&mut browser, "touchStart", &[(640.0, 330.0)]);
    touch(&mut browser, "touchEnd", &[]);
    browser.wait_for_line(&["picked=Germany"]);
    // Apart to four times as far: four times as near.
    touch(&mut browser, "touchStart", &[(615.0, 400.0)]);
    touch(
        &mut browser,
        "touchStart",
        &[(615.0, 400.0), (665.0, 400.0)],
    );
    for apart_px in [40.0, 60.0, 80.0, 100.0] {
        let at = [(640.0 - apart_px, 400.0), (640.0 + apart_px, 400.0)];
        touch(&mut browser, "touchMove", &at);
    }
    touch(&mut browser, "touchEnd", &[]);
    browser.wait_for_line(&["distance_m=225000.0", "picked=Germany"]);
    assert_eq!(browser.complaints, [""; 0]);
}

/// Answers the viewer's file dialog.
fn choose(browser: &mut Browser, file: &str) {
    browser.click(OPEN_FILE.0, OPEN_FILE.1);
    let input = browser.wait("a file dialog", |message| {
        let opened = message["method"] == "Page.fileChooserOpened";
        opened.then(|| message["params"]["backendNodeId"].clone())
    });
    let params = json!({ "files": [file], "backendNodeId": input });
    browser.call("DOM.setFileInputFiles", params);
}

#[test]
#[ignore = "needs the built page and Chromium: scripts/web-test"]
fn without_webgpu_the_page_says_so() {
    let (_server, mut browser) = open(Adapter::None, "");
    let until = Instant::now() + Duration::from_secs(20);
    let mut told = String::new();
    while !told.contains("WebGPU") && Instant::now() < until {
        browser.frames(5);
        let text = browser.evaluate("document.getElementById('message')?.textContent ?? ''");
        told = text.as_str().unwrap_or_default().to_owned();
    }
    assert!(told.starts_with("This page draws with WebGPU"), "{told:?}");
}
