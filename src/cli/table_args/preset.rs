//! A preset below the flags that are given beside it.

use super::TableArgs;
use crate::cli::output::DEFAULT_FOLDER;
use crate::error::{Error, Result};
use crate::preset::Preset;
use clap::Parser;

/// Flags alone, without a command.
#[derive(Parser)]
#[command(no_binary_name = true)]
struct Flags {
    #[command(flatten)]
    table: TableArgs,
}

impl TableArgs {
    /// The table of these flags, with blanks between.
    pub fn of_flags(flags: &str) -> Result<TableArgs> {
        // No word of theirs has blanks, so that quotes only guard it from a shell.
        let words = flags.split_whitespace().map(|word| word.replace('\'', ""));
        let parsed = Flags::try_parse_from(words);
        let wrong = |error: clap::Error| {
            let first = error.to_string().lines().next().unwrap_or_default().to_owned();
            Error::bad_input("flags", "those of 'splitsum bake'", first, "bake the file anew")
        };
        parsed.map(|flags| flags.table).map_err(wrong)
    }

    /// These flags, and where they say nothing those of their preset.
    pub(super) fn with_preset(&self) -> Result<TableArgs> {
        let Some(name) = &self.preset else { return Ok(self.clone()) };
        let preset = Preset::named(name)?;
        let mut base = TableArgs::of_flags(preset.flags)?;
        // Another file has its own format, and what that leaves open.
        let other_file = self.output.as_ref().is_some_and(|output| !ends_like(output, preset.file));
        if self.format.is_some() || other_file {
            base.format = None;
            base.components = None;
            base.supercompress = None;
            base.numbers = None;
            base.symbol = None;
            base.slices_as = None;
        } else {
            base.output = Some(format!("{DEFAULT_FOLDER}/{}", preset.file));
        }
        let given = self.clone();
        Ok(TableArgs {
            preset: None,
            lut: given.lut.or(base.lut),
            model: given.model.or(base.model),
            masking: given.masking.or(base.masking),
            fresnel: given.fresnel.or(base.fresnel),
            channels: given.channels.or(base.channels),
            f0: given.f0.or(base.f0),
            ior: given.ior.or(base.ior),
            side: given.side.or(base.side),
            transmission_masking: given.transmission_masking.or(base.transmission_masking),
            size: given.size.or(base.size),
            x: given.x.or(base.x),
            y: given.y.or(base.y),
            z: given.z.or(base.z),
            precision: given.precision.or(base.precision),
            certify: given.certify.or(base.certify),
            tolerance: given.tolerance.or(base.tolerance),
            rule: given.rule.or(base.rule),
            estimator: given.estimator.or(base.estimator),
            format: given.format.or(base.format),
            components: given.components.or(base.components),
            supercompress: given.supercompress.or(base.supercompress),
            slices_as: given.slices_as.or(base.slices_as),
            numbers: given.numbers.or(base.numbers),
            symbol: given.symbol.or(base.symbol),
            lookup: given.lookup,
            output: given.output.or(base.output),
        })
    }
}

/// Whether two names have the same extension.
fn ends_like(name: &str, other: &str) -> bool {
    let extension =
        |name: &str| std::path::Path::new(name).extension().map(|e| e.to_ascii_lowercase());
    extension(name) == extension(other)
}
