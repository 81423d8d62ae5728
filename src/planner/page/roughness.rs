//! The roughnesses of a scene as a chart: a row for each lobe, and above them how many lobes reach
//! each roughness.

use super::super::report::{LobeText, range};
use super::svg::{Frame, Svg};
use crate::html::cut;
use crate::scene::Layer;

/// Rows that are drawn.
const MOST_ROWS: usize = 24;

/// Bins of the row of all.
const BINS: usize = 64;

/// The height of a row, and of the row of all.
const HEIGHTS: [f64; 2] = [28.0, 44.0];

/// Lobes that look the same.
struct Row<'a> {
    lobe: &'a LobeText,
    count: usize,
}

/// Lobes of the same layer and roughness share a row, unless they have texels.
fn rows<'a>(lobes: &[&'a LobeText]) -> Vec<Row<'a>> {
    let mut rows: Vec<Row<'a>> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for lobe in lobes {
        let layer = match lobe.layer {
            Layer::Base => 0,
            Layer::Clearcoat => 1,
            Layer::Sheen => 2,
        };
        let alone = lobe.histogram.map(|_| rows.len());
        let key = (lobe.roughness.map(f64::to_bits), layer, alone);
        let place = *places.entry(key).or_insert(rows.len());
        match rows.get_mut(place) {
            Some(row) => row.count += 1,
            None => rows.push(Row { lobe, count: 1 }),
        }
    }
    rows
}

/// The chart, with what it shows.
pub fn chart(lobes: &[&LobeText]) -> String {
    let all = rows(lobes);
    let (shown, rest) = all.split_at(all.len().min(MOST_ROWS));
    let [height, height_of_all] = HEIGHTS;
    let above = if lobes.len() > 1 { height_of_all } else { 0.0 };
    let frame =
        Frame { left: 230.0, top: 8.0, width: 640.0, height: above + height * shown.len() as f64 };
    let mut svg = Svg::new(900.0, frame.top + frame.height + 40.0);
    let ticks: Vec<(f64, String)> =
        (0..=10).map(|i| f64::from(i) / 10.0).map(|r| (r, r.to_string())).collect();
    svg.ticks_below(frame, &ticks, true);
    if above > 0.0 {
        sum(&mut svg, frame, lobes);
    }
    for (i, row) in shown.iter().enumerate() {
        let top = frame.top + above + height * i as f64;
        row.draw(&mut svg, Frame { top, height, ..frame });
    }
    svg.frame(frame);
    let [right, bottom] = frame.at([1.0, 0.0]);
    svg.text([right, bottom + 33.0], "d e", "perceptual roughness");
    let mut caption = "A line is one roughness for all of a material, a bar a range that it may \
                       have. Where an image was read, columns show how many of its texels have \
                       each roughness."
        .to_owned();
    if above > 0.0 {
        caption += " The first row counts the lobes that reach each roughness.";
    }
    let more: usize = rest.iter().map(|row| row.count).sum();
    if more > 0 {
        caption += &format!(" {more} more lobes are in the first row only.");
    }
    let label = "The roughnesses of the scene";
    format!(
        "<figure>\n<div class=\"wide\">{}</div>\n<figcaption>{caption}</figcaption>\n</figure>\n",
        svg.finish(label)
    )
}

/// The row of all.
fn sum(svg: &mut Svg, frame: Frame, lobes: &[&LobeText]) {
    let mut counts = [0u64; BINS];
    for lobe in lobes {
        let bin = |end: f64| ((end * BINS as f64) as usize).min(BINS - 1);
        let [low, high] = lobe.roughness.map(bin);
        counts[low..=high].iter_mut().for_each(|count| *count += 1);
    }
    let row = Frame { height: HEIGHTS[1], ..frame };
    let label = format!("all: {} lobes", lobes.len());
    svg.text([frame.left - 10.0, row.top + 0.6 * row.height], "e b", &label);
    columns(svg, row, &counts, "ink", "lobes");
}

/// Columns for counts, the largest nearly as high as the row.
fn columns(svg: &mut Svg, row: Frame, counts: &[u64], class: &str, what: &str) {
    let most = counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let width = 1.0 / counts.len() as f64;
    for (i, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        // What is there is seen.
        let share = (count as f64 / most * 0.86).max(0.06);
        let left = i as f64 * width;
        let place = row.at([left, share]);
        let size = [(row.width * width - 1.0).max(1.0), row.height * share];
        let title = format!("{count} {what}, roughness {}", range([left, left + width]));
        svg.rectangle(place, size, class, &title);
    }
}

impl Row<'_> {
    fn draw(&self, svg: &mut Svg, row: Frame) {
        let LobeText { material, layer, roughness, histogram, .. } = self.lobe;
        let layer = match layer {
            Layer::Base => String::new(),
            other => format!(", {other}"),
        };
        let more = match self.count - 1 {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let room = 32usize.saturating_sub(layer.len() + more.len()).max(8);
        let label = format!("{}{layer}{more}", cut(material, room));
        let [left, middle] = row.at([0.0, 0.5]);
        svg.text([left - 10.0, middle + 4.0], "e", &label);
        svg.line("grid", row.at([0.0, 1.0]), row.at([1.0, 1.0]));
        let [low, high] = *roughness;
        let title = format!("{material}{layer}{more}: roughness {}", range(*roughness));
        if low == high {
            let [x, y] = row.at([low, 0.86]);
            svg.rectangle([x - 1.5, y], [3.0, 0.72 * row.height], "orange", &title);
        } else if let Some(texels) = histogram {
            let [x, y] = row.at([low, 0.1]);
            columns(svg, row, texels, "blue", "texels");
            svg.rectangle([x, y], [(high - low) * row.width, 3.0], "ink", &title);
        } else {
            let [x, y] = row.at([low, 0.68]);
            let size = [(high - low) * row.width, 0.36 * row.height];
            svg.rectangle([x, y], size, "blue", &title);
        }
    }
}
