//! The error of lookup in tables of any size, axes and storage.

use super::{Entry, PALETTE, draw_footer, draw_title, legend};
use crate::choice::Choice;
use crate::compare::draw::axes::{Decades, draw};
use crate::compare::draw::{Colour, Drawing};
use crate::compare::study::lookup::{AXES, Reading};
use crate::compare::study::{Lobe, Machine};
use crate::table::precision::Precision;

/// The largest error of a lookup over two domains and the mean error, against the size of the table
/// in KiB.
pub fn chart(readings: &[Reading], lobe: Lobe, machine: &Machine) -> Drawing {
    let mut drawing = Drawing::new(1000.0, 620.0);
    let about = format!(
        "error of the albedo E(F0) that a renderer reads, bilinearly, at the F0 that shows it \
         most; {lobe}"
    );
    draw_title(&mut drawing, "What size a table needs", &about);
    type Of = fn(&Reading) -> f64;
    let panels: [(&str, Of); 3] = [
        ("largest error anywhere", |reading| reading.everywhere),
        ("largest, roughness from 0.045, n\u{b7}v from 0.001", |reading| reading.practical),
        ("root of the mean square, evenly over both", |reading| reading.rms),
    ];
    let kib = |reading: &Reading| reading.bytes as f64 / 1024.0;
    for (panel, (name, of)) in panels.into_iter().enumerate() {
        let left = 82.0 + 318.0 * panel as f64;
        let x = Decades::around(readings.iter().map(kib), left, left + 250.0);
        let y = Decades::around(readings.iter().map(of), 395.0, 66.0);
        draw(&mut drawing, x, y, ("KiB of the table's two channels", name));
        for (i, axes) in AXES.iter().enumerate() {
            for (precision, kind, dashed) in STORAGES {
                let own = |r: &&Reading| r.has(*axes) && r.precision == precision;
                let mut own: Vec<&Reading> = readings.iter().filter(own).collect();
                own.sort_by_key(|reading| reading.size);
                let places = own.iter().map(|r| (x.place(kib(r)), y.place(of(r))));
                drawing.line(places.clone().collect(), COLOURS[i], 1.4, dashed);
                for (reading, place) in own.iter().zip(places) {
                    let size = reading.size;
                    let label = format!(
                        "{size} x {size}, {}, {}, {}: {:.1e}",
                        reading.x,
                        reading.y,
                        precision.word(),
                        of(reading)
                    );
                    drawing.mark(place, kind, 3.5, COLOURS[i], label);
                }
            }
        }
    }
    let axes = |(i, (x, y)): (usize, &(&str, &str))| Entry {
        label: format!("{x} by {y}{}", if x.contains("edges") { "" } else { ", centres" }),
        kind: 0,
        colour: COLOURS[i],
        dashed: false,
    };
    legend(&mut drawing, (82.0, 470.0), 6, &AXES.iter().enumerate().map(axes).collect::<Vec<_>>());
    let storage = |(precision, kind, dashed): (Precision, usize, bool)| Entry {
        label: precision.to_string(),
        kind,
        colour: [90; 3],
        dashed,
    };
    legend(&mut drawing, (562.0, 470.0), 6, &STORAGES.map(storage));
    draw_footer(&mut drawing, machine);
    drawing
}

const COLOURS: [Colour; 5] = [PALETTE[1], PALETTE[6], PALETTE[4], PALETTE[3], PALETTE[2]];

const STORAGES: [(Precision, usize, bool); 3] =
    [(Precision::F16, 0, false), (Precision::Unorm16, 3, true), (Precision::Unorm8, 1, true)];
