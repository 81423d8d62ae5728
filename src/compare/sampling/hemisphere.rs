//! Directions of light that know nothing of the lobe.

use super::{Sample, View};
use crate::compare::point_set::Point;
use crate::numeric::lanes::Real;
use std::f64::consts::{PI, TAU};

/// pdf = 1/(2π).
#[inline(always)]
pub fn uniform_sample<R: Real>(view: &View<R>, point: &Point) -> Sample<R> {
    let z = 1.0 - point.v;
    direct(view, point, z, (point.v * (1.0 + z)).sqrt(), TAU)
}

/// pdf = n·l/π.
#[inline(always)]
pub fn cosine_sample<R: Real>(view: &View<R>, point: &Point) -> Sample<R> {
    let z = (1.0 - point.v).sqrt();
    direct(view, point, z, point.root, PI / z)
}

/// The sample at n·l = `z`, sin θ_l = `sine`.
#[inline(always)]
fn direct<R: Real>(
    view: &View<R>,
    point: &Point,
    z: f64,
    sine: f64,
    inverse_pdf: f64,
) -> Sample<R> {
    let plane = sine * point.cosine;
    // v + l, which is 2 v·h long.
    let (x, y2, vertical) = (view.sv + plane, sine * sine * point.sine2, view.mu + z);
    let horizontal2 = x * x + y2;
    let t = horizontal2 / vertical / vertical;
    let vh = (horizontal2 + vertical * vertical).sqrt() * 0.5;
    let nl = R::from(z);
    let weight = view.distribution(t) * view.cosine_visibility(nl) * inverse_pdf;
    Sample { nl, plane: R::from(plane), vh, weight }
}
