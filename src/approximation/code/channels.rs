//! The function of the channels: where a place lies, and the sum of what counts there.

use super::function::{Function, horner, sum};
use super::functions::Functions;
use super::place;
use crate::approximation::{Across, Along, Shape};
use crate::lookup::Language;

/// A place in the coordinates of a shape.
struct Places {
    /// The lines that find it.
    lines: Vec<String>,
    /// The calls that give what is summed up there: function and first arguments.
    terms: Vec<(&'static str, Vec<String>)>,
}

impl Functions<'_> {
    fn places(&self) -> Places {
        let (dialect, region) = (self.dialect, &self.approximation.region);
        let local = |name: &str, value: String| dialect.local(dialect.syntax.float, name, &value);
        let constant = (!self.takes_roughness()).then_some(region.roughness[0]);
        let mut lines = Vec::new();
        if constant.is_none() {
            lines.push(place::roughness(dialect, region));
        }
        let (x, least) = match self.approximation.shape {
            Shape::Polynomial { x } | Shape::Surface { x, .. } => (x, 0.0),
            Shape::Spline { x, .. } => (x, region.least_nov),
            // A sampler reads textures: they are refused.
            Shape::Texture { .. } => (Along::Nov, 0.0),
        };
        let (before, x) = place::along(dialect, x, least, constant);
        lines.extend(before);
        let count = self.packing.count;
        let terms = match self.approximation.shape {
            Shape::Polynomial { .. } => {
                lines.push(local("x", dialect.affine(&x, 2.0, -1.0)));
                let number = |i| ("number", vec![dialect.whole_number(i)]);
                (0..count).map(number).collect()
            }
            Shape::Surface { y, columns, .. } => {
                lines.push(local("x", x));
                if y != Across::Linear {
                    lines.push(local("y", place::power(dialect, y)));
                }
                let row = |j| ("row", vec![dialect.whole_number(j * columns), "x".into()]);
                (0..count / columns).map(row).collect()
            }
            Shape::Spline { y, size: [columns, rows], degree, .. } => {
                lines.push(local("x", dialect.affine(&x, (columns - degree) as f64, 0.0)));
                lines.push(local("y", place::across(dialect, y, region, rows - degree)));
                let k = self.spans(&mut lines, degree, [columns, rows]);
                let row = |b| ("row", vec![self.plus(&k, b * columns), "along".into()]);
                (0..=degree).map(row).collect()
            }
            Shape::Texture { .. } => Vec::new(),
        };
        Places { lines, terms }
    }

    /// The sum of terms in a pass, in a variable: the lines before, and the sum as an expression.
    fn summed(
        &self,
        terms: &[(&'static str, Vec<String>)],
        variable: &str,
        pass: Option<usize>,
    ) -> (Vec<String>, String) {
        let call = |(function, arguments): &(&str, Vec<String>)| {
            let arguments: Vec<&str> = arguments.iter().map(|word| &**word).collect();
            self.call(function, &arguments, pass)
        };
        let calls = terms.iter().map(call);
        if self.is_spline() {
            let weight = |b| self.dialect.component("across", b);
            let weighted = calls.enumerate().map(|(b, call)| format!("{} * {call}", weight(b)));
            return (Vec::new(), sum(&weighted.collect::<Vec<String>>()));
        }
        let calls: Vec<String> = calls.collect();
        let x = match self.approximation.shape {
            Shape::Surface { .. } => self.surface_variable(),
            _ => "x",
        };
        horner(self.sum_of(&calls, variable), variable, &calls, x)
    }

    /// The name of a surface's coordinate across roughness.
    pub fn surface_variable(&self) -> &'static str {
        match self.approximation.shape {
            Shape::Surface { y: Across::Linear, .. } => "r",
            _ => "y",
        }
    }

    /// The lines of the spans at (x, y) and of the weights there; the first control point.
    fn spans(&self, lines: &mut Vec<String>, degree: usize, [columns, rows]: [usize; 2]) -> String {
        let dialect = self.dialect;
        let mut terms = Vec::new();
        let axes = [("j", "y", rows, columns), ("i", "x", columns, 1)];
        let mut fractions = Vec::new();
        for (index, place, count, stride) in axes {
            let last = count - degree - 1;
            if last == 0 {
                fractions.push(place.to_owned());
                continue;
            }
            let whole = (dialect.whole)(place, last);
            lines.push(dialect.local(dialect.index, index, &whole));
            fractions.push(format!("{place} - {}", (dialect.float)(index)));
            terms.push(match stride {
                1 => index.to_owned(),
                _ => format!("{index} * {}", dialect.whole_number(stride)),
            });
        }
        for (name, fraction) in ["across", "along"].into_iter().zip(&fractions) {
            let weights = self.name("weights");
            if dialect.language == Language::C {
                lines.push(format!("float {name}[{}];", degree + 1));
                lines.push(format!("{weights}({fraction}, {name});"));
            } else {
                let value = format!("{weights}({fraction})");
                lines.push(dialect.local(&dialect.weights(degree), name, &value));
            }
        }
        match terms.is_empty() {
            true => String::new(),
            false => {
                lines.push(dialect.local(dialect.index, "k", &terms.join(" + ")));
                "k".into()
            }
        }
    }

    /// The variable in which terms are summed up, with the last of them; it changes but where two
    /// terms are returned at once.
    pub fn sum_of(&self, terms: &[String], name: &str) -> String {
        let last = terms.last().map_or("", |term| term);
        match terms.len() {
            2 if name == "sum" => self.dialect.local(&self.kind(), name, last),
            _ => self.dialect.variable(&self.kind(), name, last),
        }
    }

    /// The function of the channels, under this name.
    pub fn channels(&self, about: &str, name: &str, public: bool) -> String {
        let Places { mut lines, terms } = self.places();
        let mut values = Vec::new();
        let is_coded = self.is_spline() && self.packing.decode(0).is_some();
        for (pass, channel) in self.passes().into_iter().zip(self.channel_names()) {
            let variable = if pass.is_some() { channel } else { "sum" };
            let (before, mut value) = self.summed(&terms, variable, pass);
            lines.extend(before);
            if pass.is_some() || is_coded {
                lines.push(match self.is_spline() {
                    true => self.dialect.local(&self.kind(), variable, &value),
                    false => format!("{variable} = {value};"),
                });
                value = variable.to_owned();
            }
            values.push(if is_coded { self.decode(&value, pass) } else { value });
        }
        match &values[..] {
            [first, second] => {
                lines.extend(self.dialect.return_pair(&self.pair(), [first, second]));
            }
            _ => lines.push(format!("return {};", values.concat())),
        }
        let (kind, name) = (self.channels_kind(), self.name(name));
        let parameters = self.place_parameters();
        Function { about, public, kind: &kind, name: &name, parameters: &parameters, lines }
            .text(self.dialect)
    }
}
