//! Images that are not there, that are shown, or that are too large.

use globefill::{
    FillStyle, Hatch, HatchKind, Image, ImageFill, Pattern, RendererError, StyleError, Wrap,
};

use crate::{
    PLACES, SMALL,
    common::headless::gpu_limited,
    refusals::hatched,
    stage::{Stage, bare, ground, pose},
};

#[test]
fn images_that_are_not_there_or_too_large() {
    let Some(gpu) = gpu_limited(|limits| limits.max_texture_dimension_2d = 2048) else {
        return;
    };
    let surface = bare(&pose(PLACES[0], 1e4, 0.0), SMALL);
    let mut stage = Stage::new(&gpu, ground(PLACES[0]), &surface);
    let image = |width: u32, height: u32| {
        let texels = vec![90; (4 * width * height) as usize];
        Image::from_rgba8(width, height, &texels).expect("an image")
    };
    let large = stage
        .renderer
        .insert_images(&gpu.queue, &[image(4, 4), image(2049, 1)]);
    let (width, height, most) = (2049, 1, 2048);
    assert_eq!(
        large,
        Err(RendererError::ImageTooLarge {
            width,
            height,
            most
        })
    );
    let fits = stage.renderer.insert_image(&gpu.queue, &image(2048, 1));
    let fits = fits.expect("as large as can be");

    let shows = |image| FillStyle {
        pattern: Some(Pattern::Image(ImageFill {
            wrap: Wrap::Repeat,
            ..ImageFill::new(image)
        })),
        ..Default::default()
    };
    let tiles = |image| {
        hatched(Hatch {
            kind: HatchKind::Image(image),
            ..Default::default()
        })
    };
    let mesh = stage.mesh;
    for style in [shows(fits), tiles(fits)] {
        stage.set(0, style);
        assert_eq!(
            stage.renderer.remove_image(fits),
            Err(RendererError::ImageInUse)
        );
        stage.draw(&surface);
        stage.set(0, FillStyle::default());
    }
    stage
        .renderer
        .remove_image(fits)
        .expect("no style shows it any more");
    assert_eq!(
        stage.renderer.remove_image(fits),
        Err(RendererError::NoSuchImage)
    );
    let missing = RendererError::InvalidStyle {
        fill: 0,
        error: StyleError::NoSuchImage,
    };
    for style in [shows(fits), tiles(fits)] {
        assert_eq!(
            stage.renderer.set_style(mesh, 0, style),
            Err(missing.clone())
        );
        assert_eq!(stage.renderer.style(mesh, 0), Ok(FillStyle::default()));
    }
    // The place of the removed one is taken by another, which is not the same.
    let next = stage
        .renderer
        .insert_image(&gpu.queue, &image(2048, 1))
        .expect("it fits");
    assert_ne!(next, fits);
    assert_eq!(stage.renderer.set_style(mesh, 0, shows(fits)), Err(missing));
    stage.set(0, shows(next));
    stage.draw(&surface);
}
