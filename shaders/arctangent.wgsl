// Arctangents. Built-in ones may err by 4096 ulp; lavapipe's err by 23 m on the ground.

// Angle of (x, y), -pi ... pi; 0 at the origin. The polynomial is the minimax fit of atan(q)/q in q^2 on
// 0 ... 1 with a relative error of 1e-7; with rounding, what is returned is off by 4e-7 of itself
// (measured: 3.2e-7), or 5.3e-7 where divisions err by the 2.5 ulp that WGSL allows.
fn angle_of(y: f32, x: f32) -> f32 {
    let larger = max(abs(x), abs(y));
    let q = min(abs(x), abs(y)) / max(larger, 1e-37);
    let s = q * q;
    // By halves, so that fewer steps wait for each other.
    let s2 = s * s;
    let lower = fma(s2, fma(s, -0.140194809, 0.199697239), fma(s, -0.333319907, 0.9999999));
    let upper = fma(s2, fma(s, -0.00469327607, 0.0242524033), fma(s, -0.0594863935, 0.0991429286));
    let fit = fma(s2 * s2, upper, lower);
    let octant = q * fit;
    let quadrant = select(octant, 1.57079633 - octant, abs(y) > abs(x));
    let half = select(quadrant, 3.14159265 - quadrant, x < 0.0);
    return select(half, -half, y < 0.0);
}
