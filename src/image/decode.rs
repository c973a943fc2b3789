//! Images from files: PNG and JPEG.

use std::{
    fs::File,
    io::{self, Cursor, Read},
    path::Path,
};

use ::image::{
    DynamicImage, ImageDecoder, ImageFormat, Limits,
    codecs::{jpeg::JpegDecoder, png::PngDecoder},
    guess_format,
};

use super::{Image, check_size, texel_count};
use crate::error::ImageError;

/// Longest message of a decoder that is handed on, characters.
const LONGEST_MESSAGE: usize = 200;
/// A file is not read further than this: four 16-bit channels of the largest image, and some room.
const MOST_BYTES: u64 = super::MOST_TEXELS * 8 + (1 << 26);
/// What decoders may allocate for themselves, beside the picture.
const MOST_OVERHEAD_BYTES: u64 = 1 << 26;
/// So many bytes tell the format.
const SIGNATURE_BYTES: usize = 16;
/// Most texels a byte of a PNG can hold: deflate needs two bits for 258 bytes, of eight texels each.
const MOST_PNG_TEXELS_PER_BYTE: u64 = 8 * 258 * 4;
/// Most texels a byte of a JPEG can hold: a unit of 32 × 32 has eight blocks at least (four of one
/// component across, four of another down), a block takes a bit.
const MOST_JPEG_TEXELS_PER_BYTE: u64 = 32 * 32;

impl Image {
    /// The picture in a PNG or JPEG file's bytes. Needs the feature `images`.
    ///
    /// PNGs may have any colour type; channels of 16 bits are rounded to 8. Of an animation the still
    /// picture is shown. An orientation that the file's EXIF data tells is applied.
    ///
    /// # Errors
    /// Bytes that are neither or that end too early; sizes above [`MOST_PER_SIDE`](super::MOST_PER_SIDE)
    /// or [`MOST_TEXELS`](super::MOST_TEXELS), which is found out before anything is decoded. A JPEG
    /// whose end is in place but whose middle is damaged may pass: the decoder fills what is missing.
    pub fn decode(bytes: &[u8]) -> Result<Self, ImageError> {
        let picture = match format_of(bytes)? {
            Format::Png => decode_png(bytes)?,
            Format::Jpeg => decode_jpeg(bytes)?,
        };
        let rgba = picture.into_rgba8();
        Self::from_rgba8(rgba.width(), rgba.height(), &rgba)
    }

    /// The picture in a PNG or JPEG file, whatever its name. Needs the feature `images`.
    ///
    /// # Errors
    /// A file that cannot be read; what [`Self::decode`] refuses.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, ImageError> {
        let path = path.as_ref();
        let unreadable = |error: io::Error| ImageError::Unreadable {
            path: path.to_owned(),
            message: one_line(&error.to_string()),
        };
        let mut file = File::open(path).map_err(unreadable)?;
        let mut bytes = Vec::new();
        let mut read = |most_bytes: u64| file.by_ref().take(most_bytes).read_to_end(&mut bytes);
        read(SIGNATURE_BYTES as u64).map_err(unreadable)?;
        // A file that is something else need not be read.
        format_of(&bytes)?;
        let mut read = |most_bytes: u64| file.by_ref().take(most_bytes).read_to_end(&mut bytes);
        read(MOST_BYTES).map_err(unreadable)?;
        Self::decode(&bytes)
    }
}

enum Format {
    Png,
    Jpeg,
}

fn format_of(bytes: &[u8]) -> Result<Format, ImageError> {
    match guess_format(&bytes[..bytes.len().min(SIGNATURE_BYTES)]) {
        Ok(ImageFormat::Png) => Ok(Format::Png),
        Ok(ImageFormat::Jpeg) => Ok(Format::Jpeg),
        _ => Err(undecodable("the first bytes are those of neither")),
    }
}

fn decode_png(bytes: &[u8]) -> Result<DynamicImage, ImageError> {
    let (width, height) = png_size(bytes).ok_or_else(|| undecodable("the PNG has no header"))?;
    check_size(width, height)?;
    check_promise(width, height, bytes, MOST_PNG_TEXELS_PER_BYTE)?;
    if !is_png_whole(bytes) {
        return Err(undecodable("the PNG is cut short"));
    }
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits()).map_err(corrupt)?;
    picture(decoder)
}

fn decode_jpeg(bytes: &[u8]) -> Result<DynamicImage, ImageError> {
    if !is_jpeg_whole(bytes) {
        return Err(undecodable("the JPEG is cut short"));
    }
    let mut decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(corrupt)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    check_promise(width, height, bytes, MOST_JPEG_TEXELS_PER_BYTE)?;
    decoder.set_limits(limits()).map_err(corrupt)?;
    picture(decoder)
}

fn picture(mut decoder: impl ImageDecoder) -> Result<DynamicImage, ImageError> {
    // EXIF data that cannot be read turns nothing.
    let orientation = decoder.orientation().ok();
    let mut picture = DynamicImage::from_decoder(decoder).map_err(corrupt)?;
    if let Some(orientation) = orientation {
        picture.apply_orientation(orientation);
    }
    Ok(picture)
}

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(super::MOST_PER_SIDE);
    limits.max_image_height = Some(super::MOST_PER_SIDE);
    limits.max_alloc = Some(MOST_OVERHEAD_BYTES);
    limits
}

/// Refuses files too small for the size that they tell, before memory is taken for it.
fn check_promise(
    width: u32,
    height: u32,
    bytes: &[u8],
    most_texels_per_byte: u64,
) -> Result<(), ImageError> {
    if texel_count(width, height) / most_texels_per_byte > bytes.len() as u64 {
        return Err(undecodable("the file is too small for the size it tells"));
    }
    Ok(())
}

/// Width and height by a PNG's first chunk, IHDR.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let [kind, width, height] = [12, 16, 20].map(|at| bytes.get(at..)?.first_chunk::<4>().copied());
    let sides = (u32::from_be_bytes(width?), u32::from_be_bytes(height?));
    (kind? == *b"IHDR").then_some(sides)
}

/// Whether a PNG's chunks go on to the last, IEND: decoders stop reading where the picture is full.
fn is_png_whole(bytes: &[u8]) -> bool {
    let mut rest = bytes.get(8..).unwrap_or_default();
    while let Some((&[l0, l1, l2, l3, kind @ ..], _)) = rest.split_first_chunk::<8>() {
        // Length, kind, checksum.
        let chunk_bytes = 12 + u64::from(u32::from_be_bytes([l0, l1, l2, l3]));
        if chunk_bytes > rest.len() as u64 {
            return false;
        }
        if kind == *b"IEND" {
            return true;
        }
        rest = &rest[chunk_bytes as usize..];
    }
    false
}

/// Whether a JPEG's segments go on to the end-of-image marker: without it the decoder would hand out
/// what it has, grey below.
fn is_jpeg_whole(bytes: &[u8]) -> bool {
    const END_OF_IMAGE: u8 = 0xd9;
    const START_OF_SCAN: u8 = 0xda;
    let mut rest = bytes.get(2..).unwrap_or_default();
    while let Some((marker, after)) = next_marker(rest) {
        match marker {
            END_OF_IMAGE => return true,
            // Start of image, and one without a length.
            0x01 | 0xd8 => rest = after,
            _ => {
                let Some(&length) = after.first_chunk::<2>() else {
                    return false;
                };
                // A scan's data follows its segment; the next marker ends it.
                let is_scan = marker == START_OF_SCAN;
                let segment_bytes = usize::from(u16::from_be_bytes(length)).max(2);
                let Some(beyond) = after.get(segment_bytes..) else {
                    return false;
                };
                rest = if is_scan { scan_end(beyond) } else { beyond };
            }
        }
    }
    false
}

/// The next marker, and what follows it.
fn next_marker(bytes: &[u8]) -> Option<(u8, &[u8])> {
    let mut rest = bytes;
    loop {
        let start = rest.iter().position(|&byte| byte == 0xff)?;
        rest = &rest[start + 1..];
        match rest.split_first()? {
            // Fill bytes before a marker; stuffed zeros are no markers.
            (0xff | 0x00, _) => {}
            (&marker, after) => return Some((marker, after)),
        }
    }
}

/// What follows a scan's data: restart markers, 0xd0 … 0xd7, belong to it.
fn scan_end(bytes: &[u8]) -> &[u8] {
    let mut rest = bytes;
    while let Some((marker, after)) = next_marker(rest) {
        if !matches!(marker, 0xd0..=0xd7) {
            // Back to the marker's 0xff.
            return &bytes[bytes.len() - after.len() - 2..];
        }
        rest = after;
    }
    &[]
}

fn corrupt(error: ::image::ImageError) -> ImageError {
    undecodable(&error.to_string())
}

fn undecodable(message: &str) -> ImageError {
    ImageError::Undecodable(one_line(message))
}

/// A message as one short line.
fn one_line(message: &str) -> String {
    let words = message.split(|c: char| c.is_whitespace() || c.is_control());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join(" ").chars().take(LONGEST_MESSAGE).collect()
}
