//! `splitsum chart stability`

use super::{StudyArgs, read_study, write_drawing, write_json};
use crate::chart::stability::chart;
use crate::cli::progress::Progress;
use crate::cli::{output, print};
use crate::encode::metadata::TOOL;
use crate::error::{Error, Result};
use crate::study::Machine;
use crate::study::stability::{Family, Stability, measure, topics};
use serde::{Deserialize, Serialize};

#[derive(clap::Args)]
pub struct StabilityArgs {
    #[command(flatten)]
    study: StudyArgs,
}

/// What is saved beside the charts.
#[derive(Serialize, Deserialize)]
struct Saved {
    tool: String,
    machine: Machine,
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
    let pictures = CHARTS.iter().flat_map(|(_, name, _)| [format!("{name}.svg"), format!("{name}.png")]);
    let files: Vec<String> = pictures.chain(["stability.json".into(), "stability.md".into()]).collect();
    let folder = study.folder(&files)?;
    let Saved { machine, stability, .. } = match &study.from {
        Some(file) => {
            let saved: Saved = read_study(file)?;
            if !saved.stability.is_whole() {
                let (expected, got) = ("maps with an error for each point", "others");
                return Err(Error::bad_input(file, expected, got, "measure anew"));
            }
            saved
        }
        None => {
            let devices = study.devices()?;
            let progress = Progress::of_work("measuring", study.quiet);
            let size = if study.quick { [24, 16] } else { [56, 40] };
            let stability = measure(size, &devices.open()?, &|share| progress.reach(share))?;
            let saved = Saved { tool: TOOL.into(), machine: devices.machine(), stability };
            write_json(&format!("{folder}/stability.json"), &saved)?;
            saved
        }
    };
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
        "# Where formulas and methods fail\n\nWritten by `splitsum chart stability` ({}, {} threads; splitsum {}). Colours are errors \
         from 1e-8 (white) to 1 (dark blue). Every failure and every bound named here is tested.\n",
        machine.processor, machine.threads, machine.version
    );
    for (family, name, title) in CHARTS {
        if !stability.maps.iter().any(|map| map.family == family) {
            continue;
        }
        text += &format!("\n## {title}\n\n![{title}]({name}.png)\n");
        for topic in topics().into_iter().filter(|topic| topic.family() == family) {
            text += &format!("\n**{}**: {} {}\n", topic.name, topic.about, topic.claim());
        }
    }
    if !stability.facts.is_empty() {
        text += &format!("\nWhat the devices' own functions do:\n\n{}", stability.facts_table());
    }
    text + &format!("\n## All of it\n\n{}", stability.summary())
}
