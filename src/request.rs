//! A checked job: which table, over which axes, how exact, stored how. It prints itself as the command that repeats it.

use crate::axis::{Axis, AxisSpec, Parameter};
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::rule::Rule;
use crate::lut::{Grid, Lut};
use crate::model::{Microfacet, Ndf};
use crate::precision::Precision;
use crate::units::word;
use std::fmt;

/// How exact the values have to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// Certified: rounded correctly, or in f32 within this absolute error before it is rounded.
    Certified(f64),
    /// Not certified, the integrals within this absolute error, by whatever rule is the cheapest.
    Tolerance(f64),
    /// Not certified, by this rule.
    Rule(Rule),
}

impl Accuracy {
    /// Certified, in f32 with a tolerance that befits it and the lobe: f64 by the rules that devices have keeps it.
    pub fn by_default(lut: &Lut, precision: Precision) -> Self {
        Accuracy::Certified(precision.default_tolerance().max(Rule::sharpest_device_bound(lut.integrand())))
    }

    /// Not certified, with a tolerance that befits the precision and that a device can keep of the table's integrand.
    pub fn uncertified(lut: &Lut, precision: Precision) -> Self {
        Accuracy::Tolerance(precision.default_tolerance().max(Rule::device_tolerance(lut.integrand())))
    }
}

/// A checked job.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// What is baked.
    pub lut: Lut,
    /// The axis along a row.
    pub x: Axis,
    /// The axis from row to row.
    pub y: Axis,
    /// How exact.
    pub accuracy: Accuracy,
    /// How stored.
    pub precision: Precision,
}

/// Texels along each axis when no size is given.
pub const DEFAULT_SIZE: usize = 128;

impl Request {
    /// Checks that the parts fit together.
    pub fn new(lut: Lut, x: Axis, y: Axis, accuracy: Accuracy, precision: Precision) -> Result<Self> {
        let request = Request { lut, x, y, accuracy, precision };
        let (integrand, grid) = (lut.integrand(), request.grid()?);
        if let Integrand::Specular(lobe) = integrand {
            check_lobe(lobe, &grid)?;
        }
        if let (Accuracy::Certified(_), Precision::F64) = (accuracy, precision) {
            let cure = "choose another, or values that are not certified";
            return Err(Error::bad_input("precision", "one that files have, to be certified", "f64", cure));
        }
        match accuracy {
            Accuracy::Certified(tolerance) | Accuracy::Tolerance(tolerance) => {
                let needs_rule = matches!(accuracy, Accuracy::Tolerance(_)) || precision == Precision::F32;
                if needs_rule && (Rule::for_cpu(integrand, tolerance, grid.len()).is_none() || tolerance > 0.1) {
                    return Err(Error::bad_input(
                        "tolerance",
                        format!("an absolute error from {:e} to 0.1", Rule::sharpest_bound(integrand)),
                        format!("{tolerance:e}"),
                        "give one in that range",
                    ));
                }
            }
            Accuracy::Rule(rule) => {
                let promises = |&alpha: &f64| rule.bound_at(integrand, alpha).is_finite();
                if !rule.applies_to(integrand) || !grid.alphas.iter().all(promises) {
                    return Err(Error::bad_input(
                        "rule",
                        "one that serves for the model at every roughness of the axis",
                        rule.name,
                        "choose reference, a rule whose name begins with h, or closed-form for a diffuse lobe",
                    ));
                }
            }
        }
        Ok(request)
    }

    /// The table that every engine needs: x = n·v, y = perceptual roughness, texel centres.
    pub fn with_default_axes(lut: Lut, size: (usize, usize), precision: Precision) -> Result<Self> {
        let x = Axis::new(AxisSpec::of(Parameter::Nov), size.0)?;
        let y = Axis::new(AxisSpec::of(Parameter::Roughness), size.1)?;
        Request::new(lut, x, y, Accuracy::by_default(&lut, precision), precision)
    }

    /// The parameters of the texels.
    pub fn grid(&self) -> Result<Grid> {
        Grid::new(&self.x, &self.y)
    }
}

/// Refuses what means nothing, or has no finite value.
fn check_lobe(lobe: Microfacet, grid: &Grid) -> Result<()> {
    check_masking(lobe)?;
    if lobe.diverges_at_grazing() && grid.mus.contains(&0.0) {
        let (got, cure) =
            ("n.v = 0, where this albedo is infinite", "add min=1e-4 to the axis, or choose texel centres");
        return Err(Error::bad_input("axis of n.v", "n.v > 0", got, cure));
    }
    Ok(())
}

/// Refuses a masking term that means nothing for the distribution.
pub fn check_masking(Microfacet { ndf, masking }: Microfacet) -> Result<()> {
    if !ndf.maskings().contains(&masking) {
        let expected = ndf.maskings().iter().map(word).collect::<Vec<_>>().join(", ");
        let what = format!("masking of {}", word(ndf));
        return Err(Error::bad_input(what, expected, word(masking), reason(ndf)));
    }
    Ok(())
}

/// Why a distribution takes these masking terms and no other.
fn reason(ndf: Ndf) -> &'static str {
    match ndf {
        Ndf::Ggx => "neubelt is the visibility of sheen",
        Ndf::Beckmann => "joint approximates GGX's term, and neubelt is the visibility of sheen",
        Ndf::BeckmannWalter => "the model differs from beckmann in its Smith term alone: use beckmann for another",
        Ndf::BlinnPhong => "schlick-smith and joint approximate other distributions' terms; neubelt is for sheen",
        Ndf::Charlie => "its Smith term was fitted for correlated heights, and the approximations are GGX's",
    }
}

impl fmt::Display for Request {
    /// The command that repeats the job.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "splitsum bake --lut {} {}", self.lut.name(), self.lut.flags())?;
        write!(f, " --size {}x{} --x {} --y {}", self.x.size, self.y.size, self.x.spec, self.y.spec)?;
        write!(f, " --precision {}", word(self.precision))?;
        match self.accuracy {
            Accuracy::Certified(tolerance) if self.precision == Precision::F32 => {
                write!(f, " --tolerance {tolerance:e}")
            }
            Accuracy::Certified(_) => Ok(()),
            Accuracy::Tolerance(tolerance) => write!(f, " --certify off --tolerance {tolerance:e}"),
            Accuracy::Rule(rule) => write!(f, " --certify off --rule {}", rule.name),
        }
    }
}
