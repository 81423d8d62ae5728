//! KTX2: one level, row 0 topmost, with a basic data format descriptor and the metadata.
//!
//! Khronos, "KTX File Format Specification 2.0"; the descriptor is that of the "Khronos Data Format
//! Specification 1.3".

use super::encoding::Supercompress;
use super::metadata::{KEY, TOOL, metadata};
use super::texels::Texels;
use super::{WriteSeek, failed, raw};
use crate::error::{Error, Result};
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::io::Cursor;

const IDENTIFIER: [u8; 12] =
    [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, b'\r', b'\n', 0x1a, b'\n'];

/// Bytes before the descriptor: header, index, and one level.
const DESCRIPTOR_AT: usize = 104;

/// The format of a texel.
struct Texel {
    /// The number of a VkFormat.
    format: u32,
    /// Bytes of the numbers that an opposite byte order would swap.
    type_size: u32,
    /// Bits of each component.
    bits: &'static [u8],
    /// The lowest and the highest of each component's numbers, as the descriptor has them.
    range: fn(u8) -> (u32, u32),
    /// Whether they are floats, which have a sign.
    float: bool,
    /// Whether they are on the curve of sRGB.
    srgb: bool,
}

/// Writes header, descriptor, metadata and texels.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let texel = texel(texels.precision(), texels.components())?;
    let [columns, rows, slices] = texels.size();
    let descriptor = descriptor(&texel, texels.bytes());
    let values = key_values(texels)?;
    let size = columns * rows * slices * texels.bytes();
    let style = texels.encoding.style();
    let compressed = match style.supercompress {
        Supercompress::None => None,
        Supercompress::Zstd => Some(compressed(texels)?),
    };
    let values_at = DESCRIPTOR_AT + descriptor.len();
    // A level begins at a multiple of its texel's bytes and of 4, unless it is compressed.
    let alignment = match compressed {
        None => least_common_multiple(texels.bytes(), 4),
        Some(_) => 1,
    };
    let level_at = (values_at + values.len()).next_multiple_of(alignment);
    let (depth, layers) = match (slices, style.slices) {
        (1, _) => (0, 0),
        (slices, SlicesAs::Layers) => (0, slices),
        (slices, SlicesAs::Depth) => (slices, 0),
    };
    let scheme = if compressed.is_some() { 2 } else { 0 };
    let words = [
        [texel.format, texel.type_size, columns as u32, rows as u32],
        [depth as u32, layers as u32, 1, 1],
        [scheme, DESCRIPTOR_AT as u32, descriptor.len() as u32, values_at as u32],
    ];
    let mut bytes = IDENTIFIER.to_vec();
    bytes.extend(words.iter().flatten().flat_map(|word| word.to_le_bytes()));
    bytes.extend((values.len() as u32).to_le_bytes());
    let stored = compressed.as_ref().map_or(size, Vec::len);
    // No global data; then the level.
    for number in [0, 0, level_at, stored, size] {
        bytes.extend((number as u64).to_le_bytes());
    }
    bytes.extend(descriptor);
    bytes.extend(values);
    bytes.resize(level_at, 0);
    file.write_all(&bytes).map_err(failed)?;
    match compressed {
        None => raw::write(texels, file),
        Some(level) => file.write_all(&level).map_err(failed),
    }
}

/// The number of the VkFormat of texels with this storage and number of components, if they have
/// one.
#[cfg(feature = "cli")]
pub fn format_of(precision: Precision, components: usize) -> Option<u32> {
    texel(precision, components).ok().map(|texel| texel.format)
}

/// The descriptor of such texels.
#[cfg(feature = "cli")]
pub fn descriptor_of(precision: Precision, components: usize) -> Option<Vec<u8>> {
    let texel = texel(precision, components).ok()?;
    let bits: u32 = texel.bits.iter().map(|&bits| u32::from(bits)).sum();
    Some(descriptor(&texel, bits as usize / 8))
}

/// The format of a texel with this storage and number of components.
fn texel(precision: Precision, components: usize) -> Result<Texel> {
    let float = |format, bits: &'static [u8; 4]| Texel {
        format,
        type_size: u32::from(bits[0]) / 8,
        bits: &bits[..components],
        // -1 and 1 as floats.
        range: |_| ((-1f32).to_bits(), 1f32.to_bits()),
        float: true,
        srgb: false,
    };
    let whole = |format, bits: &'static [u8]| Texel {
        format,
        type_size: u32::from(bits[0]) / 8,
        bits,
        range: |bits| (0, (1 << bits) - 1),
        float: false,
        srgb: false,
    };
    Ok(match (precision, components) {
        (Precision::F16, 1) => float(76, &[16; 4]),
        (Precision::F16, 2) => float(83, &[16; 4]),
        (Precision::F16, 4) => float(97, &[16; 4]),
        (Precision::F32, 1) => float(100, &[32; 4]),
        (Precision::F32, 2) => float(103, &[32; 4]),
        (Precision::F32, 4) => float(109, &[32; 4]),
        (Precision::Unorm16, 1) => whole(70, &[16]),
        (Precision::Unorm16, 2) => whole(77, &[16; 2]),
        (Precision::Unorm16, 4) => whole(91, &[16; 4]),
        (Precision::Unorm8, 1) => whole(9, &[8]),
        (Precision::Unorm8, 2) => whole(16, &[8; 2]),
        (Precision::Unorm8 | Precision::Rgbd8, 4) => whole(37, &[8; 4]),
        (Precision::Srgb8, 4) => Texel { srgb: true, ..whole(43, &[8; 4]) },
        (Precision::A2b10g10r10, 4) => Texel { type_size: 4, ..whole(64, &[10, 10, 10, 2]) },
        (precision, components) => {
            return Err(Error::Internal(format!("KTX2: {components} components of {precision}")));
        }
    })
}

/// The basic data format descriptor: colour model RGB, primaries of BT.709.
fn descriptor(texel: &Texel, bytes: usize) -> Vec<u8> {
    let count = texel.bits.len();
    let block = 24 + 16 * count;
    let mut words = vec![4 + block as u32, 0, 2 | (block as u32) << 16];
    let transfer = if texel.srgb { 2 } else { 1 };
    words.extend([1 | 1 << 8 | transfer << 16, 0, bytes as u32, 0]);
    let mut offset = 0;
    for (channel, &bits) in texel.bits.iter().enumerate() {
        // Red, green, blue are 0 to 2, alpha is 15; floats are marked as such and as signed, and
        // alpha beside the curve of sRGB as linear.
        let channel = if channel == 3 { 15 } else { channel as u32 };
        let marks = if texel.float { 0xc0 } else { 0 };
        let linear = if texel.srgb && channel == 15 { 0x10 } else { 0 };
        let (low, high) = (texel.range)(bits);
        words.extend([
            offset | (u32::from(bits) - 1) << 16 | (channel | marks | linear) << 24,
            0,
            low,
            high,
        ]);
        offset += u32::from(bits);
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The key-value data, sorted by key: orientation, writer, and the metadata of each slice.
fn key_values(texels: &Texels) -> Result<Vec<u8>> {
    let slices = texels.size()[2];
    let mut texts: Vec<String> =
        (0..slices).map(|slice| metadata(texels, slice)).collect::<Result<_>>()?;
    let text = match (slices, texts.pop()) {
        (1, Some(text)) => text,
        (_, last) => {
            texts.extend(last);
            format!("[{}]", texts.join(","))
        }
    };
    // Right, down, and of a texture of three dimensions inwards.
    let volume = slices > 1 && texels.encoding.style().slices == SlicesAs::Depth;
    let orientation = if volume { "rdi" } else { "rd" };
    let mut bytes = Vec::new();
    for (key, value) in [("KTXorientation", orientation), ("KTXwriter", TOOL), (KEY, &*text)] {
        // Key and value end with a zero each, and an entry at a multiple of 4.
        bytes.extend((key.len() as u32 + value.len() as u32 + 2).to_le_bytes());
        bytes.extend(key.bytes().chain([0]).chain(value.bytes()).chain([0]));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}

/// The texels as one frame of Zstandard; their number of bytes stands in the file's index.
fn compressed(texels: &Texels) -> Result<Vec<u8>> {
    let mut level = Cursor::new(Vec::new());
    raw::write(texels, &mut level)?;
    Ok(compress_to_vec(&level.get_ref()[..], CompressionLevel::Fastest))
}

fn least_common_multiple(a: usize, b: usize) -> usize {
    (1..=b).map(|factor| a * factor).find(|multiple| multiple.is_multiple_of(b)).unwrap_or(a * b)
}
