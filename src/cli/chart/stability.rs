//! `splitsum chart stability`

use super::{Files, Saved, StudyArgs, write_files};
use crate::cli::print;
use crate::compare::chart::stability::chart;
use crate::compare::study::Machine;
use crate::compare::study::stability::{Family, Stability, cases, measure};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

#[derive(clap::Args)]
pub struct StabilityArgs {
    #[command(flatten)]
    study: StudyArgs,
}

#[derive(Serialize, Deserialize)]
pub struct Measured {
    stability: Stability,
}

/// Each family of maps, its files' name and its title.
const CHARTS: [(Family, &str, &str); 4] = [
    (Family::Formulas, "formulas", "Formulas of the textbook beside ours"),
    (Family::Methods, "methods", "Methods, far into the corners"),
    (Family::Storage, "storage", "What storage keeps"),
    (Family::Devices, "devices", "The same formulas in the f32 of devices"),
];

pub fn run(StabilityArgs { study }: &StabilityArgs) -> Result<()> {
    let pictures =
        CHARTS.iter().flat_map(|(_, name, _)| [format!("{name}.svg"), format!("{name}.png")]);
    let files: Vec<String> =
        pictures.chain(["stability.json".into(), "stability.md".into()]).collect();
    let folder = study.folder(&files)?;
    let size = if study.quick { [24, 16] } else { [56, 40] };
    let saved = study.saved(&format!("{folder}/stability.json"), |devices, progress| {
        let stability = measure(size, &devices.open()?, &|share| progress.reach(share))?;
        Ok(Measured { stability })
    })?;
    let source = study.from.as_deref().unwrap_or_default();
    write_files(&folder, &self::files(source, &saved)?)?;
    print(&saved.measured.stability.summary())
}

/// The drawings and the page of what `source` holds.
pub fn files(source: &str, saved: &Saved<Measured>) -> Result<Files> {
    let Saved { machine, measured: Measured { stability }, .. } = saved;
    // What is read from a file may be anything.
    if !stability.is_whole() {
        let expected = "maps with an error for each point";
        return Err(Error::bad_input(source, expected, "others", "measure anew"));
    }
    let drawn = |(family, name, title)| Some((name, chart(stability, family, title, machine)?));
    let drawings = CHARTS.into_iter().filter_map(drawn).collect();
    Ok((drawings, vec![("stability.md", page(stability, machine))]))
}

/// The pictures with what goes wrong, why, and what is done instead.
fn page(stability: &Stability, machine: &Machine) -> String {
    let mut text = format!(
        "# Where formulas and methods fail\n\nWritten by `splitsum chart stability` ({}, {} \
         threads; splitsum {}). Colours are errors from 1e-8 (white) to 1 (dark blue). Every \
         failure and every bound named here is tested.\n",
        machine.processor, machine.threads, machine.version
    );
    for (family, name, title) in CHARTS {
        if !stability.maps.iter().any(|map| map.family == family) {
            continue;
        }
        text += &format!("\n## {title}\n\n![{title}]({name}.png)\n");
        for case in cases().into_iter().filter(|case| case.family() == family) {
            text += &format!("\n**{}**: {} {}\n", case.name, case.about, case.claim());
        }
    }
    if !stability.facts.is_empty() {
        text += &format!("\nWhat the devices' own functions do:\n\n{}", stability.facts_table());
    }
    text + &format!("\n## All of it\n\n{}", stability.summary())
}
