//! Source code: the numbers of a table as an array, what has to be known of them as a comment, and
//! the functions that look them up.

use super::encoding::Notation;
use super::texels::Texels;
use super::{WriteSeek, failed};
use crate::error::Result;
use crate::lookup::{self, DEFAULT_ARRAY, DEFAULT_PREFIX, Language, Lookup, Store};
use crate::table::claim::Claim;
use crate::table::precision::Precision;

/// The most columns of a line of numbers.
const COLUMNS: usize = 100;

/// A kind of number in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Element {
    /// Whole numbers of so many bytes.
    Whole(usize),
    /// Decimals of f32.
    Float,
    /// The bits of an f32.
    Bits,
    /// The same with the suffix of an unsigned number, which shading languages ask for.
    UnsignedBits,
}

impl Element {
    /// Whether it is a value, and not as it is stored.
    fn is_decoded(self) -> bool {
        !matches!(self, Element::Whole(_))
    }
}

/// The array in a language: element, name, length, members.
type Array = fn(Element, &str, usize, &str) -> String;

/// C and C++.
pub fn h(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let includes = "#include <math.h>\n#include <stdint.h>\n#include <string.h>\n\n";
    let array: Array = |element, name, length, members| {
        let kind = ["uint8_t", "uint16_t", "uint32_t", "float"][place(element)];
        format!("static const {kind} {name}[{length}] = {{\n{members}\n}};\n")
    };
    // Two headers of tables with the same names clash, where guards would hide one.
    let parts = ["#pragma once\n\n", includes, ""];
    write(texels, file, Some(Language::C), stored(texels), array, parts)
}

/// Rust.
pub fn rs(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let array: Array = |element, name, length, members| {
        let kind = ["u8", "u16", "u32", "f32"][place(element)];
        let name = name.to_uppercase();
        format!("#[rustfmt::skip]\npub const {name}: [{kind}; {length}] = [\n{members}\n];\n")
    };
    write(texels, file, Some(Language::Rust), stored(texels), array, ["", "", ""])
}

/// A JavaScript module.
pub fn js(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let sizes = sizes(texels, "");
    write(texels, file, None, stored(texels), typed_array, ["", "", &sizes])
}

/// A TypeScript module.
pub fn ts(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let sizes = sizes(texels, " as const");
    write(texels, file, None, stored(texels), typed_array, ["", "", &sizes])
}

/// WGSL.
pub fn wgsl(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let array: Array = |element, name, length, members| {
        let kind = if element == Element::Float { "f32" } else { "u32" };
        format!("const {name} = array<{kind}, {length}>(\n{members}\n);\n")
    };
    write(texels, file, Some(Language::Wgsl), floats(texels), array, ["", "", ""])
}

/// GLSL.
pub fn glsl(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let array: Array = |element, name, length, members| {
        let kind = float_or_uint(element);
        format!("const {kind} {name}[{length}] = {kind}[{length}](\n{members}\n);\n")
    };
    write(texels, file, Some(Language::Glsl), floats(texels), array, ["", "", ""])
}

/// HLSL.
pub fn hlsl(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let array: Array = |element, name, length, members| {
        let kind = float_or_uint(element);
        format!("static const {kind} {name}[{length}] = {{\n{members}\n}};\n")
    };
    write(texels, file, Some(Language::Hlsl), floats(texels), array, ["", "", ""])
}

/// Metal.
pub fn metal(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    let array: Array = |element, name, length, members| {
        let kind = float_or_uint(element);
        format!("constant {kind} {name}[{length}] = {{\n{members}\n}};\n")
    };
    write(texels, file, Some(Language::Msl), floats(texels), array, ["", "", ""])
}

/// The numbers alone, with commas between, to be included between the brackets of an array.
pub fn txt(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    write_members(texels, file, stored(texels))?;
    file.write_all(b"\n").map_err(failed)
}

/// The kind of number in languages of the CPU.
fn stored(texels: &Texels) -> Element {
    let bytes = texels.precision().bytes();
    match (texels.encoding.style().numbers, texels.precision()) {
        (Notation::Decimals, _) | (Notation::Stored, Precision::F32) => Element::Float,
        (Notation::Bits, Precision::F32) => Element::Bits,
        (_, Precision::A2b10g10r10) => Element::Whole(4),
        (_, Precision::Rgbd8) => Element::Whole(1),
        (Notation::Stored | Notation::Bits, _) => Element::Whole(bytes),
    }
}

/// The kind of number in shading languages, which have floats of 32 bits alone.
fn floats(texels: &Texels) -> Element {
    match texels.encoding.style().numbers {
        Notation::Bits => Element::UnsignedBits,
        Notation::Stored | Notation::Decimals => Element::Float,
    }
}

/// The place of an element's type among those of 8, 16 and 32 bits and floats.
fn place(element: Element) -> usize {
    match element {
        Element::Whole(1) => 0,
        Element::Whole(2) => 1,
        Element::Whole(_) | Element::Bits | Element::UnsignedBits => 2,
        Element::Float => 3,
    }
}

/// The type of an element in the shading languages that are like C.
fn float_or_uint(element: Element) -> &'static str {
    if element == Element::Float { "float" } else { "uint" }
}

/// A typed array of JavaScript; floats by their bits are read from the buffer of those.
fn typed_array(element: Element, name: &str, _: usize, members: &str) -> String {
    let kind = ["Uint8Array", "Uint16Array", "Uint32Array", "Float32Array"][place(element)];
    let array = format!("new {kind}([\n{members}\n])");
    match element {
        Element::Bits => {
            format!("export const {name} = new Float32Array({array}.buffer);\n")
        }
        Element::Whole(_) | Element::Float | Element::UnsignedBits => {
            format!("export const {name} = {array};\n")
        }
    }
}

/// Columns, rows, slices and the names of channels as constants of a module.
fn sizes(texels: &Texels, constant: &str) -> String {
    let [width, height, depth] = texels.size();
    let components = components(texels, stored(texels));
    let names = texels.table.channels().iter().map(|channel| format!("'{}'", channel.name));
    let names = names.collect::<Vec<_>>().join(", ");
    format!(
        "\nexport const width = {width};\nexport const height = {height};\nexport const depth = \
         {depth};\nexport const components = {components};\nexport const channels = \
         [{names}]{constant};\n"
    )
}

/// The names of the array and of what begins those of its functions.
fn names<'a>(texels: &'a Texels) -> (&'a str, &'a str) {
    match texels.encoding.style().symbol.as_deref() {
        Some(symbol) => (symbol, symbol),
        None => (DEFAULT_ARRAY, DEFAULT_PREFIX),
    }
}

/// Components of a texel in an array: decimals have values alone, no divisor of RGBD.
fn components(texels: &Texels, element: Element) -> usize {
    match (texels.precision(), element.is_decoded()) {
        (Precision::Rgbd8, true) => texels.table.channels().len(),
        _ => texels.components(),
    }
}

/// Writes comment, array and lookup, and what stands before, between and behind them.
fn write(
    texels: &Texels,
    file: &mut dyn WriteSeek,
    language: Option<Language>,
    element: Element,
    array: Array,
    [head, includes, end]: [&str; 3],
) -> Result<()> {
    let [width, height, depth] = texels.size();
    let components = components(texels, element);
    let (name, prefix) = names(texels);
    let packed = texels.precision() == Precision::A2b10g10r10 && element == Element::Whole(4);
    let length = width * height * depth * if packed { 1 } else { components };
    // Everything but the numbers is short.
    let with_mark = array(element, name, length, "\0");
    let (before, behind) = with_mark.split_once('\0').unwrap_or((&with_mark, ""));
    let mut say = |text: &str| file.write_all(text.as_bytes()).map_err(failed);
    say(head)?;
    for line in about(texels) {
        say(&format!("// {line}\n"))?;
    }
    say(&format!("\n{includes}{before}"))?;
    write_members(texels, file, element)?;
    let mut say = |text: &str| file.write_all(text.as_bytes()).map_err(failed);
    say(behind)?;
    if let Some(language) = language {
        let array = if language == Language::Rust { name.to_uppercase() } else { name.to_owned() };
        let lookup = Lookup {
            layout: texels.table.layout(),
            precision: if element.is_decoded() { Precision::F32 } else { texels.precision() },
            slices_as: texels.encoding.style().slices,
            components,
            prefix,
            array: &array,
            by_bits: matches!(element, Element::Bits | Element::UnsignedBits),
            about: vec![],
        };
        say(&lookup.code(language, Store::Above, &[])?)?;
    }
    say(end)
}

/// What a reader has to know of the array.
fn about(texels: &Texels) -> Vec<String> {
    let [width, height, depth] = texels.size();
    let table = texels.table;
    let mut lines = lookup::about(table.layout(), &texels.about_components(), &texels.command());
    lines.push(format!(
        "{width} x {height} x {depth} texels, slice by slice and row by row, components side by \
         side, in {}",
        texels.precision()
    ));
    for slice in 0..depth {
        for part in table.parts(slice) {
            let promise = match &part.claim {
                Claim::Certificate(certificate) => {
                    format!("certified: {}; BLAKE3 {}", certificate.promise, certificate.blake3)
                }
                Claim::Fitted { filter, measured_error: (error, points), .. } => format!(
                    "fitted, read as a {filter}: E(F0) errs by {error:.1e}, measured at {points} \
                     points"
                ),
                Claim::Estimated { estimator, measured_error: (error, _) } => {
                    format!("not certified: by {estimator}, its integrals off by {error:.1e}")
                }
                Claim::Uncertified { rule, error_bound, .. } => {
                    format!("not certified: by rule {rule}, within {error_bound:.1e}")
                }
            };
            let names: Vec<&str> =
                part.channels.iter().map(|&channel| &*table.channels()[channel].name).collect();
            lines.push(format!("{} {promise}", names.join(", ")));
        }
    }
    lines
}

/// Writes the numbers in lines.
fn write_members(texels: &Texels, file: &mut dyn WriteSeek, element: Element) -> Result<()> {
    let [_, height, depth] = texels.size();
    let mut line = String::new();
    let last = (depth - 1, height - 1);
    for (slice, j) in (0..depth).flat_map(|slice| (0..height).map(move |j| (slice, j))) {
        for member in members(texels, element, slice, j) {
            if line.len() + member.len() + 2 > COLUMNS {
                line.push('\n');
                file.write_all(line.as_bytes()).map_err(failed)?;
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += &member;
            line.push(',');
        }
        // A row begins a line, and the last number has no comma, which GLSL and WGSL refuse.
        if (slice, j) == last {
            line.pop();
        } else {
            line.push('\n');
        }
        file.write_all(line.as_bytes()).map_err(failed)?;
        line.clear();
    }
    Ok(())
}

/// The numbers of a row.
fn members(texels: &Texels, element: Element, slice: usize, j: usize) -> Vec<String> {
    let Element::Whole(bytes) = element else {
        let values = values(texels, components(texels, element), slice, j);
        return values.map(|value| float(element, value)).collect();
    };
    let halves = texels.precision() == Precision::F16;
    let row = texels.row(slice, j);
    let whole = |bytes: &[u8]| {
        let number = bytes.iter().rev().fold(0u32, |number, byte| number << 8 | u32::from(*byte));
        match bytes.len() {
            2 if halves => format!("0x{number:04x}"),
            4 => format!("0x{number:08x}"),
            _ => number.to_string(),
        }
    };
    row.chunks_exact(bytes).map(whole).collect()
}

/// The components of a row as the values that they stand for.
fn values(texels: &Texels, components: usize, slice: usize, j: usize) -> impl Iterator<Item = f32> {
    let (table, channels) = (texels.table, texels.table.channels().len());
    (0..table.x().size()).flat_map(move |i| {
        (0..components).map(move |component| match component {
            component if component < channels => table.value(slice, i, j, component) as f32,
            3 => 1.0,
            _ => 0.0,
        })
    })
}

/// The shortest decimals that read back to the same f32, through f64 too, or its bits.
fn float(element: Element, value: f32) -> String {
    match element {
        Element::Bits => return format!("0x{:08x}", value.to_bits()),
        Element::UnsignedBits => return format!("0x{:08x}u", value.to_bits()),
        Element::Float | Element::Whole(_) => (),
    }
    let shortest = format!("{value:?}");
    match shortest.parse::<f64>() {
        Ok(through) if through as f32 == value => shortest,
        _ => format!("{:?}", f64::from(value)),
    }
}
