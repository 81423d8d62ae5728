//! `splitsum furnace`

use super::table_args::{choice, lobe};
use super::{output, resources, standard_output};
use crate::axis::{Axis, AxisSpec, Parameter};
use crate::encode::metadata::TOOL;
use crate::error::{Error, Result};
use crate::furnace::{Extremes, Furnace, Material, Split, furnaces};
use crate::integrate::rule::{REFERENCE, Rule};
use crate::lut::Grid;
use crate::model::Diffuse;
use crate::report::map::{diverging, panels};
use crate::units::{roughness_of, word};
use serde::Serialize;

/// Reflectances of the report: water, glass, a strong dielectric, half a mirror, a mirror.
const F0S: [f64; 5] = [0.02, 0.04, 0.08, 0.5, 1.0];

/// The deviation from 1 at the end of the picture's colour scale.
const SCALE: f64 = 0.25;

/// What the energies may be off.
const TOLERANCE: f64 = 2e-6;

#[derive(clap::Args)]
pub struct FurnaceArgs {
    /// Distribution of normals of the specular lobe: ggx, beckmann, beckmann-walter, blinn-phong
    #[arg(long, value_name = "NAME", default_value = "ggx")]
    model: String,
    /// Its masking [default: the first that 'bake --help' names for the model]
    #[arg(long, value_name = "NAME")]
    masking: Option<String>,
    /// What gives back its loss: none, kulla-conty (2017), turquin (2019) or fdez-aguera (2019)
    #[arg(long, value_name = "NAME", default_value = "none")]
    multiple_scattering: String,
    /// The white base: lambert, burley, oren-nayar or eon
    #[arg(long, value_name = "NAME", default_value = "lambert")]
    diffuse: String,
    /// Angles and roughnesses, each at i/(N-1), 2 to 1024
    #[arg(long, value_name = "N", default_value_t = 64)]
    size: usize,
    /// Write a picture: a column for each F0, a row for each split; blue where energy is lost, orange where it is made,
    /// full at 0.25 of the light; in each panel n.v from left to right, roughness from top to bottom
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<String>,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    tool: &'static str,
    model: String,
    masking: String,
    multiple_scattering: String,
    diffuse: String,
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
    if !(2..=1024).contains(&arguments.size) {
        return Err(Error::bad_input("size", "2 to 1024", arguments.size.to_string(), "give a number in that range"));
    }
    let material = Material {
        lobe: lobe(&arguments.model, arguments.masking.as_deref())?,
        multiple_scattering: choice("multiple scattering", &arguments.multiple_scattering)?,
        base: choice("diffuse", &arguments.diffuse)?,
    };
    if let Some(name) = &arguments.output {
        output::check_picture(name)?;
    }
    if arguments.json || arguments.output.is_none() {
        standard_output::check()?;
    }
    // The reciprocal split is a lobe of its own, in the place of Lambert's.
    let splits = if material.base == Diffuse::Lambert { &Split::ALL[..] } else { &Split::ALL[..2] };
    let axis =
        |parameter| Axis::new(AxisSpec { nodes: crate::axis::Nodes::Edges, ..AxisSpec::of(parameter) }, arguments.size);
    // A texel has its integral, and of each furnace an energy, what is drawn of it and three bytes of colour; a row
    // those of the directions of its averages.
    let (maps, size) = (F0S.len() * splits.len(), arguments.size);
    resources::start((size * size * (16 + maps * 24) + size * 4096) as u64, None, resources::ALLOW)?;
    let grid = Grid::new(&axis(Parameter::Nov)?, &axis(Parameter::Roughness)?)?;
    let rule = Rule::for_cpu(material.lobe, TOLERANCE, grid.len()).unwrap_or(REFERENCE);
    let furnaces = furnaces(material, &F0S, splits, &grid, &rule)?;
    if let Some(name) = &arguments.output {
        write_picture(name, &furnaces, splits.len(), arguments.size)?;
    }
    let line = |f: &Furnace| Line { f0: f.f0, split: f.split, extremes: f.extremes(&grid) };
    let report = Report {
        tool: TOOL,
        model: word(material.lobe.ndf),
        masking: word(material.lobe.masking),
        multiple_scattering: word(material.multiple_scattering),
        diffuse: word(material.base),
        furnaces: furnaces.iter().map(line).collect(),
    };
    if arguments.json { super::print_json(&report) } else { super::print(&describe(&report)) }
}

fn describe(report: &Report) -> String {
    let Report { model, masking, multiple_scattering, diffuse, .. } = report;
    let mut text =
        format!("{model}, {masking}, multiple scattering: {multiple_scattering}, on a white {diffuse} base\n");
    text.push_str("F0    split          least  at n.v, roughness     most  at n.v, roughness     mean");
    for Line { f0, split, extremes } in &report.furnaces {
        let Extremes { least, least_at, most, most_at, mean } = extremes;
        let place = |(mu, alpha): &(f64, f64)| format!("{mu:.2}, {:.2}", roughness_of(*alpha));
        let (split, least_at, most_at) = (word(split), place(least_at), place(most_at));
        text.push_str(&format!(
            "\n{f0:<5} {split:<11} {least:>8.4}  {least_at:<17} {most:>8.4}  {most_at:<17} {mean:>8.4}"
        ));
    }
    text
}

fn write_picture(name: &str, furnaces: &[Furnace], splits: usize, size: usize) -> Result<()> {
    // The furnaces come F0 by F0; the picture's rows are the splits.
    let of_split = |split| furnaces.iter().skip(split).step_by(splits);
    let deviation = |furnace: &Furnace| furnace.energy.iter().map(|energy| (energy - 1.0) / SCALE).collect();
    let values: Vec<Vec<f64>> = (0..splits).flat_map(of_split).map(deviation).collect();
    let picture = panels(&values, (size, size), F0S.len(), diverging);
    output::write_picture(name, &picture)
}
