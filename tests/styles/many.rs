//! Layers with more styles than uniforms hold look like those with few.

use globefill::{
    FillMesh, FillStyle, Hatch, HatchKind, Image, ImageFill, LonLat, Pattern, Polygon, Region,
    Stroke, Zone,
};

use crate::{
    PLACES, SMALL,
    common::headless::gpu,
    stage::{Stage, bare, built, pose},
};

/// Two fills in sight, and `others` on the far side of the globe.
fn scattered(others: u32) -> FillMesh {
    let seen = [1.0, 2.0].map(|size| Region::from(Zone::circle(PLACES[0], size * 1e5)));
    let far = (0..others).map(|index| {
        let lon_deg = 150.0 + f64::from(index % 40);
        let lat_deg = -60.0 + f64::from(index / 40);
        let corners = [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)];
        let ring = corners.map(|(east, north)| LonLat::new(lon_deg + east, lat_deg + north));
        Region {
            polygons: vec![Polygon {
                shell: ring.to_vec(),
                holes: Vec::new(),
            }],
            ..Default::default()
        }
    });
    built(&seen.into_iter().chain(far).collect::<Vec<_>>())
}

fn hatched(kind: HatchKind) -> FillStyle {
    let hatch = Hatch {
        kind,
        share: 0.3,
        ..Default::default()
    };
    FillStyle {
        color: [0.3, 0.6, 0.9, 0.5],
        highlight: [1.0, 1.0, 0.0, 0.2],
        pattern: Some(Pattern::Hatch(hatch)),
        ..Default::default()
    }
}

#[test]
fn many_styles_look_like_few() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 3e5, 0.4), SMALL);
    // Few; more styles than fit; more places of patterns, too.
    let pictures = [0, 460, 1100].map(|others| {
        let mut stage = Stage::new(gpu, scattered(others), &surface);
        let texels: Vec<u8> = (0..4 * 32 * 32_u32).map(|byte| (byte * 37) as u8).collect();
        let image = Image::from_rgba8(32, 32, &texels).expect("an image");
        let inserted = stage.renderer.insert_image(&gpu.queue, &image);
        let picture = ImageFill::new(inserted.expect("a small image"));
        for fill in 0..others + 2 {
            stage.set(fill, hatched(HatchKind::Dots));
        }
        let stroked = FillStyle {
            stroke: Some(Stroke::default()),
            ..hatched(HatchKind::Cross)
        };
        stage.set(0, stroked);
        let pattern = Some(Pattern::Image(picture));
        stage.set(
            1,
            FillStyle {
                pattern,
                ..hatched(HatchKind::Lines)
            },
        );
        let painted = stage.draw(&surface);
        assert!(painted.stats.styled_layers > 0);
        painted.texels
    });
    let colors: std::collections::BTreeSet<_> = pictures[0].iter().collect();
    assert!(colors.len() > 100, "{} colours", colors.len());
    assert!(pictures[1] == pictures[0], "more styles");
    assert!(pictures[2] == pictures[0], "more places");
}
