//! NumPy's .npy, version 1.0: an array of (slices,) rows, columns, components. Codes of unorms are
//! whole numbers.
//!
//! NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays".

use super::texels::Texels;
use super::{WriteSeek, failed, raw};
use crate::error::{Error, Result};
use crate::table::precision::Precision;

/// The header, with the magic bytes and its own length, is a multiple of this many bytes.
const ALIGNMENT: usize = 64;

/// Writes header and texels.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let [columns, rows, slices] = texels.size();
    let kind = match texels.precision() {
        Precision::F16 => "<f2",
        Precision::F32 => "<f4",
        Precision::F64 => "<f8",
        Precision::Unorm16 => "<u2",
        Precision::Unorm8 | Precision::Srgb8 | Precision::Rgbd8 => "|u1",
        Precision::A2b10g10r10 => {
            return Err(Error::Internal("npy: texels that are no array of numbers".into()));
        }
    };
    let depth = if slices > 1 { format!("{slices}, ") } else { String::new() };
    let shape = format!("({depth}{rows}, {columns}, {})", texels.components());
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic and version take 8 bytes, the length 2, and the line ends with a newline.
    let padding = (10 + text.len() + 1).next_multiple_of(ALIGNMENT) - (10 + text.len() + 1);
    let text = format!("{text}{}\n", " ".repeat(padding));
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text.bytes());
    file.write_all(&header).map_err(failed)?;
    raw::write(texels, file)
}
