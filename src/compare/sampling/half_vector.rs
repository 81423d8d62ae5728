//! Half vectors by the distribution of normals.

use super::{Sample, View};
use crate::brdf::Ndf;
use crate::compare::point_set::Point;
use crate::numeric::lanes::Real;

/// A half vector, the same for every direction of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfVector {
    x: f64,
    z: f64,
    /// 4/n·h times the point's weight.
    weight: f64,
}

/// tan² θ_h where a share `v` of the distribution D n·h lies below.
///
/// GGX and Beckmann: Walter et al. 2007, equations 35 and 28. Blinn-Phong: cos θ_h =
/// (1-v)^(1/(n+2)) (equation 31), n + 2 = 2/α². Charlie: ∫ D n·h dω up to θ_h is sin(θ_h)^(2 +
/// 1/α), so that sin² θ_h = v^(2α/(2α+1)).
pub fn sampled_slope2(ndf: Ndf, v: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    match ndf {
        Ndf::Ggx => a2 * v / (1.0 - v),
        Ndf::Beckmann | Ndf::BeckmannWalter => -a2 * libm::log1p(-v),
        Ndf::BlinnPhong => libm::expm1(-a2 * libm::log1p(-v)),
        Ndf::Charlie => {
            let power = 2.0 * alpha / (2.0 * alpha + 1.0) * libm::log(v);
            libm::exp(power) / -libm::expm1(power)
        }
    }
}

/// The half vectors that points choose.
pub fn sampled_half_vectors(ndf: Ndf, alpha: f64, points: &[Point]) -> Vec<HalfVector> {
    let half_vector = |point: &Point| {
        let t = sampled_slope2(ndf, point.v, alpha);
        let z = 1.0 / (1.0 + t).sqrt();
        // A ring at the horizon, where Charlie's lies as α → 0, has t = ∞.
        let sine = if t < 1e300 { t.sqrt() * z } else { 1.0 };
        HalfVector { x: sine * point.cosine, z, weight: 4.0 * point.weight / z }
    };
    points.iter().map(half_vector).collect()
}

/// pdf = D n·h / (4 v·h) (Walter et al. 2007, equations 14 and 24).
#[inline(always)]
pub fn half_vector_sample<R: Real>(view: &View<R>, half: &HalfVector) -> Sample<R> {
    let sample = view.reflected(R::from(half.x), R::from(half.z));
    Sample { weight: sample.weight * sample.vh * half.weight, ..sample }
}
