//! PNG of 1 to 16 bits, gray, palette or colour, with what it says of curves.

use super::shape::count;
use super::{Curve, Foreign, Read, refuse, refused};
use crate::format::metadata::KEY;
use crate::table::precision::Precision;
use ::png::{BitDepth, Decoder, Info, Limits, Transformations};
use std::io::Cursor;

/// The bytes that the decoder may hold beside the picture.
const MOST_HELD: usize = 64 << 20;

/// The most bytes of metadata.
const MOST_TEXT: usize = 1 << 20;

pub fn read(bytes: &[u8]) -> Read<Foreign> {
    let failed = |error| refused("PNG", error);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MOST_HELD });
    // Palettes become colours, small numbers bytes, and a transparent colour becomes alpha.
    decoder.set_transformations(Transformations::EXPAND);
    let (width, height) = decoder.read_header_info().map_err(failed)?.size();
    let size = [width as usize, height as usize, 1];
    count(size, 1)?;
    let mut reader = decoder.read_info().map_err(failed)?;
    let (color, depth) = reader.output_color_type();
    let components = color.samples();
    let count = count(size, components)?;
    let deep = depth == BitDepth::Sixteen;
    let length = count * if deep { 2 } else { 1 };
    if reader.output_buffer_size() != Some(length) {
        return refuse(format!("{length} bytes of texels"), "another number of them");
    }
    let mut codes = vec![0; length];
    reader.next_frame(&mut codes).map_err(failed)?;
    // Text may stand behind the picture; what cannot be read there changes no texel.
    let end = reader.finish();
    let (values, storage) = match deep {
        true => (fractions_of_16(&codes), Precision::Unorm16),
        false => {
            let fraction = |&code: &u8| f32::from(code) / 255.0;
            (codes.iter().map(fraction).collect(), Precision::Unorm8)
        }
    };
    let mut table = Foreign::new("PNG", size, components, storage, values);
    // Gray with alpha.
    if components == 2 {
        table.names = vec!["R".into(), "A".into()];
    }
    if let Err(error) = end {
        table.faults.push(format!("behind the picture: {}", refused("PNG", error).got));
    }
    describe(reader.info(), &mut table);
    Ok(table)
}

fn fractions_of_16(codes: &[u8]) -> Vec<f32> {
    let fraction = |&code: &[u8; 2]| f32::from(u16::from_be_bytes(code)) / 65535.0;
    codes.as_chunks::<2>().0.iter().map(fraction).collect()
}

/// What the chunks say of the curve, and the metadata of splitsum.
fn describe(info: &Info, table: &mut Foreign) {
    if let Some(gamma) = info.gama_chunk {
        let gamma = f64::from(gamma.into_value());
        table.notes.push(format!("chunk gAMA {gamma:.5}"));
        table.curve = Some(match gamma {
            1.0 => Curve::Linear,
            gamma if gamma > 0.0 => Curve::Gamma(1.0 / gamma),
            _ => Curve::Linear,
        });
    }
    if info.srgb.is_some() {
        table.notes.push("chunk sRGB".into());
        table.curve = Some(Curve::Srgb);
    }
    if info.icc_profile.is_some() {
        table.notes.push("chunk iCCP: a colour profile, which readers may apply".into());
    }
    if info.coding_independent_code_points.is_some() {
        table.notes.push("chunk cICP: a colour space, which readers may apply".into());
    }
    for text in info.utf8_text.iter().filter(|text| text.keyword == KEY) {
        let mut text = text.clone();
        if text.decompress_text_with_limit(MOST_TEXT).is_ok() {
            table.own.extend(text.get_text());
        }
    }
}
