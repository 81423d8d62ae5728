//! Where a parameter lies along an axis, as an expression in the words of a language: the inverse
//! of [`Axis::value`] where that does not clamp.

use super::{Axis, AxisSpec, Mapping, Nodes, Parameter};

impl Axis {
    /// The factor and the shift that carry t to the fractional texel.
    pub fn texels(&self) -> (f64, f64) {
        let n = self.size as f64;
        let (scale, offset) = match self.spec.nodes {
            Nodes::Edges => ((n - 1.0).max(1.0), 0.0),
            Nodes::Offset(offset) => (n, -offset),
        };
        if self.spec.flip { (-scale, n - 1.0 - offset) } else { (scale, offset) }
    }

    /// t at the parameter `p`, as an expression in a language with these words for √, log₂ and
    /// numbers. The variable of an exponent is n itself.
    fn t_at(&self, p: &str, words: &Words) -> String {
        let p = match self.spec.parameter {
            // p = log10(n)/7
            Parameter::Exponent => {
                let factor = (words.number)(std::f64::consts::LOG10_2 / 7.0);
                format!("({} * {factor})", (words.log2)(p))
            }
            Parameter::Ior => return self.t_at_ior(p, words),
            Parameter::Nov
            | Parameter::Critical
            | Parameter::Roughness
            | Parameter::Alpha
            | Parameter::F0
            | Parameter::Control => p.to_owned(),
        };
        self.t_of(p, words)
    }

    /// The same at the index of refraction `n`.
    fn t_at_ior(&self, n: &str, words: &Words) -> String {
        let AxisSpec { min, max, .. } = self.spec;
        let number = words.number;
        let one = number(1.0);
        match self.spec.mapping {
            Mapping::Linear | Mapping::Sqrt | Mapping::Square | Mapping::SqrtComplement => {
                let p = format!("({n} - {}) * {}", number(min), number(1.0 / (max - min)));
                self.t_of(format!("({p})"), words)
            }
            Mapping::SqrtF0 => {
                let root = format!("({n} - {one}) / ({n} + {one})");
                let z = (words.sqrt)(&(words.max)(&root, &number(0.0)));
                let (z0, z1) = self.ends_of_z();
                format!("({z} - {}) * {}", number(z0), number(1.0 / (z1 - z0)))
            }
            Mapping::Piecewise => {
                // n = min(n, 1) + max(n, 1) - 1.
                let above = (words.max)(n, &one);
                let [below, beyond] = [max, 1.0].map(|scale| number(0.5 * scale / (max - 1.0)));
                format!(
                    "({n} + {one} - {above} - {}) * {below} + ({above} - {one}) * {beyond}",
                    number(1.0 / max)
                )
            }
        }
    }

    /// t at p in [0, 1].
    fn t_of(&self, p: String, words: &Words) -> String {
        let zero = (words.number)(0.0);
        match self.spec.mapping {
            Mapping::Linear => p,
            Mapping::Sqrt => (words.sqrt)(&(words.max)(&p, &zero)),
            Mapping::Square => format!("({p}) * ({p})"),
            Mapping::SqrtComplement => {
                let complement = format!("{} - {p}", (words.number)(1.0));
                (words.sqrt)(&(words.max)(&complement, &zero))
            }
            // Of an index of refraction alone.
            Mapping::SqrtF0 | Mapping::Piecewise => p,
        }
    }

    /// The fractional texel at a parameter, as an expression of it: see [`Axis::texel`].
    pub fn texel_at(&self, p: &str, words: &Words) -> String {
        affine(&self.t_at(p, words), self.texels(), words)
    }

    /// The texture coordinate in [0, 1] at a parameter, as an expression in the variable `p`: the
    /// inverse of [`Axis::value`] where that does not clamp. The same text is valid in WGSL, GLSL,
    /// HLSL and Metal. The variable of an exponent is n itself.
    pub fn uv(&self, p: &str) -> String {
        self.uv_at(p, &SHADING)
    }

    /// The same in the words of a language.
    pub fn uv_at(&self, p: &str, words: &Words) -> String {
        // A sampler finds the centre of texel i at (i + 1/2)/N.
        let (n, (scale, offset)) = (self.size as f64, self.texels());
        affine(&self.t_at(p, words), (scale / n, (offset + 0.5) / n), words)
    }
}

/// The words of a language for what the place along an axis needs.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// √x
    pub sqrt: fn(&str) -> String,
    /// log₂ x
    pub log2: fn(&str) -> String,
    /// The larger of two.
    pub max: fn(&str, &str) -> String,
    /// A number.
    pub number: fn(f64) -> String,
}

/// The words of WGSL, GLSL, HLSL and Metal.
pub const SHADING: Words = Words {
    sqrt: |x| format!("sqrt({x})"),
    log2: |x| format!("log2({x})"),
    max: |x, y| format!("max({x}, {y})"),
    number: |x| format!("{x:?}"),
};

/// `t` times a scale plus an offset.
fn affine(t: &str, (scale, offset): (f64, f64), words: &Words) -> String {
    let scaled = match scale {
        1.0 => t.to_owned(),
        scale => format!("{t} * {}", (words.number)(scale)),
    };
    match offset {
        0.0 => scaled,
        offset if offset < 0.0 => format!("{scaled} - {}", (words.number)(-offset)),
        offset => format!("{scaled} + {}", (words.number)(offset)),
    }
}
