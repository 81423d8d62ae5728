//! A plan as a page of HTML with pictures. It is one file: no scripts, nothing from elsewhere, and
//! every word of a scene is escaped.

mod costs;
mod errors;
mod rejected;
mod roughness;
mod scene;
mod svg;
mod tables;

use super::candidate::Candidate;
use super::report::{Report, in_words, range};
use super::search::Outcome;
use super::tolerance::Tolerance;
use super::truth::Truth;
use crate::error::Result;
use crate::html::{self, Column, and_more, escape, page_of, short, table, whole};

/// Polynomials that are listed; the plan has all.
const MOST_PARTS: usize = 40;

/// The page of a plan. Pictures are drawn from its outcome and the truth.
pub fn page(report: &Report, outcome: &Outcome, truth: &Truth) -> Result<String> {
    let names: Vec<&str> = report.scenes.iter().take(3).map(|scene| &*scene.name).collect();
    let title = format!("Plan for {}", names.join(", "));
    let parts = [
        ship(report)?,
        scene::section(report),
        errors::section(report, outcome, truth)?,
        costs::section(report, outcome)?,
        tables::model_errors(report)?,
        tables::engines(report)?,
        rejected::section(report)?,
    ];
    Ok(page_of(&title, &parts.concat()))
}

/// What to ship, how right it is, and the command.
fn ship(report: &Report) -> Result<String> {
    let plan = &report.plan;
    let tolerance = Tolerance::named(&plan.question.tolerance)?;
    let cost = plan.cost()?;
    let worst = plan.choice.iter().max_by(|a, b| a.worst.total_cmp(&b.worst));
    let Some(worst) = worst else { return Ok(String::new()) };
    let what = match &*plan.choice {
        [only] => format!("one {}", in_words(&Candidate::named(&only.candidate)?)),
        all => format!("{} polynomials, one for each roughness", all.len()),
    };
    let points: usize = plan.choice.iter().map(|chosen| chosen.points).sum();
    let mut text = format!(
        "<p class=\"lead\">Ship <b>{} bytes</b>: {}. E(F0) then errs by at most <b>{}</b>, which \
         is {} of the tolerance ({}), measured at {} points.</p>\n",
        whole(cost.bytes),
        escape(&what),
        short(worst.error.abs()),
        short(worst.worst),
        escape(&tolerance.to_string()),
        whole(points)
    );
    let bounds = plan.choice.iter().map(|chosen| (chosen.bound, chosen.roughness[0]));
    let bounds = bounds.filter_map(|(bound, smoothest)| Some((bound?, smoothest)));
    if let Some((bound, smoothest)) = bounds.max_by(|a, b| a.0.share.total_cmp(&b.0.share)) {
        text += &format!("<p>Bound, {}.</p>\n", escape(&bound.text(smoothest)));
    }
    text += &format!("<p>Cheaper ones: {}.</p>\n", escape(&report.cheaper()));
    text += &format!("<pre><code>{}</code></pre>\n", escape(&plan.command));
    text += &format!(
        "<p>A lookup takes {} loads and {} operations. It is right for n·v from {} to 1, with the \
         {} model and {} masking. E(F0) is the share of light that a surface reflects in all \
         directions, F0 its reflectance at normal incidence, and n·v the cosine between normal and \
         view.</p>\n",
        cost.loads,
        cost.operations,
        plan.question.least_nov,
        plan.question.model,
        plan.question.masking
    );
    if plan.choice.len() > 1 {
        text += &polynomials(report)?;
    }
    Ok(text)
}

/// The polynomials of a plan that has one for each roughness.
fn polynomials(report: &Report) -> Result<String> {
    let Report { plan, .. } = report;
    let mut rows = Vec::new();
    for chosen in plan.choice.iter().take(MOST_PARTS) {
        let pieces = plan.question.pieces.iter();
        let names = pieces.filter(|piece| piece.roughness == chosen.roughness);
        let names: Vec<&str> =
            names.flat_map(|piece| &piece.materials).map(|name| &**name).collect();
        rows.push(vec![
            range(chosen.roughness),
            range(chosen.f0),
            escape(&html::list(&names, 4)),
            escape(&in_words(&Candidate::named(&chosen.candidate)?)),
            whole(chosen.bytes),
            short(chosen.error.abs()),
        ]);
    }
    let columns = [
        Column::Number("roughness"),
        Column::Number("F0"),
        Column::Text("materials"),
        Column::Text("polynomial"),
        Column::Number("bytes"),
        Column::Number("largest error"),
    ];
    Ok(table(&columns, &rows) + &and_more(plan.choice.len(), MOST_PARTS, "polynomials"))
}
