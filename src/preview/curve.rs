//! (A, B) of one roughness over n·v: linear between the nodes of an axis, clamped at its ends.

use crate::backend::cpu;
use crate::brdf::Microfacet;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rule::Rule;
use crate::table::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
use crate::table::bilinear;
use crate::table::grid::Grid;

/// (A, B) at the texels of a table over n·v and roughness, not stored and without a claim.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The axis of n·v, along a row.
    pub x: Axis,
    /// The axis of roughness.
    pub y: Axis,
    /// Row by row.
    pub values: Vec<ScaleBias>,
}

impl Samples {
    /// The values that a renderer reads at n·v and the parameter of the other axis.
    pub fn bilinear(&self, mu: f64, row: f64) -> ScaleBias {
        let place = bilinear(&self.x, &self.y, mu, row);
        let value = |i: usize, j: usize| self.values[j * self.x.size() + i];
        ScaleBias { a: place.read(|i, j| value(i, j).a), b: place.read(|i, j| value(i, j).b) }
    }
}

/// Nodes of an integral over √(n·v). Between them it errs by 3e-7 at most for the lobes and
/// roughnesses of previews, near n·v = 0, where it bends like n·v/α times a logarithm. A picture
/// shows that a hundredfold at most: a fifth of half a step of 8 bits where sRGB is steepest, 12.92
/// steps to one of light, 1 / (2 · 255 · 12.92) = 1.5e-4. Before the last node the rule itself
/// jumps by 2e-6, a fifth of its bound, as it drops the cut circles at n·v = 1.
const NODES: usize = 4097;

/// Values at the nodes of an axis of n·v.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    axis: Axis,
    values: Vec<ScaleBias>,
}

impl Curve {
    /// The values that a renderer reads from a table along one roughness.
    pub fn of_table(table: &Samples, roughness: f64) -> Self {
        let read = |i: usize| table.bilinear(table.x.value(i), roughness);
        Curve { axis: table.x, values: (0..table.x.size()).map(read).collect() }
    }

    /// The integral by a rule.
    pub fn of_integral(lobe: Microfacet, alpha: f64, rule: &Rule) -> Result<Self> {
        let spec = AxisSpec {
            mapping: Mapping::Sqrt,
            nodes: Nodes::Edges,
            ..AxisSpec::of(Parameter::Nov)
        };
        let axis = Axis::new(spec, NODES)?;
        let grid = Grid::of(axis.values(), vec![alpha]);
        Ok(Curve { axis, values: cpu::bake(lobe, &grid, rule, &|_| ()).scale_bias() })
    }

    /// (A, B) at n·v = `mu`.
    pub fn at(&self, mu: f64) -> ScaleBias {
        let (i, next, share) = self.axis.neighbours(mu);
        let (low, high) = (self.values[i], self.values[next]);
        ScaleBias { a: low.a + share * (high.a - low.a), b: low.b + share * (high.b - low.b) }
    }
}
