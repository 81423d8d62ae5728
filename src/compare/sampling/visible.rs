//! Half vectors that v sees, drawn on the projected area of a hemisphere.
//!
//! Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018.

use super::{Sample, View};
use crate::compare::point_set::Point;
use crate::numeric::lanes::Real;

/// pdf = D G1(v) / (4 n·v).
#[inline(always)]
pub fn visible_sample<R: Real>(view: &View<R>, point: &Point) -> Sample<R> {
    let (vx, vz) = view.stretched;
    // The disc, its half nearer to v squeezed to what is seen of it (section 4.2).
    let t1_squared = point.v * point.sine2;
    let s = (vz + 1.0) * 0.5;
    let t2 = s.complement() * (1.0 - t1_squared).sqrt() + s * (point.root * point.cosine);
    let t3 = (R::from(1.0 - t1_squared) - t2 * t2).max(R::from(0.0)).sqrt();
    // Back to the frame of the normal (section 4.3).
    let z = (vx * t2 + vz * t3).max(R::from(0.0));
    view.reflect_stretched((vx * t3 - vz * t2, R::from(t1_squared), z), visible_factor(view))
}

/// f n·l / (F pdf) over n·l V: 4 n·v / G1(v).
#[inline(always)]
pub fn visible_factor<R: Real>(view: &View<R>) -> R {
    (view.mu + view.visible) * 2.0
}
