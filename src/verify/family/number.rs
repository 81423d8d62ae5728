//! The number that a table is for, an index of refraction, F0 or Schlick's exponent, by a fit.

use crate::brdf::Fresnel;
use crate::brdf::fresnel::{Dielectric, SchlickPower};
use crate::error::Result;
use crate::lut::Lut;
use crate::table::axis::Parameter;
use crate::verify::sample::{FLOOR, Sample};
use crate::verify::search::{Hypothesis, points};
use crate::verify::truth::Truth;

/// The exponents of Schlick's approximation that are sought, which are all that there are.
const EXPONENT: (f64, f64) = (1.0, 20.0);

/// The F0s that are sought: of 1 nothing is left.
const REFLECTANCE: (f64, f64) = (0.0, 0.99);

/// The indices that are sought: beyond, the inside of glass is no other than a mirror.
const INDEX: (f64, f64) = (1.0, 6.0);

/// The share by which fewer digits may be farther off.
const SHORTER: f64 = 1.1;

/// Steps of a fit, each of which leaves 0.618 of the interval: they leave 3e-4 of the number.
const STEPS: usize = 20;

/// The most digits behind the point of a fitted number.
const DIGITS: usize = 3;

/// The share of a fitted number by which another has to differ to be told apart from it.
const APART: f64 = 0.02;

/// The number that a table is for: its name, its value, and the ends between which it is sought.
pub fn parameter(lut: &Lut) -> Option<(&'static str, f64, (f64, f64))> {
    match lut {
        Lut::Dfg(dfg) => match dfg.fresnel() {
            Fresnel::Dielectric(medium) => Some(("ior", medium.ior(), INDEX)),
            Fresnel::SchlickPower(power) => Some(("exponent", power.exponent(), EXPONENT)),
            _ => None,
        },
        Lut::Glass(_) | Lut::Energy(_) => match (lut.ior(), lut.f0()) {
            (Some(ior), _) => Some(("ior", ior, INDEX)),
            (_, Some(f0)) => Some(("f0", f0, REFLECTANCE)),
            _ => None,
        },
        Lut::Diffuse(_) => None,
    }
}

/// The same table for another number.
fn with_parameter(truth: Truth, value: f64) -> Result<Truth> {
    let lut = match truth.lut {
        Lut::Dfg(dfg) => match dfg.fresnel() {
            Fresnel::Dielectric(_) => {
                truth.lut.with_fresnel(Fresnel::Dielectric(Dielectric::new(value)?))?
            }
            Fresnel::SchlickPower(_) => {
                truth.lut.with_fresnel(Fresnel::SchlickPower(SchlickPower::new(value)?))?
            }
            _ => truth.lut,
        },
        // Below 1 an index is another side's.
        lut if lut.ior().is_some() => lut.at(Parameter::Ior, value.max(1.0))?,
        lut => lut.at(Parameter::F0, value)?,
    };
    Ok(Truth { lut, ..truth })
}

/// A hypothesis with the number at which it is nearest to a sample, to as few digits as do, and its
/// distance. The golden section (Kiefer 1953) of a logarithmic scale, about the number
/// that it has.
pub fn tuned(hypothesis: Hypothesis, size: [usize; 2], sample: &Sample) -> Hypothesis {
    let [xs, ys] = &sample.texels;
    let points = points(&hypothesis.layout, size, [xs, ys]);
    let Some((_, value, ends)) = parameter(&hypothesis.truth.lut) else {
        let distance = sample.distance(&hypothesis.truth.at(&points), &hypothesis.packing);
        return Hypothesis { distance, ..hypothesis };
    };
    let at = |value: f64| {
        let Ok(truth) = with_parameter(hypothesis.truth, value) else { return f64::INFINITY };
        sample.distance(&truth.at(&points), &hypothesis.packing)
    };
    // Of what lies above the lower end, from a twelfth to 4.5 times as much.
    let above = (value - ends.0).max(0.02);
    let number = |t: f64| (ends.0 + above * t.exp()).min(ends.1);
    let (mut low, mut high) = (-2.5, 1.5);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_a, mut at_b) = (at(number(a)), at(number(b)));
    for _ in 0..STEPS {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - golden * (high - low);
            at_a = at(number(a));
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + golden * (high - low);
            at_b = at(number(b));
        }
    }
    let (best, distance) = if at_a < at_b { (number(a), at_a) } else { (number(b), at_b) };
    let most = SHORTER * (distance + FLOOR);
    let mut shorter = (0..DIGITS).map(|digits| rounded(best, digits));
    let short = shorter.find(|&value| at(value) + FLOOR < most);
    let short = short.unwrap_or(rounded(best, DIGITS));
    let Ok(truth) = with_parameter(hypothesis.truth, short) else { return hypothesis };
    Hypothesis { truth, distance: at(short), ..hypothesis }
}

/// The numbers beside that of a hypothesis that have to be told apart from it, with their
/// distances.
pub fn neighbours(hypothesis: &Hypothesis, size: [usize; 2], sample: &Sample) -> Vec<(f64, f64)> {
    let Some((_, value, ends)) = parameter(&hypothesis.truth.lut) else { return Vec::new() };
    let [xs, ys] = &sample.texels;
    let points = points(&hypothesis.layout, size, [xs, ys]);
    let step = (value * APART).max(0.5 * APART);
    let values = [value - step, value + step].map(|value| rounded(value, DIGITS)).into_iter();
    let inside = values.filter(|value| (ends.0..=ends.1).contains(value));
    let of = |value: f64| {
        let truth = with_parameter(hypothesis.truth, value).ok()?;
        Some((value, sample.distance(&truth.at(&points), &hypothesis.packing)))
    };
    inside.filter_map(of).collect()
}

fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$}").parse().unwrap_or(value)
}
