//! Maps of errors: a row for each case, a panel for each way.

use super::{PALETTE, draw_footer, draw_title};
use crate::compare::draw::axes::ten_to;
use crate::compare::draw::{Anchor, Colour, Drawing, GREY, INK};
use crate::compare::study::Machine;
use crate::compare::study::stability::{Family, Fault, Map, Scale, Stability};
use crate::image::{Picture, mix};

/// Width and height of a panel, and what one takes with its labels.
const PANEL: (f64, f64) = (176.0, 118.0);
const CELL: (f64, f64) = (232.0, 190.0);

/// Errors from 10 to this power, white, to 1, dark.
const DECADES: i32 = 8;

const FAULTS: [(Fault, &str, Colour); 4] = [
    (Fault::Nan, "not a number", PALETTE[1]),
    (Fault::Infinite, "infinite", PALETTE[0]),
    (Fault::Negative, "below 0", [240, 228, 66]),
    (Fault::AboveOne, "more than all light", PALETTE[4]),
];

/// The maps of a family; nothing where there are none.
pub fn chart(
    stability: &Stability,
    family: Family,
    title: &str,
    machine: &Machine,
) -> Option<Drawing> {
    let mut rows: Vec<(&str, Vec<&Map>)> = Vec::new();
    for map in stability.maps.iter().filter(|map| map.family == family) {
        match rows.last_mut().filter(|(case, _)| *case == map.case) {
            Some((_, maps)) => maps.push(map),
            None => rows.push((&map.case, vec![map])),
        }
    }
    let columns = rows.iter().map(|(_, maps)| maps.len().min(4)).max()?;
    let lines: usize = rows.iter().map(|(_, maps)| maps.len().div_ceil(4)).sum();
    let size = (
        60.0 + CELL.0 * columns.max(3) as f64,
        118.0 + CELL.1 * lines as f64 + 22.0 * rows.len() as f64,
    );
    let mut drawing = Drawing::new(size.0, size.1);
    draw_title(
        &mut drawing,
        title,
        "error, from 10⁻⁸ (white) to 1 (dark), over two logarithmic axes",
    );
    scale(&mut drawing, 62.0);
    let mut top = 104.0;
    for (case, maps) in rows {
        drawing.text((20.0, top + 4.0), case, 14.0, Anchor::Start, INK);
        top += 22.0;
        for (i, map) in maps.iter().enumerate() {
            panel(
                &mut drawing,
                (64.0 + CELL.0 * (i % 4) as f64, top + CELL.1 * (i / 4) as f64),
                map,
            );
        }
        top += CELL.1 * maps.len().div_ceil(4) as f64;
    }
    draw_footer(&mut drawing, machine);
    Some(drawing)
}

fn panel(drawing: &mut Drawing, (left, top): (f64, f64), map: &Map) {
    let [width, height] = map.size;
    let mut picture = Picture::new(width, height, [255; 3]);
    for (i, &error) in map.errors.iter().enumerate() {
        picture.set(i % width, i / width, shade(error));
    }
    for (i, fault) in &map.faults {
        let colour =
            FAULTS.iter().find(|(kind, ..)| kind == fault).map_or(INK, |(_, _, colour)| *colour);
        picture.set(i % width, i / width, colour);
    }
    let (largest, faulty) = (map.largest(), map.faults.len());
    let said = if faulty == 0 {
        format!("to {largest:.0e}")
    } else {
        format!("to {largest:.0e}, {faulty} faults")
    };
    let title = format!("{}, {}: {said}", map.case, map.variant);
    drawing.text((left, top + 10.0), super::short(&map.variant), 12.0, Anchor::Start, INK);
    let top = top + 16.0;
    drawing.image((left, top), PANEL, picture, title);
    let (right, bottom) = (left + PANEL.0, top + PANEL.1);
    drawing.line(
        vec![(left, top), (right, top), (right, bottom), (left, bottom), (left, top)],
        GREY,
        0.8,
        false,
    );
    let first = |scale: &Scale| if scale.zero { "0".into() } else { number(scale.from) };
    drawing.text((left, bottom + 13.0), first(&map.x), 10.5, Anchor::Start, GREY);
    drawing.text((right, bottom + 13.0), number(map.x.to), 10.5, Anchor::End, GREY);
    drawing.text(
        (0.5 * (left + right), bottom + 13.0),
        map.x.name.as_str(),
        10.5,
        Anchor::Middle,
        GREY,
    );
    drawing.text((left, bottom + 27.0), said, 10.5, Anchor::Start, GREY);
    drawing.text((left - 4.0, top + 9.0), first(&map.y), 10.5, Anchor::End, GREY);
    drawing.text((left - 4.0, bottom), number(map.y.to), 10.5, Anchor::End, GREY);
    drawing.upright((left - 9.0, 0.5 * (top + bottom)), map.y.name.as_str(), 10.5);
}

/// A number of an axis, as short as it goes.
fn number(value: f64) -> String {
    let power = libm::log10(value).round() as i32;
    if (libm::exp10(f64::from(power)) / value - 1.0).abs() < 1e-6 {
        ten_to(power)
    } else {
        format!("{value}")
    }
}

fn shade(error: f64) -> Colour {
    let share = 1.0 + libm::log10(error.max(1e-300)) / f64::from(DECADES);
    mix([255.0; 3], [8.0, 40.0, 110.0], share.clamp(0.0, 1.0))
}

/// The colours and what they mean.
fn scale(drawing: &mut Drawing, top: f64) {
    let mut picture = Picture::new(64, 1, [255; 3]);
    for i in 0..64 {
        picture.set(i, 0, shade(libm::exp10(f64::from(DECADES) * (i as f64 / 63.0 - 1.0))));
    }
    drawing.image((64.0, top), (128.0, 10.0), picture, "errors");
    drawing.text((58.0, top + 9.0), ten_to(-DECADES), 11.0, Anchor::End, GREY);
    drawing.text((197.0, top + 9.0), "1", 11.0, Anchor::Start, GREY);
    for (i, (_, name, colour)) in FAULTS.iter().enumerate() {
        let left = 228.0 + 130.0 * i as f64;
        drawing.mark((left, top + 5.0), 1, 7.0, *colour, *name);
        drawing.text((left + 10.0, top + 9.0), *name, 11.0, Anchor::Start, GREY);
    }
}
