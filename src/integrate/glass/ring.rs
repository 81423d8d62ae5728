//! A ring of half vectors of one slope: cosines that vanish on it, and integrals over its azimuths.

use super::nodes::ExitNodes;
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::Node;

/// The half vectors of one slope: c = middle + swing cos φ.
#[derive(Clone, Copy)]
pub(super) struct Ring<R> {
    pub(super) secant: R,
    pub(super) middle: R,
    pub(super) swing: R,
    /// 1 - cos θ_h
    pub(super) versine: R,
}

/// A place on a ring: 1/(1+t²), C and t².
#[derive(Clone, Copy)]
pub(super) struct Azimuth<R> {
    pub(super) share: R,
    pub(super) cos_half: R,
    pub(super) t2: R,
}

/// A cosine of a ring that vanishes at C² = `square`: `scale` (C² - `square`).
#[derive(Clone, Copy)]
pub(super) struct Zero<R> {
    pub(super) scale: R,
    pub(super) square: R,
    pub(super) cos_half: R,
    pub(super) t2: R,
}

/// Nothing on a ring is as narrow: it keeps 0/0 away where all half vectors have one c.
pub(super) const SMALLEST_SWING: f64 = 1e-30;

impl<R: Real> Zero<R> {
    #[inline(always)]
    pub(super) fn new(scale: R, square: R) -> Self {
        let (zero, one) = (R::from(0.0), R::from(1.0));
        let cos_half = square.max(zero).min(one).sqrt();
        Zero { scale, square, cos_half, t2: cos_half.complement() / (cos_half + 1.0) }
    }

    /// The cosine at an azimuth whose t² is `rest` below that of the zero.
    #[inline(always)]
    pub(super) fn at(&self, azimuth: Azimuth<R>, rest: R) -> R {
        let Azimuth { share, cos_half, .. } = azimuth;
        let difference = rest * 2.0 * share / (self.t2 + 1.0);
        let between = difference * (cos_half + self.cos_half);
        let all_around = cos_half * cos_half - self.square;
        self.scale * R::from(0.0).select_below(self.square, between, all_around)
    }
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
        let azimuth = Azimuth::new(t2 * u2);
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
        let azimuth = Azimuth::new(t * t);
        sum = sum + azimuth.share * weight * part(azimuth);
    }
    zero.select_below(length2, sum * length * 8.0, zero)
}

impl<R: Real> Azimuth<R> {
    #[inline(always)]
    fn new(t2: R) -> Self {
        let share = (t2 + 1.0).recip();
        Azimuth { share, cos_half: t2.complement() * share, t2 }
    }
}
