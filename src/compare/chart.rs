//! Charts of what was measured: pure functions from a study to a drawing.

pub mod lookup;
pub mod size;
pub mod speed;
pub mod stability;

use crate::compare::draw::{Anchor, Colour, Drawing, GREY, INK};
use crate::compare::study::Machine;

/// Colours that every kind of colour vision tells apart (Okabe and Ito 2008), but for the yellow,
/// which white swallows.
pub const PALETTE: [Colour; 7] = [
    [0, 0, 0],
    [213, 94, 0],
    [0, 114, 178],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
];

/// A line of a legend.
struct Entry {
    label: String,
    kind: usize,
    colour: Colour,
    dashed: bool,
}

/// A legend below (`left`, `top`), `lines` lines to a column.
fn legend(drawing: &mut Drawing, (left, top): (f64, f64), lines: usize, entries: &[Entry]) {
    for (i, Entry { label, kind, colour, dashed }) in entries.iter().enumerate() {
        let (x, y) = (left + 320.0 * (i / lines) as f64, top + 20.0 * (i % lines) as f64);
        drawing.line(vec![(x, y), (x + 26.0, y)], *colour, 1.8, *dashed);
        drawing.mark((x + 13.0, y), *kind, 4.5, *colour, "");
        drawing.text((x + 34.0, y + 4.5), label.as_str(), 12.0, Anchor::Start, INK);
    }
}

/// A device's name without what stands in brackets.
fn short(device: &str) -> &str {
    device.split(" (").next().unwrap_or(device)
}

/// A title and, below it, what it is about.
fn draw_title(drawing: &mut Drawing, title: &str, about: &str) {
    drawing.text((20.0, 27.0), title, 17.0, Anchor::Start, INK);
    drawing.text((20.0, 47.0), about, 12.0, Anchor::Start, GREY);
}

/// The machine that measured, at the foot.
fn draw_footer(drawing: &mut Drawing, machine: &Machine) {
    let Machine { processor, threads, version, .. } = machine;
    let text = format!("{processor}, {threads} threads; splitsum {version}");
    drawing.text((20.0, drawing.height - 10.0), text, 11.0, Anchor::Start, GREY);
}
