//! CPU stages from embedded boundaries to a mesh, and what a frame costs before the GPU.
//!
//! `cargo bench --bench build`

use criterion::{Criterion, criterion_group, criterion_main};
use earcut::Earcut;
use globefill::{
    FillMesh, Locator, LonLat, MeshOptions, Region, countries::Dataset,
    geo_json::regions_from_geojson,
};

fn regions(dataset: Dataset) -> Vec<Region> {
    dataset
        .countries()
        .into_iter()
        .map(|country| country.region)
        .collect()
}

/// A square with a hole, as text.
fn geojson_text() -> String {
    let ring = |half: f64| {
        let corners = [
            [-half, -half],
            [half, -half],
            [half, half],
            [-half, half],
            [-half, -half],
        ];
        serde_json::to_string(&corners).expect("finite")
    };
    format!(
        r#"{{"type":"Polygon","coordinates":[{},{}]}}"#,
        ring(10.0),
        ring(5.0)
    )
}

/// A yardstick: the same rings, as they are, triangulated on the plane of longitude and latitude.
fn cut_on_the_plane(regions: &[Region]) -> usize {
    let mut earcut = Earcut::new();
    let (mut triangles, mut count) = (Vec::<u32>::new(), 0);
    for polygon in regions.iter().flat_map(|region| &region.polygons) {
        let mut starts = Vec::new();
        let mut vertices: Vec<[f64; 2]> = Vec::new();
        for ring in std::iter::once(&polygon.shell).chain(&polygon.holes) {
            starts.push(vertices.len() as u32);
            vertices.extend(ring.iter().map(|vertex| [vertex.lon_deg, vertex.lat_deg]));
        }
        earcut.earcut(vertices, &starts[1..], &mut triangles);
        count += triangles.len() / 3;
    }
    count
}

fn build(criterion: &mut Criterion) {
    for (name, dataset) in [
        ("110m", Dataset::Countries110m),
        ("50m", Dataset::Countries50m),
        ("states", Dataset::UsStates),
    ] {
        criterion.bench_function(&format!("decode/{name}"), |bencher| {
            bencher.iter(|| dataset.countries());
        });
        let regions = regions(dataset);
        criterion.bench_function(&format!("mesh/{name}"), |bencher| {
            bencher.iter(|| FillMesh::build(&regions, &MeshOptions::default()));
        });
        criterion.bench_function(&format!("earcut/{name}"), |bencher| {
            bencher.iter(|| cut_on_the_plane(&regions));
        });
    }
    let text = geojson_text();
    criterion.bench_function("geojson/square", |bencher| {
        bencher.iter(|| regions_from_geojson(&text));
    });
}

fn answers(criterion: &mut Criterion) {
    let regions = regions(Dataset::Countries50m);
    let mesh = FillMesh::build(&regions, &MeshOptions::default()).expect("countries mesh");
    criterion.bench_function("locator/50m", |bencher| {
        bencher.iter(|| Locator::new(&mesh))
    });
    let locator = Locator::new(&mesh);
    let mut turn = 0.0_f64;
    criterion.bench_function("fills_at/50m", |bencher| {
        bencher.iter(|| {
            turn += 1.0;
            let (x, y) = (
                (turn * 0.754_877_666).fract(),
                (turn * 0.569_840_291).fract(),
            );
            locator.fills_at(LonLat::new(360.0 * x - 180.0, 180.0 * y - 90.0))
        });
    });
    criterion.bench_function("measures/50m", |bencher| {
        bencher.iter(|| {
            (0..mesh.fills.len() as u32)
                .map(|fill| mesh.area_m2(fill))
                .sum::<f64>()
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = build, answers
}
criterion_main!(benches);
