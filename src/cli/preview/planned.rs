//! `splitsum preview --plan`

use crate::cli::plan::read_plan;
use crate::cli::progress::Progress;
use crate::cli::{output, place, resources, usage};
use crate::error::Result;
use crate::planner::file::PlanFile;
use crate::planner::report::range;
use crate::preview::planned::{Column, MOST_COLUMNS, columns, ends, render};
use std::io::Write;

/// Characters of the names of a column's materials that are printed.
const NAMES: usize = 60;

/// Renders the materials of the plan at `path` to the picture `name`, `size` pixels for a sphere.
pub fn run(path: &str, name: &str, size: usize) -> Result<()> {
    output::check_picture(name)?;
    let mut files = place::Files::default();
    files.add("the plan", path);
    if let Some(other) = files.add("the picture", name) {
        let got = format!("{name}, which is {other}");
        return Err(usage("output", "a file of its own", &got, "name another one"));
    }
    let plan = read_plan(path)?;
    let columns = columns(&plan)?;
    let rows = 3 * ends(&columns);
    // A pixel of the picture has its colour, twice while it is encoded; a sphere at each of some
    // n·v, fewer than half its pixels, seven numbers.
    let pixels = rows * columns.len() * size * size;
    resources::start((6 * pixels + 28 * size * size + (16 << 20)) as u64, None, resources::ALLOW)?;
    let progress = Progress::of_pixels(name, pixels);
    let (picture, largest) = render(&columns, size, &|pixels| progress.advance(pixels))?;
    drop(progress);
    output::write_picture(name, &picture)?;
    let lines = lines(name, &plan, &columns, &largest);
    let _ = writeln!(std::io::stderr(), "{}", lines.join("\n"));
    Ok(())
}

/// What is said of the picture.
fn lines(name: &str, plan: &PlanFile, columns: &[Column], largest: &[f64]) -> Vec<String> {
    let again =
        if ends(columns) > 1 { ", at the least F0; the same at the largest F0" } else { "" };
    let mut lines = vec![
        format!("wrote     {name}, rendered by the CPU"),
        format!(
            "rows      E(F0) in a furnace by the lookup of the plan, by the integral, their \
             difference times 100{again}"
        ),
    ];
    for (i, (column, largest)) in columns.iter().zip(largest).enumerate() {
        let Column { roughness, f0, materials, .. } = column;
        let (roughness, f0) = (range([*roughness; 2]), range(*f0));
        lines.push(format!(
            "column    {}: roughness {roughness}, F0 {f0}, difference up to {largest:.2e}: {}",
            i + 1,
            names(materials)
        ));
    }
    let ends_of = |range: [f64; 2]| if range[0] < range[1] { 2 } else { 1 };
    let all: usize = plan.question.pieces.iter().map(|piece| ends_of(piece.roughness)).sum();
    if all > MOST_COLUMNS {
        lines.push(format!("shown     {MOST_COLUMNS} of {all} ends of roughness, evenly"));
    }
    let least = plan.question.least_nov;
    lines.push(format!("tolerance {} in E(F0), for n.v from {least} on", plan.question.tolerance));
    lines
}

/// Names of materials on a line: not too many, and none with an effect on a terminal.
fn names(materials: &[String]) -> String {
    let seen = |c: char| if c.is_control() { '?' } else { c };
    let all: Vec<char> = materials.join(", ").chars().map(seen).collect();
    match all.len() > NAMES {
        true => all[..NAMES].iter().chain(&['…']).collect(),
        false => all.iter().collect(),
    }
}
