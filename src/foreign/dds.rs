//! DirectDraw Surface: the largest level of uncompressed texels, by either header.
//!
//! Microsoft, "DDS File Layout", "DDS_PIXELFORMAT" and "DDS_HEADER_DXT10".

use super::bytes::{part, word32};
use super::shape::count;
use super::texel::Texel;
use super::{Curve, Foreign, Read, refuse};
use crate::table::precision::Precision;

/// Bytes of the first header with its letters, and of the second.
const HEADER: usize = 128;
const SECOND: usize = 20;
/// The flags of a format by four letters, of masks of colours, of one channel alone.
const LETTERS: u32 = 0x4;
const COLOURS: u32 = 0x40;
const LUMINANCE: u32 = 0x2_0000;
/// The flags of a cube and of a volume.
const CUBE: u32 = 0x200;
const VOLUME: u32 = 0x20_0000;

pub fn read(bytes: &[u8]) -> Read<Foreign> {
    let word = |place: usize| word32(bytes, 4 * place);
    let (rows, columns, levels) = (word(3)? as usize, word(4)? as usize, word(7)?);
    let (flags, letters, caps) = (word(20)?, word(21)?, word(28)?);
    if word(1)? != 124 || word(19)? != 32 {
        return refuse("a DDS header of 124 bytes", format!("{} and {}", word(1)?, word(19)?));
    }
    if caps & CUBE != 0 {
        return refuse("a picture, layers or a volume", "a cube");
    }
    let depth = if caps & VOLUME != 0 { word(6)? as usize } else { 1 };
    let second = flags & LETTERS != 0 && letters == u32::from_le_bytes(*b"DX10");
    let (texel, at, layers) = match second {
        true => (by_number(word(32)?)?, HEADER + SECOND, word(35)? as usize),
        false if flags & LETTERS != 0 => (by_letters(letters)?, HEADER, 1),
        false => (by_masks(flags, [word(22)?, word(23)?, word(24)?, word(25)?])?, HEADER, 1),
    };
    if levels > 1 && layers > 1 {
        return refuse("layers without smaller levels", format!("{levels} levels"));
    }
    if depth > 1 && layers > 1 {
        return refuse("layers or a volume", "layers of volumes");
    }
    let size = [columns, rows, depth.max(layers)];
    let length = count(size, texel.components)? / texel.components * texel.bytes();
    let values = texel.numbers(part(bytes, at, length)?, size)?;
    let mut table = Foreign::new("DDS", size, texel.components, texel.storage, values);
    if texel.storage == Precision::Srgb8 {
        table.storage = Precision::Unorm8;
        table.curve = Some(Curve::Srgb);
    }
    match bytes.len() - at - length {
        0 => (),
        _ if levels > 1 => table.notes.push(format!("{levels} levels; the largest is read")),
        more => table.faults.push(format!("{more} bytes behind the texels")),
    }
    Ok(table)
}

/// The formats of DXGI that are read.
fn by_number(number: u32) -> Read<Texel> {
    let texel = Texel::new;
    Ok(match number {
        2 => texel(Precision::F32, 4),
        6 => texel(Precision::F32, 3),
        10 => texel(Precision::F16, 4),
        11 => texel(Precision::Unorm16, 4),
        16 => texel(Precision::F32, 2),
        24 => texel(Precision::A2b10g10r10, 4),
        28 => texel(Precision::Unorm8, 4),
        29 => texel(Precision::Srgb8, 4),
        34 => texel(Precision::F16, 2),
        35 => texel(Precision::Unorm16, 2),
        41 => texel(Precision::F32, 1),
        49 => texel(Precision::Unorm8, 2),
        54 => texel(Precision::F16, 1),
        56 => texel(Precision::Unorm16, 1),
        61 => texel(Precision::Unorm8, 1),
        87 => Texel { swapped: true, ..texel(Precision::Unorm8, 4) },
        91 => Texel { swapped: true, ..texel(Precision::Srgb8, 4) },
        other => return refuse("uncompressed texels", format!("DXGI's format {other}")),
    })
}

/// The formats of Direct3D 9 that are numbers in place of letters.
fn by_letters(letters: u32) -> Read<Texel> {
    let texel = Texel::new;
    Ok(match letters {
        36 => texel(Precision::Unorm16, 4),
        111 => texel(Precision::F16, 1),
        112 => texel(Precision::F16, 2),
        113 => texel(Precision::F16, 4),
        114 => texel(Precision::F32, 1),
        115 => texel(Precision::F32, 2),
        116 => texel(Precision::F32, 4),
        other => {
            let code = other.to_le_bytes().escape_ascii().to_string();
            return refuse("uncompressed texels", format!("Direct3D's format '{code}'"));
        }
    })
}

/// Whole bytes, or 16 bits, for red, green and blue.
fn by_masks(flags: u32, [bits, red, green, blue]: [u32; 4]) -> Read<Texel> {
    let texel = Texel::new;
    Ok(match (flags & (COLOURS | LUMINANCE), bits, red, green, blue) {
        (COLOURS, 32, 0xff, 0xff00, 0xff_0000) => texel(Precision::Unorm8, 4),
        (COLOURS, 32, 0xff_0000, 0xff00, 0xff) => {
            Texel { swapped: true, ..texel(Precision::Unorm8, 4) }
        }
        (COLOURS, 24, 0xff, 0xff00, 0xff_0000) => texel(Precision::Unorm8, 3),
        (COLOURS, 24, 0xff_0000, 0xff00, 0xff) => {
            Texel { swapped: true, ..texel(Precision::Unorm8, 3) }
        }
        (COLOURS, 32, 0xffff, 0xffff_0000, 0) => texel(Precision::Unorm16, 2),
        (LUMINANCE, 8, 0xff, _, _) => texel(Precision::Unorm8, 1),
        (LUMINANCE, 16, 0xffff, _, _) => texel(Precision::Unorm16, 1),
        _ => {
            let got = format!("{bits} bits with the masks {red:#x}, {green:#x}, {blue:#x}");
            return refuse("bytes, or 16 bits, of red, green and blue", got);
        }
    })
}
