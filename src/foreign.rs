//! Tables of any maker, out of their files: texels as numbers, and what a file says of them.
//!
//! Files are hostile. Sizes are bounded from headers before anything is allocated, no more is
//! decoded than they promise, and whatever is odd but can be read is noted.

mod bytes;
mod dds;
mod exr;
mod ktx2;
mod npy;
mod png;
mod raw;
mod shape;
mod source;
mod texel;

pub use raw::{RAW_WORDS, RawLayout};

use crate::error::{Error, Result, clean};
use crate::table::precision::Precision;

/// The most numbers of a file: 128 MiB as f32. A table of 4096 x 4096 texels has two components.
pub const MOST_VALUES: usize = 1 << 25;

/// The most bytes of a file that are read: those numbers, and metadata.
pub const MOST_BYTES: u64 = 160 << 20;

/// A table as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Foreign {
    /// Columns, rows and slices.
    pub size: [usize; 3],
    /// The names of a texel's components.
    pub names: Vec<String>,
    /// Slice by slice, row by row, texel by texel, component by component; codes of whole numbers
    /// are fractions of the largest.
    pub values: Vec<f32>,
    /// How numbers are stored.
    pub storage: Precision,
    /// The container, by its name.
    pub container: &'static str,
    /// What the file says of the curve of its codes.
    pub curve: Option<Curve>,
    /// What else is to be known of the file.
    pub notes: Vec<String>,
    /// What is wrong with the container.
    pub faults: Vec<String>,
    /// The metadata of splitsum: a text for each slice, or one for all.
    pub own: Vec<String>,
}

/// A curve on which codes lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// None.
    Linear,
    /// That of sRGB.
    Srgb,
    /// A power: value = code^exponent.
    Gamma(f64),
}

impl Curve {
    /// It in words.
    pub fn name(self) -> String {
        match self {
            Curve::Linear => "linear".into(),
            Curve::Srgb => "srgb".into(),
            Curve::Gamma(exponent) => format!("a power of {exponent:.2}"),
        }
    }
}

/// How a file is to be read where it does not say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The layout of texels alone.
    pub raw: Option<RawLayout>,
    /// The name of an array in source code.
    pub array: Option<String>,
}

/// Why a file is not read: the expectation, and the finding.
#[derive(Clone, Debug, PartialEq)]
struct Refusal {
    expected: String,
    got: String,
}

/// The result of reading.
type Read<T> = std::result::Result<T, Refusal>;

/// A refusal.
fn refuse<T>(expected: impl Into<String>, got: impl Into<String>) -> Read<T> {
    Err(Refusal { expected: expected.into(), got: got.into() })
}

/// The refusal of a decoder, in its words.
fn refused(container: &str, error: impl std::fmt::Display) -> Refusal {
    let got = clean(&error.to_string(), 160);
    Refusal { expected: format!("a whole {container} file"), got }
}

/// The table in a container that its first bytes tell; none where they tell none.
fn by_first_bytes(bytes: &[u8]) -> Option<Read<Foreign>> {
    Some(match bytes {
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read(bytes),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => ktx2::read(bytes),
        [b'D', b'D', b'S', b' ', ..] => dds::read(bytes),
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes),
        [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => npy::read(bytes),
        _ => return None,
    })
}

impl Foreign {
    /// The table in these bytes, for errors called `name`. Without a layout the first bytes tell
    /// the container, and what is none is text with numbers.
    pub fn read(name: &str, bytes: &[u8], reading: &Reading) -> Result<Self> {
        let read = match reading {
            // A layout is that of texels alone, or of numbers in text.
            Reading { raw: Some(layout), array: None } => match raw::read(bytes, layout) {
                Err(_) if std::str::from_utf8(bytes).is_ok() => source::read(bytes, reading),
                read => read,
            },
            _ => by_first_bytes(bytes).unwrap_or_else(|| source::read(bytes, reading)),
        };
        read.map_err(|Refusal { expected, got }| {
            let cure = "mend the file, or name another; --raw gives the layout of texels alone";
            Error::bad_input(clean(name, 200), expected, got, cure)
        })
    }

    /// Components of a texel.
    pub fn components(&self) -> usize {
        self.names.len()
    }

    /// A table of a container without more to say.
    fn new(
        container: &'static str,
        size: [usize; 3],
        components: usize,
        storage: Precision,
        values: Vec<f32>,
    ) -> Self {
        Foreign {
            size,
            names: shape::names(components),
            values,
            storage,
            container,
            curve: None,
            notes: Vec::new(),
            faults: Vec::new(),
            own: Vec::new(),
        }
    }
}
