//! KTX2 by the crate `ktx2`, and Zstandard by `ruzstd`.

use super::{Result, Values, half, numbers};
use ktx2::{Format, Reader, SupercompressionScheme};
use std::io::Read;

pub fn read(file: &[u8]) -> Result<Values> {
    let reader = Reader::new(file).map_err(|error| format!("{error:?}"))?;
    let header = reader.header();
    let level = reader.levels().next().ok_or("no level")?;
    let data = match header.supercompression_scheme {
        None => level.data.to_vec(),
        Some(SupercompressionScheme::Zstandard) => {
            let mut data = Vec::new();
            // One byte more than there may be shows that a frame is too long.
            ruzstd::decoding::StreamingDecoder::new(level.data)?
                .take(level.uncompressed_byte_length + 1)
                .read_to_end(&mut data)?;
            data
        }
        Some(other) => return Err(format!("{other:?}").into()),
    };
    if data.len() as u64 != level.uncompressed_byte_length {
        return Err("level of another length".into());
    }
    let f16 = |bytes| half(u16::from_le_bytes(bytes));
    let f32 = |bytes| f64::from(f32::from_le_bytes(bytes));
    let unorm8 = |[byte]: [u8; 1]| f64::from(byte) / 255.0;
    let unorm16 = |bytes| f64::from(u16::from_le_bytes(bytes)) / 65535.0;
    Ok(match header.format.ok_or("no format")? {
        Format::R16_SFLOAT | Format::R16G16_SFLOAT | Format::R16G16B16A16_SFLOAT => {
            numbers(&data, f16)
        }
        Format::R32_SFLOAT | Format::R32G32_SFLOAT | Format::R32G32B32A32_SFLOAT => {
            numbers(&data, f32)
        }
        Format::R8_UNORM | Format::R8G8_UNORM | Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => {
            numbers(&data, unorm8)
        }
        Format::R16_UNORM | Format::R16G16_UNORM | Format::R16G16B16A16_UNORM => {
            numbers(&data, unorm16)
        }
        Format::A2B10G10R10_UNORM_PACK32 => {
            let texel = |bytes: &[u8; 4]| {
                let word = u32::from_le_bytes(*bytes);
                let ten = |shift: u32| f64::from(word >> shift & 1023) / 1023.0;
                [ten(0), ten(10), ten(20), f64::from(word >> 30) / 3.0]
            };
            data.as_chunks().0.iter().flat_map(texel).collect()
        }
        other => return Err(format!("format {}", other.value()).into()),
    })
}
