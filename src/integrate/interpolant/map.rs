//! The variable along n·v: see [`super`].

use crate::numeric::lanes::Real;

/// The variable s, in numbers that take no more than square roots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// log₂ c
    pub compression: u32,
    /// log₂ q
    pub power: u32,
    /// The layer.
    pub layer: Layer,
    /// The y at which s is 1 where that lies before μ = 1: beyond there is nothing to follow.
    pub cut: f64,
}

/// A length of n·v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layer {
    /// So many times α.
    Alpha(f64),
    /// So many times √α.
    RootAlpha(f64),
}

/// s at one α.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    map: Map,
    /// 1/layer
    steepness: f64,
    /// tanh(asinh(y)/c) at s = 1.
    end: f64,
}

impl Map {
    /// tanh(asinh(y)/c) for y ≥ 0.
    #[inline(always)]
    fn compressed<R: Real>(self, y: R) -> R {
        let mut e = y + (y * y + 1.0).sqrt();
        for _ in 1..self.compression {
            e = e.sqrt();
        }
        (e - 1.0) / (e + 1.0)
    }

    pub(super) fn at(self, alpha: f64) -> Placement {
        let steepness = match self.layer {
            Layer::Alpha(times) => 1.0 / (times * alpha),
            Layer::RootAlpha(times) => 1.0 / (times * alpha.sqrt()),
        };
        Placement { map: self, steepness, end: self.compressed(steepness.min(self.cut)) }
    }
}

impl Placement {
    /// s
    #[inline(always)]
    pub fn of<R: Real>(&self, mu: R) -> R {
        let mut s = (self.map.compressed(mu * self.steepness) / self.end).min(R::from(1.0));
        for _ in 0..self.map.power {
            s = s.sqrt();
        }
        s
    }

    /// n·v at s.
    pub fn inverse(&self, s: f64) -> f64 {
        let power = (0..self.map.power).fold(s, |s, _| s * s);
        let c = f64::from(1 << self.map.compression);
        (libm::sinh(c * libm::atanh(self.end * power)) / self.steepness).min(1.0)
    }
}
