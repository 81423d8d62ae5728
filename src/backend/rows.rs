//! The CPU in whatever arithmetic, f64 or f32, by rules and by estimators alike: for comparing methods. Lanes are texels of a row.

use crate::integrate::ScaleBias;
use crate::integrate::rule::Integrator;
use crate::lanes::{Vector, vectorised};
use crate::lut::Grid;
use crate::model::Microfacet;
use crate::quadrature::point_set::Point;
use crate::sampling::{HalfVector, Sampler, View, estimate, half_vectors};
use rayon::prelude::*;
use std::marker::PhantomData;

/// How a texel is computed.
#[derive(Clone, Copy, Debug)]
pub enum Work<'a> {
    /// By quadrature.
    Rule(&'a Integrator),
    /// By a sampler, over these points.
    Samples(Sampler, &'a [Point]),
}

/// (A, B) at every point of the grid, in its order.
pub fn bake_in<V: Vector>(lobe: Microfacet, grid: &Grid, work: Work) -> Vec<ScaleBias> {
    let mut integrals = vec![ScaleBias::default(); grid.len()];
    integrals.par_chunks_mut(grid.mus.len()).zip(&grid.alphas).for_each(|(texels, &alpha)| {
        if alpha == 0.0 {
            let mirror = |(texel, &mu): (&mut ScaleBias, &f64)| *texel = ScaleBias::mirror(mu, lobe.smooth_limit(mu));
            return texels.iter_mut().zip(&grid.mus).for_each(mirror);
        }
        // What all texels of a row share.
        let halves = match work {
            Work::Samples(Sampler::HalfVector, points) => half_vectors(lobe.ndf, alpha, points),
            _ => Vec::new(),
        };
        vectorised(Row::<V> { lobe, work, halves: &halves, alpha, mus: &grid.mus, texels, lanes: PhantomData });
    });
    integrals
}

struct Row<'a, V> {
    lobe: Microfacet,
    work: Work<'a>,
    halves: &'a [HalfVector],
    alpha: f64,
    mus: &'a [f64],
    texels: &'a mut [ScaleBias],
    lanes: PhantomData<V>,
}

impl<V: Vector> pulp::NullaryFnOnce for Row<'_, V> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Row { lobe, work, halves, alpha, mus, texels, .. } = self;
        let alpha = V::from(alpha);
        for (mus, texels) in mus.chunks(V::LANES).zip(texels.chunks_mut(V::LANES)) {
            // A group that is not full repeats its last texel.
            let mu = V::gather(|i| mus[i.min(mus.len() - 1)]);
            let ScaleBias { a, b } = match work {
                Work::Rule(integrator) => integrator.quadrature(lobe, mu, alpha),
                Work::Samples(sampler, points) => estimate(sampler, &View::seen_from(lobe, mu, alpha), points, halves),
            };
            for (i, texel) in texels.iter_mut().enumerate() {
                *texel = ScaleBias { a: a.lane(i), b: b.lane(i) };
            }
        }
    }
}
