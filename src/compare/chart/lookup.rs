//! The error of lookup in tables of any size, axes and storage, and of the nets that the planner
//! fits.

use super::{Entry, PALETTE, draw_footer, draw_title, legend};
use crate::choice::Choice;
use crate::compare::draw::axes::{Decades, draw};
use crate::compare::draw::{Colour, Drawing};
use crate::compare::study::lookup::layer::{LAYER, Net, Where};
use crate::compare::study::lookup::{AXES, Axes, Reading};
use crate::compare::study::{Lobe, Machine};
use crate::table::precision::Precision;

/// A panel: its name, what it shows of a table, the nets that it has, and what it shows of them.
type Panel = (&'static str, fn(&Reading) -> f64, Where, fn(&Net) -> f64);

/// The nets are those that are planned for the panel's own domain; a mean is one over everything.
const PANELS: [Panel; 3] = [
    ("largest error anywhere", |r| r.everywhere, Where::Everywhere, |net| net.largest),
    (
        "largest, roughness from 0.045, n\u{b7}v from 0.001",
        |r| r.practical,
        Where::Practical,
        |net| net.largest,
    ),
    ("root of the mean square, evenly over both", |r| r.rms, Where::Everywhere, |net| net.rms),
];

fn kib(bytes: usize) -> f64 {
    bytes as f64 / 1024.0
}

/// The largest error of a lookup over two domains and the mean error, against the size of the table
/// in KiB.
pub fn chart(readings: &[Reading], nets: &[Net], lobe: Lobe, machine: &Machine) -> Drawing {
    let mut drawing = Drawing::new(1000.0, 620.0);
    let about = format!(
        "error of the albedo E(F0) that a renderer reads, at the F0 that shows it most; tables are \
         bilinear; {lobe}"
    );
    draw_title(&mut drawing, "What size a table needs", &about);
    for (index, panel) in PANELS.iter().enumerate() {
        draw_panel(&mut drawing, 82.0 + 318.0 * index as f64, panel, readings, nets);
    }
    let has = |axes: Axes| readings.iter().any(|reading| reading.has(axes));
    let tables = series().filter(|(axes, _)| has(*axes));
    let table = |((x, y), colour): (Axes, Colour)| Entry {
        label: match (x, y) {
            LAYER => "E, R over T = \u{221a}(n\u{b7}v (1+3\u{3b1})/(n\u{b7}v+3\u{3b1})), \
                      edges by roughness, edges"
                .into(),
            _ if x.contains("edges") => format!("{x} by {y}"),
            _ => format!("{x} by {y}, centres"),
        },
        kind: 0,
        colour,
        dashed: false,
    };
    legend(&mut drawing, (82.0, 470.0), 6, &tables.map(table).collect::<Vec<_>>());
    let storage = |(precision, kind, dashed): (Precision, usize, bool)| Entry {
        label: format!("exact nodes in {precision}"),
        kind,
        colour: [90; 3],
        dashed,
    };
    let mut entries: Vec<Entry> = STORAGES.map(storage).into();
    if !nets.is_empty() {
        entries.push(Entry {
            label: "splitsum plan for the panel's domain: fitted splines of E, R over T".into(),
            kind: NET.0,
            colour: NET.1,
            dashed: false,
        });
    }
    legend(&mut drawing, (562.0, 470.0), 6, &entries);
    draw_footer(&mut drawing, machine);
    drawing
}

/// The axes of tables, each with its colour.
fn series() -> impl Iterator<Item = (Axes, Colour)> {
    AXES.into_iter().chain([LAYER]).zip(COLOURS)
}

/// Draws a panel.
fn draw_panel(
    drawing: &mut Drawing,
    left: f64,
    &(name, of, domain, of_net): &Panel,
    readings: &[Reading],
    nets: &[Net],
) {
    let mut nets: Vec<&Net> = nets.iter().filter(|net| net.domain == domain).collect();
    nets.sort_by_key(|net| net.bytes);
    let all = readings.iter().map(|r| (kib(r.bytes), of(r)));
    let all: Vec<(f64, f64)> =
        all.chain(nets.iter().map(|net| (kib(net.bytes), of_net(net)))).collect();
    let x = Decades::around(all.iter().map(|place| place.0), left, left + 250.0);
    let y = Decades::around(all.iter().map(|place| place.1), 395.0, 66.0);
    draw(drawing, x, y, ("KiB of the table's two channels", name));
    for (axes, colour) in series() {
        for (precision, kind, dashed) in STORAGES {
            let own = |r: &&Reading| r.has(axes) && r.precision == precision;
            let mut own: Vec<&Reading> = readings.iter().filter(own).collect();
            own.sort_by_key(|reading| reading.size);
            let places = own.iter().map(|r| (x.place(kib(r.bytes)), y.place(of(r))));
            drawing.line(places.clone().collect(), colour, 1.4, dashed);
            for (reading, place) in own.iter().zip(places) {
                let size = reading.size;
                let label = format!(
                    "{size} x {size}, {}, {}, {}: {:.1e}",
                    reading.x,
                    reading.y,
                    precision.word(),
                    of(reading)
                );
                drawing.mark(place, kind, 3.5, colour, label);
            }
        }
    }
    let places = nets.iter().map(|net| (x.place(kib(net.bytes)), y.place(of_net(net))));
    drawing.line(places.clone().collect(), NET.1, 1.8, false);
    for (net, place) in nets.iter().zip(places) {
        let Net { candidate, bytes, .. } = net;
        let label = format!("{bytes} bytes, {candidate}: {:.1e}", of_net(net));
        drawing.mark(place, NET.0, 4.5, NET.1, label);
    }
}

const COLOURS: [Colour; 6] =
    [PALETTE[1], PALETTE[6], PALETTE[4], PALETTE[3], PALETTE[2], PALETTE[5]];

/// The mark of a fitted net, and its colour.
const NET: (usize, Colour) = (2, PALETTE[0]);

const STORAGES: [(Precision, usize, bool); 3] =
    [(Precision::F16, 0, false), (Precision::Unorm16, 3, true), (Precision::Unorm8, 1, true)];
