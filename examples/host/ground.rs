//! The ground that the fills lie on: the bare ellipsoid, or terrain.

use globefill::{DepthConvention, Ellipsoid, HeightRange, wgpu, wgpu::util::DeviceExt};

use super::{
    camera::Eye,
    elevation::Elevation,
    globe::{self, Globe},
    gpu::Gpu,
    host_view::{HostView, Specialisation},
    picture::Picture,
    terrain::Terrain,
};

/// What the pipelines of one set of targets must match.
#[derive(Clone, Copy, Debug)]
pub struct TargetFormat {
    pub color: wgpu::TextureFormat,
    pub depth: wgpu::TextureFormat,
    pub convention: DepthConvention,
    pub sample_count: u32,
}

/// The ground as one camera sees it, whatever it is drawn into.
pub struct Ground {
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    host_view: wgpu::Buffer,
    /// Width of the world picture, pixels.
    picture_px: u32,
    specialisation: Specialisation,
    shape: Shape,
}

enum Shape {
    Globe(Globe),
    Terrain(Terrain),
}

/// The ground's pipelines for one set of targets.
pub struct GroundPipelines {
    ground: wgpu::RenderPipeline,
    /// Drawn last, where no ground was.
    sky: wgpu::RenderPipeline,
}

impl Ground {
    pub fn new(
        gpu: &Gpu,
        ellipsoid: &Ellipsoid,
        elevation: Option<&Elevation>,
        eye: &Eye,
    ) -> Result<Self, String> {
        let world = Picture::world()?;
        let layout = shared_layout(&gpu.device);
        let picture_px = world.size_px.x;
        let host_view = HostView::new(ellipsoid, eye, picture_px);
        let uniform = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("host view"),
                contents: bytemuck::bytes_of(&host_view),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("smooth"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let world = world.upload(gpu, "world", wgpu::TextureFormat::Rgba8UnormSrgb);
        let detail = Picture::detail().upload(gpu, "detail", wgpu::TextureFormat::Rgba8Unorm);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("host view"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: uniform.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(&world),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::TextureView(&detail),
                },
                wgpu::BindGroupEntry {
                    binding: 3,
                    resource: wgpu::BindingResource::Sampler(&sampler),
                },
            ],
        });
        let shape = match elevation {
            Some(elevation) => Shape::Terrain(Terrain::new(gpu, ellipsoid, elevation, eye)),
            None => Shape::Globe(Globe::new(ellipsoid, eye)),
        };
        Ok(Self {
            layout,
            group,
            host_view: uniform,
            picture_px,
            specialisation: host_view.specialisation(),
            shape,
        })
    }

    /// The bare globe seen by another camera, not far from the first.
    pub fn look(&mut self, gpu: &Gpu, ellipsoid: &Ellipsoid, eye: &Eye) {
        let host_view = HostView::new(ellipsoid, eye, self.picture_px);
        gpu.queue
            .write_buffer(&self.host_view, 0, bytemuck::bytes_of(&host_view));
        self.specialisation = host_view.specialisation();
        if let Shape::Globe(globe) = &mut self.shape {
            *globe = Globe::new(ellipsoid, eye);
        }
    }

    /// The same terrain seen by another camera.
    pub fn look_over(
        &mut self,
        gpu: &Gpu,
        ellipsoid: &Ellipsoid,
        elevation: &Elevation,
        eye: &Eye,
    ) {
        self.look(gpu, ellipsoid, eye);
        if let Shape::Terrain(terrain) = &mut self.shape {
            terrain.look(gpu, ellipsoid, elevation, eye);
        }
    }

    /// Which pipelines fit: they are specialised for how near the ground is.
    pub fn specialisation(&self) -> Specialisation {
        self.specialisation
    }

    /// Between which heights the ground lies.
    pub fn heights(&self) -> HeightRange {
        match &self.shape {
            Shape::Globe(_) => HeightRange::default(),
            Shape::Terrain(terrain) => terrain.heights,
        }
    }

    pub fn pipelines(&self, gpu: &Gpu, format: &TargetFormat) -> GroundPipelines {
        let constants = self.specialisation.constants();
        let ground = match &self.shape {
            Shape::Globe(_) => globe::pipeline(gpu, &self.layout, format, &constants),
            Shape::Terrain(terrain) => terrain.pipeline(gpu, &self.layout, format, &constants),
        };
        let sky = GroundPipeline {
            label: "sky",
            source: include_str!("host_view.wgsl"),
            vertex: "whole_picture",
            fragment: "sky_pixel",
            buffers: &[],
            groups: &[Some(&self.layout)],
            constants: &constants,
            depth_compare: match format.convention {
                DepthConvention::Reversed => wgpu::CompareFunction::GreaterEqual,
                DepthConvention::Standard => wgpu::CompareFunction::LessEqual,
            },
        };
        GroundPipelines {
            ground,
            sky: sky.create(&gpu.device, format),
        }
    }

    pub fn draw(&self, pipelines: &GroundPipelines, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_pipeline(&pipelines.ground);
        match &self.shape {
            Shape::Globe(globe) => globe.draw(pass),
            Shape::Terrain(terrain) => terrain.draw(pass),
        }
        pass.set_pipeline(&pipelines.sky);
        pass.draw(0..3, 0..1);
    }
}

fn shared_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("host view"),
        entries: &[
            entry(0, UNIFORM),
            entry(1, PICTURE),
            entry(2, PICTURE),
            entry(
                3,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            ),
        ],
    })
}

pub const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

pub const PICTURE: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: true },
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// Entry points and fixed functions of one of the ground's pipelines.
pub struct GroundPipeline<'a> {
    pub label: &'a str,
    pub source: &'a str,
    pub vertex: &'a str,
    pub fragment: &'a str,
    pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub groups: &'a [Option<&'a wgpu::BindGroupLayout>],
    pub constants: &'a [(&'a str, f64)],
    pub depth_compare: wgpu::CompareFunction,
}

impl GroundPipeline<'_> {
    pub fn create(&self, device: &wgpu::Device, format: &TargetFormat) -> wgpu::RenderPipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source.into()),
        });
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: self.constants,
            ..Default::default()
        };
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.vertex),
                compilation_options: compilation_options.clone(),
                buffers: self.buffers,
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: format.depth,
                depth_write_enabled: Some(true),
                depth_compare: Some(self.depth_compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: format.sample_count,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.fragment),
                compilation_options,
                targets: &[Some(format.color.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
