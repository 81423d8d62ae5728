//! `splitsum furnace --ior`: the formulas for a base below an interface.

use super::{FurnaceArgs, SCALE, TOLERANCE, start};
use crate::brdf::{Masking, Ndf};
use crate::choice::Choice;
use crate::cli::{output, print, print_json};
use crate::error::{Error, Result};
use crate::format::metadata::TOOL;
use crate::furnace::coat::{Coat, Coated, coated};
use crate::image::{diverging, panels};
use crate::integrate::Integrand;
use crate::integrate::rule::Rule;
use crate::integrate::rules::REFERENCE;
use crate::lut::Energy;
use crate::table::grid::Grid;
use crate::units::roughness_of;
use serde::Serialize;

/// The albedos of the base that none names.
const ALBEDOS: [f64; 2] = [1.0, 0.5];

/// Beyond it a formula is not reciprocal: the integrals' own error is a hundredth.
const SYMMETRIC: f64 = 1e-4;

#[derive(Serialize)]
struct Report {
    tool: &'static str,
    model: Ndf,
    masking: Masking,
    ior: f64,
    formulas: Vec<Line>,
}

#[derive(Serialize)]
struct Line {
    formula: Coat,
    rho: f64,
    /// The least and the most that comes back beyond what is right.
    lost: f64,
    made: f64,
    /// (roughness, average over all directions) at the ends of the grid and between.
    averages: [(f64, f64); 3],
    reciprocal: bool,
}

pub(super) fn run(arguments: &FurnaceArgs, ior: f64) -> Result<()> {
    let (lobe, size) = (arguments.lobe.lobe()?, usize::from(arguments.size));
    let rhos: Vec<f64> = match arguments.albedo.is_empty() {
        true => ALBEDOS.into(),
        false => arguments.albedo.clone(),
    };
    if let Some(rho) = rhos.iter().find(|rho| !(0.0..=1.0).contains(*rho)) {
        let (got, cure) = (rho.to_string(), "give an albedo in that range");
        return Err(Error::bad_input("albedo", "0 to 1", got, cure));
    }
    let integrand = Integrand::Specular(lobe, Energy::of_interface(lobe, ior)?.fresnel());
    let grid = start(size, rhos.len() * Coat::ALL.len())?;
    let rule = Rule::for_cpu(integrand, TOLERANCE, grid.len()).unwrap_or(REFERENCE);
    let all = coated(lobe, ior, &rhos, &grid, &rule)?;
    // They come albedo by albedo, what is right last.
    let deviations: Vec<Vec<f64>> = all.chunks(Coat::ALL.len()).flat_map(deviations).collect();
    if let Some(name) = &arguments.output {
        let scaled = |deviation: &Vec<f64>| deviation.iter().map(|off| off / SCALE).collect();
        let values: Vec<Vec<f64>> = deviations.iter().map(scaled).collect();
        output::write_picture(name, &panels(&values, (size, size), Coat::ALL.len(), diverging))?;
    }
    let line = |(of, deviation): (&Coated, &Vec<f64>)| Line {
        formula: of.coat,
        rho: of.rho,
        lost: deviation.iter().fold(0.0, |lost, off| lost.max(-off)),
        made: deviation.iter().copied().fold(0.0, f64::max),
        averages: averages(of, &grid),
        reciprocal: of.asymmetry <= SYMMETRIC,
    };
    let report = Report {
        tool: TOOL,
        model: lobe.ndf,
        masking: lobe.masking,
        ior,
        formulas: all.iter().zip(&deviations).map(line).collect(),
    };
    if arguments.json { print_json(&report) } else { print(&describe(&report)) }
}

/// The energy of each formula less that of the last.
fn deviations(formulas: &[Coated]) -> Vec<Vec<f64>> {
    let less = |of: &Coated, right: &Coated| {
        of.energy.iter().zip(&right.energy).map(|(energy, right)| energy - right).collect()
    };
    let right = formulas.last();
    right.map_or(Vec::new(), |right| formulas.iter().map(|of| less(of, right)).collect())
}

/// The averages at the first row, the middle one, and the last.
fn averages(of: &Coated, grid: &Grid) -> [(f64, f64); 3] {
    let rows = grid.alphas.len();
    [0, rows / 2, rows - 1].map(|row| (roughness_of(grid.alphas[row]), of.averages[row]))
}

fn describe(report: &Report) -> String {
    let Report { model, masking, ior, formulas, .. } = report;
    let at: String = formulas.first().map_or(String::new(), |line| {
        line.averages.map(|(roughness, _)| format!("{roughness:<8.2}")).concat()
    });
    let mut text = format!(
        "{model}, {masking}, n = {ior}, on a Lambertian base of albedo rho: what the formulas lose \
         and make, at\nmost, beside the last; and their averages at three roughnesses\n\
         rho   formula             lost    made    r = {at}reciprocal"
    );
    for Line { formula, rho, lost, made, averages, reciprocal } in formulas {
        let (formula, reciprocal) = (formula.word(), if *reciprocal { "yes" } else { "no" });
        let averages = averages.map(|(_, average)| format!("{average:<8.4}")).concat();
        text.push_str(&format!(
            "\n{rho:<5} {formula:<17} {lost:>6.4}  {made:>6.4}      {averages}{reciprocal}"
        ));
    }
    text
}
