//! A table as the bytes of a file. Encoders are pure: the same table gives the same bytes, on every machine.

pub mod exr;
pub mod metadata;
pub mod png;

use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::table::Table;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: R, G, B in half or float.
    Exr,
    /// PNG: R, G, B in 16 or 8 bits, linear.
    Png,
}

impl Format {
    /// All formats, with the extension and the precisions of each, the default one first.
    pub const ALL: [(Format, &'static str, &'static [Precision]); 2] = [
        (Format::Exr, "exr", &[Precision::F16, Precision::F32]),
        (Format::Png, "png", &[Precision::Unorm16, Precision::Unorm8]),
    ];

    /// The format that a file's extension names.
    pub fn of_extension(extension: &str) -> Result<Self> {
        let found = Format::ALL.iter().find(|(_, known, _)| extension.eq_ignore_ascii_case(known));
        found.map(|(format, ..)| *format).ok_or_else(|| {
            let known = Format::ALL.map(|(_, extension, _)| format!(".{extension}")).join(" or ");
            Error::bad_input("output", format!("a name that ends in {known}"), format!("'.{extension}'"), "rename it")
        })
    }

    /// The precision to store in: the one wanted, if the format has it, or its default.
    pub fn precision(self, wanted: Option<Precision>) -> Result<Precision> {
        let (_, extension, precisions) = Format::ALL[self as usize];
        let Some(wanted) = wanted else { return Ok(precisions[0]) };
        if precisions.contains(&wanted) {
            return Ok(wanted);
        }
        let known = precisions.iter().map(crate::units::word).collect::<Vec<_>>().join(" or ");
        let expected = format!("{known} for .{extension}");
        Err(Error::bad_input(
            "precision",
            expected,
            crate::units::word(wanted),
            "choose one of these or another format",
        ))
    }
}

/// The bytes of a file of one table, or of several where the format has layers.
pub fn encode(tables: &[Table], format: Format, precision: Precision) -> Result<Vec<u8>> {
    match (format, tables) {
        (Format::Exr, tables) => exr::encode(tables, precision),
        (Format::Png, [table]) => png::encode(table, precision),
        (Format::Png, _) => {
            let (expected, got) = ("one table in a .png", format!("{} layers", tables.len()));
            Err(Error::bad_input("layers", expected, got, "write an .exr, or one F0 at a time"))
        }
    }
}

/// The bits of red, green and blue, each plane row by row; a channel that the table has not is 0.
fn rgb_planes(table: &Table, precision: Precision) -> Result<[Vec<u32>; 3]> {
    let (n, texels) = (table.channels.len(), table.x.size * table.y.size);
    let plane = |channel: usize| {
        if channel >= n {
            return Ok(vec![0; texels]);
        }
        precision.store(&table.plane(channel), table.provenance.worth.error_bound())
    };
    Ok([plane(0)?, plane(1)?, plane(2)?])
}
