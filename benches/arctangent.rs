//! What an angle costs a shader and how far it is off: built-in, polynomials, and the map form of
//! shaders/map.wgsl, which needs none. The sum alone is meant as their
//! floor; on lavapipe the map form takes less, unexplained: do not subtract it.
//!
//! `cargo bench --bench arctangent`

use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use globefill::{shaders, wgpu};
use wgpu::util::DeviceExt;

const EVALUATIONS: usize = 1 << 20;
const REPEATS: usize = 16;
const EARTH_RADIUS_M: f64 = 6_378_137.0;
/// From the anchor of the map to the eye's foot point.
const ANCHOR_RAD: f64 = 0.3;

/// Around one of the functions `measured`, called in SUM, unrolled. The first two of `given` are the map's gradient and fall, the
/// others (sine, cosine, cosine - 1, 0) of an angle.
const AROUND: &str = "
@group(0) @binding(0) var<storage, read> given: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(64)
fn repeat(@builtin(global_invocation_id) id: vec3<u32>) {
    let u = given[0];
    let fall = given[1];
    let at = given[id.x + 2u];
    var sum = 0.0;
    SUM
    sums[id.x] = sum;
}

fn measured(at: vec4<f32>, u: vec4<f32>, fall: vec4<f32>) -> f32 {
";

const ALONE: &str = "return at.x + at.y; }";
const BUILT_IN: &str = "return atan2(at.x, at.y); }";
const ANGLE_OF: &str = "return angle_of(at.x, at.y); }\n";
const ON_MAP: &str = "
    let from_foot = vec3<f32>(at.z, at.x, at.w);
    return dot(u.xyz, from_foot) / max(u.w + dot(fall.xyz, from_foot), 1e-9);
}";

/// Minimax fits of atan(q)/q in q^2 on 0 ... 1, relative, as the shipped one; highest power first.
const SIX: [f32; 6] = [
    -0.013_480_47,
    0.057_477_314,
    -0.121_239_07,
    0.195_635_93,
    -0.332_994_6,
    0.999_995_63,
];
const SEVEN: [f32; 7] = [
    0.007_863_377,
    -0.037_013,
    0.083_871_19,
    -0.134_871_92,
    0.198_814_83,
    -0.333_265_15,
    0.999_999_35,
];

/// The shipped arctangent with other terms.
fn with_terms(terms: &[f32]) -> String {
    let shipped = shaders::arctangent();
    let (before, rest) = shipped.split_once("var fit").expect("it has a fit");
    let (_, after) = rest.split_once("let octant").expect("it has an octant");
    let mut fit = format!("var fit = {:e};\n", terms[0]);
    for term in &terms[1..] {
        fit += &format!("fit = fma(s, fit, {term:e});\n");
    }
    format!("{ANGLE_OF}{before}{fit}let octant{after}")
}

type Wide = [f64; 4];

/// The error in radians of what was returned at a place, by f64.
type Error = fn(returned: f64, at: Wide, u: Wide, fall: Wide) -> f64;

fn angle_error(returned: f64, at: Wide, _: Wide, _: Wide) -> f64 {
    (returned - at[0].atan2(at[1])).abs()
}

/// A coordinate grows by 1 / nearness per radian.
fn map_error(returned: f64, at: Wide, u: Wide, fall: Wide) -> f64 {
    let nearness = u[3] + fall[0] * at[2] + fall[1] * at[0];
    (returned - (u[0] * at[2] + u[1] * at[0]) / nearness).abs() * nearness
}

/// Angles to a quarter turn from the foot point: no eye sees farther.
fn given() -> Vec<[f32; 4]> {
    let (sin, cos) = ANCHOR_RAD.sin_cos();
    let foot = -2.0 * (ANCHOR_RAD / 2.0).tan();
    let u = [
        -sin - foot * cos / 2.0,
        cos - foot * sin / 2.0,
        0.0,
        (1.0 + cos) / 2.0,
    ];
    let angles = (0..EVALUATIONS).map(|k| {
        let part = (k as f64 + 0.5) / EVALUATIONS as f64;
        let (sin, cos) = ((part - 0.5) * std::f64::consts::PI).sin_cos();
        [sin, cos, cos - 1.0, 0.0]
    });
    let rows = [u, [cos / 2.0, sin / 2.0, 0.0, 0.0]];
    rows.into_iter()
        .chain(angles)
        .map(|row| row.map(|number| number as f32))
        .collect()
}

struct Bench {
    device: wgpu::Device,
    queue: wgpu::Queue,
    given: wgpu::Buffer,
    sums: wgpu::Buffer,
    read: wgpu::Buffer,
}

impl Bench {
    async fn open(given: &[[f32; 4]]) -> Option<Self> {
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = instance.request_adapter(&Default::default()).await.ok()?;
        println!("{}", adapter.get_info().name);
        let (device, queue) = adapter.request_device(&Default::default()).await.ok()?;
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 4 * EVALUATIONS as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            given: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::cast_slice(given),
                usage: wgpu::BufferUsages::STORAGE,
            }),
            sums: buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
            device,
            queue,
        })
    }

    fn pipeline(&self, measured: &str, repeats: usize) -> wgpu::ComputePipeline {
        let call = |k| format!("sum += measured(at + {:e}, u, fall);\n", k as f64 * 1e-4);
        let sum: String = (0..repeats).map(call).collect();
        let source = AROUND.replace("SUM", &sum) + measured;
        let module = wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        };
        self.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &self.device.create_shader_module(module),
                entry_point: None,
                compilation_options: Default::default(),
                cache: None,
            })
    }

    fn run(&self, pipeline: &wgpu::ComputePipeline) {
        let entries = [&self.given, &self.sums].map(wgpu::Buffer::as_entire_binding);
        let mut binding = 0..;
        let entries = entries.map(|resource| wgpu::BindGroupEntry {
            binding: binding.next().unwrap_or_default(),
            resource,
        });
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(EVALUATIONS as u32 / 64, 1, 1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.expect("the device answers");
    }

    /// The worst error of single evaluations.
    fn worst_rad(&self, measured: &str, given: &[[f32; 4]], error: Error) -> f64 {
        self.run(&self.pipeline(measured, 1));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.sums, 0, &self.read, 0, self.read.size());
        self.queue.submit([encoder.finish()]);
        self.read
            .map_async(wgpu::MapMode::Read, .., |result| result.expect("mappable"));
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.expect("the device answers");
        let bytes = self.read.get_mapped_range(..).expect("it is mapped");
        let returned: Vec<f32> = bytemuck::cast_slice(&bytes).to_vec();
        drop(bytes);
        self.read.unmap();
        let [u, fall] = [given[0], given[1]].map(|row| row.map(f64::from));
        let errors = returned
            .iter()
            .zip(&given[2..])
            .map(|(&returned, at)| error(f64::from(returned), at.map(f64::from), u, fall));
        errors.fold(0.0, f64::max)
    }
}

fn angles(criterion: &mut Criterion) {
    let given = given();
    let Some(bench) = pollster::block_on(Bench::open(&given)) else {
        eprintln!("no adapter: nothing is measured");
        return;
    };
    let eight = ANGLE_OF.to_owned() + &shaders::arctangent();
    let forms: [(&str, String, Option<Error>); 6] = [
        ("sum alone", ALONE.to_owned(), None),
        ("built-in atan2", BUILT_IN.to_owned(), Some(angle_error)),
        ("6 terms", with_terms(&SIX), Some(angle_error)),
        ("7 terms", with_terms(&SEVEN), Some(angle_error)),
        ("8 terms, shipped", eight, Some(angle_error)),
        ("on_map", ON_MAP.to_owned(), Some(map_error)),
    ];
    let mut group = criterion.benchmark_group("angle");
    let count = (EVALUATIONS * REPEATS) as u64;
    group
        .throughput(Throughput::Elements(count))
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    for (name, measured, error) in &forms {
        let pipeline = bench.pipeline(measured, REPEATS);
        let mut fastest = Duration::MAX;
        group.bench_function(*name, |bencher| {
            bencher.iter_custom(|runs| {
                let started = Instant::now();
                (0..runs).for_each(|_| bench.run(&pipeline));
                let taken = started.elapsed();
                fastest = fastest.min(taken.div_f64(runs as f64));
                taken
            });
        });
        let each_ns = fastest.as_secs_f64() * 1e9 / count as f64;
        print!("{name}: {each_ns:.3} ns at best");
        match error.map(|error| bench.worst_rad(measured, &given, error)) {
            Some(worst) => println!(", off by {worst:.2e} rad, {:.3} m", worst * EARTH_RADIUS_M),
            None => println!(),
        }
    }
}

criterion_group!(benches, angles);
criterion_main!(benches);
