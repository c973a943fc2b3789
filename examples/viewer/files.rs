//! GeoJSON files: read and meshed on threads of their own.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, Sender, channel},
    thread,
};

use globefill::{
    FillMesh, FillStyle, MeshId, MeshOptions, Region, Renderer, geo_json::regions_from_geojson,
};

use crate::host::palette;

/// A file that is shown.
pub struct OpenFile {
    pub name: String,
    pub shown: bool,
    pub fills: usize,
    /// What was repaired in it.
    pub repairs: usize,
    colors: Vec<[f32; 4]>,
    mesh: MeshId,
    last: Option<bool>,
}

/// The files, and what went wrong with others.
pub struct Files {
    pub open: Vec<OpenFile>,
    /// Names of files that are being read.
    pub loading: Vec<String>,
    pub errors: Vec<String>,
    sender: Sender<Loaded>,
    receiver: Receiver<Loaded>,
}

struct Loaded {
    name: String,
    mesh: Result<FillMesh, String>,
}

impl Default for Files {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self {
            open: Vec::new(),
            loading: Vec::new(),
            errors: Vec::new(),
            sender,
            receiver,
        }
    }
}

impl Files {
    /// Starts reading a file; `wake` is called when it is done.
    pub fn load(&mut self, path: &Path, wake: impl FnOnce() + Send + 'static) {
        let path: PathBuf = path.to_owned();
        let name = path.file_name().unwrap_or(path.as_os_str());
        let name = name.to_string_lossy().into_owned();
        self.loading.push(name.clone());
        let sender = self.sender.clone();
        thread::spawn(move || {
            let mesh = mesh_of(&path);
            // Nobody waits any more once the viewer has closed.
            let _ = sender.send(Loaded { name, mesh });
            wake();
        });
    }

    /// Takes what has been read.
    pub fn receive(&mut self, renderer: &mut Renderer) {
        while let Ok(Loaded { name, mesh }) = self.receiver.try_recv() {
            if let Some(index) = self.loading.iter().position(|it| *it == name) {
                self.loading.remove(index);
            }
            match mesh {
                Ok(mesh) => self.open.push(OpenFile {
                    name,
                    shown: true,
                    fills: mesh.fills.len(),
                    repairs: mesh.repairs.len(),
                    colors: palette::colors(&mesh),
                    mesh: renderer.insert(mesh),
                    last: None,
                }),
                Err(error) => self.errors.push(format!("{name}: {error}")),
            }
        }
    }

    /// Forgets a file.
    pub fn close(&mut self, index: usize, renderer: &mut Renderer) -> Result<(), String> {
        let file = self.open.remove(index);
        renderer
            .remove(file.mesh)
            .map_err(|error| error.to_string())
    }

    /// Gives the renderer what changed.
    pub fn restyle(&mut self, renderer: &mut Renderer) -> Result<(), String> {
        for file in &mut self.open {
            if file.last.replace(file.shown) == Some(file.shown) {
                continue;
            }
            for (fill, &color) in (0..).zip(&file.colors) {
                let style = FillStyle {
                    color,
                    visible: file.shown,
                    z_index: 2,
                    ..Default::default()
                };
                renderer
                    .set_style(file.mesh, fill, style)
                    .map_err(|error| error.to_string())?;
            }
        }
        Ok(())
    }
}

fn mesh_of(path: &Path) -> Result<FillMesh, String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    let named = regions_from_geojson(&text).map_err(|error| error.to_string())?;
    let regions: Vec<Region> = named.into_iter().map(|it| it.region).collect();
    FillMesh::build(&regions, &MeshOptions::default()).map_err(|error| error.to_string())
}
