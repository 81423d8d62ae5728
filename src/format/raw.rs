//! The texels alone, little-endian, slice by slice and row by row: the bytes that an engine copies
//! into a texture.

use super::texels::Texels;
use super::{WriteSeek, failed};
use crate::error::Result;

/// Writes the texels of all slices.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let [_, rows, slices] = texels.size();
    for (slice, row) in (0..slices).flat_map(|slice| (0..rows).map(move |row| (slice, row))) {
        file.write_all(&texels.row(slice, row)).map_err(failed)?;
    }
    Ok(())
}
