//! Styles over surfaces whose depths are logarithmic.

use globefill::{FillStyle, HatchKind, Length, Region, Renderer, RendererOptions};

use crate::{
    PLACES, SMALL,
    common::{
        headless::gpu,
        surface::{Cast, DepthKind, Surface, Terrain},
    },
    coverage,
    edges::edges_off,
    ink::{hatch, sheet},
    stage::{Stage, built, figure, ground, pixel_m, pose},
    strokes::{AT, circle, compare, shares},
};

const KINDS: [DepthKind; 2] = [DepthKind::Logarithmic, DepthKind::FromNear];

#[test]
fn edges_of_lines_lie_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let (mut most, mut count) = (0.0f64, 0);
    let at = PLACES[0];
    for kind in KINDS {
        for (height_m, tilt) in [(3.0, 0.5), (1e3, 0.0), (1e5, 0.7), (2e7, 0.0)] {
            let cast = Cast::new(
                &figure(),
                &pose(at, height_m, tilt),
                SMALL,
                1,
                Terrain::Bare,
            );
            let surface = Surface::new(&cast, kind);
            let mut stage = Stage::new(gpu, ground(at), &surface);
            let spacing = (23.7 * pixel_m(&surface)) as f32;
            let lines = hatch(HatchKind::Lines, Length::Metres(spacing), 0.5, 0.35, at);
            stage.set(0, coverage::style_of(lines));
            let drawn = stage.draw(&surface).texels;
            let offs = edges_off(&surface, &sheet(at, 0.35), &drawn, f64::from(spacing), 0.5);
            let off = offs
                .values()
                .fold(0.0f64, |worst, off| worst.max(off.abs()));
            println!(
                "{kind:?} {height_m} m {tilt}: {off:.4} px of {}",
                offs.len()
            );
            most = most.max(off);
            count += offs.len();
        }
    }
    assert!(count > 500 && most <= 0.05, "{most} px of {count}");
}

#[test]
fn edges_are_smooth() {
    let Some(gpu) = gpu() else { return };
    for (height_m, tilt) in [(30.0, 0.0), (1e3, 0.25), (4e6, 0.3)] {
        let zone = circle(height_m);
        let cast = Cast::new(
            &figure(),
            &pose(AT, height_m, tilt),
            SMALL,
            1,
            Terrain::Bare,
        );
        let surface = Surface::new(&cast, DepthKind::Logarithmic);
        let mesh = || built(&[Region::from(zone.clone())]);
        let mut stage = Stage::new(gpu, mesh(), &surface);
        stage.options = RendererOptions {
            smooth_edges: true,
            ..stage.options
        };
        stage.renderer = Renderer::new(&gpu.device, stage.options).expect("sound");
        stage.mesh = stage.renderer.insert(mesh());
        let color = [1.0; 4];
        stage.set(
            0,
            FillStyle {
                color,
                ..Default::default()
            },
        );
        let texels = stage.draw_within(&surface, 0.0).texels;
        let wanted = shares(&surface, &zone, |outside_m| outside_m <= 0.0);
        let (rms, worst, _) = compare(&texels, &wanted);
        println!("{height_m} m, {tilt}: rms {rms:.3} worst {worst:.3}");
        assert!(rms <= 0.05, "{rms}");
    }
}
