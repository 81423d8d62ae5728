//! Fresnel's equations for unpolarised light at the interface of two dielectrics (Walter et al.
//! 2007, equation 22), in forms that do not cancel.
//!
//! With η the index on the other side over that on the side of v, c = v·h, k = η² - 1, g = √(k +
//! c²), s² = 1 - c²: F = (a² + a² b²)/2, a = (g-c)/(g+c) = k/(g+c)², b = (cg - s²)/(cg + s²), so
//! that
//!
//! F = k² (c²g² + s⁴) / ((g+c)² (cg + s²))², and F = 1 where k + c² ≤ 0 (total reflection);
//!
//! 1 - F = 2cg (1/(g+c)² + η²/(η²c + g)²), a sum of positive terms (Walter et al. 2007, equation
//! 21, has it by subtraction).

use super::{Basis, Definition, Integral};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::{Node, gauss_legendre};
use crate::units::short;

/// Fresnel's equations for light from the thinner side, η = n ≥ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    pub(super) ior: f64,
}

/// The indices of refraction for which the rules' bounds were searched: Cycles' tables end at 99.5.
const INDICES: std::ops::RangeInclusive<f64> = 1.0..=100.0;

impl Dielectric {
    /// The interface to a medium with index of refraction n from 1 to 100.
    pub fn new(ior: f64) -> Result<Self> {
        if INDICES.contains(&ior) {
            return Ok(Dielectric { ior });
        }
        let (expected, cure) = ("1 to 100", "give an index in that range");
        Err(Error::bad_input("index of refraction", expected, short(ior), cure))
    }

    /// n.
    pub const fn ior(self) -> f64 {
        self.ior
    }

    /// k = n² - 1.
    pub fn k(self) -> f64 {
        (self.ior - 1.0) * (self.ior + 1.0)
    }
}

impl Basis<1> for Dielectric {
    const DEFINITION: Definition = Definition {
        word: "dielectric",
        usage: "dielectric:IOR",
        about: "Fresnel's equations for an index of refraction from 1 to 100",
        formula: "Fresnel's equations for unpolarised light, a dielectric with index of refraction \
                  n",
        albedo: "E = R",
        channels: "r",
        smooth_complement: false,
        integrals: &[Integral {
            name: "R",
            meaning: "directional albedo of the interface: E = R",
            relative_error: 1.5,
            absolute_error: 0.0,
        }],
        wgsl: (include_str!("../../../shaders/dielectric.wgsl"), "dielectric_reflectance"),
    };

    fn arguments(self) -> Vec<f64> {
        vec![self.ior]
    }

    fn error_factor(self) -> f64 {
        1.5
    }

    fn has_layer(self) -> bool {
        // F rises within √(n² - 1) of grazing incidence, and falls to 0 and rises within 1/n.
        self.ior < 1.05 || self.ior > 4.0
    }

    fn wgsl_arguments(self) -> String {
        format!(", {:e}", self.k())
    }

    #[inline(always)]
    fn weights<R: Real>(self, vh: R) -> [R; 1] {
        [dielectric_reflectance(vh, R::from(self.k()))]
    }

    fn of_mirror(self, mu: f64) -> [Ball; 1] {
        if self.ior == 1.0 {
            return [Ball::exact(0.0)];
        }
        let (one, n, c) = (Ball::exact(1.0), Ball::exact(self.ior), Ball::exact(mu));
        let k = (n - one) * (n + one);
        let g = (k + c * c).sqrt();
        let s2 = (one - c) * (one + c);
        let a = k / ((g + c) * (g + c) * (c * g + s2));
        [a * a * (c * c * g * g + s2 * s2)]
    }
}

/// Nothing real is as small: it keeps 0/0 away where η = 1 and c = 0, where F has the limit 0.
pub const SMALLEST_ROOT: f64 = 1e-18;

/// F at c = v·h with k = η² - 1.
#[inline(always)]
pub fn dielectric_reflectance<R: Real>(c: R, k: R) -> R {
    reflectance_from(c, k + c * c, c.complement() * (c + 1.0), k)
}

/// The same from g² = k + c² and s² = 1 - c², for whoever has them without cancellation.
#[inline(always)]
pub fn reflectance_from<R: Real>(c: R, g2: R, s2: R, k: R) -> R {
    let g = g2.max(R::from(0.0)).sqrt();
    let sum = (g + c).max(R::from(SMALLEST_ROOT));
    let a = k / (sum * sum * (c * g + s2));
    let f = a * a * (c * c * g2 + s2 * s2);
    // Total reflection, or η = 1 at c = 0.
    let (zero, one) = (R::from(0.0), R::from(1.0));
    zero.select_below(g2, f, k.select_below(zero, one, zero))
}

/// F over all directions of diffuse light from the thinner side, F_avg = 2 ∫ F c dc.
///
/// Its closed form (Walsh 1926; Duntley 1942) cancels: at n = 1.0001 nothing of f32 and a millionth
/// of f64 are left. With c = √k sinh u the integrand is smooth whatever n.
pub fn average_dielectric(medium: Dielectric) -> Ball {
    if medium.ior == 1.0 {
        return Ball::exact(0.0);
    }
    let k = medium.k();
    let root = k.sqrt();
    let end = libm::asinh(1.0 / root);
    let at = |node: &Node| {
        let u = end * node.at;
        let c = (root * libm::sinh(u)).min(1.0);
        let f = dielectric_reflectance(c, k);
        2.0 * f * c * root * libm::cosh(u) * end * node.weight
    };
    let value: f64 = gauss_legendre(AVERAGE_NODES).iter().map(at).sum();
    Ball { value, error: AVERAGE_ERROR * value }
}

/// Nodes of the average.
const AVERAGE_NODES: usize = 48;

/// Its relative error, from n = 1 + 1e-9 to 100: beside twice as many nodes it was 4e-15.
const AVERAGE_ERROR: f64 = 1e-14;
