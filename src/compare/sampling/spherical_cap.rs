//! Half vectors that v sees, as the sum of v and of a direction drawn evenly from a cap of the
//! sphere.
//!
//! Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023.

use super::visible::visible_factor;
use super::{Sample, View};
use crate::compare::point_set::Point;
use crate::numeric::lanes::Real;

/// pdf = D G1(v) / (4 n·v).
#[inline(always)]
pub fn spherical_cap_sample<R: Real>(view: &View<R>, point: &Point) -> Sample<R> {
    cap_sample(view, point, view.stretched.1, visible_factor(view))
}

/// A sample from the cap of heights above -`bound`.
///
/// The height is z = (1-v)(1+b) - b; 1-z and 1+z are written as sums of positive terms.
#[inline(always)]
pub fn cap_sample<R: Real>(view: &View<R>, point: &Point, bound: R, factor: R) -> Sample<R> {
    let (vx, vz) = view.stretched;
    let below = (bound + 1.0) * point.v;
    let above = (bound + 1.0) * (1.0 - point.v) + bound.complement();
    let sine2 = below * above;
    let y2 = sine2 * point.sine2;
    let x = sine2.sqrt() * point.cosine + vx;
    let z = (below.complement() + vz).max(R::from(0.0));
    view.reflect_stretched((x, y2, z), factor)
}
