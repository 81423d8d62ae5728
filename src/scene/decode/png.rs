//! PNG: of 1 to 16 bits, gray, palette or colour. Curves and profiles in the file are ignored, as
//! glTF asks.

use super::{Header, MOST_BYTES, Rows, Texel, bytes_to_texels, texel_of};
use crate::error::clean;
use crate::scene::notes::Read;
use ::png::{BitDepth, Decoder, DecodingError, Limits, Reader, Transformations};
use std::io::Cursor;

/// An open file.
pub struct Png<'a> {
    pub header: Header,
    reader: Reader<Cursor<&'a [u8]>>,
}

impl<'a> Png<'a> {
    pub fn open(bytes: &'a [u8]) -> Read<Self> {
        let limits = Limits { bytes: MOST_BYTES as usize };
        let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        // Palettes become colours, small numbers bytes, and a transparent colour becomes alpha.
        decoder.set_transformations(Transformations::EXPAND);
        let info = decoder.read_header_info().map_err(refused)?;
        let (width, height) = info.size();
        let header = Header { width, height, lossy: false, levels: false }.checked()?;
        let reader = decoder.read_info().map_err(refused)?;
        Ok(Png { header, reader })
    }

    pub fn decode(mut self, rows: Rows) -> Read<()> {
        let (color, depth) = self.reader.output_color_type();
        let channels = color.samples();
        let deep = depth == BitDepth::Sixteen;
        let mut row = Vec::new();
        if self.reader.info().interlaced {
            // Its passes are put together first.
            let size = self.reader.output_buffer_size().filter(|&size| size as u64 <= MOST_BYTES);
            let size = size.ok_or("it is interlaced and over 192 MiB")?;
            let mut frame = vec![0; size];
            let info = self.reader.next_frame(&mut frame).map_err(refused)?;
            for line in frame.chunks_exact(info.line_size.max(1)) {
                line_to_texels(line, channels, deep, &mut row);
                rows(&row);
            }
            return Ok(());
        }
        for _ in 0..self.header.height {
            let line = self.reader.next_row().map_err(refused)?;
            let line = line.ok_or("it has too few rows")?;
            line_to_texels(line.data(), channels, deep, &mut row);
            rows(&row);
        }
        Ok(())
    }
}

fn line_to_texels(line: &[u8], channels: usize, deep: bool, row: &mut Vec<Texel>) {
    if !deep {
        return bytes_to_texels(line, channels, row);
    }
    row.clear();
    row.extend(line.chunks_exact(2 * channels).map(|texel| {
        let code =
            |channel: usize| u16::from_be_bytes([texel[2 * channel], texel[2 * channel + 1]]);
        texel_of(channels, code)
    }));
}

fn refused(error: DecodingError) -> String {
    format!("PNG: {}", clean(&error.to_string(), 120))
}
