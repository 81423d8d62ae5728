//! PNG: R, G, B in 16 or 8 bits, linear; a picture of a table, and a table for those who read nothing else.

use super::metadata::{KEY, metadata};
use super::rgb_planes;
use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::table::Table;
use ::png::{BitDepth, ColorType, Encoder, EncodingError};

/// The bytes of a PNG file.
pub fn encode(table: &Table, precision: Precision) -> Result<Vec<u8>> {
    let depth = if precision == Precision::Unorm16 { BitDepth::Sixteen } else { BitDepth::Eight };
    let [red, green, blue] = rgb_planes(table, precision)?;
    let mut data = Vec::with_capacity(6 * red.len());
    for ((r, g), b) in red.into_iter().zip(green).zip(blue) {
        for value in [r, g, b] {
            match depth {
                BitDepth::Sixteen => data.extend((value as u16).to_be_bytes()),
                _ => data.push(value as u8),
            }
        }
    }
    write(table.x.size, table.y.size, depth, &data, Some(metadata(table, precision)?))
}

/// The bytes of a PNG file of 8-bit R, G, B, row by row.
pub fn encode_rgb(width: usize, height: usize, rgb: &[u8]) -> Result<Vec<u8>> {
    write(width, height, BitDepth::Eight, rgb, None)
}

fn write(width: usize, height: usize, depth: BitDepth, data: &[u8], text: Option<String>) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let write = || -> std::result::Result<(), EncodingError> {
        let mut encoder = Encoder::new(&mut file, width as u32, height as u32);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(depth);
        if let Some(text) = text {
            encoder.add_itxt_chunk(KEY.into(), text)?;
        }
        encoder.write_header()?.write_image_data(data)
    };
    write().map_err(|error| Error::Internal(format!("PNG: {error}")))?;
    Ok(file)
}
