//! Render pipelines, compiled when a frame first needs them.

use std::collections::HashMap;

use crate::{
    frame::code::MAX_PLANES,
    frame::sight::Sight,
    gpu::fixed_function::{ADD, STENCIL_FORMAT, counting_stencil, depth_stencil, painting},
    gpu::planes::Planes,
    options::{DepthConvention, RendererOptions},
    shaders,
};

/// What it takes to draw into depth with a far plane, which must not clip the volumes.
pub(crate) const FAR_PLANE_FEATURES: wgpu::Features =
    wgpu::Features::DEPTH_CLIP_CONTROL.union(wgpu::Features::CLIP_DISTANCES);

/// What is drawn: each input kind has its own vertex entry point and topology.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Input {
    /// Cap-only inputs, indexed.
    Caps,
    /// Degenerate wall inputs, a strip over boundary slots.
    Walls,
    /// Refined walls, indexed.
    Patches,
}

/// How volumes are projected and clipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Projection {
    /// A perspective without a far plane: clipped at the near plane as usual.
    #[default]
    Infinite,
    /// A perspective with a far plane, which must not clip.
    FarPlane,
    /// Parallel lines of sight, where neither plane need clip.
    Parallel,
}

impl Projection {
    pub(crate) fn of(sight: &Sight) -> Self {
        match (sight.parallel, sight.far_plane) {
            (true, _) => Self::Parallel,
            (false, true) => Self::FarPlane,
            (false, false) => Self::Infinite,
        }
    }

    /// What the device must be able to do.
    pub(crate) fn features(self) -> wgpu::Features {
        match self {
            Self::Infinite => wgpu::Features::empty(),
            Self::FarPlane => FAR_PLANE_FEATURES,
            Self::Parallel => wgpu::Features::DEPTH_CLIP_CONTROL,
        }
    }

    /// The overrides of host.wgsl.
    pub(crate) fn constants(self) -> [(&'static str, f64); 1] {
        parallel_constants(self == Self::Parallel)
    }
}

/// The overrides of host.wgsl.
pub(crate) fn parallel_constants(parallel: bool) -> [(&'static str, f64); 1] {
    [("PARALLEL", f64::from(u8::from(parallel)))]
}

/// Names a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Key {
    /// Adds winding codes.
    Count {
        input: Input,
        planes: Planes,
        projection: Projection,
    },
    /// Counts faces in the stencil and writes no colour, in the same pass as the covers; `flipped`
    /// where the outside is seen clockwise.
    Stencil {
        input: Input,
        planes: Planes,
        flipped: bool,
        projection: Projection,
    },
    /// Paints a code where the stencil counted one, and clears the stencil there.
    Cover {
        input: Input,
        planes: Planes,
        projection: Projection,
    },
    /// Paints what is no code where the stencil counted neither none nor one, and clears it: winding
    /// sums are invalid at such pixels too, and resolve treats both alike.
    Reject {
        input: Input,
        planes: Planes,
        projection: Projection,
    },
    /// Copies the host's depth beside the stencil.
    CopyDepth,
    /// Colours the host's target.
    Resolve,
}

/// Layouts, shader modules and the pipelines made so far.
pub(crate) struct Pipelines {
    options: RendererOptions,
    pub frame_layout: wgpu::BindGroupLayout,
    pub mesh_layout: wgpu::BindGroupLayout,
    pub resolve_layout: wgpu::BindGroupLayout,
    pub depth_layout: wgpu::BindGroupLayout,
    count_shader: wgpu::ShaderModule,
    /// For depth with a far plane, where the device can draw that.
    unclipped_count_shader: Option<wgpu::ShaderModule>,
    made: HashMap<Key, wgpu::RenderPipeline>,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, options: RendererOptions) -> Self {
        let multisampled = options.sample_count > 1;
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled,
        };
        let float = texture(wgpu::TextureSampleType::Float { filterable: false });
        let plane_textures = if multisampled { MAX_PLANES as usize } else { 1 };
        let storage = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let mut resolve_bindings = vec![uniform, storage];
        resolve_bindings.extend(vec![float; plane_textures]);
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        Self {
            options,
            frame_layout: layout(device, "globefill frame", vertex | fragment, &[uniform]),
            mesh_layout: layout(device, "globefill mesh", vertex, &[storage; 4]),
            // Picking binds what resolving does.
            resolve_layout: layout(
                device,
                "globefill resolve",
                fragment | wgpu::ShaderStages::COMPUTE,
                &resolve_bindings,
            ),
            depth_layout: layout(
                device,
                "globefill depth",
                fragment,
                &[texture(wgpu::TextureSampleType::Depth)],
            ),
            count_shader: shader(device, "globefill count", shaders::count(false)),
            unclipped_count_shader: device
                .features()
                .contains(FAR_PLANE_FEATURES)
                .then(|| shader(device, "globefill count unclipped", shaders::count(true))),
            made: HashMap::new(),
        }
    }

    /// Compiles the pipeline if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, key: Key) {
        if !self.made.contains_key(&key) {
            let pipeline = self.make(device, key);
            self.made.insert(key, pipeline);
        }
    }

    /// A pipeline that `ensure` was called for.
    pub(crate) fn get(&self, key: Key) -> &wgpu::RenderPipeline {
        &self.made[&key]
    }

    fn make(&self, device: &wgpu::Device, key: Key) -> wgpu::RenderPipeline {
        match key {
            Key::Count {
                input,
                planes,
                projection,
            } => {
                let mut recipe = self.volume_recipe(input, vertex_entry(input), projection);
                recipe.fragment = Some(self.planes_entry("fs_count"));
                recipe.targets = self.targets(planes, Some(ADD), wgpu::ColorWrites::ALL);
                recipe.depth_stencil = Some(depth_stencil(
                    self.options.depth_format,
                    self.behind(),
                    wgpu::StencilState::default(),
                ));
                self.build(device, &recipe)
            }
            Key::Stencil {
                input,
                planes,
                flipped,
                projection,
            } => {
                let mut recipe = self.volume_recipe(input, vertex_entry(input), projection);
                recipe.fragment = Some(self.planes_entry("fs_count"));
                recipe.targets = self.targets(planes, None, wgpu::ColorWrites::empty());
                recipe.depth_stencil = Some(depth_stencil(
                    STENCIL_FORMAT,
                    self.behind(),
                    counting_stencil(flipped),
                ));
                self.build(device, &recipe)
            }
            Key::Cover {
                input,
                planes,
                projection,
            } => {
                let mut recipe = self.cover_recipe(input, planes, projection);
                recipe.fragment = Some(self.planes_entry("fs_cover"));
                recipe.depth_stencil = Some(painting(wgpu::CompareFunction::Equal));
                self.build(device, &recipe)
            }
            Key::Reject {
                input,
                planes,
                projection,
            } => {
                let mut recipe = self.cover_recipe(input, planes, projection);
                recipe.fragment = Some(self.planes_entry("fs_reject"));
                recipe.depth_stencil = Some(painting(wgpu::CompareFunction::Less));
                self.build(device, &recipe)
            }
            Key::CopyDepth => {
                let source = shaders::copy_depth(self.options.sample_count);
                let module = shader(device, "globefill copy depth", source);
                let mut recipe = self.screen_recipe(&module, &self.depth_layout);
                recipe.fragment = Some("fs_copy_depth".to_owned());
                let mut state = depth_stencil(
                    STENCIL_FORMAT,
                    wgpu::CompareFunction::Always,
                    wgpu::StencilState::default(),
                );
                state.depth_write_enabled = Some(true);
                recipe.depth_stencil = Some(state);
                self.build(device, &recipe)
            }
            Key::Resolve => {
                let source = shaders::resolve(self.options.sample_count);
                let module = shader(device, "globefill resolve", source);
                let mut recipe = self.screen_recipe(&module, &self.resolve_layout);
                let entry = if self.options.sample_count > 1 {
                    "fs_resolve_sample"
                } else {
                    "fs_resolve"
                };
                recipe.fragment = Some(entry.to_owned());
                recipe.targets = vec![Some(wgpu::ColorTargetState {
                    format: self.options.color_format,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })];
                self.build(device, &recipe)
            }
        }
    }

    /// Passes what lies behind the scene's surface.
    fn behind(&self) -> wgpu::CompareFunction {
        match self.options.depth {
            DepthConvention::Reversed => wgpu::CompareFunction::Less,
            DepthConvention::Standard => wgpu::CompareFunction::Greater,
        }
    }

    fn planes_entry(&self, stage: &str) -> String {
        let kind = if self.options.sample_count > 1 {
            "separate"
        } else {
            "packed"
        };
        format!("{stage}_{kind}")
    }

    fn targets(
        &self,
        planes: Planes,
        blend: Option<wgpu::BlendState>,
        write_mask: wgpu::ColorWrites,
    ) -> Vec<Option<wgpu::ColorTargetState>> {
        planes
            .formats(self.options.sample_count)
            .into_iter()
            .map(|format| {
                Some(wgpu::ColorTargetState {
                    format,
                    blend,
                    write_mask,
                })
            })
            .collect()
    }

    fn volume_recipe(
        &self,
        input: Input,
        entry: &'static str,
        projection: Projection,
    ) -> Recipe<'_> {
        Recipe {
            module: match &self.unclipped_count_shader {
                Some(module) if projection == Projection::FarPlane => module,
                _ => &self.count_shader,
            },
            constants: projection.constants().to_vec(),
            layouts: vec![&self.frame_layout, &self.mesh_layout],
            vertex: entry,
            fragment: None,
            targets: Vec::new(),
            primitive: wgpu::PrimitiveState {
                topology: match input {
                    Input::Walls => wgpu::PrimitiveTopology::TriangleStrip,
                    Input::Caps | Input::Patches => wgpu::PrimitiveTopology::TriangleList,
                },
                unclipped_depth: projection != Projection::Infinite,
                ..Default::default()
            },
            depth_stencil: None,
        }
    }

    fn cover_recipe(&self, input: Input, planes: Planes, projection: Projection) -> Recipe<'_> {
        let mut recipe = self.volume_recipe(input, cover_entry(input), projection);
        recipe.targets = self.targets(planes, None, wgpu::ColorWrites::ALL);
        recipe
    }

    fn screen_recipe<'a>(
        &self,
        module: &'a wgpu::ShaderModule,
        layout: &'a wgpu::BindGroupLayout,
    ) -> Recipe<'a> {
        Recipe {
            module,
            constants: Vec::new(),
            layouts: vec![layout],
            vertex: "vs_screen",
            fragment: None,
            targets: Vec::new(),
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
        }
    }

    fn build(&self, device: &wgpu::Device, recipe: &Recipe<'_>) -> wgpu::RenderPipeline {
        let layouts: Vec<_> = recipe.layouts.iter().map(|&layout| Some(layout)).collect();
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: &recipe.constants,
            ..Default::default()
        };
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(recipe.vertex),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(recipe.fragment.as_deref().unwrap_or(recipe.vertex)),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: recipe.module,
                entry_point: Some(recipe.vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: recipe.primitive,
            depth_stencil: recipe.depth_stencil.clone(),
            multisample: wgpu::MultisampleState {
                count: self.options.sample_count,
                ..Default::default()
            },
            fragment: recipe.fragment.as_deref().map(|entry| wgpu::FragmentState {
                module: recipe.module,
                entry_point: Some(entry),
                compilation_options: compilation_options.clone(),
                targets: &recipe.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// What differs between the pipelines.
struct Recipe<'a> {
    module: &'a wgpu::ShaderModule,
    constants: Vec<(&'static str, f64)>,
    layouts: Vec<&'a wgpu::BindGroupLayout>,
    vertex: &'static str,
    fragment: Option<String>,
    targets: Vec<Option<wgpu::ColorTargetState>>,
    primitive: wgpu::PrimitiveState,
    depth_stencil: Option<wgpu::DepthStencilState>,
}

fn vertex_entry(input: Input) -> &'static str {
    match input {
        Input::Caps => "vs_cap",
        Input::Walls => "vs_wall",
        Input::Patches => "vs_patch",
    }
}

fn cover_entry(input: Input) -> &'static str {
    match input {
        Input::Caps => "vs_cap",
        Input::Walls => "vs_wall_cover",
        Input::Patches => "vs_patch_cover",
    }
}

fn shader(device: &wgpu::Device, label: &str, source: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    visibility: wgpu::ShaderStages,
    bindings: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(bindings)
        .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}
