//! A report as a page of HTML: what the table is, its faults, its errors as figures and as maps.

use super::convention::{Words, offsets_in_words};
use super::decision::Decision;
use super::errors::{Errors, Place};
use super::fault::Fault;
use super::report::{ChannelReport, Report, Status};
use crate::error::Result;
use crate::html::{Column, address_of, escape, page_of, short, table};
use crate::image::{Picture, sequential};

/// Errors from this on are shown; lesser ones are as dark.
const LEAST: f64 = 1e-6;

/// Errors up to this are shown; larger ones are as light.
const MOST: f64 = 0.1;

/// The side of a map.
const SIDE: f64 = 320.0;

/// The page of a report.
pub fn page(report: &Report) -> Result<String> {
    let title = format!("{}: what it is, and how wrong", report.file.name);
    let parts = [lead(report), faults(report), convention(report), errors(report), maps(report)?];
    Ok(page_of(&title, &parts.concat()))
}

/// What the file is, in a sentence.
fn lead(report: &Report) -> String {
    let file = &report.file;
    let [columns, rows, slices] = file.size;
    let slices = if slices > 1 { format!(" x {slices}") } else { String::new() };
    let notes: Vec<String> = file.notes.iter().map(|note| escape(note)).collect();
    let notes = if notes.is_empty() { String::new() } else { format!(" ({})", notes.join("; ")) };
    let facts = format!(
        "<p>{}, {columns} x {rows}{slices} texels of {} in {}, in steps of {}{notes}.</p>\n",
        file.container,
        escape(&file.channels.iter().map(|c| c.name.clone()).collect::<Vec<_>>().join(", ")),
        file.storage,
        file.steps
    );
    let known = match (report.status, &report.convention, report.distance) {
        (Status::Known, Some(words), _) => {
            format!("<p class=\"lead\">{}</p>\n", escape(&words.channels.join(", ")))
        }
        (_, _, Some(distance)) => format!(
            "<p class=\"lead\">Unknown: no convention of {} tried fits; the best is off by {} % of \
             a channel's spread on the average.</p>\n",
            report.tried,
            short(100.0 * distance)
        ),
        _ => "<p class=\"lead\">Unknown: no channel varies.</p>\n".into(),
    };
    known + &facts
}

fn faults(report: &Report) -> String {
    if report.faults.is_empty() {
        return "<h2>Faults</h2>\n<p>None was found.</p>\n".into();
    }
    let line = |Fault { name, text }: &Fault| format!("<li><b>{name}</b>: {}</li>\n", escape(text));
    let lines: String = report.faults.iter().map(line).collect();
    format!("<h2>Faults</h2>\n<ul>\n{lines}</ul>\n")
}

/// The convention, and what the data say for it.
fn convention(report: &Report) -> String {
    let Some(words) = &report.convention else { return String::new() };
    let Words { x, y, command, right, offsets, sampler, .. } = words;
    let mut text = format!(
        "<h2>Convention</h2>\n<p>Along a row <code>{}</code>, from row to row <code>{}</code>.",
        escape(x),
        escape(y)
    );
    if let Some(offsets) = offsets {
        text += &format!(" By the values the offsets of nodes are {}.", offsets_in_words(*offsets));
    }
    if let Some(sampler) = sampler {
        text += &format!(
            " The sampler <code>{}</code> repeats the values to {} (at most {}).",
            escape(&sampler.estimator),
            short(sampler.left.0),
            short(sampler.left.1)
        );
    }
    text += "</p>\n";
    if let Some(command) = command {
        text += "<p>A table like it:</p>\n";
        text += &format!("<pre><code>{}</code></pre>\n", escape(command));
    }
    if let Some(right) = right.as_ref().filter(|right| Some(*right) != command.as_ref()) {
        text += "<p>The same with true integrals, at nodes that a sampler reads:</p>\n";
        text += &format!("<pre><code>{}</code></pre>\n", escape(right));
    }
    let row = |Decision { dimension, choice, ratio, decided, proved, others }: &Decision| {
        let next = match (ratio.is_finite(), decided) {
            _ if *proved => "proved by the sampler".into(),
            (false, _) => "no other is possible".into(),
            (true, true) => format!("{} times as far", short(*ratio)),
            (true, false) => format!("undecided: {} fit as well", others.join(", ")),
        };
        vec![(*dimension).to_owned(), escape(choice), escape(&next)]
    };
    let rows: Vec<Vec<String>> = report.decisions.iter().map(row).collect();
    match rows.is_empty() {
        true => text,
        false => {
            let columns =
                [Column::Text("choice"), Column::Text("by the data"), Column::Text("the next")];
            text + &table(&columns, &rows)
        }
    }
}

fn errors(report: &Report) -> String {
    let mut rows = Vec::new();
    for ChannelReport { name, meaning, stored, sampled, .. } in &report.channels {
        for (which, Errors { mean, most, largest, bias, worst, .. }) in
            [("stored", stored), ("as sampled", sampled)]
        {
            let Place { nov, roughness, value, truth, .. } = *worst;
            rows.push(vec![
                escape(&format!("{name} ({meaning})")),
                which.into(),
                short(*mean),
                short(*most),
                short(*largest),
                short(*bias),
                format!("n·v {}, roughness {}", short(nov), short(roughness)),
                format!("{} for {}", short(value), short(truth)),
            ]);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let columns = [
        Column::Text("channel"),
        Column::Text("values"),
        Column::Number("mean"),
        Column::Number("99 %"),
        Column::Number("largest"),
        Column::Number("bias"),
        Column::Text("at"),
        Column::Text("value"),
    ];
    format!(
        "<h2>Errors</h2>\n{}<p class=\"dim\">As sampled: a bilinear lookup from n·v 0.001 and \
         roughness 0.045 on.</p>\n",
        table(&columns, &rows)
    )
}

/// The errors of stored values as maps, the worst ringed.
fn maps(report: &Report) -> Result<String> {
    let mut figures = String::new();
    for ChannelReport { name, meaning, stored, differences, measured, .. } in &report.channels {
        let [columns, rows] = *measured;
        let mut picture = Picture::new(columns, rows, [0; 3]);
        for (texel, difference) in differences.iter().enumerate() {
            let share = (difference.abs() / LEAST).max(1.0).log10() / (MOST / LEAST).log10();
            picture.set(texel % columns, texel / columns, sequential(share));
        }
        let (width, height) = match columns >= rows {
            true => (SIDE, SIDE * rows as f64 / columns as f64),
            false => (SIDE * columns as f64 / rows as f64, SIDE),
        };
        let (i, j) = stored.worst.texel;
        figures += &format!(
            "<figure>\n<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
             role=\"img\">\n<image href=\"{}\" width=\"{width}\" height=\"{height}\" \
             preserveAspectRatio=\"none\" style=\"image-rendering: pixelated\"/>\n<circle \
             cx=\"{:.1}\" cy=\"{:.1}\" r=\"7\" fill=\"none\" stroke=\"#fff\" \
             stroke-width=\"2\"/>\n</svg>\n<figcaption>{}: the largest error, ringed, is \
             {}</figcaption>\n</figure>\n",
            address_of(&picture)?,
            (i + 0.5) / report.file.size[0] as f64 * width,
            (j + 0.5) / report.file.size[1] as f64 * height,
            escape(&format!("{name} ({meaning})")),
            short(stored.largest)
        );
    }
    Ok(match figures.is_empty() {
        true => figures,
        false => format!(
            "<h2>Where</h2>\n<p class=\"dim\">Errors of stored values, from 1e-6 (dark) to 0.1 \
             (light) by their logarithm; the first row on top.</p>\n<div class=\"row\">\n{figures}\
             </div>\n"
        ),
    })
}
