//! The least that a host does to fill a region: make a renderer, hand it a mesh, and call it three
//! times a frame. `host.rs` stands for your own application: it owns the device and draws the globe.

mod host;

use globefill::{
    FillMesh, FillStyle, Frame, HeightRange, MeshOptions, Renderer, RendererOptions, View,
    countries::Dataset,
};
use host::Host;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Your device, with the features that globefill likes to have.
    let options = RendererOptions::default(); // sRGB colour, reversed float depth, one sample
    let host = Host::open(Renderer::wanted_features(), &options)?;

    // Once: a renderer, and what is to be filled. Meshing needs no GPU and runs on any thread.
    let mut renderer = Renderer::new(&host.device, options)?;
    let italy = Dataset::Countries50m
        .country("Italy")
        .ok_or("no such country")?;
    let mesh = FillMesh::build(&[italy.region], &MeshOptions::default())?;
    let italy = renderer.insert(mesh);
    let green = FillStyle {
        color: [0.1, 0.6, 0.3, 0.8],
        ..Default::default()
    };
    renderer.set_style(italy, 0, green)?;
    let mut view = View::default(); // one for each camera

    // Every frame: the camera in double precision, and between which heights the ground lies.
    let frame = Frame {
        terrain: HeightRange {
            min_m: 0.0,
            max_m: 1e5,
        },
        ..Frame::new(host.camera(), host::SIZE)
    };
    let mut encoder = host.device.create_command_encoder(&Default::default());
    host.draw_globe(&mut encoder);
    let stats = renderer.prepare(&host.queue, &mut view, &frame)?;
    // After the depth is final, outside your passes:
    renderer.count(&mut view, &mut encoder, &host.depth_view);
    // In your own pass, which no longer has the depth attached:
    renderer.resolve(&view, &mut host.color_pass(&mut encoder));
    println!("{stats:?}");
    host.save(encoder, "out/embed.png")
}
