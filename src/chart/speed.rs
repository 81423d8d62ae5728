//! Error against time, and against evaluations.

use super::{Entry, PALETTE, footed, headed, legend, short};
use crate::draw::axes::{Decades, apart, draw};
use crate::draw::{Anchor, Colour, Drawing, GREY, INK};
use crate::sampling::Sampler;
use crate::sampling::stand_in::StandIn;
use crate::study::Machine;
use crate::study::speed::{Measurement, Speed, Who};
use crate::study::technique::{Arithmetic, BASELINE, Technique};
use crate::units::word;

/// What runs along the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Time, over that of the baseline.
    Time,
    /// Evaluations of the integrand.
    Evaluations,
}

/// The largest error of every method at every cost.
///
/// A method's line joins the best of its marks: whatever point set and arithmetic reaches an error first. The thin
/// line through a mark runs from the shortest time to the longest.
pub fn chart(speed: &Speed, machine: &Machine, against: Against) -> Drawing {
    let mut drawing = Drawing::new(1000.0, 770.0);
    let (lobe, size) = (speed.plan.lobe, speed.plan.size);
    let (title, name) = match against {
        Against::Time => {
            ("Error against time", "time, over that of 1,024 half vectors by Hammersley's points in the same run")
        }
        Against::Evaluations => ("Error against evaluations", "evaluations of the integrand for a texel"),
    };
    let spread = match against {
        Against::Time => ", a thin line its shortest and longest times",
        Against::Evaluations => "",
    };
    let about = format!("A and B over a {size} x {size} table, {lobe}; a method's line joins its best marks{spread}");
    headed(&mut drawing, title, &about);
    let across = |m: &Measurement| if against == Against::Time { m.ratio } else { m.evaluations };
    // Devices' evaluations are those of the CPU.
    let shown: Vec<&Measurement> =
        speed.measurements.iter().filter(|m| against == Against::Time || matches!(m.who, Who::Cpu(_))).collect();
    let x = Decades::around(shown.iter().map(|m| across(m)), 82.0, 800.0);
    let errors = shown.iter().map(|m| m.errors.largest()).chain(speed.floors.iter().map(|floor| floor.error));
    let y = Decades::around(errors, 540.0, 66.0).within(-13, 1);
    draw(&mut drawing, x, y, (name, "largest error"));
    floors(&mut drawing, speed, x, y);
    let place = |m: &Measurement| (x.place(across(m)), y.place(m.errors.largest()));
    let mut entries = Vec::new();
    for (technique, device) in lines(&shown) {
        let (kind, colour) = look(technique);
        // Devices are told apart by their marks.
        let kind = machine.devices.iter().position(|other| Some(other.name.as_str()) == device).map_or(kind, |i| i + 1);
        let own = |m: &&&Measurement| m.technique == technique && device_of(&m.who) == device;
        let own: Vec<&Measurement> = shown.iter().filter(own).copied().collect();
        let front = front(&own, across);
        drawing.line(front.iter().map(|m| place(m)).collect(), colour, 1.8, device.is_some());
        for m in &own {
            let best = front.iter().any(|other| std::ptr::eq(*other, *m));
            let large = best || technique == Technique::Certified;
            if large && against == Against::Time {
                let (height, [least, most]) = (place(m).1, m.spread.map(|seconds| m.ratio * seconds / m.seconds));
                drawing.line(vec![(x.place(least), height), (x.place(most), height)], colour, 0.8, false);
            }
            drawing.mark(place(m), kind, if large { 4.5 } else { 2.2 }, colour, label(m));
        }
        let label = match device {
            None => format!("{} ({})", technique.name(), technique.source()),
            Some(device) => format!("{} on {}", technique.name(), short(device)),
        };
        entries.push(Entry { label, kind, colour, dashed: device.is_some() });
    }
    let baseline = |m: &&&Measurement| {
        (m.technique, &m.step, &m.who)
            == (Technique::Samples(Sampler::HalfVector), &BASELINE.name(), &Who::Cpu(Arithmetic::F32))
    };
    let all = front(&shown, across);
    drawing.line(all.iter().map(|m| place(m)).collect(), GREY, 1.0, true);
    if let Some(m) = shown.iter().find(baseline) {
        drawing.ring(place(m), 9.0, INK);
    }
    // Three columns, and two lines more that are no methods.
    let rows = (entries.len() + 2).div_ceil(3).max(7);
    legend(&mut drawing, (40.0, 608.0), rows, &entries);
    let slot = |i: usize| (40.0 + 320.0 * (i / rows) as f64, 608.0 + 20.0 * (i % rows) as f64);
    let (left, height) = slot(entries.len());
    drawing.line(vec![(left, height), (left + 26.0, height)], GREY, 1.0, true);
    drawing.text((left + 34.0, height + 4.5), "Pareto front", 12.0, Anchor::Start, INK);
    let (left, height) = slot(entries.len() + 1);
    drawing.ring((left + 13.0, height), 7.0, INK);
    drawing.text((left + 34.0, height + 4.5), "the baseline, which bakers take", 12.0, Anchor::Start, INK);
    drawing.height = 630.0 + 20.0 * rows as f64;
    footed(&mut drawing, machine);
    drawing
}

fn floors(drawing: &mut Drawing, speed: &Speed, x: Decades, y: Decades) {
    let heights: Vec<f64> = speed.floors.iter().map(|floor| y.place(floor.error)).collect();
    let labels =
        apart(&heights.iter().map(|height| height - 4.0).collect::<Vec<_>>(), 14.0, (y.end + 12.0, y.start - 4.0));
    for ((floor, height), label) in speed.floors.iter().zip(heights).zip(labels) {
        drawing.line(vec![(x.start, height), (x.end, height)], GREY, 1.0, false);
        drawing.text((x.end + 6.0, label), floor.name.as_str(), 11.0, Anchor::Start, GREY);
    }
}

/// The lines of the chart: every method on the CPU; on devices one of each kind, lest nothing be seen for lines.
fn lines<'a>(shown: &[&'a Measurement]) -> Vec<(Technique, Option<&'a str>)> {
    let mut lines: Vec<(Technique, Option<&str>)> = Vec::new();
    for m in shown {
        let line = (m.technique, device_of(&m.who));
        let drawn = line.1.is_none() || [Technique::HSpace, Technique::Samples(Sampler::HalfVector)].contains(&line.0);
        if drawn && !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines.sort_by_key(|(_, device)| device.is_some());
    lines
}

fn device_of(who: &Who) -> Option<&str> {
    match who {
        Who::Cpu(_) => None,
        Who::Device(name) => Some(name),
    }
}

fn label(m: &Measurement) -> String {
    let (name, largest) = (m.technique.name(), m.errors.largest());
    let who = match &m.who {
        Who::Cpu(arithmetic) => format!("CPU {}", word(arithmetic)),
        Who::Device(name) => name.clone(),
    };
    format!(
        "{name}, {}, {who}: {largest:.1e} at {:.3} of the baseline, {:.0} evaluations",
        m.step, m.ratio, m.evaluations
    )
}

/// Those that nothing beats in both, from cheap to dear.
fn front<'a>(all: &[&'a Measurement], across: impl Fn(&Measurement) -> f64) -> Vec<&'a Measurement> {
    let mut sorted = all.to_vec();
    sorted.sort_by(|a, b| across(a).total_cmp(&across(b)).then(a.errors.largest().total_cmp(&b.errors.largest())));
    let mut front: Vec<&Measurement> = Vec::new();
    for m in sorted {
        if front.last().is_none_or(|best| m.errors.largest() < best.errors.largest()) {
            front.push(m);
        }
    }
    front
}

fn look(technique: Technique) -> (usize, Colour) {
    match technique {
        Technique::Samples(Sampler::Uniform) => (0, [150; 3]),
        Technique::Samples(Sampler::Cosine) => (1, [150; 3]),
        Technique::Samples(Sampler::HalfVector) => (0, PALETTE[1]),
        Technique::Samples(Sampler::Visible) => (1, PALETTE[6]),
        Technique::Samples(Sampler::SphericalCap) => (2, PALETTE[4]),
        Technique::Samples(Sampler::BoundedVisible) => (3, PALETTE[5]),
        Technique::StandIn(StandIn::KarisMobile) => (4, [110; 3]),
        Technique::StandIn(StandIn::Lazarov) => (2, [110; 3]),
        Technique::StandIn(StandIn::Materialx) => (5, [110; 3]),
        Technique::HSpace => (0, PALETTE[2]),
        Technique::LSpace => (1, PALETTE[3]),
        Technique::DoubleExponential => (4, PALETTE[2]),
        Technique::Surrogate => (3, PALETTE[3]),
        Technique::Certified => (5, PALETTE[0]),
    }
}
