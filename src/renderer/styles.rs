//! How the fills of a renderer look: styles, images, and resolving with patterns.

use std::collections::BTreeMap;

use glam::{DVec2, UVec2};

use super::{MeshId, Renderer, Resident, chosen::Chosen, prepare::Selected, windows::layer_window};
use crate::{
    error::{RendererError, StyleError},
    extents::Extents,
    fill_mesh::FillMesh,
    frame::layers::Counting,
    frame::placed::{AnglePlace, MapPlace, PatternPlace},
    frame::reference::Reference,
    frame::sight_uniform::SightUniform,
    frame::window::Window,
    gpu::edge_pipelines::EdgePipelines,
    gpu::edge_view::{EdgeFrame, EdgeSubject},
    gpu::image_arrays::ImageArrays,
    gpu::layer_tables::LayerTables,
    gpu::style_pipelines::StylePipelines,
    gpu::style_view::{StyleFrame, StyleView},
    gpu::targets::LayerTarget,
    hatch::Hatch,
    image::{Image, ImageId},
    image_fill::{ImageFill, Placement},
    length::Length,
    style::{FillStyle, Pattern},
    view::{Prepared, View},
};

impl Renderer {
    /// Sets how a fill looks from the next `prepare` on; `fill` is the index of its region in the
    /// mesh.
    ///
    /// # Errors
    /// [`RendererError::NoSuchMesh`], [`RendererError::NoSuchFill`], and
    /// [`RendererError::InvalidStyle`], which names the field; the previous style stays.
    pub fn set_style(
        &mut self,
        mesh: MeshId,
        fill: u32,
        style: FillStyle,
    ) -> Result<(), RendererError> {
        let invalid = |error| RendererError::InvalidStyle { fill, error };
        style.check().map_err(invalid)?;
        let tall = self.tallness(&style).map_err(invalid)?;
        let resident = self
            .meshes
            .get_mut(&mesh)
            .ok_or(RendererError::NoSuchMesh)?;
        let fills = resident.styles.len() as u32;
        let current = resident
            .styles
            .get_mut(fill as usize)
            .ok_or(RendererError::NoSuchFill { fill, fills })?;
        if *current == style {
            return Ok(());
        }
        if current.pattern != style.pattern {
            let place = place_of(&resident.mesh, fill, style.pattern.as_ref(), tall);
            resident.places[fill as usize] = place;
        }
        *current = style;
        self.changed();
        Ok(())
    }

    /// How a fill looks from the next `prepare` on.
    ///
    /// # Errors
    /// [`RendererError::NoSuchMesh`], [`RendererError::NoSuchFill`].
    pub fn style(&self, mesh: MeshId, fill: u32) -> Result<FillStyle, RendererError> {
        let resident = self.meshes.get(&mesh).ok_or(RendererError::NoSuchMesh)?;
        let fills = resident.styles.len() as u32;
        let style = resident.styles.get(fill as usize);
        style
            .copied()
            .ok_or(RendererError::NoSuchFill { fill, fills })
    }

    /// Height over width of the image that a style shows; 1 for none.
    fn tallness(&self, style: &FillStyle) -> Result<f64, StyleError> {
        let Some(image) = style.pattern.and_then(|pattern| pattern.image()) else {
            return Ok(1.0);
        };
        let slot = self.images.as_ref().and_then(|images| images.slot(image));
        slot.map_or(Err(StyleError::NoSuchImage), |slot| {
            Ok(f64::from(slot.tall))
        })
    }

    /// Uploads an image for fills to show; see [`Self::insert_images`].
    ///
    /// # Errors
    /// [`RendererError::ImageTooLarge`].
    pub fn insert_image(
        &mut self,
        queue: &wgpu::Queue,
        image: &Image,
    ) -> Result<ImageId, RendererError> {
        let ids = self.insert_images(queue, std::slice::from_ref(image))?;
        Ok(ids[0])
    }

    /// Uploads images for fills to show. Those of one size that are inserted together share a texture
    /// array; a layer of fills is resolved by one draw for each array that its fills show.
    ///
    /// Texels of images are decoded from sRGB unless the colour target holds encoded colours itself, as
    /// `Rgba8Unorm` does.
    ///
    /// # Errors
    /// [`RendererError::ImageTooLarge`] if the device's textures cannot be as large; then none is
    /// uploaded.
    pub fn insert_images(
        &mut self,
        queue: &wgpu::Queue,
        images: &[Image],
    ) -> Result<Vec<ImageId>, RendererError> {
        let most = self.device.limits().max_texture_dimension_2d;
        if let Some(large) = images.iter().find(|it| it.width().max(it.height()) > most) {
            return Err(RendererError::ImageTooLarge {
                width: large.width(),
                height: large.height(),
                most,
            });
        }
        let format = image_format(self.options.color_format);
        let device = &self.device;
        let arrays = self.images.get_or_insert_with(|| ImageArrays::new(device));
        Ok(arrays.insert(device, queue, format, images))
    }

    /// Forgets an image. Its texture stays for another of the same size.
    ///
    /// # Errors
    /// [`RendererError::NoSuchImage`], and [`RendererError::ImageInUse`] while a style shows it.
    pub fn remove_image(&mut self, image: ImageId) -> Result<(), RendererError> {
        let shown =
            |style: &FillStyle| style.pattern.and_then(|pattern| pattern.image()) == Some(image);
        let mut residents = self.meshes.values();
        if residents.any(|resident| resident.styles.iter().any(shown)) {
            return Err(RendererError::ImageInUse);
        }
        let removed = self
            .images
            .as_mut()
            .is_some_and(|images| images.remove(image));
        removed.then_some(()).ok_or(RendererError::NoSuchImage)
    }

    /// Whether what is styled can be drawn.
    pub(super) fn check_styles(
        &self,
        selections: &[Selected],
        counting: Counting,
    ) -> Result<(), RendererError> {
        let styled = self.layers(counting)?.styles.iter().any(Option::is_some);
        let ellipsoids = || selections.iter().map(|selected| selected.sight.ellipsoid);
        if styled && ellipsoids().zip(ellipsoids().skip(1)).any(|(a, b)| a != b) {
            return Err(RendererError::Unsupported(
                "patterns, strokes, fades and smooth edges need all meshes on one ellipsoid",
            ));
        }
        Ok(())
    }

    /// Places patterns for the frame's eye, compiles and uploads what is missing; returns the bytes.
    pub(super) fn prepare_styles(
        &mut self,
        queue: &wgpu::Queue,
        view: &mut View,
        prepared: &Prepared,
        selections: &[Selected],
        chosen: &Chosen,
    ) -> u64 {
        let counting = chosen.counting;
        let tables = &self.layers[counting as usize];
        let styled = |tables: &&LayerTables| tables.styles.iter().any(Option::is_some);
        let tables = tables.as_ref().and_then(|tables| tables.as_ref().ok());
        let (Some(tables), Some(Selected { sight, .. })) =
            (tables.filter(styled), selections.first())
        else {
            view.styles = None;
            return 0;
        };
        let device = &self.device;
        let images = self.images.get_or_insert_with(|| ImageArrays::new(device));
        let pipelines = self.style_pipelines.get_or_insert_with(|| {
            let layer_layout = &self.pipelines.resolve_layout;
            StylePipelines::new(device, self.options, layer_layout, &images.layout)
        });
        if tables.edges.iter().any(Option::is_some) && pipelines.edges.is_none() {
            let surface_layout = &pipelines.surface_layout;
            let edges = EdgePipelines::new(device, &self.pipelines, surface_layout, self.options);
            pipelines.edges = Some(edges);
        }
        for (layer, (table, &joined)) in tables.styles.iter().zip(&chosen.joined).enumerate() {
            if let Some(table) = table {
                let key = tables.style_key(device, layer, table, sight.kind);
                pipelines.ensure(device, key.joined(joined));
            }
        }
        let frame = &prepared.frame;
        let reference = Reference::new(sight.ellipsoid, sight.eye_ecef_m);
        let depth = self.options.depth;
        let mut uniform = SightUniform::new(sight, &reference, depth, frame.size_px);
        uniform.window = styled_window(&self.meshes, tables, selections, frame.size_px);
        let subjects: Vec<EdgeSubject<'_>> = selections
            .iter()
            .map(|selected| EdgeSubject {
                id: selected.id,
                gpu: &self.meshes[&selected.id].gpu,
                sight: &selected.sight,
                selection: &selected.selection,
            })
            .collect();
        let with = StyleFrame {
            tables,
            revision: (self.revision, counting),
            uniform,
            lens: sight.kind,
            reference,
            edges: EdgeFrame {
                size_px: frame.size_px,
                depth,
                layers: &tables.edges,
            },
            subjects: &subjects,
        };
        let styles = view.styles.get_or_insert_with(|| StyleView::new(device));
        styles.prepare(device, queue, pipelines, &with)
    }

    /// Binds the depth that patterns are placed by, and measures how far pixels are from boundaries.
    pub(super) fn count_styles(
        &self,
        view: &mut View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
    ) {
        if let (Some(styles), Some(pipelines)) = (&mut view.styles, &self.style_pipelines) {
            let meshes = self.drawn(&view.meshes);
            let shown = view.prepared.map(|it| it.shown).unwrap_or_default();
            styles.count(&self.device, pipelines, encoder, depth, &meshes, shown);
        }
    }

    /// Resolves a layer whose sums are bound, if its styles are more than colours; answers whether.
    pub(super) fn resolve_styled(
        &self,
        view: &View,
        pass: &mut wgpu::RenderPass<'_>,
        layer: usize,
        target: &LayerTarget,
    ) -> bool {
        let (Some(styles), Some(pipelines), Some(images)) =
            (&view.styles, &self.style_pipelines, &self.images)
        else {
            return false;
        };
        let styled = styles.draws_of(layer).is_some();
        styles.resolve(pipelines, images, pass, layer, target.joined);
        styled
    }
}

/// The format of textures whose texels are what the colour target takes.
fn image_format(target: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match target {
        // These hold encoded colours themselves.
        wgpu::TextureFormat::Rgba8Unorm
        | wgpu::TextureFormat::Bgra8Unorm
        | wgpu::TextureFormat::Rgb10a2Unorm => wgpu::TextureFormat::Rgba8Unorm,
        _ => wgpu::TextureFormat::Rgba8UnormSrgb,
    }
}

/// Where the pattern of a fill lies; `tall` is the height of its image over its width.
fn place_of(
    mesh: &FillMesh,
    fill: u32,
    pattern: Option<&Pattern>,
    tall: f64,
) -> Option<PatternPlace> {
    match pattern? {
        Pattern::Hatch(hatch) => Some(PatternPlace::Map(hatch_place(mesh, fill, hatch, tall))),
        Pattern::Image(image) => Some(image_place(mesh, fill, image)),
    }
}

fn hatch_place(mesh: &FillMesh, fill: u32, hatch: &Hatch, tall: f64) -> MapPlace {
    let middle = || mesh.centroid(fill);
    let anchor = hatch.anchor.or_else(middle).unwrap_or_default();
    let unit_m = match hatch.spacing {
        Length::Metres(metres) => f64::from(metres),
        Length::Pixels(_) => 1.0,
    };
    let angle_rad = f64::from(hatch.angle_rad);
    MapPlace::repeating(
        &mesh.ellipsoid,
        anchor,
        angle_rad,
        unit_m * DVec2::new(1.0, tall),
    )
}

fn image_place(mesh: &FillMesh, fill: u32, image: &ImageFill) -> PatternPlace {
    let ellipsoid = &mesh.ellipsoid;
    let rotation_rad = f64::from(image.rotation_rad);
    let repeats = DVec2::from_array(image.repeats.map(f64::from));
    let angles = |extents: Option<Extents>, spherical| {
        let extents = extents.or_else(|| mesh.extents(fill));
        let extents = extents.unwrap_or(Extents::GLOBE);
        let place = AnglePlace::new(ellipsoid, extents, spherical, rotation_rad, repeats);
        PatternPlace::Angles(place)
    };
    match image.placement {
        Placement::Geodetic(extents) => angles(extents, false),
        Placement::Spherical(extents) => angles(extents, true),
        Placement::Local { center, size_m } => {
            let size_m = DVec2::from_array(size_m.map(f64::from)) / repeats;
            let place = MapPlace::picture(ellipsoid, center, rotation_rad, size_m);
            PatternPlace::Map(place)
        }
    }
}

/// What holds all fills of the layers that have styles, and what their strokes add.
fn styled_window(
    meshes: &BTreeMap<MeshId, Resident>,
    tables: &LayerTables,
    selections: &[Selected],
    size_px: UVec2,
) -> [f32; 4] {
    let reaches = tables
        .edges
        .iter()
        .flatten()
        .flat_map(|edges| &edges.reaches);
    let [reach_m, reach_px] = reaches.fold([0.0_f32; 2], |most, reach| {
        std::array::from_fn(|unit| most[unit].max(reach[unit]))
    });
    let layers = (0..).zip(&tables.styles);
    let styled = layers.filter(|(_, styles)| styles.is_some());
    let window = styled.fold(Window::EMPTY, |window, (layer, _)| {
        window.joined(layer_window(meshes, selections, layer, f64::from(reach_m)))
    });
    window.pixels(size_px, f64::from(reach_px) + 1.0)
}
