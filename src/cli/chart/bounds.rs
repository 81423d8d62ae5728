//! `splitsum chart bounds`

use super::{Devices, MeasuredArgs};
use crate::cli::{output, print, standard_output};
use crate::compare::study::Machine;
use crate::compare::study::bounds::{Finding, Plan, Search, check, everything, search};
use crate::error::{Error, Result};

#[derive(clap::Args)]
pub struct BoundsArgs {
    /// Length of the search; every rule and lobe gets a first round, however short
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    seconds: f64,
    /// Seeds the starts of the search
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    measured: MeasuredArgs,
    /// A page for what is found (Markdown) [default: none, it is printed]
    #[arg(short, long, value_name = "FILE")]
    output: Option<String>,
}

pub fn run(arguments: &BoundsArgs) -> Result<()> {
    let &BoundsArgs { seconds, seed, .. } = arguments;
    // Longer than a year is a slip, and NaN no time.
    if !(0.0..=3e7).contains(&seconds) {
        let cure = "give a number in that range";
        return Err(Error::bad_input("seconds", "0 to 3e7", format!("{seconds:?}"), cure));
    }
    arguments.output.as_ref().map_or_else(standard_output::check, |file| output::check(file))?;
    let (devices, progress) = arguments.measured.start("searching")?;
    let found =
        search(Plan::of_seconds(seconds, seed), &everything(), &devices.open()?, &|share| {
            progress.reach(share)
        })?;
    drop(progress);
    let page = page(&found, &devices, arguments);
    // What breaks a bound is printed, and no file claims that it holds.
    match &arguments.output {
        Some(file) if check(&found).is_ok() => output::write(file, page.as_bytes())?,
        _ => print(&page)?,
    }
    check(&found)
}

/// Where rules are worst, in tables.
fn page(found: &Search, devices: &Devices, arguments: &BoundsArgs) -> String {
    let machine: Machine = devices.machine();
    let names: String = machine
        .devices
        .iter()
        .map(|device| format!(", {} ({})", device.name, device.driver))
        .collect();
    let worst = found.findings.iter().map(Finding::ratio).fold(0.0, f64::max);
    let mut text = format!(
        "# How far bounds are from being broken\n\nWritten by `splitsum chart bounds --seconds {} \
         --seed {}` (splitsum {}; the CPU{names}). For every rule, integrand and channel it climbs \
         towards the largest error over the bound, from starts crowded at every edge and corner of \
         the domain; the truth is the reference, and the reference's own truth one with half again \
         as many nodes. {} points were tried. The largest share is {worst:.2}; the command fails \
         where one exceeds 2/3, the margin of 1.5 that every bound keeps.\n\n\
         ## The worst place of each rule\n\n{HEAD}",
        arguments.seconds, arguments.seed, machine.version, found.points
    );
    for group in found.findings.chunk_by(|a, b| (a.rule, &a.device) == (b.rule, &b.device)) {
        for integral in integrals(group) {
            let of_integral = group.iter().filter(|finding| finding.integral == integral);
            text += &of_integral
                .max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
                .map_or(String::new(), row);
        }
    }
    text += &format!("\n## Everything beyond a quarter\n\n{HEAD}");
    text + &found
        .findings
        .iter()
        .filter(|finding| finding.ratio() > SHOWN)
        .map(row)
        .collect::<String>()
}

/// The names of the integrals of these findings.
fn integrals(group: &[Finding]) -> Vec<&'static str> {
    let mut names: Vec<&str> = group.iter().map(|finding| finding.integral).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Smaller shares of a bound are left out of the second table.
const SHOWN: f64 = 0.25;

const HEAD: &str = "| rule | by | of | integral | n·v | 1 - n·v | α | error | bound | \
                    error/bound |\n\
                    | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";

fn row(finding: &Finding) -> String {
    let Finding { rule, device, of, integral, mu, alpha, error, bound } = finding;
    let by = device.as_deref().map_or("CPU", |device| device.split(" (").next().unwrap_or(device));
    let (rest, ratio) = (1.0 - mu, finding.ratio());
    format!(
        "| `{rule}` | {by} | {of} | {integral} | {mu:.3e} | {rest:.1e} | {alpha:.3e} \
         | {error:.1e} | {bound:.1e} | {ratio:.2} |\n"
    )
}
