//! Images to rows of texels. Files are told apart by their first bytes, since names and stated
//! types may be wrong; sizes are checked before anything is decoded.

mod jpeg;
mod ktx2;
mod png;

use super::notes::Read;

/// R, G, B, A in 16 bits. A code c of 8 bits becomes 257 c, which is the same fraction.
pub type Texel = [u16; 4];

/// What takes the rows of an image, one after the other.
pub type Rows<'a> = &'a mut dyn FnMut(&[Texel]);

/// The texels of the largest image that is decoded: 8192 x 8192.
pub const MOST_TEXELS: u64 = 1 << 26;

/// The longest side of an image, which bounds a row's memory.
const LONGEST_SIDE: u32 = 1 << 16;

/// The bytes that a decoder may hold. A plane of another image takes 64 MiB beside it.
const MOST_BYTES: u64 = 192 << 20;

/// What is known of an image before it is decoded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// Decoders of this format differ in their results.
    pub lossy: bool,
    /// The file brings smaller levels of its own.
    pub levels: bool,
}

impl Header {
    /// The number of texels of the largest level.
    pub fn texels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    fn checked(self) -> Read<Self> {
        match self.texels() {
            0 => Err("it has no texels".into()),
            texels if texels > MOST_TEXELS || self.width.max(self.height) > LONGEST_SIDE => {
                Err(format!("{} x {} texels are too many", self.width, self.height))
            }
            _ => Ok(self),
        }
    }
}

/// An image file of a known format.
pub enum Image<'a> {
    Png(Box<png::Png<'a>>),
    Jpeg(jpeg::Jpeg<'a>),
    Ktx2(ktx2::Ktx2<'a>),
}

impl<'a> Image<'a> {
    /// Reads the header.
    pub fn open(bytes: &'a [u8]) -> Read<Self> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => png::Png::open(bytes).map(Box::new).map(Image::Png),
            [0xff, 0xd8, ..] => jpeg::Jpeg::open(bytes).map(Image::Jpeg),
            [0xab, b'K', b'T', b'X', b' ', b'2', ..] => ktx2::Ktx2::open(bytes).map(Image::Ktx2),
            [b'R', b'I', b'F', b'F', ..] => Err("WebP is not read here".into()),
            [b'D', b'D', b'S', b' ', ..] => Err("DDS is not read here".into()),
            [_, _, _, _, b'f', b't', b'y', b'p', ..] => Err("AVIF is not read here".into()),
            [] => Err("it is empty".into()),
            _ => Err("it is neither PNG nor JPEG nor KTX2".into()),
        }
    }

    /// Its header.
    pub fn header(&self) -> Header {
        match self {
            Image::Png(png) => png.header,
            Image::Jpeg(jpeg) => jpeg.header,
            Image::Ktx2(ktx2) => ktx2.header,
        }
    }

    /// Gives all rows, of KTX2 also those of the smaller levels.
    pub fn decode(self, rows: Rows) -> Read<()> {
        match self {
            Image::Png(png) => png.decode(rows),
            Image::Jpeg(jpeg) => jpeg.decode(rows),
            Image::Ktx2(ktx2) => ktx2.decode(rows),
        }
    }
}

/// Bytes of 1 to 4 channels (gray; gray and alpha; R, G, B; R, G, B, A) as texels.
fn bytes_to_texels(bytes: &[u8], channels: usize, row: &mut Vec<Texel>) {
    row.clear();
    row.extend(bytes.chunks_exact(channels).map(|texel| {
        let code = |channel: usize| 257 * u16::from(texel[channel]);
        texel_of(channels, code)
    }));
}

/// A texel from its channels' codes.
fn texel_of(channels: usize, code: impl Fn(usize) -> u16) -> Texel {
    match channels {
        1 => [code(0), code(0), code(0), u16::MAX],
        2 => [code(0), code(0), code(0), code(1)],
        3 => [code(0), code(1), code(2), u16::MAX],
        _ => [code(0), code(1), code(2), code(3)],
    }
}
