//! KTX2: the largest level of uncompressed texels, as they are or in Zstandard.
//!
//! Khronos, "KTX File Format Specification 2.0".

use super::bytes::{long, part, word32};
use super::shape::count;
use super::texel::Texel;
use super::{Curve, Foreign, Read, refuse, refused};
use crate::error::clean;
use crate::format::ktx2::{descriptor_of, format_of};
use crate::format::metadata::KEY;
use crate::table::precision::Precision;
use ruzstd::decoding::StreamingDecoder;

/// The largest window of Zstandard that a decoder may hold, in bytes.
const MOST_WINDOW: u64 = 64 << 20;

/// The most entries of key-value data that are looked at.
const MOST_ENTRIES: usize = 64;

pub fn read(bytes: &[u8]) -> Read<Foreign> {
    let word = |place: usize| word32(bytes, 12 + 4 * place);
    let number = word(0)?;
    let [columns, rows, depth, layers] = [word(2)?, word(3)?, word(4)?, word(5)?];
    let [faces, levels, scheme] = [word(6)?, word(7)?, word(8)?];
    let texel = format(number)?;
    if faces != 1 || depth > 0 && layers > 0 {
        let got = format!("{faces} faces, depth {depth}, {layers} layers");
        return refuse("a picture, layers or a volume", got);
    }
    let slices = depth.max(layers).max(1);
    let size = [columns as usize, rows as usize, slices as usize];
    let length = count(size, texel.components)? / texel.components * texel.bytes();
    let (start, stored, promised) = (long(bytes, 80)?, long(bytes, 88)?, long(bytes, 96)?);
    let data = part(bytes, start, stored)?;
    let mut faults = Vec::new();
    if promised != length {
        faults.push(format!("the level's length is {promised}, {length} for its size"));
    }
    let values = match scheme {
        0 => texel.numbers(data, size)?,
        2 => texel.numbers(&unpacked(data, length)?, size)?,
        other => {
            let got = format!("supercompression {other}");
            return refuse("texels as they are, or in Zstandard", got);
        }
    };
    let mut table = Foreign::new("KTX2", size, texel.components, texel.storage, values);
    if texel.storage == Precision::Srgb8 {
        table.storage = Precision::Unorm8;
        table.curve = Some(Curve::Srgb);
    }
    faults.extend(wrong_descriptor(bytes, number, texel)?);
    table.faults = faults;
    if levels > 1 {
        table.notes.push(format!("{levels} levels; the largest is read"));
    }
    if scheme == 2 {
        table.notes.push("compressed by Zstandard".into());
    }
    key_values(bytes, &mut table)?;
    Ok(table)
}

/// Vulkan's formats that are read; those of green and red alone, and of three components, too.
fn format(number: u32) -> Read<Texel> {
    let known = [Precision::F16, Precision::F32, Precision::Unorm16, Precision::Unorm8]
        .into_iter()
        .chain([Precision::Srgb8, Precision::A2b10g10r10])
        .flat_map(|storage| [1, 2, 4].map(|components| Texel::new(storage, components)))
        .find(|texel| format_of(texel.storage, texel.components) == Some(number));
    // What no bake writes: texels of three numbers, and blue first.
    let others = [
        (23, Texel::new(Precision::Unorm8, 3)),
        (29, Texel::new(Precision::Srgb8, 3)),
        (44, Texel { swapped: true, ..Texel::new(Precision::Unorm8, 4) }),
        (50, Texel { swapped: true, ..Texel::new(Precision::Srgb8, 4) }),
        (84, Texel::new(Precision::Unorm16, 3)),
        (90, Texel::new(Precision::F16, 3)),
        (106, Texel::new(Precision::F32, 3)),
    ];
    let other = others.iter().find(|(known, _)| *known == number).map(|(_, texel)| *texel);
    match known.or(other) {
        Some(texel) => Ok(texel),
        None => refuse(
            "uncompressed texels of unorms, halves or floats",
            format!("Vulkan's format {number}"),
        ),
    }
}

/// A level out of Zstandard; not one byte more than its size promises is decoded.
fn unpacked(mut data: &[u8], length: usize) -> Read<Vec<u8>> {
    use std::io::Read as _;
    let wrong = |error: String| refused("KTX2", format!("Zstandard: {error}"));
    let decoder = StreamingDecoder::new_with_max_window_size(&mut data, MOST_WINDOW);
    let mut decoder = decoder.map_err(|error| wrong(error.to_string()))?;
    let mut level = Vec::with_capacity(length);
    let read = (&mut decoder).take(length as u64 + 1).read_to_end(&mut level);
    read.map_err(|error| wrong(error.to_string()))?;
    Ok(level)
}

/// What the descriptor says otherwise than the format.
fn wrong_descriptor(bytes: &[u8], format: u32, texel: Texel) -> Read<Option<String>> {
    let (at, length) = (word32(bytes, 48)? as usize, word32(bytes, 52)? as usize);
    let found = part(bytes, at, length)?;
    // Blue first has other samples.
    let right = descriptor_of(texel.storage, texel.components).filter(|_| !texel.swapped);
    let Some(right) = right else { return Ok(None) };
    // Black and white points and primaries may differ; the samples may not.
    let samples = |descriptor: &[u8]| descriptor.get(28..).map(<[u8]>::to_vec);
    let curve = |descriptor: &[u8]| descriptor.get(14).copied();
    Ok(match samples(found) == samples(&right) && curve(found) == curve(&right) {
        true => None,
        false => {
            Some(format!("the data format descriptor is not that of Vulkan's format {format}"))
        }
    })
}

/// The entries of key-value data that matter.
fn key_values(bytes: &[u8], table: &mut Foreign) -> Read<()> {
    let (at, length) = (word32(bytes, 56)? as usize, word32(bytes, 60)? as usize);
    let mut rest = part(bytes, at, length)?;
    for _ in 0..MOST_ENTRIES {
        if rest.is_empty() {
            break;
        }
        let length = word32(rest, 0)? as usize;
        let entry = part(rest, 4, length)?;
        let mut parts = entry.splitn(2, |&byte| byte == 0);
        let key = parts.next().unwrap_or_default();
        let value = String::from_utf8_lossy(parts.next().unwrap_or_default());
        let value = value.trim_end_matches('\0');
        match key {
            b"KTXorientation" => match value.as_bytes() {
                [b'r', b'd', ..] => (),
                [b'r', b'u', ..] => table.notes.push("its first row is the bottom one".into()),
                _ => table.notes.push(format!("orientation '{}'", clean(value, 20))),
            },
            b"KTXwriter" => table.notes.push(format!("written by {}", clean(value, 60))),
            key if key == KEY.as_bytes() => table.own = vec![value.to_owned()],
            _ => (),
        }
        rest = rest.get((4 + length).next_multiple_of(4)..).unwrap_or_default();
    }
    Ok(())
}
