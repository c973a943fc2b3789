//! Render pipelines, compiled when a frame first needs them.

use std::collections::HashMap;

use crate::{
    frame::code::{CodeShape, MAX_PLANES},
    gpu::fixed_function::{
        ADD, COPY_FORMAT, STENCIL_FORMAT, copy_format, counting_stencil, depth_stencil, painting,
        rejecting,
    },
    gpu::planes::Planes,
    gpu::projection::{FAR_PLANE_FEATURES, Projection},
    gpu::recipe::Recipe,
    options::{DepthConvention, RendererOptions},
    shaders,
};

/// What is drawn: each input kind has its own vertex entry point and topology.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Input {
    /// Cap-only inputs of one piece a draw, indexed.
    Caps,
    /// Cap-only inputs of many pieces, indexed.
    MixedCaps,
    /// Degenerate wall inputs, a strip over boundary slots.
    Walls,
    /// Refined walls, indexed.
    Patches,
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
    /// Copies the host's depth, beside the stencil where it counts.
    CopyDepth { logarithmic: bool, stencil: bool },
    /// Colours the host's target.
    Resolve(ResolveKey),
    /// The same from the weights of a mixture.
    ResolveMixture,
}

/// What a pipeline that resolves plain colours is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ResolveKey {
    pub code: CodeShape,
    /// Whether colours are read packed.
    pub few: bool,
}

/// Where resolving binds the first plane of sums.
pub(crate) const FIRST_PLANE: u32 = 3;

/// Layouts, shader modules and the pipelines made so far.
pub(crate) struct Pipelines {
    options: RendererOptions,
    pub frame_layout: wgpu::BindGroupLayout,
    pub mesh_layout: wgpu::BindGroupLayout,
    pub resolve_layout: wgpu::BindGroupLayout,
    pub mixture_layout: wgpu::BindGroupLayout,
    depth_layout: wgpu::BindGroupLayout,
    /// The same with the host's logarithm.
    log_depth_layout: wgpu::BindGroupLayout,
    resolve_shader: wgpu::ShaderModule,
    mixture_shader: wgpu::ShaderModule,
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
        let planes = (FIRST_PLANE..).zip(vec![float; plane_textures]);
        let of_ids = (0..).zip([uniform, uniform, storage]).chain(planes.clone());
        let of_mixture = std::iter::once((0, uniform)).chain(planes);
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        Self {
            options,
            frame_layout: layout(device, "globefill frame", vertex | fragment, &[uniform]),
            mesh_layout: layout(device, "globefill mesh", vertex, &[storage; 4]),
            // Picking binds what resolving does.
            resolve_layout: layout_at(
                device,
                "globefill resolve",
                vertex | fragment | wgpu::ShaderStages::COMPUTE,
                of_ids,
            ),
            mixture_layout: layout_at(device, "globefill mixture", vertex | fragment, of_mixture),
            depth_layout: layout(
                device,
                "globefill depth",
                fragment,
                &[texture(wgpu::TextureSampleType::Depth)],
            ),
            log_depth_layout: layout(
                device,
                "globefill logarithmic depth",
                fragment,
                &[texture(wgpu::TextureSampleType::Depth), uniform],
            ),
            resolve_shader: shader(
                device,
                "globefill resolve",
                shaders::resolve(options.sample_count),
            ),
            mixture_shader: shader(
                device,
                "globefill mixture",
                shaders::resolve_mixture(options.sample_count),
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
                recipe.constants.extend(planes.constants());
                recipe.fragment = Some(self.planes_entry("fs_count"));
                recipe.targets = self.targets(planes, Some(ADD), wgpu::ColorWrites::ALL);
                let format = match projection {
                    Projection::Logarithmic => COPY_FORMAT,
                    _ => self.options.depth_format,
                };
                recipe.depth_stencil = Some(depth_stencil(
                    format,
                    self.behind(projection),
                    wgpu::StencilState::default(),
                ));
                recipe.build(device, self.options.sample_count)
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
                    self.behind(projection),
                    counting_stencil(flipped),
                ));
                recipe.build(device, self.options.sample_count)
            }
            Key::Cover {
                input,
                planes,
                projection,
            } => {
                let mut recipe = self.cover_recipe(input, planes, projection);
                recipe.fragment = Some(self.planes_entry("fs_cover"));
                recipe.depth_stencil = Some(painting());
                recipe.build(device, self.options.sample_count)
            }
            Key::Reject {
                input,
                planes,
                projection,
            } => {
                let mut recipe = self.cover_recipe(input, planes, projection);
                recipe.fragment = Some(self.planes_entry("fs_reject"));
                if planes.weights {
                    // Nothing is added to a mixture there; only the stencil is cleared.
                    recipe.targets = self.targets(planes, None, wgpu::ColorWrites::empty());
                }
                recipe.depth_stencil = Some(rejecting(!planes.weights));
                recipe.build(device, self.options.sample_count)
            }
            Key::CopyDepth {
                logarithmic,
                stencil,
            } => {
                let source = shaders::copy_depth(self.options.sample_count, logarithmic);
                let module = shader(device, "globefill copy depth", source);
                let mut recipe = self.screen_recipe(&module, self.copied_layout(logarithmic));
                recipe.fragment = Some("fs_copy_depth".to_owned());
                let mut state = depth_stencil(
                    copy_format(stencil),
                    wgpu::CompareFunction::Always,
                    wgpu::StencilState::default(),
                );
                state.depth_write_enabled = Some(true);
                recipe.depth_stencil = Some(state);
                recipe.build(device, self.options.sample_count)
            }
            Key::Resolve(ResolveKey { code, few }) => {
                let layout = &self.resolve_layout;
                let mut recipe = self.window_recipe(&self.resolve_shader, layout, "resolve");
                recipe.constants = code.constants().to_vec();
                recipe.constants.push(("FEW", u8::from(few).into()));
                recipe.build(device, self.options.sample_count)
            }
            Key::ResolveMixture => {
                let layout = &self.mixture_layout;
                let mut recipe = self.window_recipe(&self.mixture_shader, layout, "mixture");
                recipe.vertex = "vs_mixture";
                recipe.build(device, self.options.sample_count)
            }
        }
    }

    /// What the copy of the host's depth binds.
    pub(crate) fn copied_layout(&self, logarithmic: bool) -> &wgpu::BindGroupLayout {
        if logarithmic {
            &self.log_depth_layout
        } else {
            &self.depth_layout
        }
    }

    /// Passes what lies behind the scene's surface.
    fn behind(&self, projection: Projection) -> wgpu::CompareFunction {
        match self.options.depth {
            _ if projection == Projection::Logarithmic => wgpu::CompareFunction::Less,
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
                    _ => wgpu::PrimitiveTopology::TriangleList,
                },
                unclipped_depth: projection.unclipped(),
                ..Default::default()
            },
            depth_stencil: None,
        }
    }

    fn cover_recipe(&self, input: Input, planes: Planes, projection: Projection) -> Recipe<'_> {
        let mut recipe = self.volume_recipe(input, cover_entry(input), projection);
        recipe.constants.extend(planes.constants());
        let blend = planes.weights.then_some(ADD);
        recipe.targets = self.targets(planes, blend, wgpu::ColorWrites::ALL);
        recipe
    }

    /// Blends what `fs_NAME` makes of a window over the host's target.
    fn window_recipe<'a>(
        &self,
        module: &'a wgpu::ShaderModule,
        layout: &'a wgpu::BindGroupLayout,
        name: &str,
    ) -> Recipe<'a> {
        let mut recipe = self.screen_recipe(module, layout);
        recipe.vertex = "vs_resolve";
        recipe.primitive.topology = wgpu::PrimitiveTopology::TriangleStrip;
        let sampled = if self.options.sample_count > 1 {
            "_sample"
        } else {
            ""
        };
        recipe.fragment = Some(format!("fs_{name}{sampled}"));
        recipe.targets = vec![Some(wgpu::ColorTargetState {
            format: self.options.color_format,
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        })];
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
}

fn vertex_entry(input: Input) -> &'static str {
    match input {
        Input::Caps => "vs_cap",
        Input::MixedCaps => "vs_caps",
        Input::Walls => "vs_wall",
        Input::Patches => "vs_patch",
    }
}

fn cover_entry(input: Input) -> &'static str {
    match input {
        Input::Caps => "vs_cap",
        Input::MixedCaps => "vs_caps",
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

/// A layout of bindings from 0 on.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    visibility: wgpu::ShaderStages,
    bindings: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    layout_at(
        device,
        label,
        visibility,
        (0..).zip(bindings.iter().copied()),
    )
}

fn layout_at(
    device: &wgpu::Device,
    label: &str,
    visibility: wgpu::ShaderStages,
    bindings: impl Iterator<Item = (u32, wgpu::BindingType)>,
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = bindings
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
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
