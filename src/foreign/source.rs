//! Numbers in source code of any language: the longest list of them, or that of a named array, and
//! files in base64.

mod literal;
mod scan;

use super::shape::count;
use super::{Foreign, RawLayout, Read, Reading, refuse, refused};
use crate::error::clean;
use crate::numeric::half;
use crate::table::precision::Precision;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use scan::{Found, Numbers};

pub fn read(bytes: &[u8], reading: &Reading) -> Read<Foreign> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        let first = bytes[..bytes.len().min(4)].escape_ascii().to_string();
        let expected = "EXR, KTX2, DDS, PNG, npy or text";
        return refuse(expected, format!("a file that begins with '{first}'"));
    };
    match scan::find(text, reading.array.as_deref())? {
        Found::Numbers(numbers) => of_numbers(numbers, reading.raw.as_ref()),
        Found::Base64(text) => of_base64(text, reading.raw.as_ref()),
    }
}

/// A file, or texels of a known layout, in base64.
fn of_base64(text: &str, layout: Option<&RawLayout>) -> Read<Foreign> {
    let bytes = STANDARD.decode(text).map_err(|error| refused("base64", error))?;
    let read = match layout {
        Some(layout) => super::raw::read(&bytes, layout),
        None => super::by_first_bytes(&bytes)
            .unwrap_or_else(|| refuse("a file in base64, or --raw", "texels alone")),
    };
    let mut table = read?;
    table.notes.push("in base64, in source code".into());
    Ok(table)
}

fn of_numbers(numbers: Numbers, layout: Option<&RawLayout>) -> Read<Foreign> {
    let (values, storage) = values(&numbers, layout.map(RawLayout::storage));
    let (size, components, guess) = match layout {
        Some(layout) => (layout.size, layout.components(), None),
        None => {
            let (size, components) = shape(&values)?;
            let [columns, rows, slices] = size;
            let guess = format!(
                "{columns} x {rows} x {slices} texels of {components} by its \
                                 smoothness; --raw names another size"
            );
            (size, components, Some(guess))
        }
    };
    if count(size, components)? != values.len() {
        let expected = format!("{} numbers", count(size, components)?);
        return refuse(expected, format!("an array of {}", values.len()));
    }
    let mut table = Foreign::new("source code", size, components, storage, values);
    if let Some(name) = numbers.name {
        table.notes.push(format!("array {}", clean(name, 60)));
    }
    table.notes.extend(guess);
    Ok(table)
}

/// The numbers as values, and their storage: decimals, or whole numbers as the layout says, else
/// by the largest: codes of 8 bits, bits of halves, codes of 16 bits, bits of floats.
fn values(numbers: &Numbers, wanted: Option<Precision>) -> (Vec<f32>, Precision) {
    let Numbers { bits, decimal, .. } = numbers;
    if *decimal {
        return (bits.iter().map(|&bits| f32::from_bits(bits)).collect(), Precision::F32);
    }
    let largest = bits.iter().copied().max().unwrap_or(0);
    let storage = wanted.unwrap_or(match largest {
        0..=0xff => Precision::Unorm8,
        // Halves up to the largest finite one; a table whose codes of 16 bits end below it has no
        // value above 0.48.
        0x100..=0x7bff => Precision::F16,
        0x7c00..=0xffff => Precision::Unorm16,
        _ => Precision::F32,
    });
    let value = |&bits: &u32| match storage {
        Precision::F16 => half::value(bits as u16) as f32,
        Precision::F32 => f32::from_bits(bits),
        Precision::Unorm16 => bits as f32 / 65535.0,
        _ => bits as f32 / 255.0,
    };
    (bits.iter().map(value).collect(), storage)
}

/// The size and the components of so many numbers: of all squares and cubes the one whose
/// neighbours differ least.
fn shape(values: &[f32]) -> Read<([usize; 3], usize)> {
    let mut shapes = Vec::new();
    for components in (1..=4).filter(|count| values.len().is_multiple_of(*count)) {
        let texels = values.len() / components;
        let side = (texels as f64).sqrt().round() as usize;
        if side * side == texels {
            shapes.push(([side, side, 1], components));
        }
        let side = (texels as f64).cbrt().round() as usize;
        if side > 1 && side * side * side == texels {
            shapes.push(([side; 3], components));
        }
    }
    let unevenness =
        |&(size, components): &([usize; 3], usize)| unevenness(values, size, components);
    match shapes.into_iter().min_by(|a, b| unevenness(a).total_cmp(&unevenness(b))) {
        Some(shape) => Ok(shape),
        None => {
            let got = format!("an array of {}, which is none", values.len());
            refuse("a square or a cube of texels of 1 to 4 numbers, or --raw with the size", got)
        }
    }
}

/// The mean difference of a texel from the next in its row, and from the one below.
fn unevenness(values: &[f32], [columns, rows, slices]: [usize; 3], components: usize) -> f64 {
    let at = |texel: usize, component: usize| f64::from(values[texel * components + component]);
    let (mut sum, mut pairs) = (0.0, 0usize);
    for texel in 0..columns * rows * slices {
        let (i, j) = (texel % columns, texel / columns % rows);
        let next = (i + 1 < columns).then_some(texel + 1);
        let below = (j + 1 < rows).then_some(texel + columns);
        for other in next.into_iter().chain(below) {
            for component in 0..components {
                sum += (at(texel, component) - at(other, component)).abs().min(1.0);
            }
            pairs += components;
        }
    }
    sum / pairs.max(1) as f64
}
