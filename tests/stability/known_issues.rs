//! Cells that fail, and why. Each names its cause as far as it is known.

use globefill::EdgeKind;

use crate::{
    common::headless::gpu,
    gate::Gate,
    placement::POLE_EDGE,
    shapes,
    shot::{BARE, Shot},
    subject::Subject,
};

#[test]
#[ignore = "known issue: "]
fn a_pixel_amid_a_disc_of_85_degrees() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("known issue", gpu);
    let shape = &shapes::great()[0];
    let subject = Subject::placed(shape, &POLE_EDGE, EdgeKind::Geodesic);
    let shots: Vec<Shot> = BARE.into_iter().skip(8).take(1).collect();
    gate.check(&subject, &shots);
    gate.finish();
}

#[test]
#[ignore = "scratch"]
fn scratch() {
    use crate::common::{
        camera::Pose,
        draw::IdPainter,
        surface::{Cast, DepthKind, Surface, Terrain},
    };
    use globefill::{CountTechnique, View};
    let Some(gpu) = gpu() else { return };
    let subject = &crate::real::countries()[0];
    let figure = &subject.oracle.figure;
    let shot = crate::shot::HIGH_AND_LOW[3];
    let first = shot.pose(figure, &subject.foci);
    let n = figure.normal(first.at);
    println!(
        "{first:?} ground {} mesh {} {} sag {}",
        shot.terrain.height_m(n),
        subject.mesh.arcs.len(),
        subject.mesh.vertices.len(),
        subject.mesh.sag_m
    );
    for (k, scale) in [(1, 1), (1, 8), (2, 8)] {
        let terrain = Terrain::Deep;
        let ground = terrain.height_m(n);
        let pose = Pose { height_m: ground + 1.0 + f64::from(k) * 0.1, ..first };
        let size = glam::UVec2::new(320, 180) * scale;
        let cast = Cast::new(figure, &pose, size, 1, terrain);
        let surface = Surface::new(&cast, DepthKind::Reversed);
        let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surface, CountTechnique::Winding);
        let picture = painter.draw(gpu, &mut View::default(), &surface, 0.0);
        let expected = crate::common::score::expected_ids(&subject.oracle, &surface);
        let w = size.x as usize;
        let wrong: Vec<_> = (0..picture.ids.len()).filter(|&p| picture.ids[p] != expected[p]).map(|p| ((p % w) as f64 / f64::from(scale) - 160.0, (p / w) as f64 / f64::from(scale) - 90.0, picture.ids[p], expected[p])).collect();
        println!("{k} {scale}: {} {:?}", wrong.len(), wrong.iter().take(60).collect::<Vec<_>>());
    }
    for edge in subject.oracle.boundary(0).filter(|e| e.from.lat_deg < -89.99 && e.to.lat_deg < -89.99) {
        println!("{:?} {:?} {}", edge.from, edge.to, edge.radius_m);
    }
}
