//! The truth that approximations are fitted to: an interpolant between a few thousand integrals,
//! and integrals themselves where a lobe is smoother than it covers.

use super::tolerance::Tolerance;
use crate::approximation::{Along, Region};
use crate::backend::cpu::{Baker, bake_points};
use crate::brdf::Microfacet;
use crate::brdf::fresnel::{Schlick, schlick_weight};
use crate::integrate::ScaleBias;
use crate::integrate::interpolant::norms::Norms;
use crate::integrate::interpolant::{Interpolant, InterpolantRule};
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::{B5920, D10240, L4608, P1024, R1776, REFERENCE, S2304};
use crate::numeric::lanes::{F64x8, Work, vectorised};
use crate::units::alpha_of;
use rayon::prelude::*;
use std::sync::OnceLock;

/// E and R at a point: the albedo at F0 = 1, and what B has beyond (1 - n·v)⁵ E.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Albedo {
    /// The albedo at F0 = 1.
    pub e: f64,
    /// B of E(F0) = F0 A + B.
    pub b: f64,
}

impl Albedo {
    /// Of A and B.
    #[inline(always)]
    fn of([a, b]: [f64; 2]) -> Self {
        Albedo { e: a + b, b }
    }

    /// E(F0).
    pub fn at(self, f0: f64) -> f64 {
        self.b + f0 * (self.e - self.b)
    }

    /// A and B.
    pub fn scale_bias(self) -> [f64; 2] {
        [self.e - self.b, self.b]
    }
}

/// The integrals of a lobe, quickly.
#[derive(Debug)]
pub struct Truth {
    lobe: Microfacet,
    rule: InterpolantRule,
    interpolant: Interpolant<2>,
    norms: OnceLock<[Norms; 2]>,
    /// For what the interpolant does not cover.
    fine: Baker,
    /// The error that the interpolant's rule promises; 0 of lobes that it is not made for.
    promised: f64,
}

/// Places along n·v and across roughness where the interpolant is compared with integrals.
const PLACES: [usize; 2] = [24, 12];

/// Integrals by the reference rule at a time.
const AT_A_TIME: usize = 256;

/// The rule by which a lobe is integrated, one by one.
fn fine_rule(lobe: Microfacet) -> &'static Rule {
    let as_sharp = |rule: &&Rule| rule.applies_to(lobe) && rule.bound(lobe) <= D10240.bound(lobe);
    [&L4608, &P1024, &R1776, &B5920].into_iter().find(as_sharp).unwrap_or(&D10240)
}

impl Truth {
    /// Works out the interpolant of a lobe.
    pub fn new(lobe: Microfacet) -> Self {
        let Method::Interpolant(rule) = S2304.method else { unreachable!("S2304 interpolates") };
        let integrate = |points: Vec<(f64, f64)>| bake_points(lobe, &points, fine_rule(lobe));
        let integrals: Vec<_> = rule.points(lobe).into_iter().map(integrate).collect();
        let interpolant = rule.fit(lobe, Schlick, &integrals);
        let promised = if S2304.applies_to(lobe) { S2304.bound(lobe) } else { 0.0 };
        let (norms, fine) = (OnceLock::new(), Baker::new(lobe, fine_rule(lobe)));
        Truth { lobe, rule, interpolant, norms, fine, promised }
    }

    /// The lobe.
    pub fn lobe(&self) -> Microfacet {
        self.lobe
    }

    /// How large the interpolant's E and R and their derivatives are.
    pub fn norms(&self) -> &[Norms; 2] {
        self.norms.get_or_init(|| self.interpolant.norms())
    }

    /// E and B at these n·v of each perceptual roughness, one after the other.
    pub fn rows(&self, rows: &[(f64, Vec<f64>)]) -> Vec<Albedo> {
        rows.par_iter().flat_map_iter(|(roughness, novs)| self.row(*roughness, novs)).collect()
    }

    /// E and B at these n·v of one roughness.
    pub fn row(&self, roughness: f64, novs: &[f64]) -> Vec<Albedo> {
        let alpha = alpha_of(roughness);
        if alpha == 0.0 {
            let mirror = |&nov: &f64| {
                let e = self.lobe.smooth_limit(nov);
                Albedo { e, b: schlick_weight(nov) * e }
            };
            return novs.iter().map(mirror).collect();
        }
        if !self.rule.covers(alpha) {
            let points: Vec<(f64, f64)> = novs.iter().map(|&nov| (nov, alpha)).collect();
            let field = self.fine.bake_points(&points);
            return field.scale_bias().iter().map(|value| Albedo::of(value.array())).collect();
        }
        let mut albedos = Vec::with_capacity(novs.len());
        let interpolant = &self.interpolant;
        vectorised(Interpolated { interpolant, alpha, novs, albedos: &mut albedos });
        albedos
    }

    /// E and B at these (n·v, perceptual roughness).
    pub fn at(&self, places: &[(f64, f64)]) -> Vec<Albedo> {
        // A row of one roughness costs as much as dozens of its points.
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by(|&a, &b| places[a].1.total_cmp(&places[b].1));
        let mut albedos = vec![Albedo::default(); places.len()];
        for row in order.chunk_by(|&a, &b| places[a].1 == places[b].1) {
            let novs: Vec<f64> = row.iter().map(|&index| places[index].0).collect();
            let values = self.row(places[row[0]].1, &novs);
            row.iter().zip(values).for_each(|(&index, value)| albedos[index] = value);
        }
        albedos
    }

    /// The largest error of the interpolant over the tolerance in a region: as its rule promises
    /// for the lobes that it is made for, of others as found at points along the layer.
    pub fn error(&self, region: &Region, f0: [f64; 2], tolerance: Tolerance) -> f64 {
        let [low, high] = region.roughness;
        let place = |index: usize| {
            let (i, j) = (index % PLACES[0], index / PLACES[0]);
            let share = |k: usize, count: usize| (k as f64 + 0.5) / count as f64;
            let across = share(j, PLACES[1]);
            let roughness = low + (high - low) * across * across;
            let along = share(i, PLACES[0]);
            (Along::Layer(3.0).inverse(region.least_nov, along, roughness), roughness)
        };
        let places: Vec<(f64, f64)> = (0..PLACES[0] * PLACES[1]).map(place).collect();
        let points: Vec<(f64, f64)> =
            places.iter().map(|&(nov, roughness)| (nov, alpha_of(roughness))).collect();
        let fine = self.fine.bake_points(&points).scale_bias();
        let share = |(own, fine): (Albedo, &ScaleBias)| {
            let of = |f0: f64| (own.at(f0) - fine.at_f0(f0)).abs() / tolerance.at(fine.at_f0(f0));
            of(f0[0]).max(of(f0[1]))
        };
        let found = self.at(&places).into_iter().zip(&fine).map(share).fold(0.0, f64::max);
        found.max(self.promised / tolerance.at(1.0))
    }

    /// The same by the reference rule, integral by integral.
    pub fn by_reference(lobe: Microfacet, places: &[(f64, f64)]) -> Vec<Albedo> {
        let of_some = |places: &[(f64, f64)]| -> Vec<Albedo> {
            let points: Vec<(f64, f64)> =
                places.iter().map(|&(nov, roughness)| (nov, alpha_of(roughness))).collect();
            let field = bake_points(lobe, &points, &REFERENCE);
            field.scale_bias().iter().map(|value| Albedo { e: value.e(), b: value.b }).collect()
        };
        places.par_chunks(AT_A_TIME).flat_map_iter(of_some).collect()
    }
}

/// Values of an interpolant at these n·v.
struct Interpolated<'a> {
    interpolant: &'a Interpolant<2>,
    alpha: f64,
    novs: &'a [f64],
    albedos: &'a mut Vec<Albedo>,
}

impl Work for Interpolated<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let row = self.interpolant.row(self.alpha);
        for chunk in self.novs.chunks(16) {
            let lanes = |half: usize| {
                F64x8(std::array::from_fn(|i| chunk[(8 * half + i).min(chunk.len() - 1)]))
            };
            let [first, second] = row.at(Schlick, [lanes(0), lanes(1)]);
            let value = |i: usize| {
                let half = if i < 8 { &first } else { &second };
                Albedo::of([half.0[0].0[i % 8], half.0[1].0[i % 8]])
            };
            self.albedos.extend((0..chunk.len()).map(value));
        }
    }
}
