//! `splitsum furnace`

mod coat;

use super::choices::{self, LobeArgs};
use super::{output, resources, standard_output};
use crate::brdf::{Diffuse, Masking, Ndf};
use crate::choice::Choice;
use crate::error::Result;
use crate::format::metadata::TOOL;
use crate::furnace::{Extremes, Furnace, Material, MultipleScattering, Split, furnaces};
use crate::image::{diverging, panels};
use crate::integrate::rule::Rule;
use crate::integrate::rules::REFERENCE;
use crate::table::axis::{Axis, AxisSpec, Nodes, Parameter};
use crate::table::grid::Grid;
use crate::units::roughness_of;
use serde::Serialize;

/// Reflectances of the report: water, glass, a strong dielectric, half a mirror, a mirror.
const F0S: [f64; 5] = [0.02, 0.04, 0.08, 0.5, 1.0];

/// The deviation from 1 at the end of the picture's colour scale.
const SCALE: f64 = 0.25;

/// The largest error of the energies.
const TOLERANCE: f64 = 2e-6;

#[derive(clap::Args)]
pub struct FurnaceArgs {
    #[command(flatten)]
    lobe: LobeArgs,
    /// Compensation of its loss
    #[arg(
        long, value_name = "NAME", default_value = "none",
        value_parser = choices::of::<MultipleScattering>()
    )]
    multiple_scattering: MultipleScattering,
    /// The white base
    #[arg(
        long, value_name = "NAME", default_value = "lambert",
        value_parser = choices::of::<Diffuse>()
    )]
    diffuse: Diffuse,
    /// The formulas for a base below an interface with this index of refraction, 1 to 100, beside
    /// each other, in the place of those at an F0
    #[arg(
        long, value_name = "N", conflicts_with_all = ["multiple_scattering", "diffuse"],
        allow_hyphen_values = true
    )]
    ior: Option<f64>,
    /// Albedos of that base, with commas between, each from 0 to 1 [default: 1,0.5]
    #[arg(
        long,
        value_name = "RHO[,RHO...]",
        value_delimiter = ',',
        requires = "ior",
        allow_hyphen_values = true
    )]
    albedo: Vec<f64>,
    /// Angles and roughnesses, each at i/(N-1), 2 to 1024
    #[arg(
        long, value_name = "N", default_value_t = 64,
        value_parser = clap::value_parser!(u16).range(2..=1024)
    )]
    size: u16,
    /// Write a picture: a column for each F0, a row for each split, or a column for each formula
    /// and a row for each albedo; blue where energy is lost, orange where it is made, full at 0.25
    /// of the light; in each panel n.v from left to right, roughness from top to bottom
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<String>,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    tool: &'static str,
    model: Ndf,
    masking: Masking,
    multiple_scattering: MultipleScattering,
    diffuse: Diffuse,
    furnaces: Vec<Line>,
}

#[derive(Serialize)]
struct Line {
    f0: f64,
    split: Split,
    #[serde(flatten)]
    extremes: Extremes,
}

pub fn run(arguments: &FurnaceArgs) -> Result<()> {
    let size = usize::from(arguments.size);
    let material = Material {
        lobe: arguments.lobe.lobe()?,
        multiple_scattering: arguments.multiple_scattering,
        base: arguments.diffuse,
    };
    if let Some(name) = &arguments.output {
        output::check_picture(name)?;
    }
    if arguments.json || arguments.output.is_none() {
        standard_output::check()?;
    }
    if let Some(ior) = arguments.ior {
        return coat::run(arguments, ior);
    }
    // The reciprocal split is a lobe of its own, in the place of Lambert's.
    let splits = if material.base == Diffuse::Lambert { Split::ALL } else { &Split::ALL[..2] };
    let grid = start(size, F0S.len() * splits.len())?;
    let rule = Rule::for_cpu(material.lobe, TOLERANCE, grid.len()).unwrap_or(REFERENCE);
    let furnaces = furnaces(material, &F0S, splits, &grid, &rule)?;
    if let Some(name) = &arguments.output {
        write_picture(name, &furnaces, splits.len(), size)?;
    }
    let line = |f: &Furnace| Line { f0: f.f0, split: f.split, extremes: f.extremes(&grid) };
    let report = Report {
        tool: TOOL,
        model: material.lobe.ndf,
        masking: material.lobe.masking,
        multiple_scattering: material.multiple_scattering,
        diffuse: material.base,
        furnaces: furnaces.iter().map(line).collect(),
    };
    if arguments.json { super::print_json(&report) } else { super::print(&describe(&report)) }
}

/// n·v and roughness, each at i/(size - 1), once there is memory for so many maps of energy.
fn start(size: usize, maps: usize) -> Result<Grid> {
    // A texel has its integral, and of each map an energy, what is drawn of it and three bytes of
    // colour; a row those of the directions of its averages.
    let bytes = size * size * (16 + maps * 24) + size * 4096;
    resources::start(bytes as u64, None, resources::ALLOW)?;
    let edges = |parameter| AxisSpec { nodes: Nodes::Edges, ..AxisSpec::of(parameter) };
    let axis = |parameter| Axis::new(edges(parameter), size);
    Grid::new(&axis(Parameter::Nov)?, &axis(Parameter::Roughness)?)
}

fn describe(report: &Report) -> String {
    let Report { model, masking, multiple_scattering, diffuse, .. } = report;
    let mut text = format!(
        "{model}, {masking}, multiple scattering: {multiple_scattering}, on a white {diffuse} \
         base\n"
    );
    text.push_str(
        "F0    split          least  at n.v, roughness     most  at n.v, roughness     mean",
    );
    for Line { f0, split, extremes } in &report.furnaces {
        let Extremes { least, least_at, most, most_at, mean } = extremes;
        let place = |(mu, alpha): &(f64, f64)| format!("{mu:.2}, {:.2}", roughness_of(*alpha));
        let (split, least_at, most_at) = (split.word(), place(least_at), place(most_at));
        text.push_str(&format!(
            "\n{f0:<5} {split:<11} {least:>8.4}  {least_at:<17} {most:>8.4}  {most_at:<17} \
             {mean:>8.4}"
        ));
    }
    text
}

fn write_picture(name: &str, furnaces: &[Furnace], splits: usize, size: usize) -> Result<()> {
    // The furnaces come F0 by F0; the picture's rows are the splits.
    let of_split = |split| furnaces.iter().skip(split).step_by(splits);
    let deviation =
        |furnace: &Furnace| furnace.energy.iter().map(|energy| (energy - 1.0) / SCALE).collect();
    let values: Vec<Vec<f64>> = (0..splits).flat_map(of_split).map(deviation).collect();
    let picture = panels(&values, (size, size), F0S.len(), diverging);
    output::write_picture(name, &picture)
}
