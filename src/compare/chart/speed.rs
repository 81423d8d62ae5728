//! Error against time, and against evaluations.

use super::{Entry, PALETTE, draw_footer, draw_title, legend, short};
use crate::choice::Choice;
use crate::compare::analytic_fit::AnalyticFit;
use crate::compare::draw::axes::{Decades, draw, spread_labels};
use crate::compare::draw::{Anchor, Colour, Drawing, GREY, INK};
use crate::compare::sampling::Sampler;
use crate::compare::study::Machine;
use crate::compare::study::speed::{Measurement, Plan, Speed, Who};
use crate::compare::technique::{Arithmetic, BASELINE, Technique};

/// The quantity along the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Time, over that of the baseline.
    Time,
    /// Evaluations of the integrand.
    Evaluations,
}

/// The largest error of every method at every cost.
///
/// A method's line joins the best of its marks: whatever point set and arithmetic reaches an error
/// first. The thin line through a mark runs from the shortest time to the longest.
pub fn chart(speed: &Speed, machine: &Machine, against: Against) -> Drawing {
    let mut chart = Chart::new(speed, machine, against);
    chart.draw_frame();
    draw_limits(&mut chart.drawing, speed, chart.x, chart.y);
    let entries: Vec<Entry> = lines(&chart.shown)
        .into_iter()
        .map(|(technique, device)| chart.draw_line(technique, device))
        .collect();
    chart.draw_pareto_front();
    chart.draw_legend(&entries);
    chart.drawing
}

/// A chart with its scales.
struct Chart<'a> {
    drawing: Drawing,
    speed: &'a Speed,
    machine: &'a Machine,
    against: Against,
    /// The measurements that it shows.
    shown: Vec<&'a Measurement>,
    x: Decades,
    y: Decades,
}

impl Against {
    fn of(self, m: &Measurement) -> f64 {
        match self {
            Against::Time => m.ratio,
            Against::Evaluations => m.evaluations,
        }
    }
}

impl<'a> Chart<'a> {
    fn new(speed: &'a Speed, machine: &'a Machine, against: Against) -> Self {
        // Devices' evaluations are those of the CPU.
        let shows = |m: &&Measurement| against == Against::Time || matches!(m.who, Who::Cpu(_));
        let shown: Vec<&Measurement> = speed.measurements.iter().filter(shows).collect();
        let errors = shown.iter().map(|m| m.errors.largest());
        let errors = errors.chain(speed.floors.iter().map(|floor| floor.error));
        let x = Decades::around(shown.iter().map(|m| against.of(m)), 82.0, 800.0);
        let y = Decades::around(errors, 540.0, 66.0).within(-13, 1);
        Chart { drawing: Drawing::new(1000.0, 770.0), speed, machine, against, shown, x, y }
    }

    fn place(&self, m: &Measurement) -> (f64, f64) {
        (self.x.place(self.against.of(m)), self.y.place(m.errors.largest()))
    }

    /// Title and axes.
    fn draw_frame(&mut self) {
        let (title, name, spread) = match self.against {
            Against::Time => (
                "Error against time",
                "time, over that of 1,024 half vectors by Hammersley's points in the same run",
                ", a thin line its shortest and longest times",
            ),
            Against::Evaluations => {
                ("Error against evaluations", "evaluations of the integrand for a texel", "")
            }
        };
        let Plan { lobe, size, .. } = self.speed.plan;
        let about = format!(
            "A and B over a {size} x {size} table, {lobe}; a method's line joins its best \
             marks{spread}"
        );
        draw_title(&mut self.drawing, title, &about);
        draw(&mut self.drawing, self.x, self.y, (name, "largest error"));
    }

    /// The marks of a method and the line through the best of them; returns its entry in the
    /// legend.
    fn draw_line(&mut self, technique: Technique, device: Option<&str>) -> Entry {
        let (kind, colour) = style_of(technique);
        // Devices are told apart by their marks.
        let mut devices = self.machine.devices.iter();
        let number = devices.position(|other| Some(other.name.as_str()) == device);
        let kind = number.map_or(kind, |number| number + 1);
        let own = |m: &&&Measurement| m.technique == technique && device_of(&m.who) == device;
        let own: Vec<&Measurement> = self.shown.iter().filter(own).copied().collect();
        let front = front(&own, self.against);
        let places = front.iter().map(|m| self.place(m)).collect();
        self.drawing.line(places, colour, 1.8, device.is_some());
        for m in own {
            let best = front.iter().any(|other| std::ptr::eq(*other, m));
            self.draw_mark(m, kind, colour, best || technique == Technique::Certified);
        }
        let label = match device {
            None => format!("{} ({})", technique.name(), technique.source()),
            Some(device) => format!("{} on {}", technique.name(), short(device)),
        };
        Entry { label, kind, colour, dashed: device.is_some() }
    }

    fn draw_mark(&mut self, m: &Measurement, kind: usize, colour: Colour, large: bool) {
        let place = self.place(m);
        if large && self.against == Against::Time {
            let ends =
                m.spread.map(|seconds| (self.x.place(m.ratio * seconds / m.seconds), place.1));
            self.drawing.line(ends.into(), colour, 0.8, false);
        }
        self.drawing.mark(place, kind, if large { 4.5 } else { 2.2 }, colour, label(m));
    }

    /// The best of all methods, and a ring around the baseline.
    fn draw_pareto_front(&mut self) {
        let places = front(&self.shown, self.against).iter().map(|m| self.place(m)).collect();
        self.drawing.line(places, GREY, 1.0, true);
        let is_baseline = |m: &&&Measurement| {
            m.technique == Technique::Samples(Sampler::HalfVector)
                && m.step == BASELINE.name()
                && m.who == Who::Cpu(Arithmetic::F32)
        };
        if let Some(m) = self.shown.iter().find(is_baseline) {
            let place = self.place(m);
            self.drawing.ring(place, 9.0, INK);
        }
    }

    /// The legend in three columns; its last two lines are no methods.
    fn draw_legend(&mut self, entries: &[Entry]) {
        const LEFT: f64 = 40.0;
        const TOP: f64 = 608.0;
        let rows = (entries.len() + 2).div_ceil(3).max(7);
        let drawing = &mut self.drawing;
        legend(drawing, (LEFT, TOP), rows, entries);
        let slot = |i: usize| (LEFT + 320.0 * (i / rows) as f64, TOP + 20.0 * (i % rows) as f64);
        let mut explain = |(left, height): (f64, f64), text| {
            drawing.text((left + 34.0, height + 4.5), text, 12.0, Anchor::Start, INK);
        };
        let (front, ring) = (slot(entries.len()), slot(entries.len() + 1));
        explain(front, "Pareto front");
        explain(ring, "the baseline, which bakers take");
        drawing.line(vec![front, (front.0 + 26.0, front.1)], GREY, 1.0, true);
        drawing.ring((ring.0 + 13.0, ring.1), 7.0, INK);
        drawing.height = 630.0 + 20.0 * rows as f64;
        draw_footer(drawing, self.machine);
    }
}

/// The lower limits that storage, arithmetic and lookup set, as lines across the chart.
fn draw_limits(drawing: &mut Drawing, speed: &Speed, x: Decades, y: Decades) {
    let heights: Vec<f64> = speed.floors.iter().map(|floor| y.place(floor.error)).collect();
    let labels = spread_labels(
        &heights.iter().map(|height| height - 4.0).collect::<Vec<_>>(),
        14.0,
        (y.end + 12.0, y.start - 4.0),
    );
    for ((floor, height), label) in speed.floors.iter().zip(heights).zip(labels) {
        drawing.line(vec![(x.start, height), (x.end, height)], GREY, 1.0, false);
        drawing.text((x.end + 6.0, label), floor.name.as_str(), 11.0, Anchor::Start, GREY);
    }
}

/// The lines of the chart: every method on the CPU; on devices one of each kind, lest nothing be
/// seen for lines.
fn lines<'a>(shown: &[&'a Measurement]) -> Vec<(Technique, Option<&'a str>)> {
    let mut lines: Vec<(Technique, Option<&str>)> = Vec::new();
    for m in shown {
        let line = (m.technique, device_of(&m.who));
        let drawn = line.1.is_none()
            || [Technique::HalfVectors, Technique::Samples(Sampler::HalfVector)].contains(&line.0);
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
        Who::Cpu(arithmetic) => format!("CPU {}", arithmetic.word()),
        Who::Device(name) => name.clone(),
    };
    format!(
        "{name}, {}, {who}: {largest:.1e} at {:.3} of the baseline, {:.0} evaluations",
        m.step, m.ratio, m.evaluations
    )
}

/// The measurements that no other beats in both cost and error, the cheapest first.
fn front<'a>(all: &[&'a Measurement], against: Against) -> Vec<&'a Measurement> {
    let mut sorted = all.to_vec();
    let order = |a: &&Measurement, b: &&Measurement| {
        let by_cost = against.of(a).total_cmp(&against.of(b));
        by_cost.then(a.errors.largest().total_cmp(&b.errors.largest()))
    };
    sorted.sort_by(order);
    let mut front: Vec<&Measurement> = Vec::new();
    for m in sorted {
        if front.last().is_none_or(|best| m.errors.largest() < best.errors.largest()) {
            front.push(m);
        }
    }
    front
}

fn style_of(technique: Technique) -> (usize, Colour) {
    match technique {
        Technique::Samples(Sampler::Uniform) => (0, [150; 3]),
        Technique::Samples(Sampler::Cosine) => (1, [150; 3]),
        Technique::Samples(Sampler::HalfVector) => (0, PALETTE[1]),
        Technique::Samples(Sampler::Visible) => (1, PALETTE[6]),
        Technique::Samples(Sampler::SphericalCap) => (2, PALETTE[4]),
        Technique::Samples(Sampler::BoundedVisible) => (3, PALETTE[5]),
        Technique::AnalyticFit(AnalyticFit::KarisMobile) => (4, [110; 3]),
        Technique::AnalyticFit(AnalyticFit::Lazarov) => (2, [110; 3]),
        Technique::AnalyticFit(AnalyticFit::Materialx) => (5, [110; 3]),
        Technique::HalfVectors => (0, PALETTE[2]),
        Technique::LightDirections => (1, PALETTE[3]),
        Technique::DoubleExponential => (4, PALETTE[2]),
        Technique::Interpolant => (3, PALETTE[3]),
        Technique::Certified => (5, PALETTE[0]),
    }
}
