//! What a browser does in its own way: one thread, promises, downloads, a page around the canvas.

use std::{
    future::Future,
    path::{Path, PathBuf},
    rc::Rc,
};

use glam::UVec2;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{
    Blob, Document, DragEvent, File, HtmlAnchorElement, HtmlCanvasElement, HtmlInputElement,
    Response, Url,
};
use winit::{
    application::ApplicationHandler,
    event_loop::EventLoop,
    platform::web::{EventLoopExtWebSys, WindowAttributesExtWebSys},
    window::{Window, WindowAttributes},
};

use crate::{
    graphics::Graphics,
    host::elevation::{Elevation, Grid, Placement},
};

/// The page's canvas.
const CANVAS: &str = "globe";
/// The page's element for what went wrong.
const MESSAGE: &str = "message";

/// Hands events to an application as long as the page is open.
pub fn run_app<T>(
    events: EventLoop<T>,
    app: impl ApplicationHandler<T> + 'static,
) -> Result<(), String> {
    std::panic::set_hook(Box::new(|panic| {
        web_sys::console::error_1(&panic.to_string().into());
        tell("The viewer has crashed; the console says where.");
    }));
    events.spawn_app(app);
    Ok(())
}

/// The page's canvas, which the page sizes.
pub fn window(_size_px: UVec2) -> Result<WindowAttributes, String> {
    Ok(Window::default_attributes()
        .with_canvas(Some(canvas()?))
        // The page itself keeps what belongs to the globe from the browser, and leaves it its keys.
        .with_prevent_default(false))
}

pub fn run(future: impl Future<Output = ()> + 'static) {
    spawn_local(future);
}

/// Works when the next frame has been shown: there is one thread, and a person wants to see what is going on.
pub fn spawn(job: impl FnOnce() + 'static) {
    let Some(window) = web_sys::window() else {
        return;
    };
    let shown = Closure::once_into_js(move || {
        if let Some(window) = web_sys::window() {
            let job = Closure::once_into_js(job);
            let _ = window.set_timeout_with_callback(job.unchecked_ref());
        }
    });
    let _ = window.request_animation_frame(shown.unchecked_ref());
}

/// Asks for a GeoJSON file, and hands on its name and text, or what went wrong; nothing if nothing is chosen.
pub fn ask_file(then: impl FnOnce(String, Result<String, String>) + 'static) {
    let Some(input) = document()
        .ok()
        .and_then(|document| document.create_element("input").ok())
        .and_then(|element| element.dyn_into::<HtmlInputElement>().ok())
    else {
        return;
    };
    input.set_type("file");
    input.set_accept(".geojson,.json,application/geo+json");
    let asked = input.clone();
    let chosen = Closure::once_into_js(move || {
        if let Some(file) = asked.files().and_then(|files| files.get(0)) {
            read_blob(file, then);
        }
    });
    input.set_onchange(Some(chosen.unchecked_ref()));
    input.click();
}

/// Fetches a file that lies beside the page.
pub fn read_file(path: PathBuf, then: impl FnOnce(String, Result<String, String>) + 'static) {
    spawn_local(async move {
        let url = path.to_string_lossy().into_owned();
        let text = fetch(&url).await;
        let text = text
            .and_then(|bytes| String::from_utf8(bytes).map_err(|error| format!("{url}: {error}")));
        then(name(&path), text);
    });
}

/// Hands on the files that are dropped on the page, and whether one is held over it.
pub fn watch_drops(
    dropped: impl Fn(String, Result<String, String>) + 'static,
    hovers: impl Fn(bool) + 'static,
) {
    let Ok(document) = document() else {
        return;
    };
    let (dropped, hovers) = (Rc::new(dropped), Rc::new(hovers));
    for kind in ["dragover", "dragleave", "drop"] {
        let (dropped, hovers) = (dropped.clone(), hovers.clone());
        let listener = Closure::<dyn Fn(DragEvent)>::new(move |event: DragEvent| {
            event.prevent_default();
            hovers(event.type_() == "dragover");
            let files = event.data_transfer().and_then(|transfer| transfer.files());
            if let Some(files) = files.filter(|_| event.type_() == "drop") {
                for file in (0..files.length()).filter_map(|index| files.get(index)) {
                    let dropped = dropped.clone();
                    read_blob(file, move |name, text| dropped(name, text));
                }
            }
        });
        let _ = document.add_event_listener_with_callback(kind, listener.as_ref().unchecked_ref());
        // The page listens as long as it is open.
        listener.forget();
    }
}

pub fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// What was drawn last, as PNG: the browser keeps the canvas.
pub fn picture(_graphics: &Graphics, then: impl FnOnce(Result<Vec<u8>, String>) + 'static) {
    let encoded = Closure::once_into_js(move |blob: Option<Blob>| {
        spawn_local(async move {
            let bytes = match blob {
                Some(blob) => bytes(blob.array_buffer()).await,
                None => Err("the canvas is empty".to_owned()),
            };
            then(bytes);
        });
    });
    // A canvas that is there and of one's own cannot refuse.
    let _ = canvas().map(|canvas| canvas.to_blob(encoded.unchecked_ref()));
}

/// Downloads a picture.
pub fn save(file: &str, bytes: &[u8]) -> Result<String, String> {
    let parts = Array::of1(&Uint8Array::from(bytes));
    let blob = Blob::new_with_u8_array_sequence(&parts).map_err(|error| told(&error))?;
    let url = Url::create_object_url_with_blob(&blob).map_err(|error| told(&error))?;
    let link = document()?
        .create_element("a")
        .map_err(|error| told(&error))?
        .dyn_into::<HtmlAnchorElement>()
        .map_err(|_| "the browser makes no links")?;
    link.set_href(&url);
    link.set_download(file);
    link.click();
    Url::revoke_object_url(&url).map_err(|error| told(&error))?;
    Ok(format!("Downloaded {file}"))
}

/// The world's terrain, which lies beside the page.
pub fn elevation(then: impl FnOnce(Result<Elevation, String>) + 'static) {
    spawn_local(async move {
        let read = async {
            let placement = fetch("terrain-world.json").await?;
            let grid = Grid::decode(&fetch("terrain-world.png").await?)?;
            Elevation::new(grid, &Placement::parse(&placement)?)
        };
        then(read.await);
    });
}

/// The query of the page's address as flags: `?camera=10,51,9e5&terrain` is `--camera 10,51,9e5 --terrain`,
/// and `open=FILE` is a file beside the page.
pub fn arguments() -> Vec<String> {
    let Some(query) = query() else {
        return Vec::new();
    };
    let pairs = query.split('&').filter(|pair| !pair.is_empty());
    pairs
        .flat_map(|pair| match pair.split_once('=') {
            _ if pair == LOG => Vec::new(),
            Some(("open", file)) => vec![file.to_owned()],
            Some((flag, value)) => vec![format!("--{flag}"), value.to_owned()],
            None => vec![format!("--{pair}")],
        })
        .collect()
}

/// Says why the viewer cannot go on.
pub fn give_up(error: &str) {
    web_sys::console::error_1(&error.into());
    tell(error);
}

/// The query's word that asks for the log.
const LOG: &str = "log";

/// A line on the console for whoever drives the viewer from outside, with `?log`.
pub fn log(line: impl FnOnce() -> String) {
    if query().is_some_and(|query| query.split('&').any(|pair| pair == LOG)) {
        web_sys::console::log_1(&line().into());
    }
}

fn query() -> Option<String> {
    let search = web_sys::window()?.location().search().ok()?;
    let plain = js_sys::decode_uri_component(search.strip_prefix('?')?).ok()?;
    Some(plain.into())
}

fn document() -> Result<Document, String> {
    web_sys::window()
        .and_then(|window| window.document())
        .ok_or_else(|| "there is no page".to_owned())
}

fn canvas() -> Result<HtmlCanvasElement, String> {
    document()?
        .get_element_by_id(CANVAS)
        .and_then(|element| element.dyn_into().ok())
        .ok_or_else(|| "the page has no canvas".to_owned())
}

/// Shows a text instead of the globe.
fn tell(text: &str) {
    if let Some(element) = document().ok().and_then(|it| it.get_element_by_id(MESSAGE)) {
        element.set_text_content(Some(text));
    }
}

async fn fetch(url: &str) -> Result<Vec<u8>, String> {
    let named = |error: JsValue| format!("{url}: {}", told(&error));
    let window = web_sys::window().ok_or("there is no page")?;
    let response = JsFuture::from(window.fetch_with_str(url))
        .await
        .map_err(named)?;
    let response: Response = response.dyn_into().map_err(named)?;
    if !response.ok() {
        return Err(format!(
            "{url}: {} {}",
            response.status(),
            response.status_text()
        ));
    }
    let buffer = response.array_buffer().map_err(named)?;
    bytes(buffer)
        .await
        .map_err(|error| format!("{url}: {error}"))
}

async fn bytes(buffer: js_sys::Promise) -> Result<Vec<u8>, String> {
    let buffer = JsFuture::from(buffer).await.map_err(|error| told(&error))?;
    Ok(Uint8Array::new(&buffer).to_vec())
}

fn read_blob(file: File, then: impl FnOnce(String, Result<String, String>) + 'static) {
    spawn_local(async move {
        let name = file.name();
        let text = JsFuture::from(file.text()).await;
        let text = text
            .map_err(|error| format!("{name}: {}", told(&error)))
            .map(|text| text.as_string().unwrap_or_default());
        then(name, text);
    });
}

fn told(error: &JsValue) -> String {
    error
        .dyn_ref::<js_sys::Error>()
        .map_or_else(|| format!("{error:?}"), |error| error.message().into())
}
