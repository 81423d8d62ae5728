//! Point sets of the unit square: where an estimator samples.

use crate::choice::choice;
use crate::numeric::quadrature::gauss_legendre::{Node, gauss_legendre};
use std::f64::consts::TAU;

/// A point (u, v), of which u turns the azimuth φ = 2πu, so that its cosine is all that is needed
/// of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// cos 2πu
    pub cosine: f64,
    /// sin² 2πu
    pub sine2: f64,
    /// v in [0, 1).
    pub v: f64,
    /// √v
    pub root: f64,
    /// Its weight; the weights of all points add up to 1.
    pub weight: f64,
}

/// A set of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointSet {
    /// (i/N, the binary digits of i mirrored) (Hammersley 1960; Wong, Luk and Heng 1997): what
    /// bakers use.
    Hammersley,
    /// The first two dimensions of Sobol's sequence (1967) with its digits scrambled as Owen does
    /// (1995).
    Sobol,
    /// Multiples of the inverse of the plastic number and of its square (Roberts 2018).
    R2,
    /// Gauss-Legendre in v, the trapezoid rule in u, of which half the circle is enough: √N × √N
    /// points.
    GaussTrapezoid,
}

choice!(PointSet, "point set", {
    Hammersley = "hammersley", "Hammersley 1960";
    Sobol = "sobol", "Sobol 1967, scrambled (Owen 1995)";
    R2 = "r2", "Roberts 2018";
    GaussTrapezoid = "gauss-trapezoid", "Gauss-Legendre by the trapezoid rule";
});

impl PointSet {
    /// `count` points, for [`PointSet::GaussTrapezoid`] the next square below; `seed` is that of
    /// the scrambling.
    pub fn points(self, count: usize, seed: u64) -> Vec<Point> {
        if self == PointSet::GaussTrapezoid {
            let side = count.isqrt();
            let u = |j: usize| (j as f64 + 0.5) / (2.0 * side as f64);
            let row = |node: Node| {
                (0..side).map(move |j| Point::new((u(j), node.at), node.weight / side as f64))
            };
            return gauss_legendre(side).into_iter().flat_map(row).collect();
        }
        let point = |i| Point::new(self.coordinates(i, count, seed), 1.0 / count as f64);
        (0..count).map(point).collect()
    }

    /// (u, v) of point `i` of `count` of the sets without weights.
    pub fn coordinates(self, i: usize, count: usize, seed: u64) -> (f64, f64) {
        match self {
            PointSet::Sobol => (
                fraction(scrambled((i as u32).reverse_bits(), seed)),
                fraction(scrambled(sobol(i as u32), seed.wrapping_add(1))),
            ),
            PointSet::R2 => {
                // The real root of p³ = p + 1.
                const PLASTIC: f64 = 1.324_717_957_244_746;
                let at = |step: f64| (0.5 + step * i as f64).fract();
                (at(1.0 / PLASTIC), at(1.0 / (PLASTIC * PLASTIC)))
            }
            _ => (i as f64 / count as f64, fraction((i as u32).reverse_bits())),
        }
    }
}

impl Point {
    /// The point (u, v).
    pub fn new((u, v): (f64, f64), weight: f64) -> Self {
        let cosine = libm::cos(TAU * u);
        Point { cosine, sine2: (1.0 - cosine) * (1.0 + cosine), v, root: v.sqrt(), weight }
    }
}

/// The digits behind the binary point as a number in [0, 1).
fn fraction(digits: u32) -> f64 {
    f64::from(digits) / 4_294_967_296.0
}

/// The second dimension of Sobol's sequence: its direction numbers are the rows of Pascal's
/// triangle modulo 2.
fn sobol(mut i: u32) -> u32 {
    let (mut direction, mut digits) = (1 << 31, 0);
    while i != 0 {
        digits ^= if i & 1 == 1 { direction } else { 0 };
        direction ^= direction >> 1;
        i >>= 1;
    }
    digits
}

/// Owen's nested scrambling: every digit is flipped or not by a coin that belongs to the digits
/// before it.
fn scrambled(digits: u32, seed: u64) -> u32 {
    (0..32).fold(digits, |scrambled, place| {
        let before = (u64::from(digits) >> (31 - place)) >> 1;
        let coin = mix(seed ^ mix(before << 6 | place)) >> 63;
        scrambled ^ (coin as u32) << (31 - place)
    })
}

/// A number whose bits all depend on all bits of `x` (the finaliser of SplitMix64; Steele, Lea and
/// Flood 2014).
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}
