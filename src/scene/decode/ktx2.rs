//! KTX2 (Khronos Data Format, KTX file format 2.0): R, G, B or R, G, B, A in bytes, as they are or
//! compressed by Zstandard. Formats for graphics processors are not read.

use super::{Header, Rows, bytes_to_texels};
use crate::error::clean;
use crate::scene::notes::Read;
use ruzstd::decoding::StreamingDecoder;

/// The largest window of Zstandard that a decoder may hold, in bytes.
const MOST_WINDOW: u64 = 64 << 20;

/// An open file.
pub struct Ktx2<'a> {
    pub header: Header,
    bytes: &'a [u8],
    channels: usize,
    levels: usize,
    zstandard: bool,
}

impl<'a> Ktx2<'a> {
    pub fn open(bytes: &'a [u8]) -> Read<Self> {
        let word = |place: usize| word(bytes, 12 + 4 * place);
        let format = word(0)?;
        let (width, height) = (word(2)?, word(3)?);
        let [depth, layers, faces, levels] = [word(4)?, word(5)?, word(6)?, word(7)?];
        // The numbers of Vulkan's formats: R8G8B8 and R8G8B8A8, unorm and sRGB.
        let channels = match format {
            23 | 29 => 3,
            37 | 43 => 4,
            0 => return Err("KTX2: Basis Universal is not read here".into()),
            other => return Err(format!("KTX2: Vulkan's format {other} is not read here")),
        };
        let zstandard = match word(8)? {
            0 => false,
            2 => true,
            other => return Err(format!("KTX2: supercompression {other} is not read here")),
        };
        if depth > 0 || layers > 0 || faces != 1 || levels > 32 {
            return Err("KTX2: it is no picture of two dimensions".into());
        }
        let header = Header { width, height, lossy: false, levels: levels > 1 }.checked()?;
        Ok(Ktx2 { header, bytes, channels, levels: levels.max(1) as usize, zstandard })
    }

    pub fn decode(self, rows: Rows) -> Read<()> {
        let mut row = Vec::new();
        for level in 0..self.levels {
            let side = |side: u32| side.checked_shr(level as u32).unwrap_or(0).max(1) as usize;
            let (width, height) = (side(self.header.width), side(self.header.height));
            // The index of levels begins at byte 80, with three numbers of eight bytes each.
            let start = long(self.bytes, 80 + 24 * level)?;
            let length = long(self.bytes, 88 + 24 * level)?;
            let end = start.checked_add(length);
            let data = end.and_then(|end| self.bytes.get(start..end));
            let mut data = data.ok_or("KTX2: a level leaves the file")?;
            let line = width * self.channels;
            if self.zstandard {
                let decoder = StreamingDecoder::new_with_max_window_size(&mut data, MOST_WINDOW);
                let mut decoder = decoder.map_err(refused)?;
                read_rows(&mut decoder, line, height, &mut |line| {
                    bytes_to_texels(line, self.channels, &mut row);
                    rows(&row);
                })?;
            } else {
                read_rows(&mut data, line, height, &mut |line| {
                    bytes_to_texels(line, self.channels, &mut row);
                    rows(&row);
                })?;
            }
        }
        Ok(())
    }
}

/// Reads so many rows of so many bytes.
fn read_rows(
    from: &mut dyn std::io::Read,
    line: usize,
    height: usize,
    row: &mut dyn FnMut(&[u8]),
) -> Read<()> {
    let mut bytes = vec![0; line];
    for _ in 0..height {
        from.read_exact(&mut bytes).map_err(refused)?;
        row(&bytes);
    }
    Ok(())
}

fn word(bytes: &[u8], at: usize) -> Read<u32> {
    let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
    word.map(u32::from_le_bytes).ok_or_else(|| "KTX2: its header is cut off".into())
}

fn long(bytes: &[u8], at: usize) -> Read<usize> {
    let long = bytes.get(at..at + 8).and_then(|long| long.try_into().ok());
    let long = long.map(u64::from_le_bytes).and_then(|long| usize::try_from(long).ok());
    long.ok_or_else(|| "KTX2: its index of levels is cut off".into())
}

fn refused(error: impl std::fmt::Display) -> String {
    format!("KTX2: {}", clean(&error.to_string(), 120))
}
