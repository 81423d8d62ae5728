//! (A, B) of one roughness over n·v: linear between the nodes of an axis, clamped at its ends.

use crate::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
use crate::backend::cpu;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rule::Rule;
use crate::lut::Grid;
use crate::model::Microfacet;
use crate::table::Table;

/// Nodes of an integral over √(n·v). Between them it errs by 3e-7 at most for the lobes and roughnesses of previews,
/// near n·v = 0, where it bends like n·v/α times a logarithm. A picture shows that a hundredfold at most: a fifth of
/// half a step of 8 bits where sRGB is steepest, 12.92 steps to one of light, 1 / (2 · 255 · 12.92) = 1.5e-4. Before
/// the last node the rule itself jumps by 2e-6, a fifth of its bound, as it drops the cut circles at n·v = 1.
const NODES: usize = 4097;

/// Values at the nodes of an axis of n·v.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    axis: Axis,
    values: Vec<ScaleBias>,
}

impl Curve {
    /// What a renderer reads from a table of (A, B) over n·v and roughness, all along one roughness.
    pub fn of_table(table: &Table, roughness: f64) -> Self {
        let read = |i: usize| {
            let texel = table.bilinear(table.x.value(i), roughness);
            ScaleBias { a: texel[0], b: texel[1] }
        };
        Curve { axis: table.x, values: (0..table.x.size).map(read).collect() }
    }

    /// The integral by a rule.
    pub fn of_integral(lobe: Microfacet, alpha: f64, rule: &Rule) -> Result<Self> {
        let spec = AxisSpec { mapping: Mapping::Sqrt, nodes: Nodes::Edges, ..AxisSpec::of(Parameter::Nov) };
        let axis = Axis::new(spec, NODES)?;
        let grid = Grid::of(axis.values(), vec![alpha]);
        Ok(Curve { axis, values: cpu::bake(lobe, &grid, rule, &|_| ()) })
    }

    /// (A, B) at n·v = `mu`.
    pub fn at(&self, mu: f64) -> ScaleBias {
        let (i, next, share) = self.axis.neighbours(mu);
        let (low, high) = (self.values[i], self.values[next]);
        ScaleBias { a: low.a + share * (high.a - low.a), b: low.b + share * (high.b - low.b) }
    }
}
