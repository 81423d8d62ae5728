//! Configurations: TOML files with a `[[table]]` for each table.

use super::table_args::{Job, TableArgs};
use crate::error::{Error, Result};
use serde::Deserialize;
use std::path::Path;

/// A configuration larger than this is a mistake.
const LARGEST: u64 = 1 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    #[serde(default)]
    table: Vec<TableArgs>,
}

/// The jobs of a configuration; relative outputs are relative to the configuration's folder.
pub fn read(path: &str) -> Result<Vec<Job>> {
    let io = Error::io("read", path, "name a TOML file that can be read");
    let size = std::fs::metadata(path).map_err(&io)?.len();
    if size > LARGEST {
        let (expected, got) = ("a configuration of at most 1 MiB", format!("{size} bytes"));
        return Err(Error::bad_input(path, expected, got, "name a TOML file"));
    }
    jobs(path, &std::fs::read(path).map_err(&io)?)
}

/// The jobs of a configuration with these bytes at `path`.
fn jobs(path: &str, bytes: &[u8]) -> Result<Vec<Job>> {
    let wrong =
        |expected: &str, got: String, cure: &str| Error::bad_input(path, expected, got, cure);
    let text = std::str::from_utf8(bytes)
        .map_err(|_| wrong("TOML", "bytes that are not UTF-8".into(), "name a TOML file"))?;
    let keys = "give the flags of 'splitsum bake --help' without the dashes, and values as there";
    let config: Config = toml::from_str(text).map_err(|error| {
        wrong("[[table]] entries", format!("\n{}", error.to_string().trim_end()), keys)
    })?;
    if config.table.is_empty() {
        return Err(wrong("at least one [[table]]", "none".into(), "add one"));
    }
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    let mut jobs = Vec::new();
    for (index, table) in config.table.into_iter().enumerate() {
        let name = format!("{path}, table {}", index + 1);
        let mut job = table.job().map_err(|error| in_table(&name, error))?;
        match &table.output {
            Some(output) if output != "-" => {
                job.output = folder.join(output).to_string_lossy().into_owned()
            }
            other => {
                let got = if other.is_some() { "-" } else { "none" };
                let cure = "give output = \"FILE\"";
                return Err(Error::bad_input(name, "an output file", got, cure));
            }
        }
        if let Some((lookup, _)) = &mut job.lookup {
            *lookup = folder.join(&*lookup).to_string_lossy().into_owned();
        }
        jobs.push(job);
    }
    Ok(jobs)
}

/// The number of tables in a configuration with these bytes, without a disk.
#[doc(hidden)]
pub fn count(bytes: &[u8]) -> Result<usize> {
    jobs("a configuration", bytes).map(|jobs| jobs.len())
}

fn in_table(name: &str, error: Error) -> Error {
    match error {
        Error::BadInput(mut complaint) => {
            complaint.what = format!("{name}: {}", complaint.what);
            Error::BadInput(complaint)
        }
        other => other,
    }
}
