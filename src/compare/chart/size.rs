//! Cost against the size of a table.

use super::{Entry, PALETTE, draw_footer, draw_title, legend, short};
use crate::compare::draw::axes::{Decades, draw};
use crate::compare::draw::{Colour, Drawing};
use crate::compare::study::size::{Cost, Way};
use crate::compare::study::{Lobe, Machine};

/// Milliseconds of a table against its texels.
pub fn chart(costs: &[Cost], lobe: Lobe, machine: &Machine) -> Drawing {
    let mut drawing = Drawing::new(1000.0, 560.0);
    let about = format!(
        "{lobe}; where no certificate is asked for, the integrals are within \
         2\u{207b}\u{b9}\u{2076}; every time is the shortest of three"
    );
    draw_title(&mut drawing, "Where a device begins to pay", &about);
    let x = Decades::around(costs.iter().map(|cost| cost.size as f64), 82.0, 640.0);
    let y = Decades::around(costs.iter().map(|cost| 1e3 * cost.seconds), 490.0, 66.0);
    draw(&mut drawing, x, y, ("texels along either edge", "milliseconds"));
    let mut ways: Vec<&Way> = Vec::new();
    for cost in costs {
        if !ways.contains(&&cost.way) {
            ways.push(&cost.way);
        }
    }
    let mut entries = Vec::new();
    for (i, way) in ways.iter().enumerate() {
        let colour = colour(way, i);
        let own: Vec<&Cost> = costs.iter().filter(|cost| cost.way == **way).collect();
        let place = |cost: &Cost| (x.place(cost.size as f64), y.place(1e3 * cost.seconds));
        let dashed = matches!(way, Way::Device(_));
        drawing.line(own.iter().map(|cost| place(cost)).collect(), colour, 1.8, dashed);
        for cost in &own {
            let label = format!("{}, {}: {:.2} ms", name(way), cost.size, 1e3 * cost.seconds);
            drawing.mark(place(cost), i, 4.5, colour, label);
        }
        entries.push(Entry { label: name(way), kind: i, colour, dashed });
    }
    legend(&mut drawing, (660.0, 82.0), 20, &entries);
    draw_footer(&mut drawing, machine);
    drawing
}

fn name(way: &Way) -> String {
    match way {
        Way::Certified => "CPU, certified halves".into(),
        Way::Cpu => "CPU, within 2⁻¹⁶".into(),
        Way::DeviceWithStart(device) => format!("{}, with its start", short(device)),
        Way::Device(device) => short(device).into(),
    }
}

fn colour(way: &Way, i: usize) -> Colour {
    match way {
        Way::Certified => PALETTE[2],
        Way::Cpu => PALETTE[3],
        // A device has one colour, with its start and without.
        _ => PALETTE[[1, 1, 4, 4, 6, 6][i.saturating_sub(2) % 6]],
    }
}
