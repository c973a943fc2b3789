//! The shaders' arctangent against f64, beside the built-in one.

mod common;

use common::headless::{Gpu, gpu};
use globefill::{shaders, wgpu};
use wgpu::util::DeviceExt;

/// A dispatch has at most 65535 workgroups.
const WORKGROUP: usize = 64;
const RANDOM_PAIRS: usize = 1 << 20;
/// What angle_of may be off by, as a share of the angle: what its comment says, and some of what a
/// division may err by.
const RELATIVE: f64 = 5e-7;
/// Angles this small may be flushed to zero.
const SMALLEST_RAD: f64 = f32::MIN_POSITIVE as f64;
const EARTH_RADIUS_M: f64 = 6_378_137.0;

const EVALUATE: &str = "
@group(0) @binding(0) var<storage, read> pairs: array<vec2<f32>>;
@group(0) @binding(1) var<storage, read_write> angles: array<vec2<f32>>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {
    let pair = pairs[id.x];
    angles[id.x] = vec2<f32>(angle_of(pair.x, pair.y), atan2(pair.x, pair.y));
}
";

#[test]
fn angles_are_those_of_f64() {
    let Some(gpu) = gpu() else { return };
    let pairs = pairs();
    let angles = evaluate(gpu, &pairs);
    let mut ours = Worst::default();
    let mut built_in = Worst::default();
    for (&[y, x], &[our_angle, built_in_angle]) in pairs.iter().zip(&angles) {
        if y == 0.0 && x == 0.0 {
            // The built-in one may say anything.
            assert_eq!(our_angle, 0.0);
            continue;
        }
        let expected = f64::from(y).atan2(f64::from(x));
        ours.add(f64::from(our_angle), expected);
        built_in.add(f64::from(built_in_angle), expected);
        let error = (f64::from(our_angle) - expected).abs();
        assert!(
            error <= RELATIVE * expected.abs() + SMALLEST_RAD,
            "angle_of({y:e}, {x:e}) is {our_angle:e}, not {expected:e}"
        );
    }
    println!("{}, {} pairs", gpu.adapter.name, pairs.len());
    println!("angle_of: {ours}");
    println!("atan2:    {built_in}");
}

/// Pairs (y, x): random ones, then each axis and diagonal and the origin.
fn pairs() -> Vec<[f32; 2]> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut pairs: Vec<[f32; 2]> = (0..RANDOM_PAIRS)
        .map(|k| match k % 4 {
            // Even in angle, all octants.
            0 | 1 => {
                let (y, x) = (std::f64::consts::TAU * random.next()).sin_cos();
                let length = (8.0 * random.next() - 4.0).exp2();
                [(y * length) as f32, (x * length) as f32]
            }
            // Ratios from 2^-120 to 2^120.
            2 => [random.magnitude(60.0), random.magnitude(60.0)],
            // Near the diagonals, where octants meet.
            _ => {
                let x = random.magnitude(20.0);
                let y = f64::from(x) * (1.0 + 1e-3 * (random.next() - 0.5));
                [(y * random.sign()) as f32, x]
            }
        })
        .collect();
    for length in [1e-30, 1e-6, 1.0, 3.0, 6.4e6, 1e18] {
        for y in [-length, 0.0, length] {
            for x in [-length, 0.0, length] {
                pairs.push([y, x]);
            }
        }
    }
    pairs.resize(pairs.len().next_multiple_of(WORKGROUP), [1.0, 1.0]);
    pairs
}

/// SplitMix64.
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn sign(&mut self) -> f64 {
        if self.next() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Of either sign, from 2^-most to 2^most.
    fn magnitude(&mut self, most: f64) -> f32 {
        (self.sign() * (most * (2.0 * self.next() - 1.0)).exp2()) as f32
    }
}

#[derive(Default)]
struct Worst {
    rad: f64,
    relative: f64,
}

impl Worst {
    fn add(&mut self, angle_rad: f64, expected_rad: f64) {
        let error_rad = (angle_rad - expected_rad).abs();
        self.rad = self.rad.max(error_rad);
        if expected_rad.abs() > 1e6 * SMALLEST_RAD {
            self.relative = self.relative.max(error_rad / expected_rad.abs());
        }
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let on_ground_m = self.rad * EARTH_RADIUS_M;
        write!(
            formatter,
            "off by {:.2e} rad, {on_ground_m:.2} m on the ground; {:.2e} of the angle",
            self.rad, self.relative
        )
    }
}

/// Of each pair, angle_of and the built-in function.
fn evaluate(gpu: &Gpu, pairs: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("arctangent"),
        source: wgpu::ShaderSource::Wgsl((shaders::arctangent() + EVALUATE).into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("arctangent"),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let given = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("pairs"),
        contents: bytemuck::cast_slice(pairs),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let buffer = |label, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: given.size(),
            usage,
            mapped_at_creation: false,
        })
    };
    let answers = buffer(
        "angles",
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    );
    let read = buffer(
        "readback",
        wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
    );
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("arctangent"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: given.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: answers.as_entire_binding(),
            },
        ],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.dispatch_workgroups((pairs.len() / WORKGROUP) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&answers, 0, &read, 0, given.size());
    gpu.queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |result| {
        result.expect("the buffer can be mapped");
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = read.get_mapped_range(..).expect("it is mapped");
    bytemuck::cast_slice(&bytes).to_vec()
}
