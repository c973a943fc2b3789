//! What a frame costs and shows when little changes: still frames, hidden fills, several views.

mod common;

use std::collections::BTreeSet;

use common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::{Gpu, gpu},
    pair_mesh::Pair,
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::UVec2;
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FillMesh, FillStyle, LonLat, MeshOptions, Region, View,
    Zone,
};

const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];

fn surface(height_m: f64, size_px: UVec2) -> Surface {
    let pose = Pose::nadir(11.0, 47.0, height_m).turned(30.0, -70.0);
    let figure = Figure::new(Ellipsoid::WGS84);
    let cast = Cast::new(&figure, &pose, size_px, 1, Terrain::Bare);
    Surface::new(&cast, DepthKind::Reversed)
}

fn painter(gpu: &Gpu, surface: &Surface, count: CountTechnique) -> IdPainter {
    let pair = Pair::about(EdgeKind::Straight, 11.0, 47.0, 65.0, 0.9);
    IdPainter::new(gpu, pair.mesh(), surface, count)
}

#[test]
fn a_still_frame_uploads_nothing() {
    let Some(gpu) = gpu() else { return };
    let (near, far) = (
        surface(200.0, UVec2::new(160, 90)),
        surface(2e5, UVec2::new(160, 90)),
    );
    for count in TECHNIQUES {
        let mut painter = painter(gpu, &near, count);
        let mut view = View::default();
        let first = painter.draw(gpu, &mut view, &near, 0.0);
        assert!(first.stats.upload_bytes > 0);
        let second = painter.draw(gpu, &mut view, &near, 0.0);
        assert_eq!(second.stats.upload_bytes, 0);
        assert!(second.ids == first.ids);
        let moved = painter.draw(gpu, &mut view, &far, 0.0);
        assert!(moved.stats.upload_bytes > 0 && moved.ids != first.ids);
        let back = painter.draw(gpu, &mut view, &near, 0.0);
        assert!(back.ids == first.ids);
    }
}

#[test]
fn hidden_fills_cost_no_draws() {
    let Some(gpu) = gpu() else { return };
    let surface = surface(2e4, UVec2::new(160, 90));
    for count in TECHNIQUES {
        let mut painter = painter(gpu, &surface, count);
        let mut view = View::default();
        let both = painter.draw(gpu, &mut view, &surface, 0.0);
        assert!(both.ids.contains(&1) && both.ids.contains(&2));
        let hidden = FillStyle {
            visible: false,
            ..Default::default()
        };
        let mesh = painter.mesh;
        painter
            .renderer
            .set_style(mesh, 1, hidden)
            .expect("fill 1 exists");
        let one = painter.draw(gpu, &mut view, &surface, 0.0);
        let expected: Vec<u32> = both.ids.iter().map(|&id| id % 2).collect();
        assert!(one.ids == expected);
        assert_eq!(one.stats.drawn, 1);
        painter
            .renderer
            .set_style(mesh, 0, hidden)
            .expect("fill 0 exists");
        let none = painter.draw(gpu, &mut view, &surface, 0.0);
        assert!(none.ids.iter().all(|&id| id == 0));
        assert_eq!((none.stats.draws, none.stats.drawn), (0, 0));
    }
}

#[test]
fn fills_beside_the_picture_cost_no_draws() {
    let Some(gpu) = gpu() else { return };
    let size_px = UVec2::new(160, 90);
    let near = surface(2e4, size_px);
    let figure = Figure::new(Ellipsoid::WGS84);
    // The pair lies 150 km away, above the horizon.
    let pose = Pose::nadir(13.0, 47.0, 2e4);
    let cast = Cast::new(&figure, &pose, size_px, 1, Terrain::Bare);
    let beside = Surface::new(&cast, DepthKind::Reversed);
    let mut painter = painter(gpu, &near, CountTechnique::Winding);
    let mut view = View::default();
    for _ in 0..2 {
        let none = painter.draw(gpu, &mut view, &beside, 0.0);
        assert!(none.ids.iter().all(|&id| id == 0));
        assert_eq!((none.stats.draws, none.stats.drawn), (0, 2));
        assert_eq!((none.stats.passes, none.stats.layers), (0, 1));
        let both = painter.draw(gpu, &mut view, &near, 0.0);
        assert!(both.ids.contains(&1) && both.ids.contains(&2));
    }
}

#[test]
fn views_of_one_renderer_do_not_meet() {
    let Some(gpu) = gpu() else { return };
    let surfaces = [
        surface(300.0, UVec2::new(160, 90)),
        surface(5e5, UVec2::new(64, 64)),
        surface(2e7, UVec2::new(333, 77)),
    ];
    for count in TECHNIQUES {
        let alone: Vec<Vec<u32>> = surfaces
            .iter()
            .map(|s| {
                painter(gpu, s, count)
                    .draw(gpu, &mut View::default(), s, 0.0)
                    .ids
            })
            .collect();
        let mut painter = painter(gpu, &surfaces[0], count);
        let mut views: [View; 3] = Default::default();
        for _ in 0..2 {
            for (k, (surface, view)) in surfaces.iter().zip(&mut views).enumerate() {
                assert!(painter.draw(gpu, view, surface, 0.0).ids == alone[k]);
            }
        }
        // One view resized again and again.
        for k in [2, 0, 1, 2] {
            let ids = painter.draw(gpu, &mut views[0], &surfaces[k], 0.0).ids;
            assert!(ids == alone[k]);
        }
    }
}

#[test]
fn removed_meshes_are_gone() {
    let Some(gpu) = gpu() else { return };
    let surface = surface(2e4, UVec2::new(160, 90));
    for count in TECHNIQUES {
        let mut painter = painter(gpu, &surface, count);
        let mut view = View::default();
        painter.draw(gpu, &mut view, &surface, 0.0);
        let mesh = painter.mesh;
        painter.renderer.remove(mesh).expect("it is there");
        let none = painter.draw(gpu, &mut view, &surface, 0.0);
        assert!(none.ids.iter().all(|&id| id == 0));
        assert_eq!((none.stats.fills, none.stats.gpu_bytes), (0, 0));
        assert!(painter.renderer.remove(mesh).is_err());
        assert!(
            painter
                .renderer
                .set_style(mesh, 0, FillStyle::default())
                .is_err()
        );
    }
}

/// Each corner of a cap finds its own piece, so one draw serves many: the same picture as fill by fill.
#[test]
fn a_thousand_fills_take_few_draws() {
    let Some(gpu) = gpu() else { return };
    let surface = surface(4e5, UVec2::new(160, 90));
    let circles: Vec<Region> = (0..1000)
        .map(|k| {
            let (row, column) = (f64::from(k / 40), f64::from(k % 40));
            let middle = LonLat::new(5.0 + 0.3 * column, 45.0 + 0.2 * row);
            Zone::circle(middle, 1e4).into()
        })
        .collect();
    let mesh = FillMesh::build(&circles, &MeshOptions::default()).expect("they are sound");
    let [winding, stencil] = TECHNIQUES.map(|count| {
        let mut painter = IdPainter::new(gpu, mesh.clone(), &surface, count);
        painter.draw(gpu, &mut View::default(), &surface, 0.25)
    });
    assert!(winding.ids == stencil.ids);
    let shown: BTreeSet<u32> = winding.ids.iter().copied().collect();
    assert!(shown.len() > 150, "{}", shown.len());
    assert_eq!(winding.stats.drawn, stencil.stats.drawn);
    assert!(10 * winding.stats.draws < winding.stats.drawn);
}
