//! Winding codes: how the ids of a layer's fills are spread over planes of small integer sums.
//!
//! The count pass adds codes, so a pixel inside one fill holds that fill's code exactly as long as
//! no partial sum leaves the integers of the target's float format. That is proven, not observed:
//! the sum of |digit| over every triangle drawn stays below the format's mantissa.

/// Most planes a code may have.
pub(crate) const MAX_PLANES: u32 = 4;
/// Digits are stored in 8 bits.
const MAX_BASE: u32 = 256;
/// Check digits have the first of these numbers of bits that leaves head-room.
const CHECK_BITS: [u32; 2] = [5, 2];

/// Checks that share a plane with their ids have the first of these numbers of bits that leaves head-room.
const JOINED_BITS: [u32; 2] = [5, 4];

/// The number that is summed for a packed code where so many bits of its check share the plane of the id; as in
/// extrude.wgsl.
pub(crate) fn joined_number(packed: u32, bits: u32) -> u32 {
    (packed & 0xff) << bits | packed >> 8 & ((1 << bits) - 1)
}

/// One number for each plane of a code.
pub(crate) type PlaneSums = [u64; MAX_PLANES as usize];

/// How many partial sums a float format holds exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mantissa {
    /// 16-bit floats: integers to 2¹¹.
    Half,
    /// 32-bit floats: integers to 2²⁴.
    Single,
}

impl Mantissa {
    /// Whether sums stay within the integers that are exact.
    pub(crate) fn holds(self, sums: &PlaneSums) -> bool {
        sums.iter().all(|&sum| sum < self.limit())
    }

    pub(crate) fn limit(self) -> u64 {
        match self {
            Self::Half => 1 << 11,
            Self::Single => 1 << 24,
        }
    }
}

/// What programs that decode are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct CodeShape {
    digits: u32,
    planes: u32,
    check_bits: u32,
    /// As in [`Planes`](crate::gpu::planes::Planes).
    joined: u32,
}

impl CodeShape {
    /// The same with so many bits of the check in the plane of the id.
    pub(crate) fn joined(self, joined: u32) -> Self {
        Self { joined, ..self }
    }

    /// The overrides of layer.wgsl.
    pub(crate) fn constants(self) -> [(&'static str, f64); 4] {
        [
            ("JOINED", self.joined.into()),
            ("DIGITS", self.digits.into()),
            ("PLANES", self.planes.into()),
            ("CHECK_BITS", self.check_bits.into()),
        ]
    }
}

/// A positional code for the ids 1 … `fills`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Code {
    pub fills: u32,
    pub base: u32,
    pub digits: u32,
    pub planes: u32,
    /// Bits of the planes behind the digits, which check them.
    pub check_bits: u32,
}

impl Code {
    /// The shortest code for `fills` ids whose sums provably fit `mantissa` so many `times`, given the
    /// number of triangles drawn for each id; `None` if there is none.
    pub(crate) fn fitting(triangles_by_id: &[u64], mantissa: Mantissa, times: u64) -> Option<Self> {
        let fits = |code: &Self| {
            let sums = code.largest_sums(triangles_by_id);
            mantissa.holds(&sums.map(|sum| times * sum))
        };
        Self::candidates(triangles_by_id.len() as u32).find(fits)
    }

    /// The code of which sums need least room, whether or not all that is stored has it: what is drawn may.
    pub(crate) fn sparest(triangles_by_id: &[u64]) -> Option<Self> {
        Self::candidates(triangles_by_id.len() as u32)
            .min_by_key(|code| code.largest_sums(triangles_by_id).into_iter().max())
    }

    pub(crate) fn shape(&self) -> CodeShape {
        CodeShape {
            digits: self.digits,
            planes: self.planes,
            check_bits: self.check_bits,
            joined: 0,
        }
    }

    /// With how many bits of the check ids may be summed in one plane, the most first: none for codes that
    /// are not an id and a check.
    pub(crate) fn joined_bits(&self) -> impl Iterator<Item = u32> {
        let is_checked_id = (self.digits, self.planes) == (1, 2);
        let most = if is_checked_id { self.check_bits } else { 0 };
        JOINED_BITS.into_iter().filter(move |&bits| bits <= most)
    }

    /// A code for counting by stencil, where nothing is summed.
    pub(crate) fn unsummed(fills: u32) -> Option<Self> {
        Self::candidates(fills).next()
    }

    fn candidates(fills: u32) -> impl Iterator<Item = Self> {
        // (digits, planes); a lone fill needs no check, its sum is 0 or 1.
        let shapes: &[(u32, u32)] = if fills == 1 {
            &[(1, 1), (1, 4)]
        } else {
            &[(1, 2), (2, 4), (3, 4)]
        };
        CHECK_BITS.into_iter().flat_map(move |check_bits| {
            shapes.iter().filter_map(move |&(digits, planes)| {
                let base = (2..=MAX_BASE).find(|base| base.pow(digits) > fills)?;
                Some(Self {
                    fills,
                    base,
                    digits,
                    planes,
                    check_bits,
                })
            })
        })
    }

    /// Upper bounds of |partial sum| on any pixel, by plane.
    pub(crate) fn largest_sums(&self, triangles_by_id: &[u64]) -> PlaneSums {
        let mut sums = PlaneSums::default();
        for (id, triangles) in (1..).zip(triangles_by_id) {
            for (sum, digit) in sums.iter_mut().zip(self.planes_of(id)) {
                *sum += triangles * u64::from(digit);
            }
        }
        sums
    }

    /// The digits and checks that make up the code of `id`; as layer.wgsl knows them.
    pub(crate) fn planes_of(&self, id: u32) -> [u32; MAX_PLANES as usize] {
        // Far from linear in the id, so that A − B + C rarely checks (lowbias32 of C. Wellons).
        let mut mixed = (id ^ (id >> 16)).wrapping_mul(0x7feb_352d);
        mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b);
        mixed ^= mixed >> 16;
        let checks = [
            mixed & ((1 << self.check_bits) - 1),
            mixed >> self.check_bits & ((1 << self.check_bits) - 1),
        ];
        let mut planes = [0; MAX_PLANES as usize];
        let mut rest = id;
        for digit in &mut planes[..self.digits as usize] {
            *digit = rest % self.base;
            rest /= self.base;
        }
        for (plane, check) in planes[self.digits as usize..self.planes as usize]
            .iter_mut()
            .zip(checks)
        {
            *plane = check;
        }
        planes
    }

    /// The planes of `id`, 8 bits each, as the extruder reads them.
    pub(crate) fn packed(&self, id: u32) -> u32 {
        u32::from_le_bytes(self.planes_of(id).map(|digit| digit as u8))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_distinct_and_fit_their_bytes() {
        for fills in [1, 2, 31, 255, 256, 3_000, 70_000] {
            let triangles = vec![1; fills];
            let code = Code::fitting(&triangles, Mantissa::Single, 1).expect("fits");
            let mut seen = std::collections::HashSet::new();
            for id in 1..=fills as u32 {
                let planes = code.planes_of(id);
                assert!(planes.iter().all(|&digit| digit < 256));
                assert!(seen.insert(planes));
                assert_ne!(code.packed(id), 0);
            }
        }
    }

    #[test]
    fn head_room_is_refused_when_not_proven() {
        assert!(Code::fitting(&[2_047], Mantissa::Half, 1).is_some());
        assert!(Code::fitting(&[2_048], Mantissa::Half, 1).is_none());
        assert!(Code::fitting(&[1 << 24], Mantissa::Single, 1).is_none());
        // 241 fills of 1 500 triangles: ids in one digit would sum to 4·10⁷.
        let code = Code::fitting(&[1_500; 241], Mantissa::Single, 1).expect("two digits fit");
        assert_eq!((code.digits, code.planes, code.base), (2, 4, 16));
    }

    #[test]
    fn joined_numbers_name_their_ids() {
        let code = Code::fitting(&[100; 242], Mantissa::Single, 1).expect("fits");
        let bits: Vec<u32> = code.joined_bits().collect();
        assert_eq!(bits, [5, 4]);
        for bits in bits {
            let numbers: Vec<u32> = (0..=242)
                .map(|id| {
                    if id == 0 {
                        0
                    } else {
                        joined_number(code.packed(id), bits)
                    }
                })
                .collect();
            for (id, number) in (0..).zip(&numbers) {
                assert_eq!(number >> bits, id);
            }
            let known: std::collections::HashSet<i64> =
                numbers.iter().map(|&number| number.into()).collect();
            let (mut valid, mut tried) = (0, 0);
            for a in &numbers[1..] {
                for b in numbers[1..].iter().step_by(7).filter(|&b| b != a) {
                    for c in numbers[1..].iter().step_by(11).filter(|&c| c != b) {
                        tried += 1;
                        let sum = i64::from(*a) - i64::from(*b) + i64::from(*c);
                        valid += u32::from(known.contains(&sum));
                    }
                }
            }
            println!("{valid} of {tried} false sums are some id's number");
            let most = if bits == 5 { 0.04 } else { 0.08 };
            assert!(
                f64::from(valid) < most * f64::from(tried),
                "{valid} of {tried}"
            );
        }
        for other in [1, 3_000] {
            let code = Code::fitting(&vec![1; other], Mantissa::Single, 1).expect("fits");
            assert_eq!(code.joined_bits().count(), 0, "{other} fills");
        }
    }

    #[test]
    fn most_false_sums_are_recognised() {
        let code = Code::fitting(&[100; 200], Mantissa::Single, 1).expect("fits");
        let (mut valid, mut tried) = (0, 0);
        for a in 1..200u32 {
            for b in (1..200u32).step_by(7) {
                for c in (1..200u32).step_by(11) {
                    if a == b || b == c {
                        continue;
                    }
                    tried += 1;
                    let [a, b, c] = [a, b, c].map(|id| code.planes_of(id).map(i64::from));
                    let sum: Vec<i64> =
                        (0..4).map(|plane| a[plane] - b[plane] + c[plane]).collect();
                    let valid_sum = (1..=200).any(|id| {
                        code.planes_of(id)
                            .iter()
                            .zip(&sum)
                            .all(|(&p, &s)| i64::from(p) == s)
                    });
                    valid += u32::from(valid_sum);
                }
            }
        }
        println!("{valid} of {tried} false sums are some id's code");
        assert!(
            f64::from(valid) < 0.04 * f64::from(tried),
            "{valid} of {tried}"
        );
    }
}
