//! Files of splitsum against their own metadata: they are baked again, and compared byte for byte.

use crate::backend::Backend;
use crate::bake::Plan;
use crate::cli::table_args::{Job, TableArgs};
use crate::error::{Error, Result};
use crate::foreign::{Foreign, Reading};
use crate::verify::{Expected, Fault, Kind};
use std::io::Cursor;

/// The longest bake, by its own plan: a file may ask for hours.
const LONGEST: f64 = 60.0;

/// The command in the metadata of a file of splitsum, or in the comment of its source code.
pub fn command(bytes: &[u8], table: &Foreign) -> Option<String> {
    let of_json = |text: &String| {
        let json: serde_json::Value = serde_json::from_str(text).ok()?;
        let first = if json.is_array() { json.get(0)? } else { &json };
        first.get("command")?.as_str().map(str::to_owned)
    };
    let command = match table.own.first() {
        Some(text) => of_json(text),
        None => std::str::from_utf8(bytes).ok().and_then(|text| {
            let (_, rest) = text.split_once(": splitsum bake ")?;
            rest.lines().next().map(|line| format!("splitsum bake {line}"))
        }),
    };
    command?.strip_prefix("splitsum bake ").map(str::to_owned)
}

/// The job of a command; an error where it is none, or of another size.
fn job(command: &str, table: &Foreign) -> std::result::Result<Job, String> {
    let wrong = |error: Error| format!("its command is none that bakes: {error}");
    let job = TableArgs::of_flags(command).and_then(|table| table.job()).map_err(wrong)?;
    let layout = job.request.layout();
    let size = [layout.x.size(), layout.y.size(), layout.slice_count()];
    match size == table.size {
        true => Ok(job),
        false => Err(format!("its command bakes {size:?} texels, the file has {:?}", table.size)),
    }
}

/// What the metadata say that a table is, where its command bakes one of its size.
pub fn expected(command: &str, table: &Foreign) -> Result<Option<Expected>> {
    let expected = |job: Job| Expected { whose: "its metadata".into(), request: job.request };
    Ok(job(command, table).ok().map(expected))
}

/// Where a file is not what its own command bakes.
pub fn faults(command: &str, bytes: &[u8], table: &Foreign) -> Result<Vec<Fault>> {
    let fault = |text: String| Ok(vec![Fault::new(Kind::NotOurs, text)]);
    let job = match job(command, table) {
        Ok(job) => job,
        Err(why) => return fault(why),
    };
    let backend = Backend::cpu();
    let plan = Plan::new(&job.request, &backend)?;
    if plan.seconds() > LONGEST {
        return fault(format!("a bake of {:.0} s was not repeated", plan.seconds()));
    }
    let baked = plan.bake(&|_| ())?.table;
    let mut file = Cursor::new(Vec::new());
    job.encoding.write(&baked, &mut file)?;
    let again = file.into_inner();
    if again == bytes {
        return Ok(Vec::new());
    }
    let reading = Reading::default();
    let again = Foreign::read("the bake", &again, &reading)?;
    Ok(vec![Fault::new(Kind::NotOurs, differences(table, &again))])
}

/// What differs, in words.
fn differences(table: &Foreign, again: &Foreign) -> String {
    let components = table.components();
    if components != again.components() || table.size != again.size {
        return "its channels are not those of its command".into();
    }
    let differ = |at: &usize| table.values[*at].to_bits() != again.values[*at].to_bits();
    let wrong: Vec<usize> = (0..table.values.len()).filter(differ).collect();
    if let [first, ..] = wrong[..] {
        let (texel, component) = (first / components, first % components);
        let [columns, rows, _] = table.size;
        return format!(
            "{} of {} values are not those of its bake; the first is {} of texel ({}, {}), slice \
             {}: {} in place of {}",
            wrong.len(),
            table.values.len(),
            table.names[component],
            texel % columns,
            texel / columns % rows,
            texel / columns / rows,
            table.values[first],
            again.values[first]
        );
    }
    let keys = changed_keys(&table.own, &again.own);
    match keys.is_empty() {
        true => "all values are those of its bake; the rest of the file is not".into(),
        false => format!("metadata are not those of its bake: {}", keys.join(", ")),
    }
}

/// The keys of metadata that differ.
fn changed_keys(found: &[String], baked: &[String]) -> Vec<String> {
    let parse = |texts: &[String]| -> Vec<serde_json::Value> {
        texts.iter().filter_map(|text| serde_json::from_str(text).ok()).collect()
    };
    let mut keys = Vec::new();
    for (found, baked) in parse(found).iter().zip(&parse(baked)) {
        let (Some(found), Some(baked)) = (found.as_object(), baked.as_object()) else { continue };
        for key in found.keys().chain(baked.keys()) {
            if found.get(key) != baked.get(key) && !keys.contains(key) {
                keys.push(key.clone());
            }
        }
    }
    keys
}
