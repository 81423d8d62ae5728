//! NumPy's .npy: an array of (slices,) rows, columns(, components) of floats or whole numbers.
//!
//! NumPy Enhancement Proposal 1.

use super::bytes::{part, word16, word32};
use super::shape::{MOST_COMPONENTS, count};
use super::{Foreign, Read, refuse};
use crate::error::clean;
use crate::numeric::half;
use crate::table::precision::Precision;

/// The most bytes of the header's text.
const MOST_HEADER: usize = 1 << 16;

pub fn read(bytes: &[u8]) -> Read<Foreign> {
    let (length, at) = match part(bytes, 6, 1)?[0] {
        1 => (usize::from(word16(bytes, 8)?), 10),
        2 | 3 => (word32(bytes, 8)? as usize, 12),
        other => return refuse("version 1, 2 or 3 of .npy", other.to_string()),
    };
    if length > MOST_HEADER {
        return refuse(format!("a header of at most {MOST_HEADER} bytes"), length.to_string());
    }
    let header = String::from_utf8_lossy(part(bytes, at, length)?);
    let data = &bytes[at + length..];
    let (shape, columns_first) = (shape(&header)?, value(&header, "fortran_order")?);
    let (size, components) = match shape[..] {
        [rows, columns] => ([columns, rows, 1], 1),
        [rows, columns, components] if components <= MOST_COMPONENTS => {
            ([columns, rows, 1], components)
        }
        [slices, rows, columns] => ([columns, rows, slices], 1),
        [slices, rows, columns, components] => ([columns, rows, slices], components),
        _ => {
            let expected = "an array of (slices,) rows, columns(, components)";
            return refuse(expected, format!("{} dimensions", shape.len()));
        }
    };
    let count = count(size, components)?;
    let kind = Kind::named(value(&header, "descr")?.trim_matches(['\'', '"']))?;
    if data.len() != count * kind.bytes {
        return refuse(format!("{} bytes of numbers", count * kind.bytes), data.len().to_string());
    }
    let mut values: Vec<f32> =
        data.chunks_exact(kind.bytes).map(|number| kind.number(number) as f32).collect();
    if columns_first.starts_with("True") {
        values = with_last_index_fastest(&values, &shape);
    }
    Ok(Foreign::new("npy", size, components, kind.storage, values))
}

/// A type of numbers.
struct Kind {
    storage: Precision,
    bytes: usize,
    big_endian: bool,
    /// The largest code of whole numbers.
    largest: Option<f64>,
}

impl Kind {
    fn named(name: &str) -> Read<Kind> {
        let (order, kind) = name.split_at_checked(1).unwrap_or((name, ""));
        let (storage, bytes, largest) = match kind {
            "f2" => (Precision::F16, 2, None),
            "f4" => (Precision::F32, 4, None),
            // What a file has in f64 is read as f32.
            "f8" => (Precision::F32, 8, None),
            "u1" => (Precision::Unorm8, 1, Some(255.0)),
            "u2" => (Precision::Unorm16, 2, Some(65535.0)),
            _ => return refuse("f2, f4, f8, u1 or u2", format!("'{}'", clean(name, 40))),
        };
        Ok(Kind { storage, bytes, big_endian: order == ">", largest })
    }

    fn number(&self, bytes: &[u8]) -> f64 {
        let mut ordered = [0; 8];
        let ordered = &mut ordered[..self.bytes];
        ordered.copy_from_slice(bytes);
        if self.big_endian {
            ordered.reverse();
        }
        let bits = ordered.iter().rev().fold(0u64, |bits, &byte| bits << 8 | u64::from(byte));
        match (self.largest, self.bytes) {
            (Some(largest), _) => bits as f64 / largest,
            (None, 2) => half::value(bits as u16),
            (None, 4) => f64::from(f32::from_bits(bits as u32)),
            (None, _) => f64::from_bits(bits),
        }
    }
}

/// What follows a key of the header.
fn value<'a>(header: &'a str, key: &str) -> Read<&'a str> {
    let after = ["'", "\""].iter().find_map(|quote| {
        header.split_once(&format!("{quote}{key}{quote}:")).map(|(_, rest)| rest.trim_start())
    });
    match after {
        Some(rest) => Ok(match rest.as_bytes().first() {
            Some(b'(') => rest.split_inclusive(')').next().unwrap_or(rest),
            _ => rest.split([',', '}']).next().unwrap_or(rest).trim(),
        }),
        None => refuse(format!("a header with '{key}'"), clean(header, 80)),
    }
}

fn shape(header: &str) -> Read<Vec<usize>> {
    let text = value(header, "shape")?;
    let numbers = text.trim_matches(['(', ')']).split(',').map(str::trim);
    let numbers = numbers.filter(|number| !number.is_empty()).map(str::parse);
    match numbers.collect::<Result<Vec<usize>, _>>() {
        Ok(shape) => Ok(shape),
        Err(_) => refuse("a shape of whole numbers", clean(text, 60)),
    }
}

/// The numbers of an array whose first index runs fastest, in the order in which the last does.
fn with_last_index_fastest(values: &[f32], shape: &[usize]) -> Vec<f32> {
    let place = |mut index: usize| {
        // The last index first.
        let mut indices = vec![0; shape.len()];
        for (at, &side) in indices.iter_mut().zip(shape).rev() {
            *at = index % side;
            index /= side;
        }
        indices.iter().zip(shape).rev().fold(0, |place, (&at, &side)| place * side + at)
    };
    (0..values.len()).map(|index| values[place(index)]).collect()
}
