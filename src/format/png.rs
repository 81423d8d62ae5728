//! PNG: R, G, B in 16 or 8 bits, linear; a picture of a table, and a table for those who read
//! nothing else.

use super::metadata::{KEY, metadata};
use super::{WriteSeek, failed, texel_bytes};
use crate::error::{Error, Result};
use crate::table::Table;
use crate::table::precision::Precision;
use ::png::{BitDepth, ColorType, Encoder, EncodingError, Writer};
use std::io::Write;

/// Writes a PNG file, line by line.
pub fn write(table: &Table, file: &mut dyn WriteSeek) -> Result<()> {
    let depth = match table.precision() {
        Precision::Unorm16 => BitDepth::Sixteen,
        Precision::Unorm8 => BitDepth::Eight,
        Precision::F16 | Precision::F32 | Precision::F64 => {
            return Err(Error::Internal("PNG: a table that is not unorm".into()));
        }
    };
    let text = metadata(table, 0, &["R", "G", "B"])?;
    let write = || -> std::result::Result<(), EncodingError> {
        let mut writer = header(file, (table.x().size(), table.y().size()), depth, Some(text))?;
        let mut lines = writer.stream_writer()?;
        for j in 0..table.y().size() {
            lines.write_all(&line(table, j, depth))?;
        }
        lines.finish()?;
        writer.finish()
    };
    write().map_err(refused)
}

/// The bytes of a row.
fn line(table: &Table, j: usize, depth: BitDepth) -> Vec<u8> {
    let samples = (0..table.x().size()).flat_map(|i| [0, 1, 2].map(|channel| (i, channel)));
    match depth {
        BitDepth::Sixteen => samples
            .flat_map(|(i, channel)| {
                u16::from_le_bytes(texel_bytes(table, 0, (i, j), channel)).to_be_bytes()
            })
            .collect(),
        _ => samples.flat_map(|(i, channel)| texel_bytes::<1>(table, 0, (i, j), channel)).collect(),
    }
}

/// The bytes of a PNG file of 8-bit R, G, B, row by row.
pub fn encode_rgb(width: usize, height: usize, rgb: &[u8]) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut write = || -> std::result::Result<(), EncodingError> {
        header(&mut file, (width, height), BitDepth::Eight, None)?.write_image_data(rgb)
    };
    write().map_err(refused)?;
    Ok(file)
}

fn header<W: Write>(
    file: W,
    (width, height): (usize, usize),
    depth: BitDepth,
    text: Option<String>,
) -> std::result::Result<Writer<W>, EncodingError> {
    let mut encoder = Encoder::new(file, width as u32, height as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(depth);
    if let Some(text) = text {
        encoder.add_itxt_chunk(KEY.into(), text)?;
    }
    encoder.write_header()
}

fn refused(error: EncodingError) -> Error {
    match error {
        EncodingError::IoError(error) => failed(error),
        other => Error::Internal(format!("PNG: {other}")),
    }
}
