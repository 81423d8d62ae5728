//! DirectDraw Surface with the header of Direct3D 10: the texels top row first, without mips. Few
//! readers take two components, so that four are the default.
//!
//! Microsoft, "DDS File Layout" and "DDS_HEADER_DXT10".

use super::texels::Texels;
use super::{WriteSeek, failed, raw};
use crate::error::{Error, Result};
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;

/// The fields of the header that are given: caps, height, width, pitch, pixel format.
const GIVEN: u32 = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000;
/// The depth is given too.
const GIVEN_DEPTH: u32 = 0x80_0000;
/// The pixel format is a code of four letters.
const FOUR_LETTERS: u32 = 0x4;
/// A texture; one of several surfaces; one of three dimensions.
const TEXTURE: u32 = 0x1000;
const COMPLEX: u32 = 0x8;
const VOLUME: u32 = 0x20_0000;

/// Writes headers and texels.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let [columns, rows, slices] = texels.size().map(|size| size as u32);
    let volume = slices > 1 && texels.encoding.style().slices == SlicesAs::Depth;
    let (depth, layers) = if volume { (slices, 1) } else { (0, slices) };
    let pitch = columns * texels.bytes() as u32;
    let mut header = [0u32; 37];
    header[0] = u32::from_le_bytes(*b"DDS ");
    header[1] = 124;
    header[2] = if volume { GIVEN | GIVEN_DEPTH } else { GIVEN };
    header[3..7].copy_from_slice(&[rows, columns, pitch, depth]);
    // Nineteen words on: its size, flags and letters.
    header[19..22].copy_from_slice(&[32, FOUR_LETTERS, u32::from_le_bytes(*b"DX10")]);
    header[27] = if slices > 1 { TEXTURE | COMPLEX } else { TEXTURE };
    header[28] = if volume { VOLUME } else { 0 };
    // Format, dimensions (3 is Texture2D, 4 Texture3D), flags, layers, alpha mode.
    header[32..37].copy_from_slice(&[format(texels)?, if volume { 4 } else { 3 }, 0, layers, 0]);
    let bytes: Vec<u8> = header.iter().flat_map(|word| word.to_le_bytes()).collect();
    file.write_all(&bytes).map_err(failed)?;
    raw::write(texels, file)
}

/// The number of a DXGI_FORMAT.
fn format(texels: &Texels) -> Result<u32> {
    Ok(match (texels.precision(), texels.components()) {
        (Precision::F16, 1) => 54,
        (Precision::F16, 2) => 34,
        (Precision::F16, 4) => 10,
        (Precision::F32, 1) => 41,
        (Precision::F32, 2) => 16,
        (Precision::F32, 4) => 2,
        (Precision::Unorm16, 1) => 56,
        (Precision::Unorm16, 2) => 35,
        (Precision::Unorm16, 4) => 11,
        (Precision::Unorm8, 1) => 61,
        (Precision::Unorm8, 2) => 49,
        (Precision::Unorm8 | Precision::Rgbd8, 4) => 28,
        (Precision::Srgb8, 4) => 29,
        (Precision::A2b10g10r10, 4) => 24,
        (precision, components) => {
            return Err(Error::Internal(format!("DDS: {components} components of {precision}")));
        }
    })
}
