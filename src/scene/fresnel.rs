//! Reflectance at normal and at grazing incidence: F0 and F90 of glTF's mix of a dielectric and a
//! metal (glTF 2.0, appendix B.2, KHR_materials_ior and KHR_materials_specular).

use super::span::Span;
use crate::units::{F0, Ior};

/// F0 of a dielectric without KHR_materials_ior: index of refraction 1.5.
pub const DIELECTRIC: f64 = 0.04;

/// F0 of an interval of indices of refraction. 0 stands for F = 1; between 0 and 1 all may be.
pub fn f0_of_ior(ior: Span) -> Span {
    let f0 = |n: f64| Ior::new(n).map_or(1.0, |n| F0::from(n).get());
    if ior.is_point() || ior.low >= 1.0 { ior.map(f0) } else { Span::UNIT }
}

/// The dielectric part.
#[derive(Clone, Copy)]
pub struct Dielectric {
    /// Of R, G, B.
    pub f0: [Span; 3],
    pub f90: Span,
}

impl Dielectric {
    /// KHR_materials_specular: F0 = min(F0 of the index times colour, 1) times specular, F90 =
    /// specular.
    pub fn new(f0: Span, color: [Span; 3], specular: Span) -> Self {
        let scaled = |color: Span| f0.times(color).map(|f0| f0.min(1.0)).times(specular);
        Dielectric { f0: color.map(scaled), f90: specular }
    }

    /// F0 of all channels where the metal part has these colours. It is linear in each of its
    /// arguments, so its ends are at theirs.
    pub fn f0_with(&self, color: [Span; 3], metallic: Span) -> Span {
        let mixed = |(&f0, color)| mix(f0, color, metallic);
        let spans = self.f0.iter().zip(color).map(mixed);
        Span::hull_of(spans).unwrap_or(Span::UNIT)
    }

    /// F90; that of a metal is 1.
    pub fn f90_with(&self, metallic: Span) -> Span {
        mix(self.f90, Span::point(1.0), metallic)
    }
}

/// (1 - t) a + t b.
fn mix(a: Span, b: Span, t: Span) -> Span {
    let at =
        |t: f64| Span { low: (1.0 - t) * a.low + t * b.low, high: (1.0 - t) * a.high + t * b.high };
    at(t.low).hull(at(t.high))
}
