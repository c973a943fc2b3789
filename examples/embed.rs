//! All that goes into an application that draws a globe already: a renderer, a mesh, three calls a
//! frame. `embed/host.rs` stands for that application; it knows nothing of fills.

#[path = "embed/host.rs"]
mod host;

use globefill::{
    Camera, FillMesh, FillStyle, Frame, MeshOptions, Renderer, RendererOptions, View,
    countries::Dataset,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Your device, with those of the features that your adapter has.
    let host = host::Host::open(Renderer::wanted_features())?;

    // Once: a renderer, and what is to be filled. Meshing needs no GPU and runs on any thread.
    let options = RendererOptions {
        color_format: host::COLOR,
        depth_format: host::DEPTH,
        ..Default::default() // reversed depth, one sample a pixel
    };
    let mut renderer = Renderer::new(&host.device, options)?;
    let italy = Dataset::Countries50m.country("Italy");
    let italy = italy.ok_or("no such country")?;
    let mesh = FillMesh::build(&[italy.region], &MeshOptions::default())?;
    let mesh = renderer.insert(mesh);
    let green = FillStyle {
        color: [0.1, 0.6, 0.3, 0.8],
        ..Default::default()
    };
    renderer.set_style(mesh, 0, green)?;
    let mut view = View::default(); // one for each camera

    // Every frame: your camera in double precision, your globe, and then
    let eye = host.eye();
    let camera = Camera {
        eye_ecef_m: eye.position_m,
        view_from_ecef: eye.view_from_ecef,
        clip_from_view: eye.clip_from_view,
    };
    let mut encoder = host.device.create_command_encoder(&Default::default());
    host.draw_globe(&mut encoder);
    let frame = Frame::new(camera, host::SIZE); // with terrain, say its heights here
    let stats = renderer.prepare(&host.queue, &mut view, &frame)?;
    // after the depth is final, outside your passes:
    renderer.count(&mut view, &mut encoder, &host.depth_view);
    // in a pass of yours that does not have that depth attached:
    renderer.resolve(&view, &mut host.color_pass(&mut encoder));

    println!("{stats:?}");
    host.save(encoder, "out/embed.png")
}
