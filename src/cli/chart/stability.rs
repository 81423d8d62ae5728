//! `splitsum chart stability`

use super::{Saved, StudyArgs, write_drawing};
use crate::cli::{output, print};
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
struct Measured {
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
    let Saved { machine, measured: Measured { stability }, .. } =
        study.saved(&format!("{folder}/stability.json"), |devices, progress| {
            let stability = measure(size, &devices.open()?, &|share| progress.reach(share))?;
            Ok(Measured { stability })
        })?;
    // What is read from a file may be anything.
    if !stability.is_whole() {
        let (file, expected) =
            (study.from.as_deref().unwrap_or_default(), "maps with an error for each point");
        return Err(Error::bad_input(file, expected, "others", "measure anew"));
    }
    for (family, name, title) in CHARTS {
        if let Some(drawing) = chart(&stability, family, title, &machine) {
            write_drawing(&folder, name, &drawing)?;
        }
    }
    output::write(&format!("{folder}/stability.md"), page(&stability, &machine).as_bytes())?;
    print(&stability.summary())
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
