// Binning: for each block, then for each tile, which sensors cover all of its surface (summed, once)
// and which may cover some of it (listed, to be asked again nearer by). A slack that is no number, which
// the middle of the Earth can have, is listed.

// The surface's distances within each tile.
@compute @workgroup_size(64)
fn cs_range(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= sight.tiles.z {
        return;
    }
    let corner = TILE * tile_at(id.x);
    let end = min(corner + TILE, sight.size.xy);
    var least = 2.0;
    var most = -1.0;
    for (var y = corner.y; y < end.y; y += 1u) {
        for (var x = corner.x; x < end.x; x += 1u) {
            for (var sample = 0u; sample < SAMPLES; sample += 1u) {
                let depth = depth_at(vec2<u32>(x, y), sample);
                let sky = is_sky(depth);
                least = select(min(least, depth), least, sky);
                most = select(max(most, depth), most, sky);
            }
        }
    }
    var tile: Tile;
    tile.nearest = 1.0;
    if most >= least {
        let distances = vec2<f32>(distance_of(least), distance_of(most));
        tile.nearest = min(distances.x, distances.y);
        tile.farthest = max(distances.x, distances.y);
    }
    tiles[id.x] = tile;
}

// A ball around the surface within a rectangle of pixels: its middle from the eye, its radius.
fn ball_of(corner: vec2<u32>, end: vec2<u32>, tile: Tile) -> vec4<f32> {
    let edges = array<vec2<u32>, 4>(
        corner, vec2<u32>(end.x, corner.y), vec2<u32>(corner.x, end.y), end,
    );
    let halfway = 0.5 * (tile.nearest + tile.farthest);
    let middle = from_eye_at(0.5 * vec2<f32>(corner + end), halfway);
    var radius = 0.0;
    for (var k = 0; k < 4; k += 1) {
        let at_px = vec2<f32>(edges[k]);
        radius = max(radius, length(from_eye_at(at_px, tile.nearest) - middle));
        radius = max(radius, length(from_eye_at(at_px, tile.farthest) - middle));
    }
    // What is added is for rounding.
    return vec4<f32>(middle, 1.001 * radius + 1e-5 * length(middle));
}

// Appends to a list; answers whether there was room.
fn append(tile: ptr<function, Tile>, cursor: ptr<function, Cursor>, sensor: u32) -> bool {
    if (*cursor).entry % PAGE == 0u {
        let page = atomicAdd(&used, 1u);
        if page >= sight.counts.y {
            return false;
        }
        if (*cursor).entry == 0u {
            (*tile).page = page;
        } else {
            pages[PAGE * sight.counts.y + (*cursor).page] = page;
        }
        (*cursor).page = page;
    }
    pages[PAGE * (*cursor).page + (*cursor).entry % PAGE] = sensor;
    (*cursor).entry += 1u;
    return true;
}

@compute @workgroup_size(64)
fn cs_bin_blocks(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= sight.blocks.z {
        return;
    }
    let first = BLOCK * block_at(id.x);
    let last = min(first + BLOCK, sight.tiles.xy);
    var block: Tile;
    block.nearest = 1.0;
    for (var y = first.y; y < last.y; y += 1u) {
        for (var x = first.x; x < last.x; x += 1u) {
            let tile = tiles[y * sight.tiles.x + x];
            if shows_surface(tile) {
                let some = shows_surface(block);
                block.nearest = select(tile.nearest, min(block.nearest, tile.nearest), some);
                block.farthest = select(tile.farthest, max(block.farthest, tile.farthest), some);
            }
        }
    }
    if shows_surface(block) {
        let ball = ball_of(TILE * first, min(TILE * last, sight.size.xy), block);
        let place = place_of(ball.xyz, ball.w);
        var list: Cursor;
        for (var sensor = 0u; sensor < sight.counts.x; sensor += 1u) {
            let slack = slack_of(sensor, place);
            if slack.x >= 0.0 {
                block.weight += sensors[sensor].weight;
                block.covering += 1u;
            } else if !(slack.y < 0.0) && !append(&block, &list, sensor) {
                list.entry = UNLISTED;
                break;
            }
        }
        block.partly = list.entry;
        if list.entry == UNLISTED {
            block.weight = vec4<u32>(0u);
            block.covering = 0u;
        }
    }
    blocks[id.x] = block;
}

@compute @workgroup_size(64)
fn cs_bin_tiles(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= sight.tiles.z {
        return;
    }
    let at = tile_at(id.x);
    let block = blocks[block_of(at)];
    var tile = tiles[id.x];
    tile.weight = block.weight;
    tile.covering = block.covering;
    let listed = block.partly != UNLISTED;
    let asked = select(sight.counts.x, block.partly, listed);
    if shows_surface(tile) {
        let ball = ball_of(TILE * at, min(TILE * (at + 1u), sight.size.xy), tile);
        let place = place_of(ball.xyz, ball.w);
        tile.strays = select(0u, 1u, strays(place, ball.w));
        var asking = Cursor(block.page, 0u);
        var list: Cursor;
        for (var k = 0u; k < asked; k += 1u) {
            let sensor = next_sensor(&asking, listed);
            let slack = slack_of(sensor, place);
            if slack.x >= 0.0 {
                tile.weight += sensors[sensor].weight;
                tile.covering += 1u;
            } else if !(slack.y < 0.0) && !append(&tile, &list, sensor) {
                list.entry = UNLISTED;
                break;
            }
        }
        tile.partly = list.entry;
        if list.entry == UNLISTED {
            tile.weight = block.weight;
            tile.covering = block.covering;
        }
    }
    tiles[id.x] = tile;
}
