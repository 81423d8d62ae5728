//! Plans for the materials of 745 scenes (tests/figures/scenes.json): what each needs, what it errs
//! by, and what the tables of engines give for it. It prints Markdown: docs/scenes.md.

use serde::Deserialize;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::error::Result;
use splitsum::planner::check::by_reference;
use splitsum::planner::cost::Weights;
use splitsum::planner::domain::Domain;
use splitsum::planner::engines::engines;
use splitsum::planner::file::PlanFile;
use splitsum::planner::search::{Outcome, Task, search};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::Truth;
use splitsum::scene::{Assumptions, Layer, read};
use std::time::Instant;

const SCENES: &str = include_str!("../tests/figures/scenes.json");

/// The tolerance of E(F0).
const TOLERANCE: f64 = 4e-3;

/// The least n·v.
const LEAST_NOV: f64 = 1e-3;

#[derive(Deserialize)]
struct Entry {
    name: String,
    core: bool,
    materials: serde_json::Value,
}

/// What a scene came to.
struct Row {
    domain: Domain,
    pieces: usize,
    choice: String,
    bytes: usize,
    numbers: usize,
    error: f64,
    /// The largest bound over the tolerance; infinite where there is none.
    bound: f64,
    seconds: f64,
    engines: Vec<f64>,
}

fn main() -> Result<()> {
    let entries: Vec<Entry> = serde_json::from_str(SCENES)
        .map_err(|error| splitsum::Error::Internal(format!("scenes.json: {error}")))?;
    let truth = Truth::new(Microfacet::new(Ndf::Ggx, None)?);
    let mut rows: Vec<Row> = Vec::new();
    let mut known: Vec<(usize, usize)> = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let json = format!("{{\"materials\":{}}}", entry.materials);
        let files = |_: &str| Ok(Vec::new());
        let scene = read(&entry.name, json.as_bytes(), &Assumptions::default(), &files)?;
        let layers = [Layer::Base, Layer::Clearcoat];
        let mut domain = Domain::of(std::slice::from_ref(&scene), &layers, LEAST_NOV);
        domain.pieces.iter_mut().for_each(|piece| piece.materials.clear());
        if domain.pieces.is_empty() {
            continue;
        }
        let place = match rows.iter().position(|row| row.domain == domain) {
            Some(place) => place,
            None => {
                rows.push(row(domain, &truth)?);
                rows.len() - 1
            }
        };
        known.push((index, place));
    }
    print(&entries, &rows, &known);
    Ok(())
}

fn row(domain: Domain, truth: &Truth) -> Result<Row> {
    let started = Instant::now();
    let tolerance = Tolerance::Absolute(TOLERANCE);
    let weights = Weights::default();
    let task = Task { domain: domain.clone(), tolerance, weights, sampler: None };
    let outcome = search(&task, truth);
    // The proofs belong to it.
    PlanFile::new(&task, truth, &outcome, String::new())?;
    let Outcome { choice, cost, .. } = outcome;
    let seconds = started.elapsed().as_secs_f64();
    let whole = domain.whole().map_or([0.0, 1.0], |(_, f0)| f0);
    let f0 = |index: usize| if choice.len() > 1 { domain.pieces[index].f0 } else { whole };
    let errors = choice.iter().enumerate().map(|(index, (approximation, _))| {
        by_reference(approximation, f0(index), tolerance, truth).error.abs()
    });
    let error = errors.fold(0.0, f64::max);
    let bounds = choice.iter().map(|(approximation, worst)| match worst.bound {
        Some(bound) if bound.from <= approximation.region.roughness[0] => bound.share,
        _ => f64::INFINITY,
    });
    let bound = bounds.fold(0.0, f64::max);
    let is_line = domain.is_constant() && choice.len() == domain.pieces.len();
    Ok(Row {
        pieces: domain.pieces.len(),
        choice: if is_line { "polynomials" } else { "net" }.into(),
        bytes: cost.bytes,
        numbers: choice.iter().flat_map(|one| &one.0.numbers).map(|numbers| numbers.len()).sum(),
        error,
        bound,
        seconds,
        engines: engines(&domain, tolerance, truth)?.iter().map(|one| one.error.abs()).collect(),
        domain,
    })
}

/// The median, the 95 % quantile and the largest of the times of plans for scenes whose roughnesses
/// are constant, or are not.
fn times(rows: &[Row], are_constant: bool) -> String {
    let is_asked = |row: &&Row| row.domain.is_constant() == are_constant;
    let mut times: Vec<f64> = rows.iter().filter(is_asked).map(|row| row.seconds).collect();
    times.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = (times.len().saturating_sub(1) as f64 * share) as usize;
        1e3 * times.get(index).unwrap_or(&0.0)
    };
    format!("{:.0}, {:.0} and {:.0} ms", at(0.5), at(0.95), at(1.0))
}

fn print(entries: &[Entry], rows: &[Row], known: &[(usize, usize)]) {
    println!("# What 745 scenes need\n");
    println!(
        "Printed by `cargo run --release --example scenes`: `splitsum plan` at a tolerance of \
         {TOLERANCE} in E(F0), n·v from {LEAST_NOV}, for the materials of public glTF files. \
         Errors are the largest at points that were not fitted to, by the reference rule. \
         The columns of engines are the largest errors of exact A and B at the nodes of their \
         tables.\n"
    );
    let mut bytes: Vec<usize> = known.iter().map(|&(_, row)| rows[row].bytes).collect();
    bytes.sort_unstable();
    let largest = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(0.0, f64::max);
    let share = |of: &dyn Fn(&Row) -> bool| {
        let count = known.iter().filter(|(_, row)| of(&rows[*row])).count();
        100.0 * count as f64 / known.len() as f64
    };
    println!("| over {} scenes, {} of them different | |\n| --- | --- |", known.len(), rows.len());
    println!("| bytes, median | {} |", bytes[bytes.len() / 2]);
    println!("| bytes, largest | {} |", bytes.last().unwrap_or(&0));
    println!("| largest error | {:.2e} |", largest(&|row| row.error));
    let is_proved = |row: &Row| row.bound.is_finite();
    let bounded = largest(&|row| if is_proved(row) { row.bound } else { 0.0 });
    println!("| largest bound that is proved | {bounded:.4} of the tolerance |");
    println!("| scenes whose whole domain it holds for | {:.0} % |", share(&is_proved));
    println!("| scenes that need no table | {:.0} % |", share(&|row| row.choice == "polynomials"));
    println!("| time of a plan with its proofs: median, 95 % and largest | |");
    println!("| where roughnesses are constant | {} |", times(rows, true));
    println!("| where some are ranges | {} |\n", times(rows, false));
    let names = ["three.js", "Bevy", "Unreal", "Filament", "HDRP's axes"];
    let engines = names.join(" | ");
    println!("| scene | roughnesses | choice | bytes | numbers | error | {engines} |");
    println!("|{}", " --- |".repeat(6 + names.len()));
    for &(index, place) in known.iter().filter(|(index, _)| entries[*index].core) {
        let Row { pieces, choice, bytes, numbers, error, engines, .. } = &rows[place];
        let engines: Vec<String> = engines.iter().map(|error| format!("{error:.3}")).collect();
        let name = entries[index].name.replace('|', "/");
        println!(
            "| {name} | {pieces} | {choice} | {bytes} | {numbers} | {error:.4} | {} |",
            engines.join(" | ")
        );
    }
    println!(
        "\nThe other {} scenes are variants and tests:\n",
        known.len() - entries.iter().filter(|entry| entry.core).count()
    );
    println!("| bytes | scenes | largest error |\n| --- | --- | --- |");
    let limits = [4, 8, 12, 16, 24, 32, 64, 128, 192, 256, 320, usize::MAX];
    let mut below = 0;
    for limit in limits {
        let within = |row: &Row| below < row.bytes && row.bytes <= limit;
        let count = known.iter().filter(|(_, row)| within(&rows[*row])).count();
        if count > 0 {
            let error =
                rows.iter().filter(|row| within(row)).map(|row| row.error).fold(0.0, f64::max);
            println!("| {} to {limit} | {count} | {error:.4} |", below + 1);
        }
        below = limit;
    }
}
