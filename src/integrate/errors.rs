//! The bounds of a rule's errors at a point: those of [`super::bounds`], and those of f32 on a
//! device.

use super::bounds::{Bound, GRAZING, LAYER, all, columns, glass_columns, glass_layer};
use super::rule::{Method, Rule};
use super::{Integrand, scale};
use crate::brdf::fresnel::MOST_WEIGHTS;
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::numeric::lanes::Real;

/// The bounds of a rule's errors for an integrand, to be asked row by row.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    rule: Rule,
    integrand: Integrand,
    /// The error that f32 adds, on a device.
    device: Option<f64>,
    factors: [f64; MOST_WEIGHTS],
    added: [f64; MOST_WEIGHTS],
}

/// The bounds at one α, from some n·v on.
#[derive(Clone, Copy, Debug)]
pub struct RowErrors {
    bound: Bound,
    device: Option<Device>,
    /// The relative error in each integral over that in Schlick's B.
    factors: [f64; MOST_WEIGHTS],
    /// What the rounding of v·h adds to each.
    added: [f64; MOST_WEIGHTS],
    /// Whether the first integral, too, vanishes somewhere, as both of glass do; with a device of
    /// lobes it was not measured.
    all_vanish: bool,
}

#[derive(Clone, Copy, Debug)]
struct Device {
    /// The largest error that f32 adds.
    f32: f64,
    /// Whether [`of_small`] holds.
    sharp: bool,
}

/// The largest error that f32 arithmetic on a device adds to a rule's: 1.2e-6, half again as much
/// as the 8e-7 that were measured with correctly rounded ÷ and √. With its fitted Λ, at roughness
/// 1e-8, where only a tail of its ring is seen, Charlie errs by 1.5e-6.
pub fn f32_arithmetic(integrand: impl Into<Integrand>) -> f64 {
    match integrand.into() {
        Integrand::Specular(
            Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated },
            _,
        ) => 2.5e-6,
        // The rounding of a base counts once for each factor of a power, and the exact equations
        // take more steps; 1.0e-6 was measured.
        Integrand::Specular(
            _,
            Fresnel::SchlickPower(_) | Fresnel::Dielectric(_) | Fresnel::Conductor(_),
        ) => 1.6e-6,
        // At the critical angle a layer of 1/n is thinner than f32 resolves: 2.5e-5 was measured at
        // n = 100.
        Integrand::Glass(interface) if interface.ior() >= 12.0 => 4e-5,
        _ => 1.2e-6,
    }
}

/// The largest error of rule and f32 together of an integral that vanishes at normal incidence, for
/// rules within 3e-6: twice the largest that was measured on lavapipe and SwiftShader
/// (tests/vulkan/certified.rs). The power is that of (1 - v·h)⁵, whose f32 errs like the fourth
/// power of its base.
#[inline(always)]
fn of_small<R: Real>(integral: R) -> R {
    let root = integral.sqrt();
    root * root.sqrt() * 2e-6 + 2e-9
}

/// The bound below which [`of_small`] was measured.
const SHARP_ON_DEVICE: f64 = 3e-6;

/// The error of a closed form of a diffuse lobe: a few units in the last place of its functions.
const CLOSED_FORM: f64 = 4e-15;

/// The error of a mirror, which is a closed form.
const MIRROR: f64 = 1e-15;

impl Rule {
    /// The bounds of its errors on the CPU.
    pub fn errors(&self, integrand: impl Into<Integrand>) -> Errors {
        Errors::of(*self, integrand.into(), None)
    }

    /// The bounds of its errors on a device, which computes in f32.
    pub fn device_errors(&self, integrand: impl Into<Integrand>) -> Errors {
        let integrand = integrand.into();
        Errors::of(*self, integrand, Some(f32_arithmetic(integrand)))
    }

    /// The largest error of any integral over the whole domain, in exact arithmetic: absolute, or
    /// relative where an albedo exceeds 1.
    pub fn bound(&self, integrand: impl Into<Integrand>) -> f64 {
        // Bounds are widest at one end or the other.
        let integrand = integrand.into();
        self.bound_at(integrand, 0.0, f64::MIN_POSITIVE).max(self.bound_at(integrand, 0.0, 1.0))
    }

    /// The same at one α where n·v is at least `mu`.
    pub fn bound_at(&self, integrand: impl Into<Integrand>, mu: f64, alpha: f64) -> f64 {
        self.bounds_at(integrand.into(), mu, alpha).all
    }

    /// The bounds at one α where n·v is at least `mu`.
    pub(super) fn bounds_at(&self, integrand: Integrand, mu: f64, alpha: f64) -> Bound {
        match (integrand, self.promised) {
            (_, Some(promised)) => Bound { all: promised, relative: 0.0, absolute: promised },
            (Integrand::Specular(..) | Integrand::Glass(_), _) if alpha == 0.0 => all(MIRROR),
            (Integrand::Glass(interface), _) => {
                let bound = (self.column)(glass_columns(interface));
                glass_layer(interface).map_or(bound, |layer| bound.plus((self.column)(layer)))
            }
            (Integrand::Specular(lobe, fresnel), _) => {
                let bound = (self.column)(columns(lobe, mu, alpha)).times(fresnel.error_factor());
                if fresnel.has_layer() { bound.plus((self.column)(&LAYER)) } else { bound }
            }
            (Integrand::Diffuse(_), _) if self.method == Method::ClosedForm => all(CLOSED_FORM),
            (Integrand::Diffuse(_), _) => all(f64::INFINITY),
        }
    }
}

impl Errors {
    fn of(rule: Rule, integrand: Integrand, device: Option<f64>) -> Self {
        let (mut factors, mut added) = ([1.0; MOST_WEIGHTS], [0.0; MOST_WEIGHTS]);
        if let Integrand::Specular(_, fresnel) = integrand {
            for (k, integral) in fresnel.definition().integrals.iter().enumerate() {
                (factors[k], added[k]) = (integral.relative_error, integral.absolute_error);
            }
        }
        Errors { rule, integrand, device, factors, added }
    }

    /// The bounds at one α where n·v is at least `mu`.
    pub fn row(&self, mu: f64, alpha: f64) -> RowErrors {
        let all_vanish = match self.integrand {
            Integrand::Specular(lobe, _) => lobe.fades() && self.device.is_none(),
            Integrand::Glass(_) => true,
            Integrand::Diffuse(_) => false,
        };
        // In f32 the rounding of v·h leaves nothing sharp; of glass it was not measured.
        let rounds = self.added.iter().any(|&added| added > 0.0);
        let sharp = || !rounds && !all_vanish && self.rule.bound(self.integrand) <= SHARP_ON_DEVICE;
        let device = self.device.map(|f32| Device { f32, sharp: sharp() });
        let bound = self.rule.bounds_at(self.integrand, mu, alpha);
        RowErrors { bound, device, factors: self.factors, added: self.added, all_vanish }
    }

    /// The bounds of the errors of these integrals at (n·v, α).
    pub fn at(&self, (mu, alpha): (f64, f64), integrals: &[f64]) -> [f64; MOST_WEIGHTS] {
        self.row(mu, alpha).of(integrals)
    }

    /// The bounds of the errors of these averages at one α, but for those of the averages'
    /// quadrature: the integrals' own beyond [`GRAZING`], and below it the share of an average
    /// there.
    ///
    /// That is 2 ∫ μ dμ = [`GRAZING`]², and where albedos exceed 1 twice ∫ μ E dμ, since errors are
    /// relative to them: Neubelt's E is at most 0.4/√α where n·v < √α and falls like a Gaussian
    /// beyond, so that the share is at most 0.4 √α, and 0.4 [`GRAZING`]²/√α.
    pub fn of_averages(&self, alpha: f64, averages: &[f64]) -> [f64; MOST_WEIGHTS] {
        let exceeds = match self.integrand {
            Integrand::Specular(lobe, _) => lobe.may_exceed_one(),
            Integrand::Glass(_) | Integrand::Diffuse(_) => false,
        };
        let share = if exceeds { GRAZING } else { GRAZING * GRAZING };
        let at_grazing = share * self.row(0.0, alpha).largest();
        self.row(GRAZING, alpha).of(averages).map(|error| error + at_grazing)
    }
}

impl RowErrors {
    /// The bounds of the errors of these integrals, of one point or of as many as R has lanes;
    /// zeros for those that there are not.
    #[inline(always)]
    pub fn of<R: Real>(&self, integrals: &[R]) -> [R; MOST_WEIGHTS] {
        let scale = scale(integrals);
        let mut errors = [R::from(0.0); MOST_WEIGHTS];
        for (k, (error, &integral)) in errors.iter_mut().zip(integrals).enumerate() {
            *error = match k {
                0 if !self.all_vanish => self.of_first(scale),
                _ => {
                    self.of_vanishing(self.factors[k], integral.abs(), scale)
                        + scale * self.added[k]
                }
            };
        }
        errors
    }

    /// The largest error where no albedo exceeds 1; infinite where there is no bound.
    pub fn largest(&self) -> f64 {
        self.of_first(1.0)
    }

    /// Whether they are those of a device.
    pub fn on_device(&self) -> bool {
        self.device.is_some()
    }

    #[inline(always)]
    fn of_first<R: Real>(&self, scale: R) -> R {
        scale * self.bound.all + scale * self.device.map_or(0.0, |device| device.f32)
    }

    /// The bound of an integral whose weight vanishes at normal incidence.
    #[inline(always)]
    fn of_vanishing<R: Real>(&self, factor: f64, integral: R, scale: R) -> R {
        let Bound { all, relative, absolute } = self.bound;
        // Without a sharp bound a product with 0 would be NaN.
        let sharp = if relative.is_finite() {
            (integral * relative + scale * absolute) * factor
        } else {
            R::from(f64::INFINITY)
        };
        let error = sharp.min(scale * all);
        match self.device {
            None => error,
            Some(Device { f32, sharp: true }) => {
                (scale * of_small(integral / scale) * factor).min(error + scale * f32)
            }
            Some(Device { f32, sharp: false }) => error + scale * f32,
        }
    }
}
