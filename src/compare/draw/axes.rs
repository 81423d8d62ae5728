//! The axes of a chart, both logarithmic.

use super::{Anchor, Drawing, GREY, INK, PALE};

/// A range of whole decades, along pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decades {
    /// 10 to this power at the beginning.
    pub first: i32,
    /// And to this at the end.
    pub last: i32,
    /// The pixel at which it begins.
    pub start: f64,
    /// The pixel at which it ends.
    pub end: f64,
}

impl Decades {
    /// The decades that hold all of the values; those that are not positive and finite are left
    /// out.
    pub fn around(values: impl IntoIterator<Item = f64>, start: f64, end: f64) -> Self {
        let logs = values.into_iter().filter(|v| *v > 0.0 && v.is_finite()).map(libm::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), log| (l.min(log), h.max(log)));
        let (first, last) =
            if low <= high { (low.floor() as i32, high.ceil() as i32) } else { (-1, 0) };
        Decades { first, last: last.max(first + 1), start, end }
    }

    /// The same without what lies beyond these powers of ten.
    pub fn within(self, first: i32, last: i32) -> Self {
        let first = self.first.clamp(first, last - 1);
        Decades { first, last: self.last.clamp(first + 1, last), ..self }
    }

    /// The pixel of a value; values beyond the ends lie at the ends.
    pub fn place(&self, value: f64) -> f64 {
        let share =
            (libm::log10(value) - f64::from(self.first)) / f64::from(self.last - self.first);
        // NaN, which has no place, lies at the beginning.
        self.start
            + (self.end - self.start) * if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    }

    fn ticks(self) -> impl Iterator<Item = (f64, String)> {
        let step = (self.last - self.first + 9) / 10;
        (self.first..=self.last)
            .step_by(step.max(1) as usize)
            .map(|power| (libm::exp10(f64::from(power)), ten_to(power)))
    }
}

/// 10 to a power, as people write it.
pub fn ten_to(power: i32) -> String {
    if (-1..=2).contains(&power) {
        return format!("{}", libm::exp10(f64::from(power)));
    }
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + (digit as u32 - '0' as u32)).unwrap_or(digit),
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
}

/// Grid, ticks and names of both axes.
pub fn draw(drawing: &mut Drawing, x: Decades, y: Decades, names: (&str, &str)) {
    for (value, label) in x.ticks() {
        let at = x.place(value);
        drawing.line(vec![(at, y.start), (at, y.end)], PALE, 1.0, false);
        drawing.text((at, y.start + 18.0), label, 12.0, Anchor::Middle, GREY);
    }
    for (value, label) in y.ticks() {
        let at = y.place(value);
        drawing.line(vec![(x.start, at), (x.end, at)], PALE, 1.0, false);
        drawing.text((x.start - 8.0, at + 4.0), label, 12.0, Anchor::End, GREY);
    }
    drawing.line(vec![(x.start, y.end), (x.start, y.start), (x.end, y.start)], INK, 1.0, false);
    drawing.text((0.5 * (x.start + x.end), y.start + 40.0), names.0, 13.0, Anchor::Middle, INK);
    drawing.upright((x.start - 52.0, 0.5 * (y.start + y.end)), names.1, 13.0);
}

/// Heights for labels that would stand at these: no two closer than `gap`, none beyond `low` to
/// `high`, in the order given.
pub fn spread_labels(wanted: &[f64], gap: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&i, &j| wanted[i].total_cmp(&wanted[j]));
    let mut places = wanted.to_vec();
    let mut floor = low;
    for &i in &order {
        places[i] = places[i].max(floor);
        floor = places[i] + gap;
    }
    let mut ceiling = high;
    for &i in order.iter().rev() {
        places[i] = places[i].min(ceiling);
        ceiling = places[i] - gap;
    }
    places
}
