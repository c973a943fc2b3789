//! Colours by which neighbours can be told apart.

use globefill::FillMesh;

/// Pleasant on land and on water, distinct from each other; sRGB.
const COLORS: [[u8; 3]; 8] = [
    [226, 106, 88],
    [240, 178, 72],
    [122, 184, 98],
    [72, 168, 182],
    [112, 126, 204],
    [186, 112, 190],
    [236, 136, 160],
    [226, 220, 200],
];

const OPACITY: f32 = 0.5;

/// Neighbours' colours are farther apart than this, as sRGB bytes, where there are enough.
const FAR_APART: f32 = 90.0;

/// A colour for every fill, linear RGB and alpha: no two fills that share a border have the same or a
/// similar one, unless one has so many neighbours that the colours do not suffice.
pub fn colors(mesh: &FillMesh) -> Vec<[f32; 4]> {
    let mut neighbours = vec![Vec::new(); mesh.fills.len()];
    let fill_of = |piece: u32| mesh.pieces[piece as usize].fill;
    for arc in &mesh.arcs {
        if let (Some(left), Some(right)) = (arc.left, arc.right) {
            let (left, right) = (fill_of(left), fill_of(right));
            neighbours[left as usize].push(right as usize);
            neighbours[right as usize].push(left as usize);
        }
    }
    let mut chosen: Vec<usize> = Vec::with_capacity(mesh.fills.len());
    for (fill, beside) in neighbours.iter().enumerate() {
        let apart = |color: usize| {
            let taken = beside.iter().filter(|&&other| other < fill);
            taken
                .map(|&other| difference(color, chosen[other]))
                .fold(FAR_APART, f32::min)
        };
        // Starting elsewhere for every fill spreads the colours over the map; of equals the last wins.
        let first = fill * 5 % COLORS.len();
        let color = (0..COLORS.len())
            .map(|step| (first + step) % COLORS.len())
            .rev()
            .max_by(|&a, &b| apart(a).total_cmp(&apart(b)))
            .unwrap_or(first);
        chosen.push(color);
    }
    chosen
        .into_iter()
        .map(|color| {
            let [red, green, blue] = COLORS[color].map(linear);
            [red, green, blue, OPACITY]
        })
        .collect()
}

/// How far two of the colours are apart.
fn difference(a: usize, b: usize) -> f32 {
    let [a, b] = [a, b].map(|color| glam::Vec3::from_array(COLORS[color].map(f32::from)));
    a.distance(b)
}

/// The linear value of an sRGB byte (IEC 61966-2-1).
pub fn linear(byte: u8) -> f32 {
    let value = f32::from(byte) / 255.0;
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}
