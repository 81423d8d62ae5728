//! JPEG: gray or colour, baseline or progressive.

use super::{Header, MOST_BYTES, Rows, bytes_to_texels};
use crate::error::clean;
use crate::scene::notes::Read;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// A file whose frame header was read.
pub struct Jpeg<'a> {
    pub header: Header,
    bytes: &'a [u8],
    channels: usize,
}

impl<'a> Jpeg<'a> {
    pub fn open(bytes: &'a [u8]) -> Read<Self> {
        let frame = Frame::find(bytes).ok_or("JPEG: it has no frame header")?;
        let header =
            Header { width: frame.width, height: frame.height, lossy: true, levels: false };
        let header = header.checked()?;
        if !matches!(frame.channels, 1 | 3) {
            return Err(format!("JPEG: {} channels are not read here", frame.channels));
        }
        // A progressive file's coefficients have two bytes each, and all are held at a time.
        let bytes_each = frame.channels as u64 * if frame.progressive { 3 } else { 1 };
        if header.texels() * bytes_each > MOST_BYTES {
            return Err(format!("JPEG: {} x {} takes over 192 MiB", frame.width, frame.height));
        }
        Ok(Jpeg { header, bytes, channels: frame.channels })
    }

    pub fn decode(self, rows: Rows) -> Read<()> {
        let colors = if self.channels == 1 { ColorSpace::Luma } else { ColorSpace::RGB };
        let (width, height) = (self.header.width as usize, self.header.height as usize);
        // Strict: what is cut off is an error, and not gray.
        let options = DecoderOptions::default()
            .set_strict_mode(true)
            .set_max_width(width)
            .set_max_height(height)
            .jpeg_set_out_colorspace(colors);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(self.bytes), options);
        let texels = decoder.decode().map_err(|error| {
            let why = format!("{error:?}");
            format!("JPEG: {}", clean(&why, 120))
        })?;
        if texels.len() != width * height * self.channels {
            return Err("JPEG: its headers do not agree".into());
        }
        let mut row = Vec::new();
        for line in texels.chunks_exact(width * self.channels) {
            bytes_to_texels(line, self.channels, &mut row);
            rows(&row);
        }
        Ok(())
    }
}

/// The header of a frame (ITU-T T.81, section B.2.2).
struct Frame {
    width: u32,
    height: u32,
    channels: usize,
    progressive: bool,
}

impl Frame {
    fn find(bytes: &[u8]) -> Option<Frame> {
        let mut at = 2;
        loop {
            let marker = *bytes.get(at + 1)?;
            if bytes[at] != 0xff {
                return None;
            }
            match marker {
                // A filling byte.
                0xff => at += 1,
                // Markers alone.
                0x01 | 0xd0..=0xd8 => at += 2,
                // The data, or the end, before a frame.
                0xda | 0xd9 => return None,
                // 0xc4, 0xc8 and 0xcc are no frames.
                0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf => {
                    let header = bytes.get(at + 2..at + 10)?;
                    let number = |at| u32::from(u16::from_be_bytes([header[at], header[at + 1]]));
                    return Some(Frame {
                        width: number(5),
                        height: number(3),
                        channels: usize::from(header[7]),
                        progressive: matches!(marker, 0xc2 | 0xc6 | 0xca | 0xce),
                    });
                }
                _ => {
                    let length = u16::from_be_bytes([*bytes.get(at + 2)?, *bytes.get(at + 3)?]);
                    at += 2 + usize::from(length.max(2));
                }
            }
        }
    }
}
