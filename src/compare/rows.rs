//! The CPU in f32 or f64, by rules and by estimators alike: for comparing methods. Lanes are texels
//! of a row.

use super::analytic_fit::AnalyticFit;
use super::point_set::Point;
use super::sampling::{HalfVector, Sampler, View, estimate, sampled_half_vectors};
use crate::brdf::Microfacet;
use crate::brdf::fresnel::Schlick;
use crate::choice::Choice;
use crate::integrate::{Kernel, ScaleBias, mirror};
use crate::numeric::lanes::{self, Real, Vector, vectorised};
use crate::table::grid::Grid;
use rayon::prelude::*;

/// The method of a texel.
#[derive(Clone, Copy, Debug)]
pub enum Work<'a> {
    /// A sampler, over these points.
    Samples(Sampler, &'a [Point]),
    /// A closed form fitted to the integral.
    Fit(AnalyticFit),
}

/// (A, B) at every point of the grid, in its order.
pub fn bake_in<V: Vector>(lobe: Microfacet, grid: &Grid, work: Work) -> Vec<ScaleBias> {
    match work {
        Work::Samples(sampler, points) => {
            macro_rules! by {
                ($sampler:ident) => {
                    rows::<V, _>(lobe, grid, &Samples::<{ Sampler::$sampler as usize }>(points))
                };
            }
            match sampler {
                Sampler::Uniform => by!(Uniform),
                Sampler::Cosine => by!(Cosine),
                Sampler::HalfVector => by!(HalfVector),
                Sampler::Visible => by!(Visible),
                Sampler::SphericalCap => by!(SphericalCap),
                Sampler::BoundedVisible => by!(BoundedVisible),
            }
        }
        Work::Fit(fit) => rows::<V, _>(lobe, grid, &fit),
    }
}

/// A method by its type, so that the loop over a row is compiled for it alone: together they are
/// too large to be optimised.
pub trait Method: Sync {
    /// The half vectors that all texels of a row share.
    fn share(&self, _: Microfacet, _: f64) -> Vec<HalfVector> {
        Vec::new()
    }

    /// (A, B) at a texel, or at as many as there are lanes.
    fn texel<R: Real>(
        &self,
        shared: &[HalfVector],
        lobe: Microfacet,
        mu: R,
        alpha: R,
    ) -> ScaleBias<R>;
}

impl<K: Kernel> Method for K {
    #[inline(always)]
    fn texel<R: Real>(&self, _: &[HalfVector], lobe: Microfacet, mu: R, alpha: R) -> ScaleBias<R> {
        self.integrate(lobe, Schlick, mu, alpha).0.into()
    }
}

impl Method for AnalyticFit {
    #[inline(always)]
    fn texel<R: Real>(&self, _: &[HalfVector], _: Microfacet, mu: R, alpha: R) -> ScaleBias<R> {
        self.evaluate(mu, alpha)
    }
}

/// The sampler of this place in [`Sampler::ALL`], and its points.
struct Samples<'a, const SAMPLER: usize>(&'a [Point]);

impl<const SAMPLER: usize> Method for Samples<'_, SAMPLER> {
    fn share(&self, lobe: Microfacet, alpha: f64) -> Vec<HalfVector> {
        match Sampler::ALL[SAMPLER] {
            Sampler::HalfVector => sampled_half_vectors(lobe.ndf, alpha, self.0),
            _ => Vec::new(),
        }
    }

    #[inline(always)]
    fn texel<R: Real>(
        &self,
        shared: &[HalfVector],
        lobe: Microfacet,
        mu: R,
        alpha: R,
    ) -> ScaleBias<R> {
        estimate(Sampler::ALL[SAMPLER], &View::seen_from(lobe, mu, alpha), self.0, shared)
    }
}

/// (A, B) at every point of the grid by one method.
pub fn rows<V: Vector, M: Method>(lobe: Microfacet, grid: &Grid, method: &M) -> Vec<ScaleBias> {
    let mut integrals = vec![ScaleBias::default(); grid.len()];
    integrals.par_chunks_mut(grid.mus.len()).zip(&grid.alphas).for_each(|(texels, &alpha)| {
        if alpha == 0.0 {
            for (texel, &mu) in texels.iter_mut().zip(&grid.mus) {
                *texel = mirror(lobe, Schlick, mu).map(|integral| integral.value).into();
            }
            return;
        }
        let shared = &method.share(lobe, alpha);
        for (mus, texels) in grid.mus.chunks(V::LANES).zip(texels.chunks_mut(V::LANES)) {
            // A group that is not full repeats its last texel.
            let mu = V::gather(|i| mus[i.min(mus.len() - 1)]);
            let ScaleBias { a, b } =
                vectorised(Group { lobe, method, shared, mu, alpha: V::from(alpha) });
            for (i, texel) in texels.iter_mut().enumerate() {
                *texel = ScaleBias { a: a.lane(i), b: b.lane(i) };
            }
        }
    });
    integrals
}

/// A group of as many texels as there are lanes.
struct Group<'a, V, M> {
    lobe: Microfacet,
    method: &'a M,
    shared: &'a [HalfVector],
    mu: V,
    alpha: V,
}

impl<V: Vector, M: Method> lanes::Work for Group<'_, V, M> {
    type Output = ScaleBias<V>;

    #[inline(always)]
    fn call(self) -> ScaleBias<V> {
        self.method.texel(self.shared, self.lobe, self.mu, self.alpha)
    }
}
