//! The CPU: f64, every texel on its own, so that threads cannot change a bit of the result.

use super::Progress;
use crate::integrate::rule::Rule;
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::Grid;
use rayon::prelude::*;

/// Texels that a thread takes at a time: some 0.2 ms of work.
const CHUNK: usize = 64;

/// (A, B) at every point of the grid, in its order.
pub fn bake(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, progress: Progress) -> Vec<ScaleBias> {
    let (integrand, integrator) = (integrand.into(), rule.integrator());
    let mut integrals = vec![ScaleBias::default(); grid.len()];
    integrals.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, texels)| {
        for (i, texel) in texels.iter_mut().enumerate() {
            let (mu, alpha) = grid.point(chunk * CHUNK + i);
            *texel = integrator.integrate(integrand, mu, alpha);
        }
        progress(texels.len());
    });
    integrals
}

/// (A, B) at the named points of the grid.
pub fn bake_at(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, indices: &[usize]) -> Vec<ScaleBias> {
    let (integrand, integrator) = (integrand.into(), rule.integrator());
    let integrate = |&index: &usize| {
        let (mu, alpha) = grid.point(index);
        integrator.integrate(integrand, mu, alpha)
    };
    indices.par_iter().map(integrate).collect()
}
