//! File formats: a table as the bytes of a file. Encoders are pure: the same table gives the same
//! bytes, on every machine.

#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "serde")]
pub mod metadata;
#[cfg(feature = "png")]
pub mod png;

use crate::choice::words;
use crate::error::{Error, Result};
use crate::table::Table;
use crate::table::precision::Precision;
use std::io::{Cursor, Seek, Write};
use std::path::Path;

/// A file that encoders write.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// A file format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// The extension of its files, which is its word too.
    extension: &'static str,
    /// The storages that it has, the default one first.
    precisions: &'static [Precision],
    /// The names of its channels; a table with fewer fills up with zeros.
    channels: &'static [&'static str],
    /// Whether a file holds several slices.
    slices: bool,
    write: fn(&Table, &mut dyn WriteSeek) -> Result<()>,
}

/// All formats, the default one first.
pub const FORMATS: &[Format] = &[
    #[cfg(feature = "exr")]
    Format {
        extension: "exr",
        precisions: &[Precision::F16, Precision::F32],
        // three.js refuses files with fewer.
        channels: &["R", "G", "B"],
        slices: true,
        write: exr::write,
    },
    #[cfg(feature = "png")]
    Format {
        extension: "png",
        precisions: &[Precision::Unorm16, Precision::Unorm8],
        channels: &["R", "G", "B"],
        slices: false,
        write: png::write,
    },
];

impl Format {
    /// The format with this word.
    pub fn named(word: &str) -> Result<&'static Format> {
        FORMATS.iter().find(|format| format.extension == word).ok_or_else(|| {
            let known = extensions("", |_| true);
            Error::bad_input("format", known, format!("'{word}'"), "name one of these")
        })
    }

    /// The format of a file with this name, by its extension.
    pub fn of_file(name: &str) -> Result<&'static Format> {
        let extension = Path::new(name).extension().unwrap_or_default();
        let is_its = |format: &&Format| extension.eq_ignore_ascii_case(format.extension);
        FORMATS.iter().find(is_its).ok_or_else(|| {
            let expected = format!("a name that ends in {}", extensions(".", |_| true));
            Error::bad_input("output", expected, format!("'{name}'"), "rename it")
        })
    }

    /// The first format with this storage; without a wish, or where none has it, the default one.
    pub fn of_precision(wanted: Option<Precision>) -> &'static Format {
        let has =
            |format: &&Format| wanted.is_none_or(|wanted| format.precisions.contains(&wanted));
        FORMATS.iter().find(has).unwrap_or(&FORMATS[0])
    }

    /// The extension of its files, which is its word too.
    pub fn extension(&self) -> &'static str {
        self.extension
    }

    /// The storages that it has, the default one first.
    pub fn precisions(&self) -> &'static [Precision] {
        self.precisions
    }

    /// The storage: the one wanted, if the format has it, or its default.
    pub fn precision(&self, wanted: Option<Precision>) -> Result<Precision> {
        let wanted = wanted.unwrap_or(self.precisions[0]);
        if self.precisions.contains(&wanted) {
            return Ok(wanted);
        }
        let expected =
            format!("{} for .{}", words(self.precisions).replace(", ", " or "), self.extension);
        let cure = "choose one of these or another format";
        Err(Error::bad_input("precision", expected, wanted.to_string(), cure))
    }

    /// Refuses a number of slices or channels that a file does not hold.
    pub fn check(&self, slices: usize, channels: usize) -> Result<()> {
        if slices > 1 && !self.slices {
            let (expected, got) =
                (format!("one slice in a .{}", self.extension), slices.to_string());
            let several = extensions(".", |format| format.slices);
            let cure = match several.is_empty() {
                true => "write one slice at a time".into(),
                false => format!("choose {several}, or write one slice at a time"),
            };
            return Err(Error::bad_input("slices", expected, got, cure));
        }
        if channels > self.channels.len() {
            let expected =
                format!("at most {} channels in a .{}", self.channels.len(), self.extension);
            return Err(Error::bad_input(
                "channels",
                expected,
                channels.to_string(),
                "choose fewer, or another format",
            ));
        }
        Ok(())
    }

    /// Writes a file, as it is encoded; an error where the format does not hold the table.
    pub fn write(&self, table: &Table, file: &mut dyn WriteSeek) -> Result<()> {
        self.precision(Some(table.precision()))?;
        self.check(table.layout().slice_count(), table.channels().len())?;
        (self.write)(table, file)
    }
}

/// The extensions of the formats that `serve`, as in `.exr or .png`.
fn extensions(dot: &str, serve: impl Fn(&Format) -> bool) -> String {
    let known = FORMATS.iter().filter(|format| serve(format));
    known.map(|format| format!("{dot}{}", format.extension)).collect::<Vec<_>>().join(" or ")
}

/// The bytes of a file.
pub fn encode(table: &Table, format: &Format) -> Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    format.write(table, &mut file)?;
    Ok(file.into_inner())
}

/// The stored bytes of a channel of a texel of a slice, little-endian; zeros of a channel that the
/// table has not.
#[cfg(any(feature = "exr", feature = "png"))]
#[inline]
fn texel_bytes<const N: usize>(
    table: &Table,
    slice: usize,
    (i, j): (usize, usize),
    channel: usize,
) -> [u8; N] {
    let channels = table.channels().len();
    if channel >= channels {
        return [0; N];
    }
    let value = (j * table.x().size() + i) * channels + channel;
    table.bytes(slice)[value * N..].first_chunk().copied().unwrap_or([0; N])
}

/// The error of a system that refuses to write; whoever opened the file knows its name.
#[cfg(any(feature = "exr", feature = "png"))]
fn failed(source: std::io::Error) -> Error {
    Error::Io {
        action: "write",
        path: "the file".into(),
        source,
        cure: "make room or choose another place",
    }
}
