//! Which frame is answered for, and what is no question or no answer.

use std::slice::from_ref;

use glam::UVec2;
use globefill::{CountTechnique, FillStyle, Pick, PickedFill, RendererError};

use crate::{
    common::{headless::gpu, scene::depth_texture, surface::DepthKind},
    host::{CENTRE, Host, SIZE, SKY, TECHNIQUES, circle, circles, disk, read, readable},
};

#[test]
fn a_frame_is_answered_as_it_was_prepared() {
    let Some(gpu) = gpu() else { return };
    let [small, middle, large] = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let below = host.insert(&[large.clone(), middle.clone()]);
        let above = host.insert(from_ref(&small));
        let shown = [
            PickedFill {
                mesh: above,
                fill: 0,
            },
            PickedFill {
                mesh: below,
                fill: 1,
            },
            PickedFill {
                mesh: below,
                fill: 0,
            },
        ];
        host.draw();
        // Asked before, between and after changes, and read after all of them.
        let (at_px, _) = host
            .surface
            .lens
            .project(host.surface.points_m[80 + 45 * 160].expect("land"));
        let answers = readable(gpu, 3 * Pick::BYTES);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut picks = Vec::new();
        for step in 0..3_u32 {
            let offset = u64::from(step) * Pick::BYTES;
            let asked = host.renderer.read_fills(
                &host.view,
                &mut encoder,
                at_px.as_uvec2(),
                &answers,
                offset,
            );
            picks.push(asked.expect("the pixel is in the picture"));
            match step {
                0 => host.restyle(below, 0, |style| style.z_index = 9),
                1 => host.renderer.remove(below).expect("it is there"),
                _ => {}
            }
        }
        gpu.queue.submit([encoder.finish()]);
        host.insert(&circles().map(|(region, _)| region));
        host.draw();
        let bytes = read(gpu, &answers);
        for (pick, answer) in picks.iter().zip(bytes.chunks_exact(Pick::BYTES as usize)) {
            assert_eq!(pick.fills(answer), shown);
        }
        assert!(host.pick_at(CENTRE).len() == 4, "the next frame is another");
    }
}

#[test]
fn changes_between_prepare_and_count_leave_the_order() {
    let Some(gpu) = gpu() else { return };
    let [small, middle, large] = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let removed = host.insert(from_ref(&middle));
        let mesh = host.insert(&[small.clone(), large.clone()]);
        host.prepare();
        host.renderer.remove(removed).expect("it is there");
        host.restyle(mesh, 0, |style| style.z_index = 3);
        host.insert(from_ref(&middle));
        let (_, depth) = depth_texture(gpu, &host.surface, host.options.depth_format);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        host.renderer.count(&mut host.view, &mut encoder, &depth);
        gpu.queue.submit([encoder.finish()]);
        // What is gone cannot be counted; all else is as prepared.
        let fills = [1, 0].map(|fill| PickedFill { mesh, fill });
        assert_eq!(host.pick_at(CENTRE), fills);
    }
}

#[test]
fn views_are_asked_apart() {
    let Some(gpu) = gpu() else { return };
    let [small, _, large] = circles().map(|(region, _)| region);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[small, large]);
    host.draw();
    let first = std::mem::take(&mut host.view);
    host.restyle(mesh, 1, |style| style.visible = false);
    host.draw();
    let fill = |fill| PickedFill { mesh, fill };
    assert_eq!(host.pick_at(CENTRE), [fill(0)]);
    host.view = first;
    assert_eq!(host.pick_at(CENTRE), [fill(1), fill(0)]);
}

#[test]
fn pixels_outside_the_frame_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    host.insert(&[region]);
    let answers = readable(gpu, Pick::BYTES);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut refused = |host: &Host<'_>, pixel| {
        let asked = host
            .renderer
            .read_fills(&host.view, &mut encoder, pixel, &answers, 0);
        asked.err() == Some(RendererError::NoSuchPixel(pixel))
    };
    assert!(refused(&host, UVec2::ZERO), "nothing was prepared");
    host.draw();
    let last = SIZE - UVec2::ONE;
    assert!(!refused(&host, last));
    for pixel in [
        UVec2::new(SIZE.x, 0),
        UVec2::new(0, SIZE.y),
        SIZE,
        UVec2::MAX,
    ] {
        assert!(refused(&host, pixel), "{pixel}");
    }
}

#[test]
fn what_is_no_answer_names_no_fills() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[region]);
    host.draw();
    let answers = readable(gpu, Pick::BYTES);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let asked = host
        .renderer
        .read_fills(&host.view, &mut encoder, SKY, &answers, 0);
    let pick = asked.expect("the pixel is in the picture");
    let mut bytes = vec![0; Pick::BYTES as usize + 5];
    bytes[0] = 1;
    let found = [PickedFill { mesh, fill: 0 }];
    assert_eq!(pick.fills(&bytes), found);
    assert_eq!(pick.fills(&bytes[..Pick::BYTES as usize]), found);
    assert_eq!(pick.fills(&bytes[..Pick::BYTES as usize - 1]), []);
    assert_eq!(pick.fills(&[]), []);
    // Ids that no layer has.
    assert_eq!(pick.fills(&[0xff; Pick::BYTES as usize]), []);
}

#[test]
fn styles_can_be_asked_for() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[region.clone(), region]);
    let style = FillStyle {
        z_index: -4,
        ..Default::default()
    };
    host.renderer.set_style(mesh, 1, style).expect("sound");
    assert_eq!(host.renderer.style(mesh, 0), Ok(FillStyle::default()));
    assert_eq!(host.renderer.style(mesh, 1), Ok(style));
    let beyond = RendererError::NoSuchFill { fill: 2, fills: 2 };
    assert_eq!(host.renderer.style(mesh, 2), Err(beyond));
    host.renderer.remove(mesh).expect("it is there");
    assert_eq!(host.renderer.style(mesh, 0), Err(RendererError::NoSuchMesh));
}
