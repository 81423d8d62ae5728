//! A ring of half vectors of one slope: cosines that vanish on it, and integrals over its azimuths.

use super::nodes::ExitNodes;
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::Node;

/// The half vectors of one slope: c = middle + swing cos φ.
#[derive(Clone, Copy)]
pub struct Ring<R> {
    /// 1/cos θ_h
    pub secant: R,
    /// The mean of c.
    pub middle: R,
    /// Its amplitude.
    pub swing: R,
    /// 1 - cos θ_h
    pub versine: R,
}

/// A place on a ring.
#[derive(Clone, Copy)]
pub struct Azimuth<R> {
    /// 1/(1+t²)
    pub share: R,
    /// C
    pub cos_half: R,
    /// t²
    pub t2: R,
}

/// A cosine of a ring that vanishes at C² = `square`: `scale` (C² - `square`).
#[derive(Clone, Copy)]
pub struct Zero<R> {
    /// The factor.
    pub scale: R,
    /// C² where it vanishes; below 0 or above 1 where it does so nowhere.
    pub square: R,
    /// C there.
    pub cos_half: R,
    /// t² there.
    pub t2: R,
    /// 2 `scale`/(1 + t²) there.
    pub slope: R,
}

/// Nothing on a ring is as narrow: it keeps 0/0 away where all half vectors have one c.
pub const SMALLEST_SWING: f64 = 1e-30;

/// The cosine `scale` (C² - `square`).
#[inline(always)]
pub fn zero_at<R: Real>(scale: R, square: R) -> Zero<R> {
    let (zero, one) = (R::from(0.0), R::from(1.0));
    let cos_half = square.max(zero).min(one).sqrt();
    let t2 = cos_half.complement() / (cos_half + 1.0);
    Zero { scale, square, cos_half, t2, slope: scale * 2.0 / (t2 + 1.0) }
}

/// The place at tan²(φ/4) = `t2`.
#[inline(always)]
pub fn azimuth_at<R: Real>(t2: R) -> Azimuth<R> {
    let share = (t2 + 1.0).recip();
    Azimuth { share, cos_half: t2.complement() * share, t2 }
}

/// The cosine at an azimuth whose t² is `rest` below that of the zero.
#[inline(always)]
pub fn cosine_at<R: Real>(zero: Zero<R>, azimuth: Azimuth<R>, rest: R) -> R {
    let Azimuth { share, cos_half, .. } = azimuth;
    let between = zero.slope * (rest * share) * (cos_half + zero.cos_half);
    let all_around = zero.scale * (cos_half * cos_half - zero.square);
    R::from(0.0).select_below(zero.square, between, all_around)
}

/// The integral over the azimuths up to t² = `t2`, of either side of the plane; `part` is given how
/// far t² is below.
#[inline(always)]
pub(super) fn interval<R: Real>(t2: R, nodes: &[Node], part: impl Fn(Azimuth<R>, R) -> R) -> R {
    let mut sum = R::from(0.0);
    if !t2.any(|t2| t2 > 0.0) {
        return sum;
    }
    for node in nodes {
        let u2 = node.at * node.at;
        let azimuth = azimuth_at(t2 * u2);
        sum = sum + azimuth.share * node.weight * part(azimuth, t2 * (1.0 - u2));
    }
    sum * t2.sqrt() * 8.0
}

/// The same with the nodes for a root at the end where `root` is above 0, else with the others.
#[inline(always)]
pub(super) fn either<R: Real>(
    root: R,
    t2: R,
    with_root: &[Node],
    without: &[Node],
    part: impl Fn(Azimuth<R>, R) -> R + Copy,
) -> R {
    let zero = R::from(0.0);
    let mut sum = zero;
    if root.any(|root| root > 0.0) {
        sum = zero.select_below(root, interval(t2, with_root, part), zero);
    }
    if root.any(|root| root <= 0.0) {
        sum = zero.select_below(root, sum, interval(t2, without, part));
    }
    sum
}

/// The integral over the azimuths from t² = `from` to `to`.
#[inline(always)]
pub(super) fn beyond<R: Real>(
    from: R,
    to: R,
    nodes: &ExitNodes,
    part: impl Fn(Azimuth<R>) -> R,
) -> R {
    let zero = R::from(0.0);
    let length2 = to - from;
    if !length2.any(|length| length > 0.0) {
        return zero;
    }
    // The whole interval is symmetric about its start.
    let (start, end) = (from.max(zero).sqrt(), to.max(zero).sqrt());
    let length = length2 / (start + end).max(R::from(SMALLEST_SWING));
    let mut sum = zero;
    for (node, even) in nodes.total.iter().zip(&nodes.total_even) {
        let at = zero.select_below(from, R::from(node.at), R::from(even.at));
        let weight = zero.select_below(from, R::from(node.weight), R::from(even.weight));
        let t = start + length * at;
        let azimuth = azimuth_at(t * t);
        sum = sum + azimuth.share * weight * part(azimuth);
    }
    zero.select_below(length2, sum * length * 8.0, zero)
}
