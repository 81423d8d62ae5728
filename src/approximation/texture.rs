//! Textures that a sampler reads, for shaders that stay as they are.

use super::{Channels, Shape, Storage};
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::numeric::lanes::Real;
use crate::table::axis::{Axis, AxisSpec, Mapping, Parameter};

/// The texels of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels {
    /// Integrals at their places.
    Exact,
    /// Those whose lookup errs least.
    Fitted,
}

choice!(Texels, "texels", {
    Exact = "exact", "integrals";
    Fitted = "fitted", "those whose lookup errs least";
});

/// What a shader takes from a texture, and how it finds the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// A and B, or B and E.
    pub channels: Channels,
    /// n·v along x, roughness or α across y.
    pub axes: [AxisSpec; 2],
    /// How it is stored; as is cheapest without a wish.
    pub storage: Option<Storage>,
}

impl Sampler {
    /// Checks both.
    pub fn new(channels: Channels, axes: [AxisSpec; 2], storage: Option<Storage>) -> Result<Self> {
        if !matches!(channels, Channels::ScaleBias | Channels::BiasEnergy) {
            let cure = "name one of them";
            let expected = "scale-bias or bias-energy";
            return Err(Error::bad_input("channels", expected, channels.to_string(), cure));
        }
        if storage == Some(Storage::F32) {
            let cure = "name one of them";
            return Err(Error::bad_input("storage", "f16, unorm16 or unorm8", "f32", cure));
        }
        // Any size: the axes are checked.
        Shape::texture(axes, [2, 2], Texels::Exact)?;
        Ok(Sampler { channels, axes, storage })
    }
}

/// Half a step of the weights of a sampler, of 8 bits (Direct3D 11.3, 7.18.8), in texels.
pub(super) const FILTER: f64 = 1.0 / 512.0;

impl Shape {
    /// A texture with these axes: n·v along x, roughness or α across y, at least two texels along
    /// each.
    pub fn texture([x, y]: [AxisSpec; 2], size: [usize; 2], texels: Texels) -> Result<Shape> {
        let wrong = |what: &str, expected: &str, got: String| {
            Err(Error::bad_input(what, expected, got, "as in nov,sqrt,edges and roughness,edges"))
        };
        if x.parameter != Parameter::Nov {
            return wrong("x", "an axis of nov", format!("'{x}'"));
        }
        if !matches!(y.parameter, Parameter::Roughness | Parameter::Alpha) {
            return wrong("y", "an axis of roughness or alpha", format!("'{y}'"));
        }
        let is_plain = |axis: AxisSpec| {
            let is_smooth = !matches!(axis.mapping, Mapping::Square | Mapping::SqrtComplement);
            axis.clamp && axis.min == 0.0 && axis.max == f64::INFINITY && is_smooth
        };
        if !is_plain(x) || !is_plain(y) {
            let expected = "neither unclamped, min, max, square nor sqrt-complement";
            return wrong("axis", expected, format!("'{x}' and '{y}'"));
        }
        if size.iter().any(|&side| side < 2) {
            return wrong("size", "two texels or more", format!("{} x {}", size[0], size[1]));
        }
        Ok(Shape::Texture { x: Axis::new(x, size[0])?, y: Axis::new(y, size[1])?, texels })
    }
}

/// The place of a parameter among the texels of an axis, from 0 at the first to 1 at the last; what
/// lies beyond is clamped later.
pub(super) fn place_on<R: Real>(axis: &Axis, nov: R, roughness: R) -> R {
    let last = (axis.size() - 1) as f64;
    let parameter = match axis.spec().parameter {
        Parameter::Nov => nov,
        Parameter::Alpha => roughness * roughness,
        _ => roughness,
    };
    parameter.zip(parameter, |p, _| axis.texel(p) / last)
}
