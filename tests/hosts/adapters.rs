//! Hosts with poorer adapters and with bad frames: the same picture, or a typed error.

use crate::common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::{gpu, gpu_without},
    pair_mesh::Pair,
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::{DMat3, DMat4, UVec2};
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FillMesh, FillStyle, Frame, HeightRange, MeshOptions,
    RendererError, View, countries::Dataset, wgpu::Features,
};

fn surface(height_m: f64, samples: u32, depth: DepthKind) -> Surface {
    let pose = Pose::nadir(11.0, 47.0, height_m);
    let figure = Figure::new(Ellipsoid::WGS84);
    let size_px = UVec2::new(160, 90);
    Surface::new(
        &Cast::new(&figure, &pose, size_px, samples, Terrain::Bare),
        depth,
    )
}

fn pair() -> FillMesh {
    Pair::about(EdgeKind::Straight, 11.0, 47.0, 65.0, 0.9).mesh()
}

fn countries() -> FillMesh {
    let countries = Dataset::Countries110m.countries();
    let regions: Vec<_> = countries
        .into_iter()
        .map(|country| country.region)
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is sound")
}

/// What `mesh` looks like on a device without `withheld`, and the technique that counted it.
fn draw_without(
    withheld: Features,
    mesh: FillMesh,
    surface: &Surface,
) -> Option<(Vec<u32>, CountTechnique)> {
    let poorer = gpu_without(withheld)?;
    let mut painter = IdPainter::new(&poorer, mesh, surface, CountTechnique::Winding);
    let picture = painter.draw(&poorer, &mut View::default(), surface, 0.0);
    Some((picture.ids, picture.stats.technique))
}

#[test]
fn half_floats_count_small_scenes_exactly() {
    let Some(gpu) = gpu() else { return };
    for samples in [1, 4] {
        for height_m in [50.0, 2e5] {
            let surface = surface(height_m, samples, DepthKind::Reversed);
            let mut painter = IdPainter::new(gpu, pair(), &surface, CountTechnique::Winding);
            let expected = painter.draw(gpu, &mut View::default(), &surface, 0.0).ids;
            assert!(expected.contains(&1) && expected.contains(&2));
            let Some((ids, technique)) =
                draw_without(Features::FLOAT32_BLENDABLE, pair(), &surface)
            else {
                return;
            };
            assert_eq!(technique, CountTechnique::Winding);
            assert!(ids == expected, "{samples} samples from {height_m} m");
        }
    }
}

#[test]
fn the_stencil_counts_what_half_floats_cannot() {
    let Some(gpu) = gpu() else { return };
    let surface = surface(2e6, 1, DepthKind::Reversed);
    let mut painter = IdPainter::new(gpu, countries(), &surface, CountTechnique::Winding);
    let expected = painter.draw(gpu, &mut View::default(), &surface, 0.0);
    assert_eq!(expected.stats.technique, CountTechnique::Winding);
    let drawn = draw_without(Features::FLOAT32_BLENDABLE, countries(), &surface);
    let Some((ids, technique)) = drawn else {
        return;
    };
    assert_eq!(technique, CountTechnique::Stencil);
    assert!(ids == expected.ids);
}

#[test]
fn what_a_device_cannot_count_is_refused() {
    let withheld = Features::FLOAT32_BLENDABLE | Features::DEPTH32FLOAT_STENCIL8;
    let Some(poorer) = gpu_without(withheld) else {
        return;
    };
    let surface = surface(2e6, 1, DepthKind::Reversed);
    let mut painter = IdPainter::new(&poorer, countries(), &surface, CountTechnique::Winding);
    let frame = Frame::new(surface.lens.camera(), surface.size_px());
    let refused = painter
        .renderer
        .prepare(&poorer.queue, &mut View::default(), &frame);
    let missing = RendererError::MissingFeature(Features::DEPTH32FLOAT_STENCIL8);
    assert_eq!(refused, Err(missing));
}

#[test]
fn a_far_plane_needs_its_features() {
    let Some(poorer) = gpu_without(Features::CLIP_DISTANCES) else {
        return;
    };
    let surface = surface(2e6, 1, DepthKind::Standard);
    let mut painter = IdPainter::new(&poorer, pair(), &surface, CountTechnique::Winding);
    let frame = Frame::new(surface.lens.camera(), surface.size_px());
    let refused = painter
        .renderer
        .prepare(&poorer.queue, &mut View::default(), &frame);
    assert!(
        matches!(refused, Err(RendererError::MissingFeature(_))),
        "{refused:?}"
    );
}

#[test]
fn bad_frames_and_styles_are_typed_errors_and_change_nothing() {
    let Some(gpu) = gpu() else { return };
    let surface = surface(2e5, 1, DepthKind::Reversed);
    let mut painter = IdPainter::new(gpu, pair(), &surface, CountTechnique::Winding);
    let mut view = View::default();
    let before = painter.draw(gpu, &mut view, &surface, 0.0);
    let good = Frame::new(surface.lens.camera(), surface.size_px());
    type Spoil = fn(&mut Frame);
    let bad: [(&str, Spoil); 7] = [
        ("camera.eye_ecef_m", |frame| {
            frame.camera.eye_ecef_m.y = f64::NAN
        }),
        ("camera.view_from_ecef", |frame| {
            frame.camera.view_from_ecef = 2.0 * DMat3::IDENTITY
        }),
        ("camera.clip_from_view", |frame| {
            frame.camera.clip_from_view = DMat4::NAN
        }),
        ("size_px", |frame| frame.size_px.x = 0),
        ("terrain", |frame| {
            frame.terrain = HeightRange {
                min_m: 1.0,
                max_m: 0.0,
            }
        }),
        ("pixel_error", |frame| frame.pixel_error = -1.0),
        ("host_pixel_error", |frame| {
            frame.host_pixel_error = f64::INFINITY
        }),
    ];
    for (field, spoil) in bad {
        let mut frame = good;
        spoil(&mut frame);
        let refused = painter.renderer.prepare(&gpu.queue, &mut view, &frame);
        assert_eq!(refused, Err(RendererError::InvalidFrame(field)));
    }
    let mut oblique = good;
    oblique.camera.clip_from_view.x_axis.z = 0.1;
    let refused = painter.renderer.prepare(&gpu.queue, &mut view, &oblique);
    assert!(matches!(refused, Err(RendererError::Unsupported(_))));
    for alpha in [f32::NAN, -0.1, 1.5] {
        let style = FillStyle {
            color: [0.0, 0.0, 0.0, alpha],
            ..Default::default()
        };
        let refused = painter.renderer.set_style(painter.mesh, 0, style);
        let error = globefill::StyleError::OutOfRange("color");
        assert_eq!(refused, Err(RendererError::InvalidStyle { fill: 0, error }));
    }
    let refused = painter
        .renderer
        .set_style(painter.mesh, 7, FillStyle::default());
    assert_eq!(
        refused,
        Err(RendererError::NoSuchFill { fill: 7, fills: 2 })
    );
    let after = painter.draw(gpu, &mut view, &surface, 0.0);
    assert!(after.ids == before.ids);
}
