//! The candidates that were rejected and are nearest to the tolerance.

use super::super::candidate::Candidate;
use super::super::cost::Cost;
use super::super::file::Rejected;
use super::super::report::{Report, in_words, range};
use super::super::search::PASSES;
use crate::approximation::Region;
use crate::error::Result;
use crate::html::{Column, and_more, escape, short, table, whole};

/// Candidates that are listed.
const MOST: usize = 40;

/// The least error over the tolerance that is known of an entry: its bound, that of the entry whose
/// functions include its own, or what was found.
fn nearest(entry: &Rejected, all: &[Rejected]) -> f64 {
    let included = entry.part_of.and_then(|other| all.get(other)?.bound);
    entry.bound.or(included).or(entry.found).unwrap_or(f64::INFINITY)
}

/// The section of rejected candidates.
pub fn section(report: &Report) -> Result<String> {
    let plan = &report.plan;
    let all = &plan.rejected;
    let mut text = "<h2>Rejected candidates</h2>\n".to_owned();
    if all.is_empty() {
        return Ok(text + "<p>None costs less.</p>\n");
    }
    text += &format!(
        "<p>{}. A proof is a list of points and multipliers; <code>splitsum plan --check</code> \
         verifies each of them. Listed are those nearest to the tolerance.</p>\n",
        escape(&report.cheaper())
    );
    let nearly = |entry: &Rejected| entry.found.is_some_and(|found| found <= 1.0);
    if all.iter().any(nearly) {
        text += &format!(
            "<p class=\"dim\">Numbers pass where the bound of their error is within the tolerance; \
             below roughness 0.001, where nothing bounds it, where the error that was measured is \
             at most {PASSES} of it.</p>\n"
        );
    }
    let mut order: Vec<&Rejected> = all.iter().collect();
    order.sort_by(|a, b| nearest(a, all).total_cmp(&nearest(b, all)));
    let several = plan.question.pieces.len() > 1;
    let mut rows = Vec::new();
    for entry in order.into_iter().take(MOST) {
        rows.push(row(entry, all, plan.question.least_nov, several)?);
    }
    let columns = [
        Column::Text("candidate"),
        Column::Number("bytes"),
        Column::Number("loads"),
        Column::Number("operations"),
        Column::Text("error / tolerance"),
        Column::Number("multipliers"),
    ];
    Ok(text + &table(&columns, &rows) + &and_more(all.len(), MOST, "rejected candidates"))
}

/// A bound, rounded down.
fn at_least(bound: f64) -> String {
    match (bound * 1e4).floor() / 1e4 {
        rounded if rounded <= 1.0 => "more than 1".to_owned(),
        rounded if rounded < 1.1 => format!("at least {rounded}"),
        _ => format!("at least {}", (bound * 1e2).floor() / 1e2),
    }
}

fn row(entry: &Rejected, all: &[Rejected], least_nov: f64, several: bool) -> Result<Vec<String>> {
    let candidate = Candidate::named(&entry.candidate)?;
    let cost = Cost::of(&candidate, &Region::new(least_nov, entry.roughness));
    let mut name = format!("<div class=\"name\">{}</div>", escape(&in_words(&candidate)));
    if several {
        name += &format!("<span class=\"dim\">roughness {}</span>", range(entry.roughness));
    }
    let included = entry.part_of.and_then(|other| all.get(other));
    let verdict = match (entry.bound, included, entry.found) {
        (Some(bound), ..) => at_least(bound),
        (None, Some(other), _) => format!(
            "{}, as part of<br><span class=\"dim\">{}</span>",
            at_least(nearest(entry, all)),
            escape(&other.candidate)
        ),
        (None, None, Some(found)) => format!("{} found, not proved", short(found)),
        (None, None, None) => String::new(),
    };
    let multipliers = match entry.proof.len() {
        0 => "–".to_owned(),
        count => whole(count),
    };
    let (bytes, loads, operations) = (cost.bytes, cost.loads, cost.operations);
    Ok(vec![name, whole(bytes), whole(loads), whole(operations), verdict, multipliers])
}
