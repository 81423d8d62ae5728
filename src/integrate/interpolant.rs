//! Integrals over all (n·v, α) by Chebyshev interpolation between those of a rule at a few thousand
//! points. A table of any size costs no more integrals than that, and a texel a few short
//! polynomials.
//!
//! With y = μ/layer, the layer being a multiple of α, or of √α for Charlie, the first variable is
//! s ∝ tanh(asinh(y)/c)^(1/q), 1 at μ = 1: it spreads the layer over many nodes, and its power q,
//! about μ near 0, turns the term μ ln μ of Smith masking into s^q ln s, which a polynomial
//! follows. The second is √r = α^¼, in pieces where one polynomial would be slow: a Gaussian grows
//! where the argument of α exceeds 45 degrees, which bounds how fast it converges by the ratio of
//! a piece's ends.
//!
//! The polynomials follow E, the sum of the first two integrals, or E - E(α → 0), and of every
//! integral but the first the rest beyond a mirror's: B - (1-μ)⁵ E for Schlick's. The rests vanish
//! as α → 0; the integrals themselves change over μ ~ 1, which s does not resolve at small α.

mod chebyshev;
mod follow;
pub mod map;
pub mod nodes;
pub mod norms;

pub use map::{Layer, Map};

use self::chebyshev::{chebyshev_node, clenshaw, transform, transposed};
use self::follow::{Follows, Stretch};
use self::map::Placement;
use super::bent_rings::BentRingRule;
use super::half_vectors::HalfVectorRule;
use super::light_directions::LightDirectionRule;
use super::light_planes::LightPlaneRule;
use super::rings::RingRule;
use super::{Field, Integrals};
use crate::brdf::fresnel::Basis;
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::numeric::lanes::{F64x8, Real, Vector};
use std::array::from_fn;

/// The smallest perceptual roughness of an interpolant: half a texel of a table of 512 rows.
pub const SMOOTHEST: f64 = 1.0 / 1024.0;

const LANES: usize = F64x8::LANES;

/// An interpolant's pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterpolantRule {
    /// The perceptual roughness at which the first begins.
    pub start: f64,
    /// The rule that integrates below, and above α = 1.
    pub below: Source,
    /// By ascending roughness, the last one up to 1.
    pub pieces: &'static [Piece],
    /// The distributions that it was made for.
    pub distributions: &'static [Ndf],
    /// The masking terms that it was made for.
    pub maskings: &'static [Masking],
    /// What is subtracted from E before it is followed.
    pub beyond: Beyond,
}

/// What is subtracted from E before a polynomial follows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Nothing: the polynomials are those of the integrals themselves.
    Nothing,
    /// E(α → 0).
    Limit,
}

/// A piece: its nodes, and the rule that integrates there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The perceptual roughness at which it ends, where the next begins.
    pub end: f64,
    /// Nodes along s; a multiple of the lanes of [`F64x8`]. As many on either side of a break.
    pub directions: usize,
    /// Nodes along √r; even.
    pub roughnesses: usize,
    /// Whether one polynomial spans n·v on either side of a break of the masking term.
    pub apart: bool,
    /// s
    pub map: Map,
    /// The rule that integrates at the nodes.
    pub source: Source,
}

/// The rule of a piece's nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// Over half vectors.
    HalfVectors(HalfVectorRule),
    /// Over directions of light.
    LightDirections(LightDirectionRule),
    /// Over planes of light directions.
    LightPlanes(LightPlaneRule),
    /// About a ring.
    Rings(RingRule),
    /// About a ring, with a bend of the masking term.
    BentRings(BentRingRule),
}

/// Polynomials in s and √r, as Chebyshev coefficients: of E, then of the rests of the other
/// integrals.
#[derive(Clone, Debug)]
pub struct Interpolant<const N: usize> {
    pieces: Vec<Fit<N>>,
}

/// The polynomials of a piece.
#[derive(Clone, Debug)]
struct Fit<const N: usize> {
    follows: Follows,
    piece: Piece,
    /// √r at its ends.
    roots: [f64; 2],
    /// On either side of a break where they are apart: for each power of √r the coefficients in s,
    /// eight powers of s to a group.
    sides: Vec<Vec<Vec<[F64x8; N]>>>,
}

/// The polynomials in s at one α.
#[derive(Clone, Debug)]
pub struct InterpolantRow<const N: usize> {
    follows: Follows,
    alpha: f64,
    place: Placement,
    /// n·v of the break; 0 where there is none.
    between: f64,
    /// What each of the polynomials spans, and its coefficients.
    sides: Vec<(Stretch, Vec<[f64; N]>)>,
}

impl InterpolantRule {
    /// The number of integrals that it takes, of a lobe without a break.
    #[allow(clippy::len_without_is_empty, reason = "a rule always has nodes")]
    pub fn len(&self) -> usize {
        self.pieces.iter().map(|piece| piece.directions * piece.roughnesses).sum()
    }

    /// Evaluations of the integrand, of a lobe without a break.
    pub fn evaluations(&self) -> usize {
        let of = |piece: &Piece| piece.directions * piece.roughnesses * piece.source.evaluations();
        self.pieces.iter().map(of).sum()
    }

    /// The largest number of nodes along s.
    pub fn directions(&self) -> usize {
        self.pieces.iter().map(|piece| piece.directions).max().unwrap_or(0)
    }

    /// Whether an α lies in its domain.
    pub fn covers(&self, alpha: f64) -> bool {
        (self.start * self.start..=1.0).contains(&alpha)
    }

    /// The pieces with the √r at their ends.
    fn pieces(&self) -> impl Iterator<Item = (Piece, [f64; 2])> {
        let ends = self.pieces.iter().map(|piece| piece.end.sqrt());
        let starts = std::iter::once(self.start.sqrt()).chain(ends.clone());
        self.pieces.iter().copied().zip(starts.zip(ends).map(|(start, end)| [start, end]))
    }

    fn follows(&self, lobe: Microfacet, piece: &Piece) -> Follows {
        Follows { lobe, beyond: self.beyond, apart: piece.apart }
    }

    /// The (n·v, α) of the nodes of each piece for a lobe, n·v varying fastest, a side of a break
    /// after the other.
    pub fn points(&self, lobe: Microfacet) -> Vec<Vec<(f64, f64)>> {
        let points = |(piece, roots): (Piece, _)| piece.points(self.follows(lobe, &piece), roots);
        self.pieces().map(points).collect()
    }

    /// The interpolant through these integrals at the rule's points, a field for each piece.
    pub fn fit<const N: usize, B: Basis<N>>(
        &self,
        lobe: Microfacet,
        basis: B,
        integrals: &[Field],
    ) -> Interpolant<N> {
        let fits = self.pieces().zip(integrals).map(|((piece, roots), integrals)| {
            let follows = self.follows(lobe, &piece);
            let sides = piece.fit(follows, basis, &piece.points(follows, roots), integrals);
            Fit { follows, piece, roots, sides }
        });
        Interpolant { pieces: fits.collect() }
    }
}

impl Source {
    /// Evaluations of the integrand for a node.
    pub fn evaluations(&self) -> usize {
        match self {
            Source::HalfVectors(rule) => rule.evaluations(),
            Source::LightDirections(rule) => rule.evaluations(),
            Source::LightPlanes(rule) => rule.evaluations(),
            Source::Rings(rule) => rule.evaluations(),
            Source::BentRings(rule) => rule.evaluations(),
        }
    }
}

impl Piece {
    fn points(&self, follows: Follows, [start, end]: [f64; 2]) -> Vec<(f64, f64)> {
        let alphas = (0..self.roughnesses).map(|j| {
            let root = start + (end - start) * chebyshev_node(j, self.roughnesses);
            root * root * root * root
        });
        let alphas: Vec<f64> = alphas.collect();
        let sides = follows.sides();
        let mut points = Vec::with_capacity(sides * self.directions * self.roughnesses);
        for side in 0..sides {
            for &alpha in &alphas {
                let place = self.map.at(alpha);
                let stretch = follows.stretches(&place, alpha)[side];
                let node = |i| stretch.inverse(&place, chebyshev_node(i, self.directions));
                points.extend((0..self.directions).map(|i| (node(i), alpha)));
            }
        }
        points
    }

    /// The coefficients on each side.
    fn fit<const N: usize, B: Basis<N>>(
        &self,
        follows: Follows,
        basis: B,
        points: &[(f64, f64)],
        integrals: &Field,
    ) -> Vec<Vec<Vec<[F64x8; N]>>> {
        debug_assert_eq!((integrals.len(), integrals.count()), (points.len(), N));
        let followed: Vec<[f64; N]> = integrals
            .iter()
            .zip(points)
            .map(|(integrals, &point)| follows.follow(basis, point, integrals))
            .collect();
        let side = |followed: &[[f64; N]]| {
            let parts: [Vec<f64>; N] =
                from_fn(|k| self.transform(followed.iter().map(|values| values[k]).collect()));
            // Of power k of s and power j of √r, the latter varying fastest.
            let at = |part: &[f64], group: usize, j: usize| {
                F64x8(from_fn(|lane| part[(group * LANES + lane) * self.roughnesses + j]))
            };
            let groups = |j: usize| {
                (0..self.directions / LANES).map(|g| from_fn(|k| at(&parts[k], g, j))).collect()
            };
            (0..self.roughnesses).map(groups).collect()
        };
        followed.chunks(self.directions * self.roughnesses).map(side).collect()
    }

    /// The coefficients in s and √r of values at the points: the transform along √r of the
    /// transform along s.
    fn transform(&self, values: Vec<f64>) -> Vec<f64> {
        let along_s = transform(&values, self.directions);
        transform(&transposed(&along_s, self.directions), self.roughnesses)
    }
}

impl<const N: usize> Interpolant<N> {
    /// The polynomials at one `alpha` in the rule's domain.
    #[inline(always)]
    pub fn row(&self, alpha: f64) -> InterpolantRow<N> {
        let root = alpha.sqrt().sqrt();
        let last = self.pieces.len() - 1;
        let piece = self.pieces[..last].partition_point(|fit| fit.roots[1] < root);
        let Fit { follows, piece, roots: [start, end], sides } = &self.pieces[piece];
        debug_assert!((start - 1e-9..=1.0).contains(&root), "{alpha}");
        let x = F64x8::from(2.0 * (root - start) / (end - start) - 1.0);
        let place = piece.map.at(alpha);
        let stretches = follows.stretches(&place, alpha).into_iter().zip(sides);
        InterpolantRow {
            follows: *follows,
            alpha,
            place,
            between: follows.break_at(alpha).unwrap_or(0.0),
            sides: stretches.map(|(stretch, side)| (stretch, coefficients_at(side, x))).collect(),
        }
    }
}

/// The coefficients in s at the place x of √r between its ends -1 and 1.
#[inline(always)]
fn coefficients_at<const N: usize>(side: &[Vec<[F64x8; N]>], x: F64x8) -> Vec<[f64; N]> {
    let groups = side[0].len();
    let mut coefficients = vec![[0.0; N]; groups * LANES];
    for (pair, coefficients) in coefficients.chunks_mut(2 * LANES).enumerate() {
        let second = (2 * pair + 1).min(groups - 1);
        let of = |row: &Vec<[F64x8; N]>| [row[2 * pair], row[second]];
        let pair = clenshaw(side, [x; 2], of);
        for (coefficients, group) in coefficients.chunks_exact_mut(LANES).zip(&pair) {
            for (i, coefficients) in coefficients.iter_mut().enumerate() {
                for k in 0..N {
                    coefficients[k] = group[k].0[i];
                }
            }
        }
    }
    coefficients
}

impl<const N: usize> InterpolantRow<N> {
    /// The integrals at these n·v.
    #[inline(always)]
    pub fn at<B: Basis<N>, R: Real>(&self, basis: B, mu: [R; 2]) -> [Integrals<N, R>; 2] {
        let s = mu.map(|mu| self.place.of(mu));
        let mut followed = side_at(&self.sides[0], mu, s);
        // On the break itself the term is what it is beyond.
        if let Some(beyond) = self.sides.get(1) {
            let beyond = side_at(beyond, mu, s);
            for i in 0..2 {
                for k in 0..N {
                    followed[i][k] =
                        mu[i].select_below(R::from(self.between), followed[i][k], beyond[i][k]);
                }
            }
        }
        let [first, second] = followed;
        let unfollow = |mu, followed| self.follows.unfollow(basis, mu, self.alpha, followed);
        [unfollow(mu[0], first), unfollow(mu[1], second)]
    }
}

/// The polynomials of one side at these n·v, whose places along s are given.
#[inline(always)]
fn side_at<const N: usize, R: Real>(
    (stretch, coefficients): &(Stretch, Vec<[f64; N]>),
    mu: [R; 2],
    s: [R; 2],
) -> [[R; N]; 2] {
    let x = from_fn(|i| stretch.of(mu[i], s[i]) * 2.0 - 1.0);
    clenshaw(coefficients, x, |c: &[f64; N]| [c.map(R::from); 2])
}
