//! How a table becomes a file: the format, and what a format leaves open.

use super::texels::Texels;
use super::{Format, WriteSeek, extensions};
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::lookup::check_name;
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;
use crate::table::{Layout, Table};
use std::fmt;

/// What a format leaves open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Components of a texel; by default as many as the format needs for the channels.
    pub components: Option<usize>,
    /// The compression of a KTX2 file.
    pub supercompress: Supercompress,
    /// What slices are to a graphics API.
    pub slices: SlicesAs,
    /// How source code has numbers.
    pub numbers: Notation,
    /// The name of the array in source code, with which the names of its functions begin; by
    /// default `splitsum_table`.
    pub symbol: Option<String>,
}

/// The compression of a KTX2 file, which its readers undo.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Supercompress {
    /// None: every reader reads it.
    #[default]
    None,
    /// Zstandard.
    Zstd,
}

choice!(Supercompress, "supercompress", {
    None = "none", "none: every reader reads it";
    Zstd = "zstd", "Zstandard: a little smaller";
});

/// How source code has numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Notation {
    /// As they are stored: halves by their bits, f32 as decimals, unorms as whole numbers.
    #[default]
    Stored,
    /// By their bits.
    Bits,
    /// As the shortest decimals that read back to the same f32.
    Decimals,
}

choice!(Notation, "numbers", {
    Stored = "stored", "halves by their bits, f32 as decimals, unorms as whole numbers";
    Bits = "bits", "all by their bits";
    Decimals = "decimals", "all as the shortest decimals that read back to the same f32";
});

/// A format with everything decided that it leaves open.
#[derive(Clone, Debug)]
pub struct Encoding {
    format: &'static Format,
    style: Style,
    components: usize,
}

impl Style {
    /// Refuses what the format does not leave open.
    fn check(&self, format: &Format) -> Result<()> {
        let given = [
            ("supercompress", self.supercompress != Supercompress::default()),
            ("slices-as", self.slices != SlicesAs::default()),
            ("numbers", self.numbers != Notation::default()),
            ("symbol", self.symbol.is_some()),
        ];
        let follows = |flag| format.options.contains(&flag);
        match given.into_iter().find(|&(flag, given)| given && !follows(flag)) {
            None => self.symbol.iter().try_for_each(|symbol| check_name("symbol", symbol)),
            Some((flag, _)) => {
                let known = extensions(".", |format| format.options.contains(&flag));
                let cure = "leave it out, or choose one of those formats";
                Err(Error::bad_input(flag, known, format!(".{}", format.extension), cure))
            }
        }
    }
}

impl Encoding {
    /// The format for tables of this layout and storage in this style; an error where it does not
    /// hold them.
    pub fn new(
        format: &'static Format,
        style: Style,
        layout: &Layout,
        precision: Precision,
    ) -> Result<Self> {
        format.precision(Some(precision))?;
        let slices = layout.slice_count();
        if slices > 1 && !format.slices {
            let (expected, got) =
                (format!("one slice in a .{}", format.extension), slices.to_string());
            let several = extensions(".", |format| format.slices);
            let cure = match several.is_empty() {
                true => "write one slice at a time".into(),
                false => format!("choose {several}, or write one slice at a time"),
            };
            return Err(Error::bad_input("slices", expected, got, cure));
        }
        let components = components(format, style.components, layout.channels.len(), precision)?;
        style.check(format)?;
        if style.slices != SlicesAs::default() && slices == 1 {
            let cure = "leave it out, or bake several";
            return Err(Error::bad_input("slices-as", "several slices", "one", cure));
        }
        Ok(Encoding { format, style, components })
    }

    /// The format for a table, in its default style.
    pub fn of(table: &Table, format: &'static Format) -> Result<Self> {
        Encoding::new(format, Style::default(), table.layout(), table.precision())
    }

    /// The format.
    pub fn format(&self) -> &'static Format {
        self.format
    }

    /// What the format leaves open.
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// Components of a texel: its channels, then 0, and 1 as the fourth.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Writes a file, as it is encoded.
    pub fn write(&self, table: &Table, file: &mut dyn WriteSeek) -> Result<()> {
        let (style, precision) = (self.style.clone(), table.precision());
        let encoding = Encoding::new(self.format, style, table.layout(), precision)?;
        (self.format.write)(&Texels::new(table, encoding), file)
    }
}

/// The number of components: as wanted, or the smallest that the format has for the channels.
fn components(
    format: &Format,
    wanted: Option<usize>,
    channels: usize,
    precision: Precision,
) -> Result<usize> {
    // Those storages are of four components by their definition, or because GPUs have no other
    // texture on the curve of sRGB.
    let whole = match precision {
        Precision::A2b10g10r10 | Precision::Rgbd8 => true,
        Precision::Srgb8 => format.is_texture(),
        _ => false,
    };
    let fewest = if whole { 4 } else { wanted.unwrap_or(format.fewest).max(channels) };
    let smallest = format.components.iter().find(|count| **count >= fewest).copied();
    match (smallest, wanted) {
        (Some(count), None) => Ok(count),
        (Some(count), Some(wanted)) if count == wanted => Ok(count),
        _ => {
            let least = if whole { 4 } else { channels };
            let known = format.components.iter().filter(|count| **count >= least);
            let known: Vec<String> = known.map(usize::to_string).collect();
            let expected = match known.is_empty() {
                true => format!(
                    "at most {} channels in a .{}",
                    format.components.last().unwrap_or(&0),
                    format.extension
                ),
                false => format!(
                    "{} for {channels} channels of {precision} in a .{}",
                    known.join(" or "),
                    format.extension
                ),
            };
            let got = wanted.unwrap_or(channels).to_string();
            let what = if known.is_empty() { "channels" } else { "components" };
            Err(Error::bad_input(what, expected, got, "choose those, or another format"))
        }
    }
}

impl Encoding {
    /// The command that repeats the file: that of the table, and the format where its storage does
    /// not tell.
    pub fn command(&self, table: &str, precision: Precision) -> String {
        let told = std::ptr::eq(Format::of_precision(Some(precision)), self.format);
        match told && self.style == Style::default() {
            true => table.to_owned(),
            false => format!("{table} {self}"),
        }
    }
}

impl fmt::Display for Encoding {
    /// The flags of the format, of its defaults only what the extension tells.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Style { components, supercompress, slices, numbers, symbol } = &self.style;
        write!(f, "--format {}", self.format.extension)?;
        if let Some(components) = components {
            write!(f, " --components {components}")?;
        }
        if *supercompress != Supercompress::default() {
            write!(f, " --supercompress {supercompress}")?;
        }
        if *slices != SlicesAs::default() {
            write!(f, " --slices-as {slices}")?;
        }
        if *numbers != Notation::default() {
            write!(f, " --numbers {numbers}")?;
        }
        if let Some(symbol) = symbol {
            write!(f, " --symbol {symbol}")?;
        }
        Ok(())
    }
}
