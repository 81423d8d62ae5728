//! File formats: a table as the bytes of a file. Encoders are pure: the same table gives the same
//! bytes, on every machine.

pub mod code;
pub mod dds;
pub mod encoding;
#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "ktx2")]
pub mod ktx2;
#[cfg(feature = "serde")]
pub mod metadata;
#[cfg(feature = "png")]
pub mod png;
pub mod npy;
pub mod raw;
pub mod texels;

pub use encoding::{Encoding, Style};

use crate::choice::words;
use crate::error::{Error, Result};
use crate::table::Table;
use crate::table::precision::Precision;
use std::io::{Cursor, Seek, Write};
use std::path::Path;
use texels::Texels;

/// A file that encoders write.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// A file format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// The extension of its files, which is its word too.
    extension: &'static str,
    /// It in a line, for `--help`.
    about: &'static str,
    /// The storages that it has, the default one first.
    precisions: &'static [Precision],
    /// The numbers of components that a texel can have, ascending.
    components: &'static [usize],
    /// The fewest without a wish: many readers refuse less.
    fewest: usize,
    /// Whether a file holds several slices.
    slices: bool,
    /// The flags of [`Style`] that it follows, besides components.
    options: &'static [&'static str],
    write: fn(&Texels, &mut dyn WriteSeek) -> Result<()>,
}

/// All storages of files.
const ALL: &[Precision] = &[
    Precision::F16,
    Precision::F32,
    Precision::Unorm16,
    Precision::Unorm8,
    Precision::A2b10g10r10,
    Precision::Srgb8,
    Precision::Rgbd8,
];

/// All formats, the default one first.
pub const FORMATS: &[Format] = &[
    #[cfg(feature = "exr")]
    Format {
        extension: "exr",
        about: "OpenEXR; slices are parts",
        precisions: &[Precision::F16, Precision::F32],
        components: &[3, 4],
        // three.js refuses files with fewer.
        fewest: 3,
        slices: true,
        options: &[],
        write: exr::write,
    },
    #[cfg(feature = "png")]
    Format {
        extension: "png",
        about: "a picture of the table",
        precisions: &[Precision::Unorm16, Precision::Unorm8, Precision::Srgb8, Precision::Rgbd8],
        components: &[1, 3, 4],
        fewest: 3,
        slices: false,
        options: &[],
        write: png::write,
    },
    #[cfg(feature = "ktx2")]
    Format {
        extension: "ktx2",
        about: "KTX2, a texture as GPUs take it, with the metadata",
        precisions: ALL,
        components: &[1, 2, 4],
        fewest: 1,
        slices: true,
        options: &["supercompress", "slices-as"],
        write: ktx2::write,
    },
    Format {
        extension: "dds",
        about: "DirectDraw Surface with the header of Direct3D 10",
        precisions: ALL,
        components: &[1, 2, 4],
        // Most readers refuse fewer: on request.
        fewest: 4,
        slices: true,
        options: &["slices-as"],
        write: dds::write,
    },
    Format {
        extension: "npy",
        about: "an array of NumPy: (slices,) rows, columns, components",
        precisions: &[
            Precision::F16,
            Precision::F32,
            Precision::Unorm16,
            Precision::Unorm8,
            Precision::Srgb8,
            Precision::Rgbd8,
        ],
        components: &[1, 2, 3, 4],
        fewest: 1,
        slices: true,
        options: &[],
        write: npy::write,
    },
    Format {
        extension: "raw",
        about: "the texels alone, little-endian, row by row",
        precisions: ALL,
        components: &[1, 2, 3, 4],
        fewest: 1,
        slices: true,
        options: &[],
        write: raw::write,
    },
    Format {
        extension: "h",
        about: "a header of C and C++: array and lookup",
        write: code::h,
        ..CODE
    },
    Format {
        extension: "rs",
        about: "a module of Rust: array and lookup",
        write: code::rs,
        ..CODE
    },
    Format {
        extension: "js",
        about: "a module of JavaScript: a typed array",
        write: code::js,
        ..CODE
    },
    Format {
        extension: "ts",
        about: "a module of TypeScript: a typed array",
        write: code::ts,
        ..CODE
    },
    Format { extension: "wgsl", about: "array and lookup in WGSL", write: code::wgsl, ..CODE },
    Format { extension: "glsl", about: "array and lookup in GLSL", write: code::glsl, ..CODE },
    Format { extension: "hlsl", about: "array and lookup in HLSL", write: code::hlsl, ..CODE },
    Format { extension: "metal", about: "array and lookup in Metal", write: code::metal, ..CODE },
    Format {
        extension: "txt",
        about: "the numbers alone, to be included in an array",
        write: code::txt,
        options: &["numbers"],
        ..CODE
    },
];

/// What all source code has in common.
const CODE: Format = Format {
    extension: "",
    about: "",
    precisions: ALL,
    components: &[1, 2, 3, 4],
    fewest: 1,
    slices: true,
    options: &["numbers", "symbol"],
    write: code::txt,
};

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

    /// It in a line, for `--help`.
    pub fn about(&self) -> &'static str {
        self.about
    }

    /// Whether its files are textures as graphics APIs have them.
    fn is_texture(&self) -> bool {
        self.options.contains(&"slices-as")
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
}

/// The extensions of the formats that `serve`, as in `.exr, .png`.
fn extensions(dot: &str, serve: impl Fn(&Format) -> bool) -> String {
    let known = FORMATS.iter().filter(|format| serve(format));
    known.map(|format| format!("{dot}{}", format.extension)).collect::<Vec<_>>().join(", ")
}

/// The bytes of a file.
pub fn encode(table: &Table, format: &'static Format) -> Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    Encoding::of(table, format)?.write(table, &mut file)?;
    Ok(file.into_inner())
}

/// The error of a system that refuses to write; whoever opened the file knows its name.
fn failed(source: std::io::Error) -> Error {
    Error::Io {
        action: "write",
        path: "the file".into(),
        source,
        cure: "make room or choose another place",
    }
}
