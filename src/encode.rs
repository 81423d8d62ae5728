//! A table as the bytes of a file. Encoders are pure: the same table gives the same bytes, on every machine.

pub mod exr;
pub mod metadata;
pub mod png;

use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::table::Table;
use std::io::{Cursor, Seek, Write};

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

/// Writes a file of one table, or of several where the format has layers, as it encodes it.
pub fn write(tables: &[Table], format: Format, file: impl Write + Seek) -> Result<()> {
    match (format, tables) {
        (Format::Exr, tables) => exr::write(tables, file),
        (Format::Png, [table]) => png::write(table, file),
        (Format::Png, _) => {
            let (expected, got) = ("one table in a .png", format!("{} layers", tables.len()));
            Err(Error::bad_input("layers", expected, got, "write an .exr, or one F0 at a time"))
        }
    }
}

/// The bytes of such a file.
pub fn encode(tables: &[Table], format: Format) -> Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    write(tables, format, &mut file)?;
    Ok(file.into_inner())
}

/// The stored bytes of red (0), green (1) or blue (2) of a texel, little-endian; of a channel that the table has not,
/// zeros.
fn texel_bytes<const N: usize>(table: &Table, i: usize, j: usize, channel: usize) -> [u8; N] {
    let channels = table.channels.len();
    if channel >= channels {
        return [0; N];
    }
    let value = (j * table.x.size + i) * channels + channel;
    table.values.bytes()[value * N..].first_chunk().copied().unwrap_or([0; N])
}

/// The system has refused to write; whoever opened the file knows its name.
fn failed(source: std::io::Error) -> Error {
    Error::Io { action: "write", path: "the file".into(), source, cure: "make room or choose another place" }
}
