//! Styles in hosts of every kind: samples, depths, techniques, views, meshes, and images of several sizes.

use glam::{DVec2, UVec2};
use globefill::{
    CountTechnique, FillMesh, FillStyle, Hatch, Image, ImageFill, ImageId, LonLat, Pattern,
    Placement, Polygon, Region, View, Wrap,
};

use crate::{
    PLACES, SMALL,
    chart::{Layout, Spot},
    common::{
        headless::gpu,
        surface::{Cast, DepthKind, Surface, Terrain},
    },
    ramps::{Ramps, STEP},
    stage::{Stage, bare, built, figure, ground, pixel_m, pose},
};

fn shows(image: ImageId, placement: Placement) -> FillStyle {
    let fill = ImageFill {
        placement,
        wrap: Wrap::Repeat,
        ..ImageFill::new(image)
    };
    FillStyle {
        color: [0.0, 0.0, 0.0, 1.0],
        pattern: Some(Pattern::Image(fill)),
        ..Default::default()
    }
}

/// How far, texels, an enlarged image is off where the whole pixel shows ground.
fn picture_off(surface: &Surface, drawn: &[[u8; 4]], ramps: &Ramps, layout: &Layout) -> f64 {
    let count = surface.pixel_count();
    let samples = surface.samples() as usize;
    let mut worst = 0.0f64;
    let mut judged = 0;
    for pixel in (0..count).filter(|&pixel| !surface.at_discontinuity(pixel)) {
        let uvs: Vec<DVec2> = (0..samples)
            .filter_map(|sample| surface.points_m[sample * count + pixel])
            .map(|point_m| layout.uv(&figure(), point_m))
            .collect();
        let spread = uvs.iter().map(|uv| uv.distance(uvs[0])).fold(0.0, f64::max);
        if spread * ramps.size().max_element() > 1.0 {
            continue;
        }
        judged += 1;
        for (channel, &level) in drawn[pixel][..2].iter().enumerate() {
            let levels = uvs.iter().map(|&uv| ramps.level(uv, Wrap::Repeat)[channel]);
            let wanted = levels.sum::<f64>() / samples as f64;
            let off = f64::from(level) - wanted;
            worst = worst.max(off.abs() / STEP);
        }
    }
    assert!(3 * judged > count, "{judged} of {count}");
    worst
}

#[test]
fn samples_depths_and_techniques() {
    let Some(gpu) = gpu() else { return };
    let ramps = Ramps::new(200, 200);
    let mut worst = 0.0f64;
    for (height_m, share) in [(2.0, 0.4), (4e5, 0.3)] {
        let pose = pose(PLACES[0], height_m, share);
        let side_m = 1600.0 * pixel_m(&bare(&pose, SMALL));
        let size_m = DVec2::splat(f64::from(side_m as f32));
        let center = PLACES[0];
        let layout = Layout::new(Spot::Local { center, size_m });
        for samples in [1, 4] {
            let cast = Cast::new(&figure(), &pose, SMALL, samples, Terrain::Bare);
            for depth in [DepthKind::Reversed, DepthKind::Standard] {
                let surface = Surface::new(&cast, depth);
                for count in [CountTechnique::Winding, CountTechnique::Stencil] {
                    let mut stage = Stage::counted(gpu, ground(center), &surface, count);
                    let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
                    let size_m = size_m.as_vec2().to_array();
                    let place = Placement::Local { center, size_m };
                    stage.set(0, shows(image.expect("a small image"), place));
                    let drawn = stage.draw(&surface).texels;
                    let off = picture_off(&surface, &drawn, &ramps, &layout);
                    println!("{height_m} m {samples} samples {depth:?} {count:?}: {off:.4} texels");
                    worst = worst.max(off);
                }
            }
        }
    }
    // A texel takes eight pixels: a thirtieth of one is a quarter of a pixel.
    assert!(worst <= 0.03, "{worst}");
}

#[test]
fn views_of_one_renderer_keep_their_patterns() {
    let Some(gpu) = gpu() else { return };
    let surfaces = [
        bare(&pose(PLACES[0], 30.0, 0.5), SMALL),
        bare(
            &pose(LonLat::new(-70.0, -20.0), 2e7, 0.2),
            UVec2::new(50, 64),
        ),
        bare(&pose(PLACES[1], 3e4, 0.7), UVec2::new(70, 33)),
    ];
    let everywhere = || ground(LonLat::new(11.3, 20.0));
    let style = FillStyle {
        pattern: Some(Pattern::Hatch(Hatch {
            anchor: Some(PLACES[0]),
            ..Default::default()
        })),
        ..Default::default()
    };
    let alone = surfaces.each_ref().map(|surface| {
        let mut stage = Stage::new(gpu, everywhere(), surface);
        stage.set(0, style);
        stage.draw(surface).texels
    });
    let mut stage = Stage::new(gpu, everywhere(), &surfaces[0]);
    stage.set(0, style);
    let mut views: [View; 3] = Default::default();
    for round in 0..3 {
        for k in 0..3 {
            std::mem::swap(&mut stage.view, &mut views[k]);
            let painted = stage.draw(&surfaces[k]);
            std::mem::swap(&mut stage.view, &mut views[k]);
            assert!(painted.texels == alone[k], "round {round}, view {k}");
            assert!(round == 0 || painted.stats.upload_bytes == 0);
        }
    }
    // One view for all of them, one after the other.
    for k in [2, 0, 1, 0] {
        assert!(stage.draw(&surfaces[k]).texels == alone[k], "view {k}");
    }
}

/// Strips of two degrees from a longitude on.
fn strips(from_deg: f64, count: usize) -> FillMesh {
    let strip = |k: usize| {
        let west_deg = from_deg + 2.0 * k as f64;
        let corners = [(0.0, 40.0), (2.0, 40.0), (2.0, 54.0), (0.0, 54.0)];
        let shell = corners
            .map(|(east_deg, lat_deg)| LonLat::new(west_deg + east_deg, lat_deg))
            .to_vec();
        Region {
            polygons: vec![Polygon {
                shell,
                holes: vec![],
            }],
            edges: globefill::EdgeKind::Straight,
            ..Default::default()
        }
    };
    built(&(0..count).map(strip).collect::<Vec<_>>())
}

fn plain(width: u32, height: u32, color: [u8; 4]) -> Image {
    let texels = vec![color; (width * height) as usize];
    Image::from_rgba8(width, height, texels.as_flattened()).expect("an image")
}

/// Asserts the colour of each strip, away from its edges.
fn assert_strips(surface: &Surface, drawn: &[[u8; 4]], colors: &[[u8; 4]]) {
    let mut seen = vec![0; colors.len()];
    for (pixel, texel) in drawn.iter().enumerate() {
        let Some(point_m) = surface.points_m[pixel] else {
            continue;
        };
        let (foot, _) = figure().geodetic(point_m);
        let strip = (foot.lon_deg - 8.0) / 2.0;
        if strip < 0.0 || (foot.lat_deg - 47.0).abs() > 6.9 || (strip - strip.round()).abs() < 0.1 {
            continue;
        }
        let Some(color) = colors.get(strip as usize) else {
            continue;
        };
        assert_eq!(texel, color, "strip {strip}");
        seen[strip as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 20), "{seen:?}");
}

#[test]
fn images_of_several_sizes_in_several_meshes() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(LonLat::new(13.0, 47.0), 9e5, 0.0), SMALL);
    let [red, green, blue] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    let yellow = [255, 255, 0, 255];
    for count in [CountTechnique::Winding, CountTechnique::Stencil] {
        let mut stage = Stage::counted(gpu, strips(8.0, 3), &surface, count);
        let second = stage.renderer.insert(strips(14.0, 2));
        let sizes = [
            plain(4, 4, red),
            plain(16, 8, green),
            plain(4, 4, blue),
            plain(3, 50, red),
        ];
        let images = stage.renderer.insert_images(&gpu.queue, &sizes);
        let images = images.expect("small images");
        let over = |image| shows(image, Placement::Spherical(None));
        for (fill, image) in [(0, images[0]), (1, images[1]), (2, images[2])] {
            stage.set(fill, over(image));
        }
        let set = |stage: &mut Stage<'_>, fill, style| {
            let set = stage.renderer.set_style(second, fill, style);
            set.expect("the style is sound");
        };
        set(&mut stage, 0, over(images[3]));
        let white = FillStyle {
            color: [1.0; 4],
            ..Default::default()
        };
        set(&mut stage, 1, white);
        let painted = stage.draw(&surface);
        assert_strips(
            &surface,
            &painted.texels,
            &[red, green, blue, red, [255; 4]],
        );
        let three_sizes = painted.stats;

        // Removed, and another in its place, while the rest stays.
        stage.set(0, over(images[2]));
        stage
            .renderer
            .remove_image(images[0])
            .expect("no style shows it");
        let next = stage
            .renderer
            .insert_image(&gpu.queue, &plain(4, 4, yellow));
        let next = next.expect("a small image");
        let painted = stage.draw(&surface);
        assert_strips(
            &surface,
            &painted.texels,
            &[blue, green, blue, red, [255; 4]],
        );
        stage.set(0, over(next));
        let painted = stage.draw(&surface);
        assert_strips(
            &surface,
            &painted.texels,
            &[yellow, green, blue, red, [255; 4]],
        );
        assert_eq!(painted.stats.draws, three_sizes.draws);

        // Each mesh is a layer; the first one showed two sizes and shows one.
        stage.set(1, over(next));
        set(&mut stage, 0, over(images[2]));
        let painted = stage.draw(&surface);
        assert_strips(
            &surface,
            &painted.texels,
            &[yellow, yellow, blue, blue, [255; 4]],
        );
        if count == CountTechnique::Winding {
            assert_eq!(painted.stats.layers, 2);
            assert_eq!(painted.stats.draws + 1, three_sizes.draws);
        }
        stage.renderer.remove(second).expect("it is there");
        let painted = stage.draw(&surface);
        assert_strips(
            &surface,
            &painted.texels,
            &[yellow, yellow, blue, [0; 4], [0; 4]],
        );
    }
}
