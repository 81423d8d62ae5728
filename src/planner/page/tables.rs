//! What the model leaves out and what the tables of engines give, as tables.

use super::super::report::Report;
use super::super::tolerance::Tolerance;
use crate::error::Result;
use crate::html::{Column, escape, short, table, whole};

/// A place in cells: n·v, roughness and F0.
fn cells(place: [f64; 3]) -> [String; 3] {
    place.map(short)
}

/// What the model leaves out.
pub fn model_errors(report: &Report) -> Result<String> {
    let tolerance = Tolerance::named(&report.plan.question.tolerance)?;
    let mut text = "<h2>What the model leaves out</h2>\n".to_owned();
    if report.model_errors.is_empty() {
        return Ok(text + "<p>Nothing is known for this model.</p>\n");
    }
    text += "<p>A renderer that leaves these out errs by this much in E(F0), whatever the \
             table.</p>\n";
    let rows: Vec<Vec<String>> = report
        .model_errors
        .iter()
        .map(|error| {
            let mut row = vec![escape(error.what), format!("{:+.4}", error.error)];
            row.extend(cells([error.nov, error.roughness, error.f0]));
            row.push(escape(error.advice(tolerance)));
            row
        })
        .collect();
    let columns = [
        Column::Text("left out"),
        Column::Number("error of E(F0)"),
        Column::Number("n·v"),
        Column::Number("roughness"),
        Column::Number("F0"),
        Column::Text("advice"),
    ];
    Ok(text + &table(&columns, &rows))
}

/// The tables of engines beside the plan.
pub fn engines(report: &Report) -> Result<String> {
    let plan = &report.plan;
    let row = |name: String, bytes: usize, error: f64, worst: f64, place: [f64; 3]| {
        let meets = if worst <= 1.0 { "meets the tolerance" } else { "misses the tolerance" };
        let mut row = vec![name, whole(bytes), short(error.abs()), short(worst), meets.to_owned()];
        row.extend(cells(place));
        row
    };
    let mut rows = Vec::new();
    if let Some(chosen) = plan.choice.iter().max_by(|a, b| a.worst.total_cmp(&b.worst)) {
        let bytes = plan.cost()?.bytes;
        let name = "<b>this plan</b>".to_owned();
        rows.push(row(name, bytes, chosen.error, chosen.worst, chosen.place));
    }
    for engine in &report.engines {
        let (bytes, error, worst) = (engine.bytes, engine.error, engine.worst);
        rows.push(row(escape(engine.name), bytes, error, worst, engine.place));
    }
    let columns = [
        Column::Text("table"),
        Column::Number("bytes"),
        Column::Number("largest error"),
        Column::Number("error / tolerance"),
        Column::Text("verdict"),
        Column::Number("n·v"),
        Column::Number("roughness"),
        Column::Number("F0"),
    ];
    Ok(format!(
        "<h2>Tables of engines</h2>\n<p>Tables of the sizes and axes that engines ship, with exact \
         values at their nodes and bilinear filtering between, over the same scene. n·v, roughness \
         and F0 are where each is worst.</p>\n{}",
        table(&columns, &rows)
    ))
}
