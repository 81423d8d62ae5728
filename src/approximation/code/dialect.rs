//! What code of approximations needs to say beyond lookups in textures, in the words of each
//! language. Shading languages compute both channels at once; C and Rust one after the other.

use crate::lookup::Language;
use crate::lookup::syntax::{self, Syntax};

/// A language.
pub struct Dialect {
    /// What it has in common with lookups in textures.
    pub syntax: &'static Syntax,
    /// Which it is.
    pub language: Language,
    /// The type of an index.
    pub index: &'static str,
    /// What ends an index, and a word of bits.
    pub suffixes: [&'static str; 2],
    /// An array above the code: whether of floats, its name, its length, its members.
    pub array: fn(bool, &str, usize, &str) -> String,
    /// The smaller of two.
    pub min: fn(&str, &str) -> String,
    /// x^p
    pub power: fn(&str, &str) -> String,
    /// ln x
    pub log: fn(&str) -> String,
    /// ∛x
    pub cbrt: fn(&str, &str) -> String,
    /// The whole part of a float from 0 on, but no more than the index `last`.
    pub whole: fn(&str, usize) -> String,
    /// The float of an index or a word.
    pub float: fn(&str) -> String,
}

/// The dialect of a language.
pub fn of(language: Language) -> &'static Dialect {
    match language {
        Language::Wgsl => &WGSL,
        Language::Glsl => &GLSL,
        Language::Hlsl => &HLSL,
        Language::Msl => &MSL,
        Language::C => &C,
        Language::Rust => &RUST,
    }
}

/// The type of an array's members in the shading languages that are like C.
fn member(floats: bool) -> &'static str {
    if floats { "float" } else { "uint" }
}

const GLSL: Dialect = Dialect {
    syntax: &syntax::GLSL,
    language: Language::Glsl,
    index: "uint",
    suffixes: ["u", "u"],
    // The default precision of ES may hold no more than 16 bits.
    array: |floats, name, length, members| {
        let kind = member(floats);
        format!("const highp {kind} {name}[{length}] = {kind}[{length}](\n{members}\n);")
    },
    min: |x, y| format!("min({x}, {y})"),
    power: |x, p| format!("pow({x}, {p})"),
    log: |x| format!("log({x})"),
    cbrt: |x, third| format!("pow({x}, {third})"),
    whole: |x, last| format!("min(uint({x}), {last}u)"),
    float: |x| format!("float({x})"),
};

const HLSL: Dialect = Dialect {
    syntax: &syntax::HLSL,
    language: Language::Hlsl,
    array: |floats, name, length, members| {
        format!("static const {} {name}[{length}] = {{\n{members}\n}};", member(floats))
    },
    ..GLSL
};

const MSL: Dialect = Dialect {
    syntax: &syntax::MSL,
    language: Language::Msl,
    array: |floats, name, length, members| {
        format!("constant {} {name}[{length}] = {{\n{members}\n}};", member(floats))
    },
    ..GLSL
};

const WGSL: Dialect = Dialect {
    syntax: &syntax::WGSL,
    language: Language::Wgsl,
    index: "u32",
    // SPIR-V cannot index a constant: naga copies a whole `const` array into a variable of the
    // function at each such place, and llvmpipe takes minutes to compile the copies of a net of 8
    // by 8 pairs of floats. A private variable is indexed where it lies. WebGPU promises 8,192
    // bytes of them: the 28 by 42 control points of a plan take 4,704, and 28 floats for each of
    // 64 materials take 7,168.
    array: |floats, name, length, members| {
        let kind = if floats { "f32" } else { "u32" };
        format!("var<private> {name} = array<{kind}, {length}>(\n{members}\n);")
    },
    whole: |x, last| format!("min(u32({x}), {last}u)"),
    float: |x| format!("f32({x})"),
    ..GLSL
};

const C: Dialect = Dialect {
    syntax: &syntax::C,
    language: Language::C,
    index: "unsigned",
    array: |floats, name, length, members| {
        let kind = if floats { "float" } else { "uint32_t" };
        format!("static const {kind} {name}[{length}] = {{\n{members}\n}};")
    },
    min: |x, y| format!("fminf({x}, {y})"),
    power: |x, p| format!("powf({x}, {p})"),
    log: |x| format!("logf({x})"),
    cbrt: |x, _| format!("cbrtf({x})"),
    whole: |x, last| format!("(unsigned)fminf({x}, {last}.0f)"),
    float: |x| format!("(float){}", grouped(x)),
    ..GLSL
};

const RUST: Dialect = Dialect {
    syntax: &syntax::RUST,
    language: Language::Rust,
    index: "usize",
    suffixes: ["", ""],
    array: |floats, name, length, members| {
        let kind = if floats { "f32" } else { "u32" };
        format!("#[rustfmt::skip]\nstatic {name}: [{kind}; {length}] = [\n{members}\n];")
    },
    min: |x, y| format!("f32::min({x}, {y})"),
    power: |x, p| format!("f32::powf({x}, {p})"),
    log: |x| format!("f32::ln({x})"),
    cbrt: |x, _| format!("f32::cbrt({x})"),
    whole: |x, last| format!("({x} as usize).min({last})"),
    float: |x| format!("{} as f32", grouped(x)),
};

/// In brackets, where it is more than a name.
fn grouped(x: &str) -> String {
    if x.chars().all(char::is_alphanumeric) { x.to_owned() } else { format!("({x})") }
}

impl Dialect {
    /// Whether it computes one channel after the other.
    pub fn is_host(&self) -> bool {
        matches!(self.language, Language::C | Language::Rust)
    }

    /// A number, by the shortest decimals that read back to the same f32, through f64 too.
    pub fn number(&self, value: f64) -> String {
        let exact = f64::from(value as f32);
        let shortest = format!("{:?}", value as f32).parse().unwrap_or(exact);
        let same = f64::from(shortest as f32) == exact;
        (self.syntax.words.number)(if same { shortest } else { exact })
    }

    /// An index.
    pub fn whole_number(&self, value: usize) -> String {
        format!("{value}{}", self.suffixes[0])
    }

    /// x scale + offset, as short as these allow.
    pub fn affine(&self, x: &str, scale: f64, offset: f64) -> String {
        let scaled = match scale {
            1.0 => x.to_owned(),
            scale => format!("{x} * {}", self.number(scale)),
        };
        match offset {
            0.0 => scaled,
            offset if offset < 0.0 => format!("{scaled} - {}", self.number(-offset)),
            offset => format!("{scaled} + {}", self.number(offset)),
        }
    }

    /// x between two numbers; what is no number becomes the lower where max does so.
    pub fn clamped(&self, x: &str, low: f64, high: f64) -> String {
        let from_low = (self.syntax.words.max)(x, &self.number(low));
        (self.min)(&from_low, &self.number(high))
    }

    /// A local value: its type, its name, its value.
    pub fn local(&self, kind: &str, name: &str, value: &str) -> String {
        (self.syntax.local)(kind, name, value)
    }

    /// A local value that changes.
    pub fn variable(&self, kind: &str, name: &str, value: &str) -> String {
        match self.language {
            Language::Wgsl => format!("var {name} = {value};"),
            Language::Rust => format!("let mut {name} = {value};"),
            _ => format!("{kind} {name} = {value};"),
        }
    }

    /// The type of the weights of a span.
    pub fn weights(&self, degree: usize) -> String {
        match self.language {
            Language::C => "float".into(),
            Language::Rust => format!("[f32; {}]", degree + 1),
            _ => [self.syntax.float2, self.syntax.float3, self.syntax.float4][degree - 1].into(),
        }
    }

    /// A component of weights or, but in C, of a pair.
    pub fn component(&self, vector: &str, index: usize) -> String {
        match self.is_host() {
            true => format!("{vector}[{index}]"),
            false => format!("{vector}.{}", ["x", "y", "z", "w"][index]),
        }
    }

    /// A component of a pair.
    pub fn of_pair(&self, pair: &str, index: usize) -> String {
        match self.language {
            Language::C => format!("{pair}.{}", ["x", "y"][index]),
            _ => self.component(pair, index),
        }
    }

    /// What returns a pair, by the name of its type.
    pub fn return_pair(&self, kind: &str, [x, y]: [&str; 2]) -> Vec<String> {
        match self.language {
            // On a line of its own, where both are long.
            Language::C if x.len() + y.len() > 40 => vec![
                format!("{kind} pair;"),
                format!("pair.x = {x};"),
                format!("pair.y = {y};"),
                "return pair;".into(),
            ],
            Language::C => vec![format!("{kind} pair = {{{x}, {y}}};"), "return pair;".into()],
            Language::Rust => vec![format!("return [{x}, {y}];")],
            _ => vec![format!("return {kind}({x}, {y});")],
        }
    }
}
