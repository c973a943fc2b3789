//! Images on the GPU: textures of equal size together in arrays, so that fills with different images
//! are drawn at once.

use std::collections::HashMap;

use glam::UVec2;

use crate::{
    gpu::pipelines::layout,
    image::{Image, ImageId},
};

/// All images of a renderer.
pub(crate) struct ImageArrays {
    pub layout: wgpu::BindGroupLayout,
    /// Clamped, repeated.
    samplers: [wgpu::Sampler; 2],
    arrays: Vec<ImageArray>,
    /// One transparent texel, for what shows no image.
    none: wgpu::BindGroup,
    slots: HashMap<ImageId, ImageSlot>,
    next_id: u32,
}

struct ImageArray {
    size: UVec2,
    texture: wgpu::Texture,
    group: wgpu::BindGroup,
    /// Layers that no image has, any more.
    free: Vec<u32>,
}

/// Where an image is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ImageSlot {
    pub array: u32,
    pub layer: u32,
    /// Its height over its width.
    pub tall: f32,
}

impl ImageArrays {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let sampler = |label, wrap| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                address_mode_u: wrap,
                address_mode_v: wrap,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            })
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let filtering = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = layout(
            device,
            "globefill images",
            wgpu::ShaderStages::FRAGMENT,
            &[texture, filtering, filtering],
        );
        let samplers = [
            sampler("globefill clamped", wgpu::AddressMode::ClampToEdge),
            sampler("globefill repeated", wgpu::AddressMode::Repeat),
        ];
        let none = texture_of(device, wgpu::TextureFormat::Rgba8Unorm, UVec2::ONE, 1);
        Self {
            none: bind(device, &layout, &samplers, &none),
            layout,
            samplers,
            arrays: Vec::new(),
            slots: HashMap::new(),
            next_id: 0,
        }
    }

    pub(crate) fn slot(&self, image: ImageId) -> Option<ImageSlot> {
        self.slots.get(&image).copied()
    }

    /// What to bind to draw with an array.
    pub(crate) fn group(&self, array: u32) -> &wgpu::BindGroup {
        let found = self.arrays.get(array as usize);
        found.map_or(&self.none, |array| &array.group)
    }

    /// Uploads images; those of equal size share an array.
    pub(crate) fn insert(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        format: wgpu::TextureFormat,
        images: &[Image],
    ) -> Vec<ImageId> {
        let most_layers = device.limits().max_texture_array_layers;
        let mut ids = Vec::with_capacity(images.len());
        for (index, image) in images.iter().enumerate() {
            let size = UVec2::new(image.width(), image.height());
            let array = self.array_with_room(size).unwrap_or_else(|| {
                let alike = |other: &&Image| (other.width(), other.height()) == size.into();
                let layers = images[index..].iter().filter(alike).count() as u32;
                self.add_array(device, format, size, layers.min(most_layers));
                self.arrays.len() - 1
            });
            ids.push(self.place(queue, array, image));
        }
        ids
    }

    /// Forgets an image; its place is free for another of its size. Answers whether there was one.
    pub(crate) fn remove(&mut self, image: ImageId) -> bool {
        let Some(slot) = self.slots.remove(&image) else {
            return false;
        };
        self.arrays[slot.array as usize].free.push(slot.layer);
        true
    }

    fn array_with_room(&self, size: UVec2) -> Option<usize> {
        self.arrays
            .iter()
            .position(|array| array.size == size && !array.free.is_empty())
    }

    fn add_array(
        &mut self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        size: UVec2,
        layers: u32,
    ) {
        let texture = texture_of(device, format, size, layers);
        self.arrays.push(ImageArray {
            size,
            group: bind(device, &self.layout, &self.samplers, &texture),
            texture,
            free: (0..layers).rev().collect(),
        });
    }

    fn place(&mut self, queue: &wgpu::Queue, array: usize, image: &Image) -> ImageId {
        let ImageArray { texture, free, .. } = &mut self.arrays[array];
        let layer = free.pop().unwrap_or_default();
        for (level, texels) in (0..).zip(image.levels()) {
            let size = wgpu::Extent3d {
                width: texels.size.x,
                height: texels.size.y,
                depth_or_array_layers: 1,
            };
            let into = wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: level,
                origin: wgpu::Origin3d {
                    x: 0,
                    y: 0,
                    z: layer,
                },
                aspect: wgpu::TextureAspect::All,
            };
            let rows = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * texels.size.x),
                rows_per_image: None,
            };
            let encoded;
            let bytes: &[u8] = if texture.format().is_srgb() {
                bytemuck::cast_slice(&texels.texels)
            } else {
                encoded = texels.encoded();
                bytemuck::cast_slice(&encoded)
            };
            queue.write_texture(into, bytes, rows, size);
        }
        let id = ImageId(self.next_id);
        self.next_id += 1;
        let slot = ImageSlot {
            array: array as u32,
            layer,
            tall: image.height() as f32 / image.width() as f32,
        };
        self.slots.insert(id, slot);
        id
    }
}

fn texture_of(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    size: UVec2,
    layers: u32,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("globefill images"),
        size: wgpu::Extent3d {
            width: size.x,
            height: size.y,
            depth_or_array_layers: layers,
        },
        mip_level_count: size.max_element().ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    [clamped, repeated]: &[wgpu::Sampler; 2],
    texture: &wgpu::Texture,
) -> wgpu::BindGroup {
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let resources = [
        wgpu::BindingResource::TextureView(&view),
        wgpu::BindingResource::Sampler(clamped),
        wgpu::BindingResource::Sampler(repeated),
    ];
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill images"),
        layout,
        entries: &entries,
    })
}
