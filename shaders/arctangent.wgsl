// Arctangents. Built-in ones may err by 4096 ulp; lavapipe's, by 20 m on the ground.

// Angle of (x, y), -pi ... pi, to 3 roundings of itself wherever it is small, else of pi; 0 at the origin.
// The polynomial is the minimax fit of atan(q)/q in q^2 on 0 ... 1 (relative error 2e-8).
fn angle_of(y: f32, x: f32) -> f32 {
    let larger = max(abs(x), abs(y));
    let smaller = min(abs(x), abs(y));
    let q = smaller / max(larger, 1e-37);
    let s = q * q;
    var angle = POLYNOMIAL;
    angle = select(angle, 1.57079632679 - angle, abs(y) > abs(x));
    angle = select(angle, 3.14159265359 - angle, x < 0.0);
    return select(angle, -angle, y < 0.0);
}
