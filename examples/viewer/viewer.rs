//! The viewer's state, without window or GPU: what is shown, and what input does to it.

use glam::{DVec2, UVec2};
use globefill::{FrameStats, LonLat, MeshId, Renderer};
use web_time::Instant;

use crate::{
    layers::{fill_layer::FillLayer, satellites::Satellites},
    orbit::Orbit,
    touches::Touches,
};

/// Farther than this from where the button went down is a drag, not a click.
const CLICK_PX: f64 = 4.0;
/// A pointer that rested so long before the button went up does not set the globe spinning.
const REST_S: f64 = 0.08;
const TURN_DEG_PER_PX: f64 = 0.25;
const KEY_STEP_PX: f64 = 60.0;

/// A fill of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hit {
    pub layer: usize,
    pub fill: u32,
}

/// What only the host of the viewer can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    OpenFile,
    Screenshot,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Drags the ground.
    Grab,
    /// Turns and tilts.
    Tilt,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    Left,
    Right,
    Up,
    Down,
    Nearer,
    Farther,
    NorthUp,
    Home,
    Play,
}

/// Something that is being loaded.
#[derive(Clone, Debug)]
pub struct Loading {
    pub name: String,
    /// What is being done just now.
    pub step: String,
    pub since: Instant,
}

struct Drag {
    button: Button,
    from_px: DVec2,
    /// The ground point that stays under the pointer.
    anchor: Option<LonLat>,
    is_click: bool,
    /// The focus and the time before the last step.
    before: (LonLat, f64),
    last_s: f64,
}

pub struct Viewer {
    pub orbit: Orbit,
    pub layers: Vec<FillLayer>,
    pub satellites: Satellites,
    pub terrain: bool,
    pub has_terrain: bool,
    pub labels: bool,
    pub pixel_error: f64,
    pub hovered: Option<Hit>,
    pub picked: Option<Hit>,
    pub pointer_px: Option<DVec2>,
    pub loading: Vec<Loading>,
    pub errors: Vec<String>,
    pub notice: Option<String>,
    pub dropping: bool,
    pub stats: FrameStats,
    pub frame_ms: f64,
    pub adapter: String,
    pub wishes: Vec<Wish>,
    pub touches: Touches,
    drag: Option<Drag>,
    /// Meshes of closed layers that the renderer still has.
    closed: Vec<MeshId>,
}

impl Viewer {
    pub fn new(size_px: UVec2) -> Self {
        Self {
            orbit: Orbit::new(size_px),
            layers: Vec::new(),
            satellites: Satellites::default(),
            terrain: false,
            has_terrain: false,
            labels: true,
            pixel_error: 0.25,
            hovered: None,
            picked: None,
            pointer_px: None,
            loading: Vec::new(),
            errors: Vec::new(),
            notice: None,
            dropping: false,
            stats: FrameStats::default(),
            frame_ms: 0.0,
            adapter: String::new(),
            wishes: Vec::new(),
            touches: Touches::default(),
            drag: None,
            closed: Vec::new(),
        }
    }

    /// A load has begun, or has come to another step.
    pub fn loads(&mut self, name: &str, step: &str) {
        let step = step.to_owned();
        if let Some(loading) = self.loading.iter_mut().find(|it| it.name == name) {
            loading.step = step;
            return;
        }
        self.loading.push(Loading {
            name: name.to_owned(),
            step,
            since: Instant::now(),
        });
    }

    /// A load has ended, well or badly.
    pub fn ended(&mut self, name: &str) {
        if let Some(index) = self.loading.iter().position(|it| it.name == name) {
            self.loading.remove(index);
        }
    }

    /// A layer has been loaded, or not.
    pub fn loaded(&mut self, name: &str, layer: Result<FillLayer, String>) {
        self.ended(name);
        match layer {
            Ok(layer) => {
                // In the order in which they lie, whichever is ready first.
                let z_index = layer.look.z_index;
                let index = self.layers.partition_point(|it| it.look.z_index <= z_index);
                self.layers.insert(index, layer);
                (self.hovered, self.picked) = (None, None);
            }
            Err(error) => self.errors.push(error),
        }
    }

    /// Takes a layer off the globe.
    pub fn close(&mut self, layer: usize) {
        self.closed.extend(self.layers.remove(layer).mesh_id());
        (self.hovered, self.picked) = (None, None);
    }

    pub fn press(&mut self, button: Button, px: DVec2, now_s: f64) {
        self.orbit.stop();
        self.drag = Some(Drag {
            button,
            from_px: px,
            anchor: self.orbit.ground_at(px),
            is_click: true,
            before: (self.orbit.focus, now_s),
            last_s: now_s,
        });
    }

    pub fn point(&mut self, px: DVec2, now_s: f64) {
        let last_px = self.pointer_px.replace(px).unwrap_or(px);
        let Some(drag) = &mut self.drag else {
            self.hovered = self.hit_at(px);
            return;
        };
        drag.is_click &= px.distance(drag.from_px) <= CLICK_PX;
        if drag.is_click {
            return;
        }
        match drag.button {
            Button::Grab => {
                drag.before = (self.orbit.focus, drag.last_s);
                drag.last_s = now_s;
                match drag.anchor {
                    Some(anchor) => self.orbit.hold(anchor, px),
                    None => self.orbit.pan((px - last_px) * DVec2::new(-1.0, 1.0)),
                }
            }
            Button::Tilt => {
                let deg = (px - last_px) * TURN_DEG_PER_PX;
                self.orbit.turn(deg.x, -deg.y);
            }
        }
    }

    pub fn release(&mut self, now_s: f64) {
        let Some(drag) = self.drag.take() else {
            return;
        };
        if drag.is_click {
            if drag.button == Button::Grab {
                self.picked = self.hit_at(drag.from_px);
            }
        } else if drag.button == Button::Grab && now_s - drag.last_s < REST_S {
            let (focus, before_s) = drag.before;
            self.orbit.let_go(focus, drag.last_s - before_s);
        }
    }

    /// Ends a drag where it is.
    pub fn cancel_drag(&mut self) {
        self.drag = None;
    }

    /// What is held is dragged, wherever it is let go.
    pub fn no_click(&mut self) {
        if let Some(drag) = &mut self.drag {
            drag.is_click = false;
        }
    }

    /// The pointer has left the globe for the panel or out of the window.
    pub fn leave(&mut self) {
        self.hovered = None;
        self.pointer_px = None;
    }

    /// Steps of a wheel, or of a touch pad's.
    pub fn scroll(&mut self, steps: f64) {
        let middle = self.orbit.size_px.as_dvec2() / 2.0;
        self.orbit.zoom(steps, self.pointer_px.unwrap_or(middle));
    }

    pub fn key(&mut self, key: Key) {
        let orbit = &mut self.orbit;
        let middle = orbit.size_px.as_dvec2() / 2.0;
        match key {
            Key::Left => orbit.pan(DVec2::new(-KEY_STEP_PX, 0.0)),
            Key::Right => orbit.pan(DVec2::new(KEY_STEP_PX, 0.0)),
            Key::Up => orbit.pan(DVec2::new(0.0, KEY_STEP_PX)),
            Key::Down => orbit.pan(DVec2::new(0.0, -KEY_STEP_PX)),
            Key::Nearer => orbit.zoom(1.0, middle),
            Key::Farther => orbit.zoom(-1.0, middle),
            Key::NorthUp => (orbit.heading_deg, orbit.tilt_deg) = (0.0, 0.0),
            Key::Home => *orbit = Orbit::new(orbit.size_px),
            Key::Play => self.satellites.playing ^= true,
        }
    }

    /// The topmost fill under a pixel position: exact, from the true boundaries.
    pub fn hit_at(&self, px: DVec2) -> Option<Hit> {
        let at = self.orbit.ground_at(px)?;
        let hits = self.layers.iter().enumerate().filter_map(|(layer, it)| {
            let fill = it.fill_at(at)?;
            Some((it.look.z_index, Hit { layer, fill }))
        });
        hits.max_by_key(|(z_index, hit)| (*z_index, hit.layer))
            .map(|(_, hit)| hit)
    }

    /// Lets time pass; false if nothing moves.
    pub fn advance(&mut self, seconds: f64) -> bool {
        let turns = self.orbit.advance(seconds);
        let flies = self.satellites.advance(seconds);
        turns || flies
    }

    /// Hands the renderer what changed.
    pub fn sync(&mut self, renderer: &mut Renderer) -> Result<(), String> {
        for id in self.closed.drain(..) {
            renderer.remove(id).map_err(|error| error.to_string())?;
        }
        for (index, layer) in self.layers.iter_mut().enumerate() {
            let in_layer =
                |hit: Option<Hit>| hit.filter(|hit| hit.layer == index).map(|hit| hit.fill);
            layer
                .sync(renderer, in_layer(self.hovered), in_layer(self.picked))
                .map_err(|error| format!("{}: {error}", layer.title))?;
        }
        self.satellites
            .sync(renderer.sensors_mut())
            .map_err(|error| error.to_string())
    }

    /// The state on one line, for tests that drive the window.
    pub fn summary(&self) -> String {
        let fact = |hit: Hit| self.layers.get(hit.layer)?.facts.get(hit.fill as usize);
        let picked = self.picked.and_then(fact).map_or("-", |fact| &fact.name);
        format!(
            "loading={} errors={} layers={} shown={} picked={picked} distance_m={:.1} sensors={} coverage={} upload={} .",
            self.loading.len(),
            self.errors.len(),
            self.layers.len(),
            self.layers
                .iter()
                .filter(|layer| layer.look.visible)
                .count(),
            self.orbit.distance_m,
            self.stats.sensors,
            self.satellites.settings.coverage,
            self.stats.upload_bytes,
        )
    }
}
