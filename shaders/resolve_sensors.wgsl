// Resolving sensors: the sums of all that cover the surface at a pixel become a colour. Sums are of
// integers, so their order does not matter.

// Premultiplied colours by the number of sensors, the last for more.
@group(0) @binding(2) var<storage, read> coverage_colors: array<vec4<f32>>;

struct Sums {
    weight: vec4<u32>,
    covering: u32,
}

struct BlockVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) block: u32,
}

// A rectangle a block; none for blocks where nothing is to be drawn.
@vertex
fn vs_block(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) index: u32,
) -> BlockVertex {
    let gaps = sight.counts.w != 0u;
    let drawn = shows_surface(blocks[index])
        && (gaps || blocks[index].covering + blocks[index].partly > 0u);
    let corner = block_at(index) + vec2<u32>(vertex & 1u, vertex >> 1u);
    let at_px = vec2<f32>(min(TILE * BLOCK * corner, sight.size.xy));
    let clip = at_px / vec2<f32>(sight.size.xy) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    var out: BlockVertex;
    out.position = vec4<f32>(select(vec2<f32>(-2.0), clip, drawn), 0.0, 1.0);
    out.block = index;
    return out;
}

fn sums_at(pixel: vec2<u32>, sample: u32, block: u32) -> Sums {
    let depth = depth_at(pixel, sample);
    if is_sky(depth) {
        discard;
    }
    let at = pixel / TILE;
    // Whom to ask: the tile's list, or the block's, or all.
    var lister = tiles[at.y * sight.tiles.x + at.x];
    var sums = Sums(lister.weight, lister.covering);
    if lister.partly == UNLISTED {
        lister = blocks[block];
        lister.strays = 1u;
    }
    let listed = lister.partly != UNLISTED;
    let asked = select(sight.counts.x, lister.partly, listed);
    if asked + lister.strays > 0u {
        let at_px = vec2<f32>(pixel) + sample_px(sample);
        let place = place_of(from_eye_at(at_px, distance_of(depth)), 0.0);
        if strays(place, 0.0) {
            discard;
        }
        var asking = Cursor(lister.page, 0u);
        for (var k = 0u; k < asked; k += 1u) {
            let sensor = next_sensor(&asking, listed);
            if covers(sensor, place) {
                sums.weight += sensors[sensor].weight;
                sums.covering += 1u;
            }
        }
    }
    return sums;
}

// Translucent footprints, each absorbing like a filter: colours weighted by optical depth.
fn blended(sums: Sums) -> vec4<f32> {
    let depth = f32(sums.weight.w);
    let alpha = 1.0 - exp(-depth * sight.bounds.z);
    return vec4<f32>(vec3<f32>(sums.weight.xyz) / max(depth, 1.0) * alpha, alpha);
}

fn coverage(sums: Sums) -> vec4<f32> {
    return coverage_colors[min(sums.covering, sight.counts.z - 1u)];
}

@fragment
fn fs_blended(in: BlockVertex) -> @location(0) vec4<f32> {
    return blended(sums_at(vec2<u32>(in.position.xy), 0u, in.block));
}

@fragment
fn fs_coverage(in: BlockVertex) -> @location(0) vec4<f32> {
    return coverage(sums_at(vec2<u32>(in.position.xy), 0u, in.block));
}

@fragment
fn fs_blended_sample(in: BlockVertex, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    return blended(sums_at(vec2<u32>(in.position.xy), sample, in.block));
}

@fragment
fn fs_coverage_sample(in: BlockVertex, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    return coverage(sums_at(vec2<u32>(in.position.xy), sample, in.block));
}
