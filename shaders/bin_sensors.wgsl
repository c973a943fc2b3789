// Binning: for each tile, which sensors cover all of its surface (summed here, once) and which may
// cover some of it (listed, for the resolve to ask at each pixel).

// A ball around the surface in a tile: middle from the eye, radius; the radius is negative if there is
// only sky.
fn ball_of(corner: vec2<u32>) -> vec4<f32> {
    let end = min(corner + TILE, sight.size.xy);
    var least = 2.0;
    var most = -1.0;
    for (var y = corner.y; y < end.y; y += 1u) {
        for (var x = corner.x; x < end.x; x += 1u) {
            for (var sample = 0u; sample < SAMPLES; sample += 1u) {
                let depth = depth_at(vec2<u32>(x, y), sample);
                if !is_sky(depth) {
                    least = min(least, depth);
                    most = max(most, depth);
                }
            }
        }
    }
    if most < least {
        return vec4<f32>(0.0, 0.0, 0.0, -1.0);
    }
    // The tile's part of the frustum between the nearest and the farthest distance.
    let first = distance_of(least);
    let last = distance_of(most);
    let edges = array<vec2<u32>, 4>(
        corner, vec2<u32>(end.x, corner.y), vec2<u32>(corner.x, end.y), end,
    );
    let middle = ray_at(0.5 * vec2<f32>(corner + end)) * (0.5 * (first + last));
    var radius = 0.0;
    for (var k = 0; k < 4; k += 1) {
        let ray = ray_at(vec2<f32>(edges[k]));
        radius = max(radius, max(length(ray * first - middle), length(ray * last - middle)));
    }
    // Foot points lie hardly farther apart than what stands on them; the rest is for rounding.
    return vec4<f32>(middle, 1.05 * radius + 1e-5 * length(middle));
}

@compute @workgroup_size(64)
fn cs_bin(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= sight.size.w {
        return;
    }
    let corner = TILE * vec2<u32>(index % sight.size.z, index / sight.size.z);
    let ball = ball_of(corner);
    var tile: Tile;
    if ball.w >= 0.0 {
        tile.surface = 1u;
        let place = place_of(ball.xyz, ball.w);
        let capacity = sight.counts.y;
        for (var sensor = 0u; sensor < sight.counts.x; sensor += 1u) {
            let slack = slack_of(sensor, place, ball.w);
            if slack.x >= 0.0 {
                tile.weight += sensors[sensor].weight;
                tile.covering += 1u;
            } else if slack.y >= 0.0 {
                if tile.partly < capacity {
                    lists[index * capacity + tile.partly] = sensor;
                }
                tile.partly += 1u;
            }
        }
        if tile.partly > capacity {
            tile.weight = vec4<u32>(0u);
            tile.covering = 0u;
            tile.partly = UNLISTED;
        }
    }
    tiles[index] = tile;
}
