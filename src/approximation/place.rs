//! Coordinates in which the integrals are smooth: along n·v and across roughness.

use super::Region;
use crate::error::{Error, Result};
use crate::numeric::lanes::Real;

/// A coordinate along n·v, 0 at the least n·v or at 0, 1 at n·v = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// n·v
    Nov,
    /// √(n·v)
    Sqrt,
    /// ∛(n·v)
    Cbrt,
    /// μ ln(1 + 1/μ)/ln 2 with μ = n·v: GGX with height-correlated masking has
    /// E = 1 - μ ln(1 + 1/μ) at α = 1, and the integrals of other rough surfaces are much like it.
    Log,
    /// T = √(μ(1 + kα)/(μ + kα)) with μ = n·v. Near n·v = α = 0 the integrals are functions of
    /// n·v/α alone: T resolves that layer, whatever α.
    Layer(f64),
}

/// A coordinate across perceptual roughness r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Across {
    /// r
    Linear,
    /// √r
    Sqrt,
    /// r^p
    Power(f64),
}

/// Keeps the quotients finite of [`Along::Layer`] at n·v = α = 0 and of [`Along::Log`] at n·v = 0.
pub const TINY: f64 = 1e-30;

impl Along {
    /// The coordinate where n·v is counted from `least`.
    pub fn at<R: Real>(self, least: f64, nov: R, roughness: R) -> R {
        let nov = match least {
            0.0 => nov,
            _ => (nov - least).max(R::from(0.0)) * (1.0 / (1.0 - least)),
        };
        match self {
            Along::Nov => nov,
            Along::Sqrt => nov.sqrt(),
            Along::Cbrt => nov.zip(nov, |nov, _| libm::cbrt(nov)),
            Along::Log => nov.zip(nov, |nov, _| log(nov)),
            Along::Layer(k) => {
                let width = roughness * roughness * k;
                (nov * (width + 1.0) / (nov + width).max(R::from(TINY))).sqrt()
            }
        }
    }

    /// The n·v at this place.
    pub fn inverse(self, least: f64, place: f64, roughness: f64) -> f64 {
        let nov = match self {
            Along::Nov => place,
            Along::Sqrt => place * place,
            Along::Cbrt => place * place * place,
            Along::Log => inverse_log(place),
            Along::Layer(k) => {
                let (width, squared) = (roughness * roughness * k, place * place);
                // 0/0 at a mirror's n·v = 1.
                if place >= 1.0 { 1.0 } else { squared * width / (width + 1.0 - squared) }
            }
        };
        (least + (1.0 - least) * nov).min(1.0)
    }

    /// Its word in files.
    pub fn word(self) -> String {
        match self {
            Along::Nov => "nov".into(),
            Along::Sqrt => "sqrt".into(),
            Along::Cbrt => "cbrt".into(),
            Along::Log => "log".into(),
            Along::Layer(k) => format!("layer={k}"),
        }
    }

    /// The coordinate with this word.
    pub fn named(word: &str) -> Result<Self> {
        match word {
            "nov" => Ok(Along::Nov),
            "sqrt" => Ok(Along::Sqrt),
            "cbrt" => Ok(Along::Cbrt),
            "log" => Ok(Along::Log),
            _ => parameter(word, "layer=", "nov, sqrt, cbrt, log or layer=K").map(Along::Layer),
        }
    }
}

/// μ ln(1 + 1/μ)/ln 2
fn log(nov: f64) -> f64 {
    nov * libm::log(1.0 + 1.0 / nov.max(TINY)) * std::f64::consts::LOG2_E
}

/// The μ of that, by halving.
fn inverse_log(place: f64) -> f64 {
    if place <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if log(middle) < place { low = middle } else { high = middle }
    }
    high
}

impl Across {
    /// r^p
    pub fn of<R: Real>(self, roughness: R) -> R {
        match self {
            Across::Linear => roughness,
            Across::Sqrt => roughness.sqrt(),
            Across::Power(p) => roughness.zip(roughness, |r, _| libm::pow(r, p)),
        }
    }

    /// The coordinate from 0 at the smoothest to 1 at the roughest of a region, not clamped.
    pub fn at<R: Real>(self, region: &Region, roughness: R) -> R {
        let [low, high] = region.roughness.map(|end| self.of::<f64>(end));
        (self.of(roughness) - low) * (1.0 / (high - low))
    }

    /// The roughness at this place.
    pub fn inverse(self, region: &Region, place: f64) -> f64 {
        let [low, high] = region.roughness;
        let [first, last] = region.roughness.map(|end| self.of::<f64>(end));
        let power = first + (last - first) * place;
        let roughness = match self {
            Across::Linear => power,
            Across::Sqrt => power * power,
            Across::Power(p) => libm::pow(power, 1.0 / p),
        };
        roughness.clamp(low, high)
    }

    /// Its word in files.
    pub fn word(self) -> String {
        match self {
            Across::Linear => "roughness".into(),
            Across::Sqrt => "sqrt".into(),
            Across::Power(p) => format!("power={p}"),
        }
    }

    /// The coordinate with this word.
    pub fn named(word: &str) -> Result<Self> {
        match word {
            "roughness" => Ok(Across::Linear),
            "sqrt" => Ok(Across::Sqrt),
            _ => parameter(word, "power=", "roughness, sqrt or power=P").map(Across::Power),
        }
    }
}

/// The number above 0 behind a mark.
fn parameter(word: &str, mark: &str, expected: &str) -> Result<f64> {
    let number = word.strip_prefix(mark).and_then(|number| number.parse::<f64>().ok());
    number.filter(|number| *number > 0.0 && *number <= 1e3).ok_or_else(|| {
        Error::bad_input("coordinate", expected, format!("'{word}'"), "name one of these")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The n·v at a place has that place, and both ends are exact.
    #[test]
    fn a_place_is_found_again() {
        let all = [Along::Nov, Along::Sqrt, Along::Cbrt, Along::Log, Along::Layer(3.0)];
        for (along, least) in all.into_iter().flat_map(|along| [(along, 0.0), (along, 1e-3)]) {
            assert_eq!(along.inverse(least, 0.0, 0.3), least, "{along:?}");
            assert_eq!(along.inverse(least, 1.0, 0.3), 1.0, "{along:?}");
            for place in (1..100).map(|i| f64::from(i) / 100.0) {
                let found: f64 = along.at(least, along.inverse(least, place, 0.3), 0.3);
                // n·v less its least is off by a unit of 1; roots and logarithms multiply it.
                assert!((found - place).abs() < 1e-12, "{along:?} from {least}: {place}, {found}");
            }
        }
    }
}
