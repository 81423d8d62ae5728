//! The spherical cap without its lowest part, from which every direction is reflected below the
//! horizon.
//!
//! Eto and Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections", SIGGRAPH Asia 2023
//! Technical Communications.

use super::spherical_cap::cap_sample;
use super::{Sample, View};
use crate::compare::point_set::Point;
use crate::numeric::lanes::Real;

/// pdf = D / (2 (k n·v + √(α² sin² θ_v + cos² θ_v))).
#[inline(always)]
pub fn bounded_visible_sample<R: Real>(view: &View<R>, point: &Point) -> Sample<R> {
    let k = bound(view);
    cap_sample(view, point, k * view.stretched.1, (k * view.mu + view.visible) * 2.0)
}

/// k = (1-α²) s² / (s² + α² cos² θ_v), s = 1 + sin θ_v (equation 5).
#[inline(always)]
pub fn bound<R: Real>(view: &View<R>) -> R {
    let s = view.sv + 1.0;
    let ratio = view.alpha * view.mu / s;
    view.alpha.complement() * (view.alpha + 1.0) / (ratio * ratio + 1.0)
}
