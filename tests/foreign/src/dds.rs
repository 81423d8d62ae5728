//! DDS by the crate `dds`.

use super::{Result, Values, numbers};
use dds::{Channels, ColorFormat, DataLayout, Decoder, Format, ImageViewMut, Precision};
use std::io::Cursor;

pub fn read(file: &[u8]) -> Result<Values> {
    let mut decoder = Decoder::new(Cursor::new(file))?;
    let size = decoder.main_size();
    let slices = match decoder.layout() {
        DataLayout::Texture(_) => 1,
        DataLayout::Volume(volume) => volume.main().depth() as usize,
        DataLayout::TextureArray(array) => array.len(),
    };
    // The crate has no two components: it reads them as red and green of RGB.
    let format = decoder.format();
    let (channels, kept) = match format {
        Format::R16_FLOAT | Format::R32_FLOAT | Format::R8_UNORM | Format::R16_UNORM => {
            (Channels::Grayscale, 1)
        }
        Format::R16G16_FLOAT | Format::R32G32_FLOAT | Format::R8G8_UNORM | Format::R16G16_UNORM => {
            (Channels::Rgb, 2)
        }
        _ => (Channels::Rgba, 4),
    };
    // Whole numbers as they are stored; of 10 bits it would give the nearest of 16.
    let precision = match format {
        Format::R10G10B10A2_UNORM => Precision::F32,
        _ => decoder.native_color().precision,
    };
    let colour = ColorFormat::new(channels, precision);
    let mut values = Vec::new();
    let mut data = vec![0; colour.buffer_size(size).ok_or("too large")?];
    for _ in 0..slices {
        let view = ImageViewMut::new(&mut data, size, colour).ok_or("view")?;
        decoder.read_surface(view)?;
        let all = match precision {
            Precision::U8 => numbers(&data, |[byte]| f64::from(byte) / 255.0),
            Precision::U16 => {
                numbers(&data, |bytes| f64::from(u16::from_ne_bytes(bytes)) / 65535.0)
            }
            Precision::F32 => numbers(&data, |bytes| f64::from(f32::from_ne_bytes(bytes))),
        };
        let texels = all.chunks_exact(usize::from(channels.count()));
        values.extend(texels.flat_map(|texel| texel[..kept].to_vec()));
    }
    Ok(values)
}
