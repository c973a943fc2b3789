//! Colours as CSS writes them.

use crate::host::palette::linear;

/// A colour, and its alpha where one was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CssColor {
    /// Linear, 0 … 1: the colour target is sRGB.
    pub rgb: [f32; 3],
    /// 0 … 1.
    pub alpha: Option<f32>,
}

/// The basic colours of CSS, some more for maps, and none at all.
const NAMED: [(&str, [u8; 3]); 24] = [
    ("aqua", [0, 255, 255]),
    ("black", [0, 0, 0]),
    ("blue", [0, 0, 255]),
    ("brown", [165, 42, 42]),
    ("cyan", [0, 255, 255]),
    ("fuchsia", [255, 0, 255]),
    ("gold", [255, 215, 0]),
    ("gray", [128, 128, 128]),
    ("green", [0, 128, 0]),
    ("grey", [128, 128, 128]),
    ("lime", [0, 255, 0]),
    ("magenta", [255, 0, 255]),
    ("maroon", [128, 0, 0]),
    ("navy", [0, 0, 128]),
    ("olive", [128, 128, 0]),
    ("orange", [255, 165, 0]),
    ("pink", [255, 192, 203]),
    ("purple", [128, 0, 128]),
    ("red", [255, 0, 0]),
    ("silver", [192, 192, 192]),
    ("teal", [0, 128, 128]),
    ("turquoise", [64, 224, 208]),
    ("white", [255, 255, 255]),
    ("yellow", [255, 255, 0]),
];

impl CssColor {
    /// Red, green, blue and alpha; `alpha` where none was written.
    pub fn rgba(self, alpha: f32) -> [f32; 4] {
        let [red, green, blue] = self.rgb;
        [red, green, blue, self.alpha.unwrap_or(alpha)]
    }

    fn from_bytes(rgb: [u8; 3], alpha: Option<u8>) -> Self {
        Self {
            rgb: rgb.map(linear),
            alpha: alpha.map(|alpha| f32::from(alpha) / 255.0),
        }
    }
}

impl std::str::FromStr for CssColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim().to_ascii_lowercase();
        if text == "transparent" {
            return Ok(Self::from_bytes([0; 3], Some(0)));
        }
        let named = NAMED.iter().find(|(name, _)| *name == text);
        if let Some((_, rgb)) = named {
            return Ok(Self::from_bytes(*rgb, None));
        }
        text.strip_prefix('#').and_then(hexadecimal).ok_or_else(|| {
            "expected a colour: #rgb, #rgba, #rrggbb, #rrggbbaa or a name, as red or transparent"
                .into()
        })
    }
}

fn hexadecimal(digits: &str) -> Option<CssColor> {
    let digits: Option<Vec<u8>> = digits
        .chars()
        .map(|digit| digit.to_digit(16).map(|value| value as u8))
        .collect();
    match *digits?.as_slice() {
        [r, g, b] => Some(CssColor::from_bytes([r, g, b].map(|d| d * 17), None)),
        [r, g, b, a] => Some(CssColor::from_bytes(
            [r, g, b].map(|d| d * 17),
            Some(a * 17),
        )),
        [r, rr, g, gg, b, bb] => Some(CssColor::from_bytes(
            [r * 16 + rr, g * 16 + gg, b * 16 + bb],
            None,
        )),
        [r, rr, g, gg, b, bb, a, aa] => Some(CssColor::from_bytes(
            [r * 16 + rr, g * 16 + gg, b * 16 + bb],
            Some(a * 16 + aa),
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes of the sRGB encoding, IEC 61966-2-1 the other way round, in double precision.
    fn bytes(color: CssColor) -> [u8; 3] {
        color.rgb.map(|value| {
            let value = f64::from(value);
            let encoded = if value <= 0.003_130_8 {
                value * 12.92
            } else {
                1.055 * value.powf(1.0 / 2.4) - 0.055
            };
            (encoded * 255.0).round() as u8
        })
    }

    #[test]
    fn notations_of_css() {
        for (text, rgb, alpha) in [
            ("#1aF", [0x11, 0xaa, 0xff], None),
            ("#1aF0", [0x11, 0xaa, 0xff], Some(0.0)),
            ("#0a7Bc9", [0x0a, 0x7b, 0xc9], None),
            ("#0a7Bc933", [0x0a, 0x7b, 0xc9], Some(0.2)),
            (" Orange ", [255, 165, 0], None),
            ("transparent", [0, 0, 0], Some(0.0)),
        ] {
            let color: CssColor = text.parse().unwrap();
            assert_eq!(bytes(color), rgb, "{text}");
            assert_eq!(color.alpha, alpha, "{text}");
        }
    }

    #[test]
    fn what_is_no_colour() {
        for text in [
            "", "#", "#12", "#12345", "#1234567", "#ggg", "123456", "reddish", "#é12",
        ] {
            assert!(text.parse::<CssColor>().is_err(), "{text}");
        }
    }
}
