//! An axis of a table: a parameter, its mapping and its nodes. The half-texel arithmetic of the
//! crate stands here and in `expression`.
//!
//! Texel i of N lies at t = (i + offset)/N (centres: offset ½) or t = i/(N-1) (edges), clamped to
//! [0, 1] unless the axis is unclamped; a flipped axis counts its texels from the other end; the
//! mapping carries t to the parameter.

mod expression;
mod words;

pub use expression::{SHADING, Words};
pub use words::AXIS_WORDS;

use crate::choice::choice;
use crate::error::{Error, Result};
use crate::units::{Alpha, Cosine, F0, Ior, PerceptualRoughness};
use std::ops::RangeInclusive;

/// The largest number of texels along an axis.
pub const LARGEST_SIZE: usize = 16384;

/// The quantity that varies along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// μ = n·v, the cosine to the view.
    Nov,
    /// Perceptual roughness r, α = r².
    Roughness,
    /// α itself.
    Alpha,
    /// The exponent n of Blinn-Phong, from 1 to 1e7: n = 10^(7p), α² = 2/(n+2).
    Exponent,
    /// Reflectance at normal incidence, from slice to slice.
    F0,
    /// Index of refraction, from slice to slice; below 1 it is that of a medium seen from inside,
    /// 1/n.
    Ior,
    /// n·v seen from inside glass by its place about the cosine c of the critical angle: c + (2p -
    /// 1)(1 - c) above it and c + (2p - 1) c below.
    Critical,
    /// The place of a control point among those of a fitted net: no bake has it.
    Control,
}

choice!(Parameter, "axis", {
    Nov = "nov", "n.v, the cosine to the view";
    Roughness = "roughness", "perceptual roughness, alpha = roughness^2";
    Alpha = "alpha", "the width of the distribution of normals";
    Exponent = "exponent", "n = 10^(7p), Blinn-Phong's";
    F0 = "f0", "reflectance at normal incidence, from slice to slice";
    Ior = "ior", "index of refraction, from slice to slice";
    Critical = "critical", "n.v centred on the critical angle of glass seen from inside";
    Control = "control", "control points of a fitted net";
});

/// The mapping from a position t in [0, 1] along the axis to the parameter p in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// p = t
    Linear,
    /// t = √p, so p = t²: more texels at small p.
    Sqrt,
    /// t = p², so p = √t: more texels at large p.
    Square,
    /// t = √(1-p), so p = 1 - t²: t = 0 at p = 1.
    SqrtComplement,
    /// Even steps of √((n-1)/(n+1)), the fourth root of F0, of an index of refraction n from min to
    /// max; without max they lead to infinity, and n stays at 99.5 from 0.99 on: Cycles, EEVEE.
    SqrtF0,
    /// An index of refraction from 1/max to 1 on one half, and from 1 to max on the other: OSPRay,
    /// Adobe.
    Piecewise,
}

choice!(Mapping, "axis", {
    Linear = "linear", "p = t";
    Sqrt = "sqrt", "t = sqrt(p)";
    Square = "square", "t = p^2";
    SqrtComplement = "sqrt-complement", "t = sqrt(1-p)";
    SqrtF0 = "sqrt-f0", "even steps of sqrt((n-1)/(n+1)), of ior";
    Piecewise = "piecewise", "ior from 1/max to 1 and from 1 to max";
});

/// The positions of the texels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Nodes {
    /// t = i/(N-1); with one texel t = 0.
    Edges,
    /// t = (i + offset)/N; ½ is texel centres.
    Offset(f64),
}

/// An axis without its size, as the words `nov,sqrt,edges,flip` describe it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSpec {
    /// The quantity that varies.
    pub parameter: Parameter,
    /// Its mapping.
    pub mapping: Mapping,
    /// The positions of the texels.
    pub nodes: Nodes,
    /// Whether texel 0 is the far end.
    pub flip: bool,
    /// Whether texels beyond an end of [0, 1] are moved to that end.
    pub clamp: bool,
    /// Parameters below this are raised to it; of an index of refraction the near end.
    pub min: f64,
    /// Parameters above this are lowered to it; of an index of refraction the far end.
    pub max: f64,
}

/// An axis of a table: every texel's parameter is in its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    spec: AxisSpec,
    size: usize,
}

impl AxisSpec {
    /// Linear, texel centres.
    pub const fn of(parameter: Parameter) -> Self {
        AxisSpec {
            parameter,
            mapping: Mapping::Linear,
            nodes: Nodes::Offset(0.5),
            flip: false,
            clamp: true,
            min: if is_ior(parameter) { 1.0 } else { 0.0 },
            max: default_max(parameter, Mapping::Linear),
        }
    }
}

const fn is_ior(parameter: Parameter) -> bool {
    matches!(parameter, Parameter::Ior)
}

/// The index at z = √((n-1)/(n+1)) = 0.99, beyond which Cycles' axis stays there.
const CYCLES_MAX: f64 = 1.9801 / 0.0199;

/// z = √((n-1)/(n+1)) of an index of refraction.
fn root_of_f0(n: f64) -> f64 {
    ((n - 1.0) / (n + 1.0)).max(0.0).sqrt()
}

/// The max of an axis that names none: of an index of refraction OSPRay's or Cycles'.
const fn default_max(parameter: Parameter, mapping: Mapping) -> f64 {
    match (parameter, mapping) {
        (Parameter::Ior, Mapping::SqrtF0) => CYCLES_MAX,
        (Parameter::Ior, _) => 3.0,
        _ => f64::INFINITY,
    }
}

impl Axis {
    /// Checks size and parameter range at every texel.
    pub fn new(spec: AxisSpec, size: usize) -> Result<Self> {
        if !(1..=LARGEST_SIZE).contains(&size) {
            return Err(Error::bad_input(
                "size",
                format!("1 to {LARGEST_SIZE} texels along each axis"),
                size.to_string(),
                "give a size in that range",
            ));
        }
        let offset = match spec.nodes {
            Nodes::Edges => 0.0,
            Nodes::Offset(offset) => offset,
        };
        // NaN is in no range.
        let ends = match is_ior(spec.parameter) {
            true => spec.min >= 1.0 && spec.max > spec.min && spec.max.is_finite(),
            false => (0.0..=1.0).contains(&spec.min) && spec.max > 0.0 && spec.min <= spec.max,
        };
        let maps = match spec.mapping {
            Mapping::Linear | Mapping::Sqrt | Mapping::Square | Mapping::SqrtComplement => true,
            Mapping::SqrtF0 => is_ior(spec.parameter),
            // One half ends at 1.
            Mapping::Piecewise => is_ior(spec.parameter) && spec.min == 1.0,
        };
        if !(OFFSETS.contains(&offset) && ends && maps) {
            let got = format!("'{spec}'");
            return Err(Error::bad_input("axis", AXIS_WORDS, got, "use those words"));
        }
        let axis = Axis { spec, size };
        for i in 0..size {
            let value = axis.value(i);
            let checked = match spec.parameter {
                Parameter::Nov => Cosine::new(value).map(drop),
                Parameter::Roughness => PerceptualRoughness::of_texel(value).map(drop),
                Parameter::Alpha => Alpha::of_texel(value).map(drop),
                // The same range: p in [0, 1] is every exponent from 1 to 1e7.
                Parameter::Exponent | Parameter::F0 | Parameter::Control | Parameter::Critical => {
                    F0::new(value).map(drop)
                }
                Parameter::Ior => Ior::new(value.max(1.0 / value)).map(drop),
            };
            checked.map_err(|error| match error {
                Error::BadInput(mut complaint) => {
                    complaint.what = format!("{} at texel {i} of axis '{spec}'", complaint.what);
                    complaint.cure =
                        "choose other nodes, raise the axis's min, or lower its max".into();
                    Error::BadInput(complaint)
                }
                other => other,
            })?;
        }
        Ok(axis)
    }

    /// Parameter, mapping and nodes.
    pub fn spec(&self) -> AxisSpec {
        self.spec
    }

    /// The number of texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The parameter at texel `i`.
    pub fn value(&self, i: usize) -> f64 {
        self.value_at(i as f64)
    }

    /// The parameter at a place between texels: the inverse of [`Axis::texel`].
    pub fn value_at(&self, texel: f64) -> f64 {
        let i = if self.spec.flip { self.size as f64 - 1.0 - texel } else { texel };
        let t = match self.spec.nodes {
            Nodes::Edges => i / (self.size as f64 - 1.0).max(1.0),
            Nodes::Offset(offset) => (i + offset) / self.size as f64,
        };
        let t = if self.spec.clamp { t.clamp(0.0, 1.0) } else { t };
        let AxisSpec { min, max, parameter, .. } = self.spec;
        let along = |p: f64| if is_ior(parameter) { min + (max - min) * p } else { p };
        let p = match self.spec.mapping {
            Mapping::Linear => along(t),
            Mapping::Sqrt => along(t * t),
            Mapping::Square => along(t.max(0.0).sqrt()),
            Mapping::SqrtComplement => along((1.0 - t) * (1.0 + t)),
            Mapping::SqrtF0 => {
                let (z0, z1) = self.ends_of_z();
                let z = z0 + (z1 - z0) * t;
                (1.0 + z * z) / ((1.0 - z) * (1.0 + z)).max(f64::MIN_POSITIVE)
            }
            Mapping::Piecewise if t < 0.5 => return (1.0 - 2.0 * t) / max + 2.0 * t,
            Mapping::Piecewise => 1.0 + (max - 1.0) * (2.0 * t - 1.0),
        };
        p.max(min).min(max)
    }

    /// √((n-1)/(n+1)) at either end of [`Mapping::SqrtF0`].
    fn ends_of_z(&self) -> (f64, f64) {
        let AxisSpec { min, max, .. } = self.spec;
        (root_of_f0(min), if max == CYCLES_MAX { 1.0 } else { root_of_f0(max) })
    }

    /// The fractional texel at which the parameter is `p`: the inverse of [`Axis::value`] where
    /// that does not clamp.
    pub fn texel(&self, p: f64) -> f64 {
        let AxisSpec { min, max, parameter, .. } = self.spec;
        let along = || if is_ior(parameter) { (p - min) / (max - min) } else { p };
        let t = match self.spec.mapping {
            Mapping::Linear => along(),
            Mapping::Sqrt => along().max(0.0).sqrt(),
            Mapping::Square => along() * along(),
            Mapping::SqrtComplement => (1.0 - along()).max(0.0).sqrt(),
            Mapping::SqrtF0 => {
                let (z0, z1) = self.ends_of_z();
                (root_of_f0(p) - z0) / (z1 - z0)
            }
            Mapping::Piecewise if p < 1.0 => 0.5 * (p * max - 1.0) / (max - 1.0),
            Mapping::Piecewise => 0.5 + 0.5 * (p - 1.0) / (max - 1.0),
        };
        let i = match self.spec.nodes {
            Nodes::Edges => t * (self.size as f64 - 1.0).max(1.0),
            Nodes::Offset(offset) => t * self.size as f64 - offset,
        };
        if self.spec.flip { self.size as f64 - 1.0 - i } else { i }
    }

    /// The texels on either side of a parameter, clamped at the ends, and the weight of the second.
    pub fn neighbours(&self, p: f64) -> (usize, usize, f64) {
        let last = self.size - 1;
        let texel = self.texel(p).clamp(0.0, last as f64);
        let first = texel as usize;
        (first, (first + 1).min(last), texel - first as f64)
    }

    /// The number of texels whose parameter was moved to the axis's min or max.
    pub fn clamped(&self) -> usize {
        if is_ior(self.spec.parameter) {
            return 0;
        }
        let spec = AxisSpec { min: 0.0, max: f64::INFINITY, ..self.spec };
        let free = Axis { spec, size: self.size };
        (0..self.size).filter(|&i| free.value(i) != self.value(i)).count()
    }

    /// The parameter at every texel, in order.
    pub fn values(&self) -> Vec<f64> {
        (0..self.size).map(|i| self.value(i)).collect()
    }

    /// The position of a texel as a formula in i, for the metadata.
    pub fn formula(&self) -> String {
        let n = self.size;
        let i = if self.spec.flip { format!("({} - i)", n - 1) } else { "i".into() };
        let t = match self.spec.nodes {
            Nodes::Edges => format!("{i}/{}", (n - 1).max(1)),
            Nodes::Offset(offset) => format!("({i} + {offset})/{n}"),
        };
        let AxisSpec { min, max, .. } = self.spec;
        let p = match self.spec.mapping {
            Mapping::Linear => "t".into(),
            Mapping::Sqrt => "t^2".into(),
            Mapping::Square => "sqrt(t)".into(),
            Mapping::SqrtComplement => "1 - t^2".into(),
            Mapping::SqrtF0 => {
                let (z0, z1) = self.ends_of_z();
                format!("(1 + z^2)/(1 - z^2), z = {z0:?} + ({z1:?} - {z0:?}) t")
            }
            Mapping::Piecewise => {
                format!("t < 1/2 ? (1 - 2t)/{max:?} + 2t : 1 + ({max:?} - 1) (2t - 1)")
            }
        };
        let p = match (self.spec.parameter, self.spec.mapping) {
            (Parameter::Ior, Mapping::Piecewise) => p,
            (Parameter::Ior, Mapping::SqrtF0) => format!("the least of {max:?} and {p}"),
            (Parameter::Ior, _) => format!("{min:?} + ({max:?} - {min:?}) ({p})"),
            _ => {
                let p = if min > 0.0 { format!("max({p}, {min:?})") } else { p };
                if max.is_finite() { format!("min({p}, {max:?})") } else { p }
            }
        };
        let p =
            if self.spec.parameter == Parameter::Exponent { format!("10^(7 ({p}))") } else { p };
        let t = if self.spec.clamp { format!("clamp({t}, 0, 1)") } else { t };
        format!("{} = {p}, t = {t}", self.spec.parameter)
    }
}

/// The offsets of nodes: up to two texels beyond an end.
const OFFSETS: RangeInclusive<f64> = -2.0..=2.0;
