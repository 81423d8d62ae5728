//! The languages in words: what differs between them, and nothing else. C and Rust have no
//! textures.

use super::Language;
use crate::table::axis::{SHADING, Words};

/// The shape of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Two dimensions.
    Plane,
    /// An array of such.
    Layers,
    /// Three dimensions.
    Volume,
}

/// The words of a language.
pub fn of(language: Language) -> &'static Syntax {
    match language {
        Language::Wgsl => &WGSL,
        Language::Glsl => &GLSL,
        Language::Hlsl => &HLSL,
        Language::Msl => &MSL,
        Language::C => &C,
        Language::Rust => &RUST,
    }
}

/// A language.
pub struct Syntax {
    /// The words of arithmetic.
    pub words: Words,
    /// float, vec2, vec3, vec4 and int.
    pub float: &'static str,
    pub float2: &'static str,
    pub float3: &'static str,
    pub float4: &'static str,
    pub int: &'static str,
    /// The blend of two values.
    pub mix: &'static str,
    /// The type of a texture of each shape.
    pub texture: fn(Shape) -> &'static str,
    /// The type of a sampler, where it is none of the texture's.
    pub sampler: Option<&'static str>,
    /// A parameter of a function: its name and its type.
    pub parameter: fn(&str, &str) -> String,
    /// The head of a function: its type, its name, its parameters.
    pub function: fn(&str, &str, &str) -> String,
    /// A local value: its type, its name, its value.
    pub local: fn(&str, &str, &str) -> String,
    /// A local variable without a value: its type, its name.
    pub variable: fn(&str, &str) -> String,
    /// A member of a struct: its type, its name.
    pub member: fn(&str, &str) -> String,
    /// What ends a struct.
    pub struct_end: &'static str,
    /// A texel of the texture `table` at column, row and slice.
    pub fetch: fn(Shape, &str, &str, &str) -> String,
    /// The texture `table` through its sampler at `uv`, in a slice.
    pub sample: fn(Shape, &str, &str) -> String,
    /// The float of 32 bits.
    pub float_of_bits: &'static str,
}

/// What C, C++ and their shading languages have in common.
const C_LIKE: Syntax = Syntax {
    words: SHADING,
    float: "float",
    float2: "float2",
    float3: "float3",
    float4: "float4",
    int: "int",
    mix: "lerp",
    texture: |_| "",
    sampler: None,
    parameter: |name, kind| format!("{kind} {name}"),
    function: |kind, name, parameters| format!("{kind} {name}({parameters}) {{"),
    local: |kind, name, value| format!("{kind} {name} = {value};"),
    variable: |kind, name| format!("{kind} {name};"),
    member: |kind, name| format!("{kind} {name};"),
    struct_end: "};",
    fetch: |_, _, _, _| String::new(),
    sample: |_, _, _| String::new(),
    float_of_bits: "asfloat",
};

pub const GLSL: Syntax = Syntax {
    float2: "vec2",
    float3: "vec3",
    float4: "vec4",
    mix: "mix",
    // ES has no default precision for all of them.
    texture: |shape| match shape {
        Shape::Plane => "highp sampler2D",
        Shape::Layers => "highp sampler2DArray",
        Shape::Volume => "highp sampler3D",
    },
    fetch: |shape, i, j, k| match shape {
        Shape::Plane => format!("texelFetch(table, ivec2({i}, {j}), 0)"),
        Shape::Layers | Shape::Volume => format!("texelFetch(table, ivec3({i}, {j}, {k}), 0)"),
    },
    sample: |shape, uv, k| match shape {
        Shape::Plane => format!("textureLod(table, {uv}, 0.0)"),
        Shape::Layers | Shape::Volume => format!("textureLod(table, vec3({uv}, {k}), 0.0)"),
    },
    float_of_bits: "uintBitsToFloat",
    ..C_LIKE
};

pub const HLSL: Syntax = Syntax {
    texture: |shape| match shape {
        Shape::Plane => "Texture2D<float4>",
        Shape::Layers => "Texture2DArray<float4>",
        Shape::Volume => "Texture3D<float4>",
    },
    sampler: Some("SamplerState"),
    fetch: |shape, i, j, k| match shape {
        Shape::Plane => format!("table.Load(int3({i}, {j}, 0))"),
        Shape::Layers | Shape::Volume => format!("table.Load(int4({i}, {j}, {k}, 0))"),
    },
    sample: |shape, uv, k| match shape {
        Shape::Plane => format!("table.SampleLevel(table_sampler, {uv}, 0.0)"),
        Shape::Layers | Shape::Volume => {
            format!("table.SampleLevel(table_sampler, float3({uv}, {k}), 0.0)")
        }
    },
    ..C_LIKE
};

pub const MSL: Syntax = Syntax {
    // A header may be in several files.
    function: |kind, name, parameters| format!("static inline {kind} {name}({parameters}) {{"),
    words: Words { number: |x| format!("{x:?}f"), ..SHADING },
    mix: "mix",
    texture: |shape| match shape {
        Shape::Plane => "texture2d<float>",
        Shape::Layers => "texture2d_array<float>",
        Shape::Volume => "texture3d<float>",
    },
    sampler: Some("sampler"),
    fetch: |shape, i, j, k| match shape {
        Shape::Plane => format!("table.read(uint2({i}, {j}))"),
        Shape::Layers => format!("table.read(uint2({i}, {j}), uint({k}))"),
        Shape::Volume => format!("table.read(uint3({i}, {j}, {k}))"),
    },
    sample: |shape, uv, k| match shape {
        Shape::Plane => format!("table.sample(table_sampler, {uv}, level(0.0))"),
        Shape::Layers => format!("table.sample(table_sampler, {uv}, uint({k}), level(0.0))"),
        Shape::Volume => format!("table.sample(table_sampler, float3({uv}, {k}), level(0.0))"),
    },
    float_of_bits: "as_type<float>",
    ..C_LIKE
};

pub const WGSL: Syntax = Syntax {
    words: SHADING,
    float: "f32",
    float2: "vec2<f32>",
    float3: "vec3<f32>",
    float4: "vec4<f32>",
    int: "i32",
    mix: "mix",
    texture: |shape| match shape {
        Shape::Plane => "texture_2d<f32>",
        Shape::Layers => "texture_2d_array<f32>",
        Shape::Volume => "texture_3d<f32>",
    },
    sampler: Some("sampler"),
    parameter: |name, kind| format!("{name}: {kind}"),
    function: |kind, name, parameters| format!("fn {name}({parameters}) -> {kind} {{"),
    local: |_, name, value| format!("let {name} = {value};"),
    variable: |kind, name| format!("var {name}: {kind};"),
    member: |kind, name| format!("{name}: {kind},"),
    struct_end: "}",
    fetch: |shape, i, j, k| match shape {
        Shape::Plane => format!("textureLoad(table, vec2<i32>({i}, {j}), 0)"),
        Shape::Layers => format!("textureLoad(table, vec2<i32>({i}, {j}), {k}, 0)"),
        Shape::Volume => format!("textureLoad(table, vec3<i32>({i}, {j}, {k}), 0)"),
    },
    sample: |shape, uv, k| match shape {
        Shape::Plane => format!("textureSampleLevel(table, table_sampler, {uv}, 0.0)"),
        Shape::Layers => format!("textureSampleLevel(table, table_sampler, {uv}, i32({k}), 0.0)"),
        Shape::Volume => {
            format!("textureSampleLevel(table, table_sampler, vec3<f32>({uv}, {k}), 0.0)")
        }
    },
    float_of_bits: "bitcast<f32>",
};

pub const C: Syntax = Syntax {
    function: MSL.function,
    words: Words {
        sqrt: |x| format!("sqrtf({x})"),
        log2: |x| format!("log2f({x})"),
        max: |x, y| format!("fmaxf({x}, {y})"),
        number: |x| format!("{x:?}f"),
    },
    ..C_LIKE
};

pub const RUST: Syntax = Syntax {
    words: Words {
        sqrt: |x| format!("f32::sqrt({x})"),
        log2: |x| format!("f32::log2({x})"),
        max: |x, y| format!("f32::max({x}, {y})"),
        number: |x| format!("{x:?}"),
    },
    float: "f32",
    int: "i32",
    parameter: |name, kind| format!("{name}: {kind}"),
    function: |kind, name, parameters| format!("pub fn {name}({parameters}) -> {kind} {{"),
    local: |_, name, value| format!("let {name} = {value};"),
    ..C_LIKE
};
