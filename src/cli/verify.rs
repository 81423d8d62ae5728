//! `splitsum verify`

mod catalogue;
mod own;
mod text;

use super::table_args::TableArgs;
use super::{choices, output, place, print, print_json, standard_output, usage};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::foreign::{Foreign, MOST_BYTES, RawLayout, Reading};
use crate::preset::Preset;
use crate::verify::{Demands, Expected, Kind, Report, Status, page, verify};
use std::fs::File;
use std::io::Read;

#[derive(clap::Args)]
pub struct VerifyArgs {
    /// File of a table: .exr, .ktx2, .dds, .png, .npy, texels alone, or numbers in source code
    #[arg(required_unless_present = "catalogue")]
    file: Option<String>,
    #[command(flatten)]
    read: ReadArgs,
    /// Engine whose table it is to be: its convention, and its lookup ('splitsum presets' lists
    /// them)
    #[arg(
        long = "as", value_name = "PRESET", value_parser = choices::preset(),
        hide_possible_values = true
    )]
    preset: Option<String>,
    /// Largest error of a stored value; one beyond is a fault
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true)]
    max_error: Option<f64>,
    /// Faults that do not fail, with commas between, for example 8-bit
    #[arg(
        long, value_name = "FAULT[,FAULT...]", value_delimiter = ',',
        value_parser = choices::of::<Kind>()
    )]
    allow: Vec<Kind>,
    /// Write the report as a page of HTML, with maps of the errors
    #[arg(long, value_name = "FILE")]
    html: Option<String>,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
    /// List what is known of tables that others ship
    #[arg(long, conflicts_with_all = ["file", "ReadArgs", "preset", "max_error", "allow", "html"])]
    catalogue: bool,
}

/// How a file is read that does not say its layout.
#[derive(clap::Args)]
pub struct ReadArgs {
    /// Layout of texels alone, for example 64x64,rg16f: COLUMNSxROWS[xSLICES], then r, rg, rgb or
    /// rgba with 8, 16, 16f or 32f behind it, or rgb10a2; of numbers in source code their size
    #[arg(long, value_name = "SIZE,TEXEL")]
    raw: Option<String>,
    /// Name of the array in source code [default: the longest]
    #[arg(long, value_name = "NAME")]
    array: Option<String>,
}

pub fn run(arguments: &VerifyArgs) -> Result<()> {
    let VerifyArgs { file, read, preset, max_error, allow, html, json, .. } = arguments;
    standard_output::check()?;
    let Some(file) = file else { return catalogue::run(*json) };
    if max_error.is_some_and(|most| !(0.0..).contains(&most)) {
        let got = format!("{:?}", max_error.unwrap_or_default());
        return Err(Error::bad_input("max-error", "0 or more", got, "give such a number"));
    }
    if let Some(html) = html {
        let mut files = place::Files::default();
        files.add("the table that is read", file);
        if let Some(other) = files.add("the page", html) {
            let got = format!("{html}, which is {other}");
            return Err(usage("--html", "a file of its own", &got, "name another one"));
        }
        output::check(html)?;
    }
    let (table, bytes) = read_table(file, read)?;
    let command = own::command(&bytes, &table);
    let own = command.as_deref().map(|command| own::Own::new(command, &table, &bytes, read));
    let own = own.transpose()?;
    let expected = match (preset, &own) {
        (Some(preset), _) => Some(of_preset(preset, &table)?),
        (None, Some(own)) => own.expected.clone(),
        (None, None) => None,
    };
    let demands = Demands { largest_error: *max_error, expected };
    let mut report = verify(file, &table, &demands)?;
    if let Some(own) = own {
        report.faults.extend(own.fault);
        report.file.notes.extend(own.note);
    }
    if let Some(html) = html {
        output::write(html, page(&report)?.as_bytes())?;
    }
    match json {
        true => print_json(&report)?,
        false => print(&text::text(&report))?,
    }
    report.faults.retain(|fault| !allow.contains(&fault.name));
    match report.fails() {
        true => Err(refusal(&report)),
        false => Ok(()),
    }
}

/// The table of a file, and its bytes.
pub fn read_table(file: &str, read: &ReadArgs) -> Result<(Foreign, Vec<u8>)> {
    let bytes = bytes_of(file)?;
    let table = Foreign::read(file, &bytes, &read.reading()?)?;
    Ok((table, bytes))
}

impl ReadArgs {
    /// The flags as a reader takes them.
    pub fn reading(&self) -> Result<Reading> {
        let raw = self.raw.as_deref().map(str::parse::<RawLayout>).transpose()?;
        Ok(Reading { raw, array: self.array.clone() })
    }
}

/// The table of a preset in the size of another.
fn of_preset(preset: &str, table: &Foreign) -> Result<Expected> {
    let [columns, rows, _] = table.size;
    let request =
        |size: &str| Ok(TableArgs::of_flags(&format!("--preset {preset}{size}"))?.job()?.request);
    let size = match Preset::named(preset)?.only_size {
        true => {
            let own = request("")?;
            Some([own.layout().x.size(), own.layout().y.size()])
        }
        false => None,
    };
    let request = request(&format!(" --size {columns}x{rows}"))?;
    Ok(Expected { whose: preset.to_owned(), request, size, certain: false })
}

/// Why a table is refused, in a line.
fn refusal(report: &Report) -> Error {
    let mut names: Vec<&str> = report.faults.iter().map(|fault| fault.name.word()).collect();
    names.sort_unstable();
    names.dedup();
    let why = match report.status {
        Status::Unknown => "no convention that is known fits".into(),
        Status::Known => names.join(", "),
    };
    Error::CheckFailed(format!("{}: {why}", report.file.name))
}

/// The bytes of a file, which may not be too many.
fn bytes_of(path: &str) -> Result<Vec<u8>> {
    let failed = Error::io("read", path, "name a file that can be read");
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(&failed)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(&failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        let expected = format!("at most {} MiB", MOST_BYTES >> 20);
        return Err(Error::bad_input(path, expected, "more", "name a file of a table"));
    }
    Ok(bytes)
}
