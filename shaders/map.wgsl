// Coordinates of patterns. What is known exactly at the eye's foot point is carried to the pixel by
// differences, so that coordinates are off by a few roundings of the way between the two.

struct Mapped {
    // Coordinates u and v of a pattern, from those at the eye's foot point.
    uv: vec2<f32>,
    // How they change per pixel to the right and down.
    u_slope: vec2<f32>,
    v_slope: vec2<f32>,
}

// On the map about an anchor: the ellipsoid seen from the anchor's antipode on the anchor's tangent
// plane. u = L(F) / D(F) with L and D linear, so that the difference from G is
// ((L - u(G) D) . (F - G)) / D(F), and nothing large cancels.
fn on_map(placed: Placed, seen: Seen) -> Mapped {
    let from_foot = seen.from_foot;
    let nearer = 1.0 / max(placed.u.w + dot(placed.fall.xyz, from_foot), 1e-9);
    let uv = vec2<f32>(dot(placed.u.xyz, from_foot), dot(placed.v.xyz, from_foot)) * nearer;
    return Mapped(
        uv,
        slope_of(seen, placed.u.xyz - uv.x * placed.fall.xyz) * nearer,
        slope_of(seen, placed.v.xyz - uv.y * placed.fall.xyz) * nearer,
    );
}

const PI: f32 = 3.14159265;

// On longitudes and latitudes, from the middle of the image. With z stretched, the latitude is the angle of
// (radius, z): geodetic if stretched by (a/b)^2, as the normal is, geocentric if not.
fn on_angles(placed: Placed, seen: Seen) -> Mapped {
    var stretch = sight.ellipsoid.y;
    if needs(NEEDS_SPHERES) {
        stretch = placed.u.z;
    }
    let from_foot = vec3<f32>(seen.from_foot.xy, seen.from_foot.z * stretch);
    let foot = vec3<f32>(sight.foot_gradient.xy, sight.foot_gradient.z * (stretch / sight.ellipsoid.y));
    let point = foot + from_foot;
    let radius_foot = length(foot.xy);
    // Near a pole one pixel shows all longitudes.
    let radius = max(length(point.xy), 1e-3);
    let wider = dot(from_foot.xy, foot.xy + point.xy) / (radius_foot + radius);
    // Of an eye right above a pole the longitude is 0.
    let meridian = select(foot.xy, vec2<f32>(1.0, 0.0), radius_foot == 0.0);
    let turned = angle_of(
        meridian.x * from_foot.y - meridian.y * from_foot.x,
        dot(meridian, point.xy),
    );
    let higher = angle_of(
        radius_foot * from_foot.z - wider * foot.z,
        radius_foot * radius + foot.z * point.z,
    );
    let lon = placed.u.x + turned;
    let angles = vec2<f32>(lon - 2.0 * PI * round(lon * (0.5 / PI)), placed.u.y + higher);
    let lon_slope = slope_of(seen, vec3<f32>(-point.y, point.x, 0.0)) / (radius * radius);
    let northward = vec3<f32>(-point.z / radius * point.xy, radius * stretch);
    let lat_slope = slope_of(seen, northward) / dot(point, point);
    var mapped = Mapped(
        vec2<f32>(placed.v.x, placed.v.w) * angles,
        placed.v.x * lon_slope,
        placed.v.w * lat_slope,
    );
    if needs(NEEDS_TURNS) {
        mapped.uv += placed.v.yz * angles.yx;
        mapped.u_slope += placed.v.y * lat_slope;
        mapped.v_slope += placed.v.z * lon_slope;
    }
    return mapped;
}
