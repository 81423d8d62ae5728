//! Integrals of one roughness over n·v: linear between the nodes of an axis, clamped at its ends.

use crate::backend::cpu;
use crate::error::Result;
use crate::integrate::Integrand;
use crate::integrate::field::Field;
use crate::integrate::rule::Rule;
use crate::table::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
use crate::table::bilinear;
use crate::table::grid::Grid;
use rayon::prelude::*;
use std::array::from_fn;

/// N values at each texel of a table over n·v and roughness, not stored and without a claim.
#[derive(Clone, Debug)]
pub struct Samples<const N: usize> {
    /// The axis of n·v, along a row.
    pub x: Axis,
    /// The axis of roughness.
    pub y: Axis,
    /// Row by row.
    pub values: Vec<[f64; N]>,
}

impl<const N: usize> Samples<N> {
    /// The values that a renderer reads at n·v and the parameter of the other axis.
    pub fn bilinear(&self, mu: f64, row: f64) -> [f64; N] {
        let place = bilinear(&self.x, &self.y, mu, row);
        from_fn(|k| place.read(|i, j| self.values[j * self.x.size() + i][k]))
    }
}

/// The points of a field of N integrals.
pub fn points<const N: usize>(field: &Field) -> Vec<[f64; N]> {
    field.values().as_chunks().0.to_vec()
}

/// Nodes of an integral over √(n·v). Between them it errs by 3e-7 at most for the lobes and
/// roughnesses of previews, near n·v = 0, where it bends like n·v/α times a logarithm. A picture
/// shows that a hundredfold at most: a fifth of half a step of 8 bits where sRGB is steepest, 12.92
/// steps to one of light, 1 / (2 · 255 · 12.92) = 1.5e-4. Before the last node the rule itself
/// jumps by 2e-6, a fifth of its bound, as it drops the cut circles at n·v = 1.
pub const NODES: usize = 4097;

/// N values at the nodes of an axis of n·v.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<const N: usize> {
    axis: Axis,
    values: Vec<[f64; N]>,
}

impl<const N: usize> Curve<N> {
    /// The values that a renderer reads from a table along one roughness.
    pub fn of_table(table: &Samples<N>, roughness: f64) -> Self {
        let read = |i: usize| table.bilinear(table.x.value(i), roughness);
        Curve { axis: table.x, values: (0..table.x.size()).map(read).collect() }
    }

    /// The N integrals of an integrand by a rule.
    pub fn of_integral(of: impl Into<Integrand>, alpha: f64, rule: &Rule) -> Result<Self> {
        let axis = roots(NODES)?;
        let grid = Grid::of(axis.values(), vec![alpha]);
        Ok(Curve { axis, values: points(&cpu::bake(of, &grid, rule, &|_| ())) })
    }

    /// Any N values, at so many nodes evenly over √(n·v).
    pub fn of(nodes: usize, values: impl Fn(f64) -> [f64; N] + Send + Sync) -> Result<Self> {
        let axis = roots(nodes)?;
        Ok(Curve { axis, values: axis.values().into_par_iter().map(values).collect() })
    }

    /// The values at n·v = `mu`.
    pub fn at(&self, mu: f64) -> [f64; N] {
        let (i, next, share) = self.axis.neighbours(mu);
        let (low, high) = (self.values[i], self.values[next]);
        from_fn(|k| low[k] + share * (high[k] - low[k]))
    }
}

/// Nodes evenly over √(n·v), both ends included.
fn roots(nodes: usize) -> Result<Axis> {
    let spec =
        AxisSpec { mapping: Mapping::Sqrt, nodes: Nodes::Edges, ..AxisSpec::of(Parameter::Nov) };
    Axis::new(spec, nodes)
}
