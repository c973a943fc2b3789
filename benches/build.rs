//! CPU stages from embedded boundaries to a mesh, and what a frame costs before the GPU.
//!
//! `cargo bench --bench build`

use criterion::{Criterion, criterion_group, criterion_main};
use globefill::{
    FillMesh, MeshOptions, Region, countries::Dataset, geo_json::regions_from_geojson,
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
    }
    let text = geojson_text();
    criterion.bench_function("geojson/square", |bencher| {
        bencher.iter(|| regions_from_geojson(&text));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = build
}
criterion_main!(benches);
