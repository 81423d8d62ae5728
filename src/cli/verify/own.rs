//! Files of splitsum against their own metadata: they are baked again, and compared byte for byte.

use super::ReadArgs;
use crate::backend::Backend;
use crate::bake::Plan;
use crate::cli::table_args::{Job, TableArgs};
use crate::error::{Error, Result, clean};
use crate::foreign::Foreign;
use crate::request::Accuracy;
use crate::verify::{Expected, Fault, Kind};
use std::io::Cursor;

/// Seconds of a point of an estimator on one core.
const SECONDS_A_POINT: f64 = 1e-8;

/// The longest bake, by its own plan: a file may ask for hours.
const LONGEST: f64 = 60.0;

/// The comment that begins the source code of a table.
const COMMENT: &str = "// splitsum ";

/// A file that says how splitsum baked it.
pub struct Own {
    /// What it is to be, where its command bakes a table of its size.
    pub expected: Option<Expected>,
    /// Where it is not what its command bakes.
    pub fault: Option<Fault>,
    /// What else is to be known of it.
    pub note: Option<String>,
}

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
            let line = text.lines().take(LINES).find(|line| line.starts_with(COMMENT))?;
            line.split_once(": ").map(|(_, command)| command.to_owned())
        }),
    };
    command?.strip_prefix("splitsum bake ").map(str::to_owned)
}

/// The comment stands within so many lines.
const LINES: usize = 8;

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

/// The seconds of a bake: by its plan, or by the points of an estimator.
fn seconds(job: &Job, plan: &Plan) -> f64 {
    let of_estimator = match job.request.accuracy() {
        Accuracy::Estimator(estimator) => {
            let count = f64::from(estimator.count().unwrap_or(0));
            job.request.texels() as f64 * count * SECONDS_A_POINT
        }
        _ => 0.0,
    };
    plan.seconds() + of_estimator
}

impl Own {
    /// Bakes the table again, and compares.
    pub fn new(command: &str, table: &Foreign, bytes: &[u8], read: &ReadArgs) -> Result<Self> {
        let fault = |text: &str| Some(Fault::new(Kind::NotOurs, clean(text, 400)));
        let job = match job(command, table) {
            Ok(job) => job,
            Err(why) => return Ok(Own { expected: None, fault: fault(&why), note: None }),
        };
        let request = job.request.clone();
        let expected = |certain| {
            let (whose, request) = ("its metadata".into(), request.clone());
            Some(Expected { whose, request, size: None, certain })
        };
        let backend = Backend::cpu();
        let plan = Plan::new(&job.request, &backend)?;
        let seconds = seconds(&job, &plan);
        if seconds > LONGEST {
            let note = format!("not baked again to be compared: that takes {seconds:.0} s");
            return Ok(Own { expected: expected(false), fault: None, note: Some(note) });
        }
        let baked = plan.bake(&|_| ())?.table;
        let mut file = Cursor::new(Vec::new());
        job.encoding.write(&baked, &mut file)?;
        let again = file.into_inner();
        if again == bytes {
            return Ok(Own { expected: expected(true), fault: None, note: None });
        }
        let again = Foreign::read("the bake", &again, &read.reading()?)?;
        let differences = differences(table, &again);
        Ok(Own { expected: expected(false), fault: fault(&differences), note: None })
    }
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
    // A text holds the metadata of one slice, or a list of those of all.
    let parse = |texts: &[String]| -> Vec<serde_json::Value> {
        let of = |text: &String| match serde_json::from_str(text) {
            Ok(serde_json::Value::Array(list)) => list,
            Ok(one) => vec![one],
            Err(_) => Vec::new(),
        };
        texts.iter().flat_map(of).collect()
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
