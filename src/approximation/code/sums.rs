//! The functions that sum numbers up: a row of a surface or of control points, and the weights of
//! those.

use super::function::{Function, horner, sum};
use super::functions::Functions;
use crate::approximation::Shape;
use crate::lookup::Language;

impl Functions<'_> {
    /// The functions that `channels` calls besides `number`.
    pub fn helpers(&self) -> Vec<String> {
        match self.approximation.shape {
            Shape::Polynomial { .. } | Shape::Texture { .. } => Vec::new(),
            Shape::Surface { columns, .. } => {
                let dialect = self.dialect;
                let terms: Vec<String> =
                    (0..columns).map(|i| self.call_number(&self.plus("k", i))).collect();
                let (mut lines, last) = horner(self.sum_of(&terms, "sum"), "sum", &terms, "x");
                lines.push(format!("return {last};"));
                let parameters = [("k", dialect.index), ("x", dialect.syntax.float)];
                vec![self.internal(
                    "The row that begins at number k, at x.",
                    "row",
                    &parameters,
                    lines,
                )]
            }
            Shape::Spline { degree, .. } => vec![self.weights(degree), self.row(degree)],
        }
    }

    /// The weights of a span.
    fn weights(&self, degree: usize) -> String {
        let (dialect, float) = (self.dialect, self.dialect.syntax.float);
        let number = |value| dialect.number(value);
        let local = |name, value: String| dialect.local(float, name, &value);
        let complement = |x: &str| format!("{} - {x}", number(1.0));
        let (half, sixth) = (number(0.5), number(1.0 / 6.0));
        let (mut lines, weights) = match degree {
            1 => (Vec::new(), vec![complement("f"), "f".into()]),
            2 => (
                vec![
                    local("g", complement("f")),
                    local("first", format!("g * g * {half}")),
                    local("last", format!("f * f * {half}")),
                ],
                vec!["first".into(), complement("(first + last)"), "last".into()],
            ),
            _ => (
                vec![
                    local("g", complement("f")),
                    local("first", format!("g * g * g * {sixth}")),
                    local("last", format!("f * f * f * {sixth}")),
                    local(
                        "second",
                        format!("f * f * (f * {half} - {}) + {}", number(1.0), number(2.0 / 3.0)),
                    ),
                ],
                vec![
                    "first".into(),
                    "second".into(),
                    complement("(first + second + last)"),
                    "last".into(),
                ],
            ),
        };
        let kind = dialect.weights(degree);
        let name = self.name("weights");
        let pieces = ["linear", "quadratic", "cubic"][degree - 1];
        let about =
            format!("The weights of {} control points, {pieces} in f from 0 to 1.", degree + 1);
        let parameters = [("f", float), ("w[]", float)];
        let (kind, parameters) = match dialect.language {
            Language::C => {
                let set = |(i, weight)| format!("w[{i}] = {weight};");
                lines.extend(weights.iter().enumerate().map(set));
                ("void", &parameters[..])
            }
            Language::Rust => {
                lines.push(format!("return [{}];", weights.join(", ")));
                (&*kind, &parameters[..1])
            }
            _ => {
                lines.push(format!("return {kind}({});", weights.join(", ")));
                (&*kind, &parameters[..1])
            }
        };
        Function { about: &about, public: false, kind, name: &name, parameters, lines }
            .text(dialect)
    }

    /// The sum over a row of control points.
    fn row(&self, degree: usize) -> String {
        let dialect = self.dialect;
        let term =
            |i| format!("{} * {}", dialect.component("w", i), self.call_number(&self.plus("k", i)));
        let terms: Vec<String> = (0..=degree).map(term).collect();
        let weights = dialect.weights(degree);
        let weights = match dialect.language {
            Language::C => ("w[]", "const float"),
            _ => ("w", &*weights),
        };
        let lines = vec![format!("return {};", sum(&terms))];
        let about = "The control points of a row from k on, each by its weight.";
        self.internal(about, "row", &[("k", dialect.index), weights], lines)
    }
}
