//! `splitsum chart speed`

use super::{Devices, Files, Saved, StudyArgs, write_files};
use crate::brdf::Microfacet;
use crate::choice::Choice;
use crate::cli::choices::LobeArgs;
use crate::cli::print;
use crate::cli::progress::Progress;
use crate::compare::chart::lookup as lookup_chart;
use crate::compare::chart::size as size_chart;
use crate::compare::chart::speed::{Against, chart};
use crate::compare::study::lookup::layer::{self, LAYER, Net, TOLERANCES, Where};
use crate::compare::study::lookup::{Axes, Reading};
use crate::compare::study::size::Cost;
use crate::compare::study::speed::{Plan, Speed};
use crate::compare::study::worst::PRACTICAL;
use crate::compare::study::{Machine, lookup, size, speed};
use crate::compare::technique::Technique;
use crate::error::Result;
use crate::table::precision::Precision;
use serde::{Deserialize, Serialize};

#[derive(clap::Args)]
pub struct SpeedArgs {
    #[command(flatten)]
    lobe: LobeArgs,
    /// Texels along either edge of the table that every method bakes, 16 to 512 [default: 128; 64
    /// with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(16..=512))]
    size: Option<u16>,
    #[command(flatten)]
    study: StudyArgs,
}

#[derive(Serialize, Deserialize)]
pub struct Measured {
    speed: Speed,
    lookup: Vec<Reading>,
    /// Studies of earlier versions have none.
    #[serde(default)]
    nets: Vec<Net>,
    size: Vec<Cost>,
}

/// The files, without the folder.
const FILES: [&str; 14] = [
    "speed.json",
    "speed.md",
    "speed.csv",
    "lookup.csv",
    "nets.csv",
    "size.csv",
    "speed.svg",
    "speed.png",
    "evaluations.svg",
    "evaluations.png",
    "lookup.svg",
    "lookup.png",
    "size.svg",
    "size.png",
];

/// Seeds Owen's scrambling; any number will do.
const SEED: u64 = 1;

pub fn run(arguments: &SpeedArgs) -> Result<()> {
    let (study, plan) = (&arguments.study, arguments.plan()?);
    let folder = study.folder(&FILES)?;
    let path = format!("{folder}/speed.json");
    let saved = study.saved(&path, |devices, progress| measure(plan, devices, progress))?;
    write_files(&folder, &files(&saved))?;
    print(&summary(&saved.measured.speed, &saved.machine))
}

/// The drawings, the tables and the page.
pub fn files(saved: &Saved<Measured>) -> Files {
    let Saved { machine, measured: Measured { speed, lookup, nets, size }, .. } = saved;
    let lobe = speed.plan.lobe;
    let drawings = vec![
        ("speed", chart(speed, machine, Against::Time)),
        ("evaluations", chart(speed, machine, Against::Evaluations)),
        ("lookup", lookup_chart::chart(lookup, nets, lobe, machine)),
        ("size", size_chart::chart(size, lobe, machine)),
    ];
    let pages = vec![
        ("speed.csv", speed.to_csv()),
        ("lookup.csv", lookup::to_csv(lookup)),
        ("nets.csv", layer::to_csv(nets)),
        ("size.csv", size::to_csv(size)),
        ("speed.md", page(saved)),
    ];
    (drawings, pages)
}

/// The pictures, each with what a reader would read off it.
fn page(
    Saved { machine, measured: Measured { speed, lookup, nets, size }, .. }: &Saved<Measured>,
) -> String {
    let picture = |title: &str, name: &str| format!("\n## {title}\n\n![{title}]({name}.png)\n\n");
    let devices: String = machine
        .devices
        .iter()
        .map(|device| format!("; {} ({})", device.name, device.driver))
        .collect();
    let mut text = format!(
        "# Speed against accuracy\n\nWritten by `splitsum chart speed` (splitsum {}{devices}); the \
         numbers are in the `.csv` and `.json` files beside it.\n",
        machine.version
    );
    text += &(picture("Error against time", "speed") + &summary(speed, machine));
    text += &picture("Error against evaluations", "evaluations");
    text += &(picture("What size a table needs", "lookup")
        + &sizes_needed(lookup, speed.plan.lobe.into())
        + &nets_needed(nets));
    text += &(picture("Where a device begins to pay", "size") + &devices_that_pay(size));
    text
}

/// The smallest tables over the practical domain, and how little size helps beyond it, as Markdown.
fn sizes_needed(readings: &[Reading], lobe: Microfacet) -> String {
    const ERRORS: [f64; 5] = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3];
    let heads = ERRORS.map(|error| format!(" {error:e} |")).concat();
    let mut text = format!(
        "Errors are those of the albedo E(F0) at the F0 that shows them most, the largest of a \
         search over every cell and the corner.\n\nKiB of the smallest table whose lookups are \
         nowhere farther off, for perceptual roughness from {} and n·v from {} on\n\n| largest \
         error |{heads}\n| --- |{}\n",
        PRACTICAL.roughness,
        PRACTICAL.nov,
        " --- |".repeat(ERRORS.len())
    );
    for axes in lookup::AXES.into_iter().chain([LAYER]) {
        let cell = |error| match lookup::smallest(readings, axes, error) {
            Some(r) => format!(
                " {} ({} x {}, {}) |",
                r.bytes as f64 / 1024.0,
                r.size,
                r.size,
                r.precision.word()
            ),
            None => " none |".into(),
        };
        text += &format!("| {} |{}\n", name_of(axes), ERRORS.map(cell).concat());
    }
    text + &errors_everywhere(readings) + &corner(lobe)
}

/// The largest errors over all n·v and roughnesses by size, and of those over the practical domain,
/// as Markdown.
fn errors_everywhere(readings: &[Reading]) -> String {
    let half = |axes| readings.iter().filter(move |r| r.has(axes) && r.precision == Precision::F16);
    let sizes: Vec<usize> = half(lookup::CENTRES).map(|r| r.size).collect();
    let heads: String = sizes.iter().map(|size| format!(" {size} x {size} |")).collect();
    let rule = " --- |".repeat(sizes.len());
    let mut text = format!(
        "\nThe largest error anywhere of tables in half floats; behind the stroke, the largest \
         over that domain\n\n\
         | axes |{heads}\n| --- |{rule}\n"
    );
    for axes in lookup::AXES.into_iter().chain([LAYER]) {
        let cells: String =
            half(axes).map(|r| format!(" {:.4} / {:.4} |", r.everywhere, r.practical)).collect();
        text += &format!("| {} |{cells}\n", name_of(axes));
    }
    text
}

/// The axes of a table as flags of `bake`, or as words where it has none.
fn name_of(axes: Axes) -> String {
    match axes {
        LAYER => "E and R over T and roughness, edges".into(),
        (x, y) => format!("`--x {x} --y {y}`"),
    }
}

/// The nets that the planner fits, as Markdown.
fn nets_needed(nets: &[Net]) -> String {
    if nets.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "\nT is √(n·v (1 + 3α)/(n·v + 3α)), and E and R are those of docs/plan.md: both resolve \
         the corner. Their codes have an offset and a scale for each channel. Splines of them \
         whose numbers `splitsum plan` fits, judged by the same search\n\n\
         | tolerance | domain | bytes | largest error | root mean square | spline |\n\
         | --- | --- | --- | --- | --- | --- |\n",
    );
    for Net { candidate, domain, tolerance, bytes, largest, rms } in nets {
        let domain = match domain {
            Where::Everywhere => "everything".into(),
            Where::Practical => {
                format!("roughness from {}, n·v from {}", PRACTICAL.roughness, PRACTICAL.nov)
            }
        };
        text += &format!(
            "| {tolerance:e} | {domain} | {bytes} | {largest:.2e} | {rms:.2e} | `{candidate}` |\n"
        );
    }
    text
}

/// Why no size helps in the corner, where that is so.
fn corner(lobe: Microfacet) -> String {
    match lookup::corner(lobe) {
        Some(error) if error > 1e-3 => format!(
            "\nNo table over n·v and roughness errs by less than {error:.3} near the corner n·v = \
             roughness = 0, whatever its size: the two limits do not commute. Near it E depends on \
             n·v/α alone, so that every neighbourhood of the corner holds values that lie {:.3} \
             apart, and whatever is continuous there misses one of them by half of that. A table \
             with the corner's own value at a texel errs by all of it.\n",
            2.0 * error
        ),
        _ => String::new(),
    }
}

fn devices_that_pay(costs: &[Cost]) -> String {
    let line = |(device, from): (&str, Option<usize>)| match from {
        Some(size) => format!(
            "- {device} bakes faster than the CPU from {size} x {size} on, its start included.\n"
        ),
        None => format!("- {device} never bakes faster than the CPU.\n"),
    };
    size::pays(costs).into_iter().map(line).collect()
}

impl SpeedArgs {
    fn plan(&self) -> Result<Plan> {
        let quick = self.study.quick;
        let size = self.size.unwrap_or(if quick { 64 } else { 128 }).into();
        Ok(Plan { lobe: self.lobe.lobe()?.into(), size, seed: SEED, quick })
    }
}

fn measure(plan: Plan, devices: &Devices, progress: &Progress) -> Result<Measured> {
    let (lobe, quick) = (plan.lobe.into(), plan.quick);
    // The parts' shares of the time, roughly.
    let part = |from: f64, to: f64| move |share: f64| progress.reach(from + (to - from) * share);
    let speed = speed::measure(plan, &devices.open()?, &part(0.0, 0.5))?;
    let lookup = lookup::measure(lobe, if quick { 64 } else { 256 }, &part(0.5, 0.6))?;
    let tolerances = if quick { &TOLERANCES[..2] } else { &TOLERANCES };
    let nets = layer::nets(lobe, tolerances, &part(0.6, 0.7))?;
    let (largest, patience) = if quick { (256, 1.0) } else { (4096, 30.0) };
    let size = size::measure(lobe, largest, patience, &devices.options, &part(0.7, 1.0))?;
    Ok(Measured { speed, lookup, nets, size })
}

/// Errors at which methods are compared.
const ERRORS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];

/// The summary of the chart, as Markdown.
fn summary(speed: &Speed, machine: &Machine) -> String {
    let cell = |value: Option<f64>| value.map_or("never".into(), |value| format!("{value:.2}"));
    let times =
        |ratio: f64| if ratio < 10.0 { format!("{ratio:.1}") } else { format!("{ratio:.0}") };
    let heads = ERRORS.map(|error| format!(" {error:e} |")).concat();
    let mut text = format!(
        "{}, {} threads; {}, {} x {}; the baseline took {:.2} ms\n\n\
         Cheapest time that reaches each error, relative to the baseline; in brackets, how many \
         times slower than ours\n\n\
         | largest error |{heads}\n| --- |{}\n",
        machine.processor,
        machine.threads,
        speed.plan.lobe,
        speed.plan.size,
        speed.plan.size,
        1e3 * speed.baseline_seconds,
        " --- |".repeat(ERRORS.len())
    );
    let ours = ERRORS.map(|error| {
        let best = speed.cheapest(error, Technique::is_ours);
        best.map_or(" never |".into(), |m| {
            format!(" {:.3} ({} {}) |", m.ratio, m.technique.name(), m.step)
        })
    });
    text += &format!("| ours |{}\n", ours.concat());
    for peer in Technique::all().filter(|technique| !technique.is_ours()) {
        if speed.measurements.iter().any(|m| m.technique == peer) {
            let cells = ERRORS.map(|error| {
                let at = speed.at_error(peer, error);
                match (at.peer, at.ours) {
                    (Some(peer), Some(ours)) => {
                        format!(" {} ({}) |", cell(Some(peer)), times(peer / ours))
                    }
                    (peer, _) => format!(" {} |", cell(peer)),
                }
            });
            text += &format!("| {} ({}) |{}\n", peer.name(), peer.source(), cells.concat());
        }
    }
    text
}
