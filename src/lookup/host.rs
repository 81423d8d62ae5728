//! Lookup code in C and Rust: on an array of the stored numbers, row by row. What a sampler needs
//! is its texture coordinate.

use super::fields::Field;
use super::{Lookup, Store, place, syntax};
use crate::table::axis::Words;
use crate::table::precision::Precision;
use std::fmt::Write;

/// The words of a language of the CPU.
struct Host {
    words: Words,
    /// The type of a whole number of 8, 16 and 32 bits, and of a float.
    types: [&'static str; 4],
    /// A power.
    power: fn(&str, &str) -> String,
    /// The smaller of two.
    min: fn(&str, &str) -> String,
    /// A float of a whole number.
    float: fn(&str) -> String,
    /// The float of 32 bits.
    float_of_bits: &'static str,
}

const C: Host = Host {
    words: syntax::C.words,
    types: ["uint8_t", "uint16_t", "uint32_t", "float"],
    power: |x, y| format!("powf({x}, {y})"),
    min: |x, y| format!("fminf({x}, {y})"),
    float: |x| format!("(float)({x})"),
    float_of_bits: "PREFIX_float",
};

const RUST: Host = Host {
    words: syntax::RUST.words,
    types: ["u8", "u16", "u32", "f32"],
    power: |x, y| format!("f32::powf({x}, {y})"),
    min: |x, y| format!("f32::min({x}, {y})"),
    float: |x| format!("({x}) as f32"),
    float_of_bits: "f32::from_bits",
};

impl Host {
    /// The type of an element of the array.
    fn element(&self, lookup: &Lookup) -> &'static str {
        let [byte, short, word, float] = self.types;
        match lookup.precision {
            _ if lookup.by_bits => word,
            Precision::F16 | Precision::Unorm16 => short,
            Precision::F32 | Precision::F64 => float,
            Precision::Unorm8 | Precision::Srgb8 | Precision::Rgbd8 => byte,
            Precision::A2b10g10r10 => word,
        }
    }

    /// The value of component `c` of the texel whose first element is at `at`, as an expression.
    fn value(&self, lookup: &Lookup, table: &str, component: &str) -> String {
        let number = self.words.number;
        let element = |index: &str| format!("{table}[at + {index}]");
        let unit = |most: f64| format!("{} / {}", (self.float)(&element(component)), number(most));
        match lookup.precision {
            Precision::F32 | Precision::F64 if lookup.by_bits => {
                let float = self.float_of_bits.replace("PREFIX", lookup.prefix);
                format!("{float}({})", element(component))
            }
            Precision::F32 | Precision::F64 => element(component),
            Precision::F16 => format!("{}({})", lookup.prefixed("half"), element(component)),
            Precision::Unorm16 => unit(65535.0),
            Precision::Unorm8 => unit(255.0),
            Precision::A2b10g10r10 => {
                let bits = format!("{table}[at] >> (10 * {component}) & 1023");
                format!("{} / {}", (self.float)(&bits), number(1023.0))
            }
            Precision::Srgb8 => format!("{}({})", lookup.prefixed("linear"), unit(255.0)),
            Precision::Rgbd8 => {
                let divisor = format!("({} / {})", (self.float)(&element("3")), number(255.0));
                let power = (self.power)(&unit(255.0), &number(2.2));
                format!("{power} / {divisor}")
            }
        }
    }

    /// A value clamped to the texels of an axis.
    fn clamped(&self, place: &str, size: usize) -> String {
        let number = self.words.number;
        (self.min)(&(self.words.max)(place, &number(0.0)), &number(size as f64 - 1.0))
    }

    /// The places along the axes, each clamped.
    fn places(&self, lookup: &Lookup) -> Vec<(&'static str, String)> {
        let layout = lookup.layout;
        let clamped = |axis| self.clamped(&place::along(axis, &self.words), axis.size());
        let mut places = vec![("x", clamped(&layout.x)), ("y", clamped(&layout.y))];
        if let Some(third) = lookup.third() {
            places.push(("z", self.clamped(&(third.place)(lookup, &self.words), lookup.depth())));
        }
        places
    }

    /// The fields from the blended components, line by line.
    fn assignments(&self, fields: &[Field]) -> String {
        let line = |field: &Field| {
            let value = field.value(|index| format!("texel[{index}]"), self.words.number);
            format!("    numbers.{} = {value};\n", field.name)
        };
        fields.iter().map(line).collect()
    }
}

/// Elements of a texel in the array.
fn elements(lookup: &Lookup) -> usize {
    if lookup.precision == Precision::A2b10g10r10 { 1 } else { lookup.components }
}

/// The channels that are stored, of which fields are made.
fn stored(lookup: &Lookup) -> usize {
    lookup.layout.channels.len()
}

/// The index of a texel's first element, by the names of its column, row and slice.
fn index(lookup: &Lookup, [column, row, slice]: [&str; 3]) -> String {
    let (width, height) = (lookup.layout.x.size(), lookup.layout.y.size());
    let row = match lookup.depth() {
        1 => row.to_owned(),
        _ => format!("({slice} * {height} + {row})"),
    };
    format!("({row} * {width} + {column}) * {}", elements(lookup))
}

/// The lookup in C.
pub fn c(lookup: &Lookup, fields: &[Field], store: Store) -> String {
    let (host, numbers, prefix) = (&C, lookup.numbers(), lookup.prefix);
    let element = host.element(lookup);
    let mut code = lookup.heading() + "\n";
    if store == Store::Passed {
        code += "\n#include <math.h>\n#include <stdint.h>\n#include <string.h>\n";
    }
    let members: String = fields
        .iter()
        .map(|field| format!("    float {}; // {}\n", field.name, field.meaning))
        .collect();
    let _ = write!(code, "\ntypedef struct {{\n{members}}} {numbers};\n");
    code += &C_DECODERS.of(lookup);
    let depth = lookup.depth();
    let third = lookup.third().map_or(String::new(), |third| format!(", float {}", third.name));
    let places: String = host
        .places(lookup)
        .into_iter()
        .map(|(name, place)| format!("    float {name} = {place};\n"))
        .collect();
    let (width, height) = (lookup.layout.x.size(), lookup.layout.y.size());
    let assignments = host.assignments(fields);
    let (parameter, table) = match store {
        Store::Passed => (format!("const {element} *table, "), "table"),
        Store::Above => (String::new(), lookup.array),
    };
    // What slices add.
    let [k, behind, share, slice] = match depth {
        1 => [String::new(), String::new(), String::new(), String::new()],
        _ => [
            "    int k = (int)z;\n".into(),
            ", behind = corner >> 2".into(),
            "\n            * (behind ? z - (float)k : 1.0f - (z - (float)k))".into(),
            format!("        int slice = k + behind < {depth} ? k + behind : k;\n"),
        ],
    };
    let _ = write!(
        code,
        "
// In full precision: the texels around a place, each by its share.
static inline {numbers} {prefix}_exact({parameter}float nov, float roughness{third}) {{
{places}    int i = (int)x, j = (int)y;
{k}    float texel[{stored}] = {{0}};
    for (int corner = 0; corner < {corners}; ++corner) {{
        int right = corner & 1, below = corner >> 1 & 1{behind};
        float share = (right ? x - (float)i : 1.0f - (x - (float)i))
            * (below ? y - (float)j : 1.0f - (y - (float)j)){share};
        int column = i + right < {width} ? i + right : i;
        int row = j + below < {height} ? j + below : j;
{slice}        int at = {at};
        for (int c = 0; c < {stored}; ++c) {{
            texel[c] += share * ({value});
        }}
    }}
    {numbers} numbers;
{assignments}    return numbers;
}}

// The texture coordinate for a sampler that is linear and clamps to the edge.
static inline void {prefix}_uv(float nov, float roughness, float uv[2]) {{
    uv[0] = {u};
    uv[1] = {v};
}}
",
        stored = stored(lookup),
        corners = if depth > 1 { 8 } else { 4 },
        at = index(lookup, ["column", "row", "slice"]),
        value = host.value(lookup, table, "c"),
        u = place::uv(&lookup.layout.x, &host.words),
        v = place::uv(&lookup.layout.y, &host.words),
    );
    code
}

/// The lookup in Rust.
pub fn rust(lookup: &Lookup, fields: &[Field], store: Store) -> String {
    let (host, numbers, prefix) = (&RUST, lookup.numbers(), lookup.prefix);
    let element = host.element(lookup);
    let mut code = lookup.heading() + "\n";
    let members: String = fields
        .iter()
        .map(|field| format!("    /// {}\n    pub {}: f32,\n", field.meaning, field.name))
        .collect();
    let _ = write!(
        code,
        "\n/// The numbers of a lookup.\n#[allow(non_snake_case, non_camel_case_types, \
         reason = \"these are their names\")]\n\
         #[derive(Clone, Copy, Debug, Default, PartialEq)]\npub struct {numbers} {{\n{members}}}\n"
    );
    code += &RUST_DECODERS.of(lookup);
    let depth = lookup.depth();
    let third = lookup.third().map_or(String::new(), |third| format!(", {}: f32", third.name));
    let places: String = host
        .places(lookup)
        .into_iter()
        .map(|(name, place)| format!("    let {name} = {place};\n"))
        .collect();
    // What slices add.
    let [k, behind, share, slice] = match depth {
        1 => [String::new(), String::new(), String::new(), String::new()],
        _ => [
            "    let k = z as usize;\n".into(),
            "        let behind = corner >> 2;\n".into(),
            " * share(z - k as f32, behind)".into(),
            format!("        let k = (k + behind).min({});\n", depth - 1),
        ],
    };
    let assignments = host.assignments(fields);
    let (parameter, table) = match store {
        Store::Passed => (format!("table: &[{element}], "), "table"),
        Store::Above => (String::new(), lookup.array),
    };
    let allowed = match prefix.to_lowercase() == prefix {
        true => "",
        false => "#[allow(non_snake_case, reason = \"it begins with the array's name\")]\n",
    };
    let _ = write!(
        code,
        "
/// In full precision: the texels around a place, each by its share.
{allowed}pub fn {prefix}_exact({parameter}nov: f32, roughness: f32{third}) -> {numbers} {{
{places}    let (i, j) = (x as usize, y as usize);
{k}    let share = |weight: f32, far: usize| if far == 1 {{ weight }} else {{ 1.0 - weight }};
    let mut texel = [0.0f32; {stored}];
    for corner in 0..{corners} {{
        let (right, below) = (corner & 1, corner >> 1 & 1);
{behind}        let share = share(x - i as f32, right) * share(y - j as f32, below){share};
        let (i, j) = ((i + right).min({width}), (j + below).min({height}));
{slice}        let at = {at};
        for (c, sum) in texel.iter_mut().enumerate() {{
            *sum += share * ({value});
        }}
    }}
    let mut numbers = {numbers}::default();
{assignments}    numbers
}}

/// The texture coordinate for a sampler that is linear and clamps to the edge.
{allowed}pub fn {prefix}_uv(nov: f32, roughness: f32) -> [f32; 2] {{
    [{u}, {v}]
}}
",
        stored = stored(lookup),
        corners = if depth > 1 { 8 } else { 4 },
        width = lookup.layout.x.size() - 1,
        height = lookup.layout.y.size() - 1,
        at = index(lookup, ["i", "j", "k"]),
        value = host.value(lookup, table, "c"),
        u = place::uv(&lookup.layout.x, &host.words),
        v = place::uv(&lookup.layout.y, &host.words),
    );
    code
}

/// The functions that decode a stored number, where it takes more than an expression.
struct Decoders {
    half: &'static str,
    linear: &'static str,
    float: &'static str,
}

impl Decoders {
    fn of(&self, lookup: &Lookup) -> String {
        let text = match lookup.precision {
            Precision::F16 => self.half,
            Precision::Srgb8 => self.linear,
            _ if lookup.by_bits => self.float,
            _ => "",
        };
        text.replace("PREFIX", lookup.prefix)
    }
}

const C_DECODERS: Decoders = Decoders {
    half: "
// The value of a half: its exponent is moved from a bias of 15 to one of 127 by a product, which
// makes normal numbers of subnormal ones too.
static inline float PREFIX_half(uint16_t half) {
    uint32_t bits = (uint32_t)(half & 0x7fff) << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    value *= 5.192296858534828e33f; // 2^112
    return half & 0x8000 ? -value : value;
}
",
    linear: "
// The linear value on the curve of sRGB.
static inline float PREFIX_linear(float code) {
    return code <= 0.04045f ? code / 12.92f : powf((code + 0.055f) / 1.055f, 2.4f);
}
",
    float: "
// The float of its bits.
static inline float PREFIX_float(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
",
};

const RUST_DECODERS: Decoders = Decoders {
    half: "
/// The value of a half: its exponent is moved from a bias of 15 to one of 127 by a product, which
/// makes normal numbers of subnormal ones too.
#[allow(non_snake_case, reason = \"it begins as the others do\")]
fn PREFIX_half(half: u16) -> f32 {
    let value = f32::from_bits(u32::from(half & 0x7fff) << 13) * 5.192_296_9e33; // 2^112
    if half & 0x8000 == 0 { value } else { -value }
}
",
    linear: "
/// The linear value on the curve of sRGB.
#[allow(non_snake_case, reason = \"it begins as the others do\")]
fn PREFIX_linear(code: f32) -> f32 {
    if code <= 0.04045 { code / 12.92 } else { f32::powf((code + 0.055) / 1.055, 2.4) }
}
",
    float: "",
};
