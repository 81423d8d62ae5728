//! PNG: gray, R, G, B or R, G, B, A in 16 or 8 bits; a picture of a table, and a table for those
//! who read nothing else. Linear values have no chunk of a curve, those of sRGB have its chunk.

use super::metadata::{KEY, metadata};
use super::texels::Texels;
use super::{WriteSeek, failed};
use crate::error::{Error, Result};
use crate::table::precision::Precision;
use ::png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};
use std::io::Write;

/// Writes a PNG file, line by line.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let depth = match texels.precision() {
        Precision::Unorm16 => BitDepth::Sixteen,
        Precision::Unorm8 | Precision::Srgb8 | Precision::Rgbd8 => BitDepth::Eight,
        Precision::F16 | Precision::F32 | Precision::F64 | Precision::A2b10g10r10 => {
            return Err(Error::Internal("PNG: a table that is not unorm".into()));
        }
    };
    let color = match texels.components() {
        1 => ColorType::Grayscale,
        3 => ColorType::Rgb,
        _ => ColorType::Rgba,
    };
    let [columns, rows, _] = texels.size();
    let text = metadata(texels, 0)?;
    let write = || -> std::result::Result<(), EncodingError> {
        let mut encoder = Encoder::new(file, columns as u32, rows as u32);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if texels.precision() == Precision::Srgb8 {
            encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
        }
        encoder.add_itxt_chunk(KEY.into(), text)?;
        let mut writer = encoder.write_header()?;
        let mut lines = writer.stream_writer()?;
        for j in 0..rows {
            let mut line = texels.row(0, j);
            if depth == BitDepth::Sixteen {
                // PNG is big-endian.
                line.chunks_exact_mut(2).for_each(|value| value.reverse());
            }
            lines.write_all(&line)?;
        }
        lines.finish()?;
        writer.finish()
    };
    write().map_err(refused)
}

/// The bytes of a PNG file of 8-bit R, G, B, row by row.
pub fn encode_rgb(width: usize, height: usize, rgb: &[u8]) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(ColorType::Rgb);
    let write = || encoder.write_header()?.write_image_data(rgb);
    write().map_err(refused)?;
    Ok(file)
}

fn refused(error: EncodingError) -> Error {
    match error {
        EncodingError::IoError(error) => failed(error),
        other => Error::Internal(format!("PNG: {other}")),
    }
}
