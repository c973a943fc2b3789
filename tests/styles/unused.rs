//! What styles cost that are not used, and what they upload when they are.

use globefill::{
    CountTechnique, FillStyle, FrameStats, Hatch, HatchKind, Image, ImageFill, Pattern, Region,
    View, Zone,
};

use crate::{
    PLACES, SMALL,
    common::{headless::gpu, surface::Surface},
    stage::{Stage, bare, built, pose},
};

fn image(side: u32) -> Image {
    let texels = vec![200; (4 * side * side) as usize];
    Image::from_rgba8(side, side, &texels).expect("an image")
}

fn two_fills() -> globefill::FillMesh {
    built(&[1.0, 2.0].map(|size| Region::from(Zone::circle(PLACES[0], size * 1e5))))
}

fn surfaces() -> [Surface; 2] {
    [(1e5, 0.0), (3e5, 0.4)].map(|(height_m, tilt)| bare(&pose(PLACES[0], height_m, tilt), SMALL))
}

fn solid(alpha: f32) -> FillStyle {
    FillStyle {
        color: [0.3, 0.6, 0.9, alpha],
        opacity: 0.7,
        highlight: [1.0, 1.0, 0.0, 0.3],
        ..Default::default()
    }
}

fn patterned(pattern: Pattern) -> FillStyle {
    FillStyle {
        pattern: Some(pattern),
        ..solid(0.5)
    }
}

/// Two frames of a fresh view: statistics and texels.
fn frames(stage: &mut Stage<'_>) -> [(FrameStats, Vec<[u8; 4]>); 2] {
    stage.view = View::default();
    surfaces().map(|surface| {
        let painted = stage.draw(&surface);
        (painted.stats, painted.texels)
    })
}

#[test]
fn what_is_not_used_costs_nothing() {
    let Some(gpu) = gpu() else { return };
    for count in [CountTechnique::Winding, CountTechnique::Stencil] {
        let fresh = || {
            let mut stage = Stage::counted(gpu, two_fills(), &surfaces()[0], count);
            stage.set(0, solid(0.4));
            stage.set(1, solid(0.6));
            stage
        };
        let mut plain = fresh();
        // Tables of styles are uploaded with the first frame after a change.
        frames(&mut plain);
        let expected = frames(&mut plain);
        assert_eq!(expected[0].0.styled_layers, 0);

        let mut used = fresh();
        let inserted = used.renderer.insert_image(&gpu.queue, &image(32));
        let inserted = inserted.expect("a small image");
        frames(&mut used);
        assert!(frames(&mut used) == expected, "images cost something");

        used.set(0, patterned(Pattern::Image(ImageFill::new(inserted))));
        used.set(1, patterned(Pattern::Hatch(Hatch::default())));
        let styled = frames(&mut used);
        assert!(styled[0].0.styled_layers > 0 && styled[0].1 != expected[0].1);
        assert_eq!(styled[0].0.passes, expected[0].0.passes);
        assert_eq!(styled[0].0.vertices, expected[0].0.vertices);

        used.set(0, solid(0.4));
        used.set(1, solid(0.6));
        frames(&mut used);
        assert!(frames(&mut used) == expected, "patterns left something");
        used.renderer
            .remove_image(inserted)
            .expect("no style shows it");
        assert!(frames(&mut used) == expected);
    }
}

/// Bytes of the camera and of the place of a pattern.
const SIGHT: u64 = 12 * 16;
const PLACE: u64 = 64;

#[test]
fn still_frames_upload_nothing_and_moved_ones_little() {
    let Some(gpu) = gpu() else { return };
    let surfaces: Vec<Surface> = [1.0, 1.001, 1.002]
        .map(|more| bare(&pose(PLACES[0], 3e6 * more, 0.2), SMALL))
        .into();
    let mut stage = Stage::new(gpu, two_fills(), &surfaces[0]);
    let moved_bytes = |stage: &mut Stage<'_>| {
        stage.view = View::default();
        stage.draw(&surfaces[0]);
        // Buffers that grow are written anew.
        stage.draw(&surfaces[1]);
        let moved = stage.draw(&surfaces[2]);
        let still = stage.draw(&surfaces[2]);
        assert_eq!(still.stats.upload_bytes, 0);
        assert!(still.texels == moved.texels);
        moved.stats.upload_bytes
    };
    let solid_bytes = moved_bytes(&mut stage);
    for kind in [HatchKind::Lines, HatchKind::Dots, HatchKind::Checker] {
        for fill in 0..2 {
            let hatch = Hatch {
                kind,
                share: 0.3,
                ..Default::default()
            };
            stage.set(fill, patterned(Pattern::Hatch(hatch)));
        }
        let bytes = moved_bytes(&mut stage);
        println!("moved: {solid_bytes} bytes of colours, {bytes} with patterns");
        assert!(bytes > 0 && bytes <= solid_bytes + SIGHT + 2 * PLACE);
    }
}
