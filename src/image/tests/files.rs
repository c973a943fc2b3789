use std::{io::Cursor, path::PathBuf};

use ::image::{
    DynamicImage, ExtendedColorType, ImageBuffer, ImageEncoder, ImageFormat,
    codecs::{jpeg::JpegEncoder, png::PngEncoder},
};

use super::*;

fn png(width: u32, height: u32, samples: &[u8], color: ExtendedColorType) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new(&mut bytes);
    encoder.write_image(samples, width, height, color).unwrap();
    bytes
}

fn jpeg(picture: &DynamicImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, 95);
    picture.write_with_encoder(encoder).unwrap();
    bytes
}

/// A picture whose quarters are dark, red, green and blue, from the top left along rows.
fn quarters(width: u32, height: u32) -> DynamicImage {
    DynamicImage::ImageRgb8(ImageBuffer::from_fn(width, height, |x, y| {
        match (2 * x >= width, 2 * y >= height) {
            (false, false) => [10, 10, 10],
            (true, false) => [220, 20, 20],
            (false, true) => [20, 200, 20],
            (true, true) => [20, 20, 230],
        }
        .into()
    }))
}

/// A chunk of a PNG.
fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut crc = !0_u32;
    for byte in kind.iter().chain(data) {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
        }
    }
    let length = (data.len() as u32).to_be_bytes();
    [&length[..], kind, data, &(!crc).to_be_bytes()].concat()
}

/// A zlib stream that stores up to 65 535 bytes as they are.
fn stored(data: &[u8]) -> Vec<u8> {
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in data {
        a = (a + u32::from(*byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    let length = data.len() as u16;
    let mut stream = vec![0x78, 1, 1];
    stream.extend(length.to_le_bytes());
    stream.extend((!length).to_le_bytes());
    stream.extend(data);
    stream.extend((b << 16 | a).to_be_bytes());
    stream
}

/// A PNG of chunks written by hand.
fn png_by_hand(width: u32, height: u32, depth: u8, color: u8, more: &[Vec<u8>]) -> Vec<u8> {
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([depth, color, 0, 0, 0]);
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    bytes.extend(chunk(b"IHDR", &header));
    more.iter().for_each(|chunk| bytes.extend(chunk));
    bytes.extend(chunk(b"IEND", &[]));
    bytes
}

/// The decoded picture must be that of these texels.
fn assert_shows(bytes: &[u8], width: u32, height: u32, rgba: &[u8]) {
    let decoded = Image::decode(bytes).unwrap();
    let expected = Image::from_rgba8(width, height, rgba).unwrap();
    assert_eq!(decoded.levels(), expected.levels());
}

#[test]
fn every_colour_type_of_png_is_read() {
    let mut random = Random(4);
    let (width, height) = (7, 5);
    let count = 35;
    let rgba = random.bytes(4 * count);
    assert_shows(
        &png(width, height, &rgba, ExtendedColorType::Rgba8),
        width,
        height,
        &rgba,
    );

    let opaque = |colors: &[[u8; 3]]| -> Vec<u8> {
        let texels = colors
            .iter()
            .map(|&[red, green, blue]| [red, green, blue, 255]);
        texels.flatten().collect()
    };
    let rgb = random.bytes(3 * count);
    let colors: Vec<[u8; 3]> = rgb.as_chunks().0.to_vec();
    assert_shows(
        &png(width, height, &rgb, ExtendedColorType::Rgb8),
        width,
        height,
        &opaque(&colors),
    );

    let grey = random.bytes(count);
    let colors: Vec<[u8; 3]> = grey.iter().map(|&level| [level; 3]).collect();
    assert_shows(
        &png(width, height, &grey, ExtendedColorType::L8),
        width,
        height,
        &opaque(&colors),
    );

    let grey_alpha = random.bytes(2 * count);
    let texels: Vec<u8> = grey_alpha
        .chunks(2)
        .flat_map(|texel| [texel[0], texel[0], texel[0], texel[1]])
        .collect();
    assert_shows(
        &png(width, height, &grey_alpha, ExtendedColorType::La8),
        width,
        height,
        &texels,
    );

    // 16 bits: rounded to the nearest of 8.
    let wide: Vec<u16> = (0..4 * count).map(|_| random.next() as u16).collect();
    let bytes: Vec<u8> = wide
        .iter()
        .flat_map(|sample| sample.to_ne_bytes())
        .collect();
    let near = |sample: &u16| (f64::from(*sample) / 257.0).round() as u8;
    let texels: Vec<u8> = wide.iter().map(near).collect();
    assert_shows(
        &png(width, height, &bytes, ExtendedColorType::Rgba16),
        width,
        height,
        &texels,
    );
    let greys: Vec<[u8; 3]> = wide[..count]
        .iter()
        .map(|sample| [near(sample); 3])
        .collect();
    let bytes = &bytes[..2 * count];
    assert_shows(
        &png(width, height, bytes, ExtendedColorType::L16),
        width,
        height,
        &opaque(&greys),
    );
}

#[test]
fn palettes_bits_and_transparent_colours_are_read() {
    // Two bits a texel into a palette whose second colour is half transparent.
    let palette = chunk(b"PLTE", &[1, 2, 3, 40, 50, 60, 70, 80, 90]);
    let alphas = chunk(b"tRNS", &[255, 128]);
    let data = chunk(b"IDAT", &stored(&[0, 0b0001_1000, 0, 0b1001_0000]));
    let bytes = png_by_hand(3, 2, 2, 3, &[palette, alphas, data]);
    let colors = [[1, 2, 3, 255], [40, 50, 60, 128], [70, 80, 90, 255]];
    let texels = [0, 1, 2, 2, 1, 0].map(|index| colors[index]);
    assert_shows(&bytes, 3, 2, texels.as_flattened());

    // One bit of grey.
    let data = chunk(b"IDAT", &stored(&[0, 0b1010_0000]));
    let bytes = png_by_hand(3, 1, 1, 0, &[data]);
    let (black, white) = ([0, 0, 0, 255], [255; 4]);
    assert_shows(&bytes, 3, 1, [white, black, white].as_flattened());

    // One colour is none.
    let data = chunk(b"IDAT", &stored(&[0, 9, 8, 7, 1, 2, 3]));
    let none = chunk(b"tRNS", &[0, 9, 0, 8, 0, 7]);
    let bytes = png_by_hand(2, 1, 8, 2, &[none, data]);
    assert_shows(&bytes, 2, 1, &[0, 0, 0, 0, 1, 2, 3, 255]);
}

/// Where the middle of each quarter of an image shows which colour.
fn quarters_of(image: &Image) -> [char; 4] {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let at = |x: usize, y: usize| {
        let texel = image.levels()[0].texels[y * height / 4 * width + x * width / 4];
        let bright = texel[..3].iter().position(|&part| part > 150);
        bright.map_or('k', |channel| ['r', 'g', 'b'][channel])
    };
    [at(1, 1), at(3, 1), at(1, 3), at(3, 3)]
}

#[test]
fn jpegs_are_read_and_turned() {
    let plain = jpeg(&quarters(48, 32));
    let image = Image::decode(&plain).unwrap();
    assert_eq!((image.width(), image.height()), (48, 32));
    assert_eq!(quarters_of(&image), ['k', 'r', 'g', 'b']);
    let grey = Image::decode(&jpeg(&quarters(48, 32).grayscale())).unwrap();
    let is_grey = |texel: &[u8; 4]| texel[0] == texel[1] && texel[1] == texel[2] && texel[3] == 255;
    assert!(grey.levels()[0].texels.iter().all(is_grey));

    // By the EXIF standard: which side of the picture the first row and the first column are.
    let turned = [
        (1, ['k', 'r', 'g', 'b'], (48, 32)),
        (2, ['r', 'k', 'b', 'g'], (48, 32)),
        (3, ['b', 'g', 'r', 'k'], (48, 32)),
        (4, ['g', 'b', 'k', 'r'], (48, 32)),
        (5, ['k', 'g', 'r', 'b'], (32, 48)),
        (6, ['g', 'k', 'b', 'r'], (32, 48)),
        (7, ['b', 'r', 'g', 'k'], (32, 48)),
        (8, ['r', 'b', 'k', 'g'], (32, 48)),
    ];
    for (orientation, quarters, (width, height)) in turned {
        let mut exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
        exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
        let mut bytes = plain[..2].to_vec();
        bytes.extend([0xff, 0xe1]);
        bytes.extend((exif.len() as u16 + 2).to_be_bytes());
        bytes.extend(&exif);
        bytes.extend(&plain[2..]);
        let image = Image::decode(&bytes).unwrap();
        assert_eq!(
            (image.width(), image.height()),
            (width, height),
            "{orientation}"
        );
        assert_eq!(quarters_of(&image), quarters, "{orientation}");
    }
}

#[track_caller]
fn assert_undecodable(bytes: &[u8]) {
    match Image::decode(bytes) {
        Err(ImageError::Undecodable(message)) => {
            assert!(message.chars().count() <= 200 && !message.contains('\n'));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_cut_short_is_refused() {
    let picture = quarters(40, 24);
    let mut noise = Random(5).bytes(3 * 40 * 24);
    noise.iter_mut().for_each(|byte| *byte |= 1);
    let noisy = png(40, 24, &noise, ExtendedColorType::Rgb8);
    let smooth = png(40, 24, picture.as_bytes(), ExtendedColorType::Rgb8);
    for whole in [noisy, smooth, jpeg(&picture)] {
        for length in 0..whole.len() {
            assert_undecodable(&whole[..length]);
        }
        // What follows the end does not matter.
        assert!(Image::decode(&[&whole[..], &[0, 1, 0xff]].concat()).is_ok());
    }
}

#[test]
fn other_things_are_refused() {
    for bytes in [
        &b""[..],
        b"GIF89a\x01\0\x01\0\0\0\0;",
        b"RIFF\x10\0\0\0WEBPVP8 ",
        b"BM and so on",
        b"<svg/>",
        b"\x89PNG\r\n\x1a\n",
        b"\xff\xd8\xff\xd9",
        b"\xff\xd8\xff\xe0\0\x02\xff\xd9",
    ] {
        assert_undecodable(bytes);
    }
    // Damaged in the middle: the checksum tells.
    let mut bytes = png(9, 9, &Random(6).bytes(81), ExtendedColorType::L8);
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    assert_undecodable(&bytes);
    // Too few rows.
    let data = chunk(b"IDAT", &stored(&[0, 1, 2, 3]));
    assert_undecodable(&png_by_hand(3, 2, 8, 0, &[data]));
    // A header without data.
    assert_undecodable(&png_by_hand(3, 2, 8, 0, &[]));
    let empty = ImageError::Empty {
        width: 0,
        height: 2,
    };
    assert_eq!(
        Image::decode(&png_by_hand(0, 2, 8, 0, &[])).unwrap_err(),
        empty
    );
}

#[test]
fn bombs_are_refused_by_their_headers() {
    let data = || chunk(b"IDAT", &stored(&[0; 1000]));
    for (width, height) in [
        (60_000, 60_000),
        (16_385, 1),
        (u32::MAX, u32::MAX),
        (16_384, 16_384),
    ] {
        let bytes = png_by_hand(width, height, 8, 6, &[data()]);
        let too_large = ImageError::TooLarge { width, height };
        assert_eq!(Image::decode(&bytes).unwrap_err(), too_large);
    }
    // Within the limits, but nothing of a kilobyte can be that large.
    assert_undecodable(&png_by_hand(16_384, 8_192, 8, 6, &[data()]));
    // A JPEG's size is in its frame header, behind the marker 0xc0, length and precision.
    let mut bytes = jpeg(&quarters(8, 8));
    let frame = bytes
        .windows(2)
        .position(|pair| pair == [0xff, 0xc0])
        .unwrap();
    bytes[frame + 5..frame + 9].copy_from_slice(&[0xea, 0x60, 0xea, 0x60]);
    let (width, height) = (60_000, 60_000);
    assert_eq!(
        Image::decode(&bytes).unwrap_err(),
        ImageError::TooLarge { width, height }
    );
    bytes[frame + 5..frame + 9].copy_from_slice(&[0x20, 0, 0x40, 0]);
    assert_undecodable(&bytes);
}

#[test]
fn random_damage_is_answered() {
    let mut random = Random(7);
    let picture = quarters(33, 17);
    let wholes = [
        png(33, 17, picture.as_bytes(), ExtendedColorType::Rgb8),
        jpeg(&picture),
        jpeg(&picture.grayscale()),
    ];
    // Whatever comes of it, it comes as a result.
    for whole in &wholes {
        for _ in 0..700 {
            let mut bytes = whole.clone();
            for _ in 0..=random.below(6) {
                let at = random.below(bytes.len());
                bytes[at] = random.next() as u8;
            }
            if random.below(3) == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            let _ = Image::decode(&bytes);
        }
    }
    for _ in 0..500 {
        let count = random.below(200);
        let mut bytes = random.bytes(count);
        let signature = [&b""[..], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"\xff\xd8\xff"];
        bytes.splice(0..0, signature[random.below(3)].iter().copied());
        let _ = Image::decode(&bytes);
    }
}

/// A file for the time of a test.
struct TestFile(PathBuf);

impl TestFile {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let name = format!("globefill-{}-{name}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }
}

impl Drop for TestFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn files_are_opened_whatever_their_names() {
    let picture = quarters(20, 10);
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
    let file = TestFile::new("picture.jpg", bytes.get_ref());
    let opened = Image::open(&file.0).unwrap();
    assert_eq!(
        opened.levels(),
        Image::decode(bytes.get_ref()).unwrap().levels()
    );

    let text = TestFile::new(
        "text.png",
        b"no picture at all, but longer than a signature",
    );
    assert!(matches!(
        Image::open(&text.0),
        Err(ImageError::Undecodable(_))
    ));

    let missing = file.0.with_extension("missing");
    match Image::open(&missing) {
        Err(ImageError::Unreadable { path, message }) => {
            assert_eq!(path, missing);
            assert!(!message.is_empty());
        }
        other => panic!("{other:?}"),
    }
    let directory = std::env::temp_dir();
    assert!(matches!(
        Image::open(directory),
        Err(ImageError::Unreadable { .. })
    ));
}
