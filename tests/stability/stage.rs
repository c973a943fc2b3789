//! Renderers that are kept from one subject to the next: a mesh is put in, painted by number, taken out.

use std::collections::HashMap;

use globefill::{CountTechnique, FillStyle, MeshId, Renderer, RendererOptions, View, wgpu};

use crate::{
    common::{
        draw::{COLOR, Picture, id_color, id_of_color, paint},
        headless::Gpu,
        surface::Surface,
    },
    subject::Subject,
};

pub const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];

/// A renderer, what it was made with, and the mesh that is in it.
struct Painter {
    options: RendererOptions,
    renderer: Renderer,
    mesh: Option<MeshId>,
}

pub struct Stage<'a> {
    gpu: &'a Gpu,
    painters: HashMap<(usize, globefill::DepthConvention), Painter>,
}

impl<'a> Stage<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        Self {
            gpu,
            painters: HashMap::new(),
        }
    }

    /// The next subject comes.
    pub fn clear(&mut self) {
        for painter in self.painters.values_mut() {
            if let Some(mesh) = painter.mesh.take() {
                painter.renderer.remove(mesh).expect("it was inserted");
            }
        }
    }

    /// A picture of the subject that is on stage, counted by a technique of [`TECHNIQUES`].
    pub fn draw(&mut self, subject: &Subject, surface: &Surface, technique: usize) -> Picture {
        let depth = surface.range.convention();
        let painter = self
            .painters
            .entry((technique, depth))
            .or_insert_with(|| Painter::new(self.gpu, TECHNIQUES[technique], depth));
        painter.show(subject);
        let Painter {
            options, renderer, ..
        } = painter;
        let view = &mut View::default();
        let painted = paint(self.gpu, renderer, options, view, surface, 0.0);
        Picture {
            ids: painted.texels.into_iter().map(id_of_color).collect(),
            stats: painted.stats,
        }
    }
}

impl Painter {
    fn new(gpu: &Gpu, count: CountTechnique, depth: globefill::DepthConvention) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: wgpu::TextureFormat::Depth32Float,
            depth,
            count,
            ..Default::default()
        };
        Self {
            options,
            renderer: Renderer::new(&gpu.device, options).expect("the options are sound"),
            mesh: None,
        }
    }

    fn show(&mut self, subject: &Subject) {
        if self.mesh.is_some() {
            return;
        }
        let mesh = self.renderer.insert(subject.mesh.clone());
        for fill in 0..subject.mesh.fills.len() as u32 {
            let style = FillStyle {
                color: id_color(fill + 1),
                ..Default::default()
            };
            let set = self.renderer.set_style(mesh, fill, style);
            set.expect("the fill exists");
        }
        self.mesh = Some(mesh);
    }
}
