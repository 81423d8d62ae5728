//! The array of numbers, and the function that reads one of them.

use super::functions::Functions;
use crate::approximation::{Region, Shape, Storage};
use crate::choice::Choice;
use crate::lookup::Language;

impl Functions<'_> {
    /// The array of numbers, below what has to be known of it.
    pub fn array(&self) -> String {
        let words = self.packing.words();
        let floats = self.packing.storage == Storage::F32;
        let [_, suffix] = self.dialect.suffixes;
        let member = |&word: &u32| match floats {
            true => self.dialect.number(f32::from_bits(word).into()),
            false => format!("0x{word:08x}{suffix}"),
        };
        let members: Vec<String> = words.iter().map(member).collect();
        let (name, rows) = (self.array_name(), self.rows(&members));
        let about: String = self.about().iter().map(|line| format!("// {line}\n")).collect();
        about + &(self.dialect.array)(floats, &name, members.len(), &rows)
    }

    /// What a reader has to know of the array.
    fn about(&self) -> Vec<String> {
        let Region { least_nov, roughness: [low, high] } = self.approximation.region;
        let material = match self.suffix.strip_prefix('_') {
            Some(material) => format!("Material {material}, for "),
            None => "For ".into(),
        };
        let nov =
            if least_nov > 0.0 { format!("n.v from {least_nov} on") } else { "every n.v".into() };
        let roughness = if low == high { format!("{low}") } else { format!("{low} to {high}") };
        let mut lines = vec![format!("{material}{nov} and perceptual roughness {roughness}.")];
        lines.push(match self.approximation.shape {
            Shape::Polynomial { .. } => "Number k is the factor of x^k.".into(),
            Shape::Surface { columns, .. } => {
                let y = self.surface_variable();
                format!("Number {columns} j + i is the factor of x^i {y}^j.")
            }
            Shape::Spline { size: [columns, _], .. } => format!(
                "Control point {columns} j + i is in column i along n.v and row j across roughness."
            ),
            Shape::Texture { .. } => "Texels, row by row.".into(),
        });
        let about = self.approximation.channels.about();
        let order = match about.split_once(" and ") {
            Some((first, rest)) => {
                format!(", {first} before {}", rest.split(' ').next().unwrap_or_default())
            }
            None => String::new(),
        };
        lines.push(match self.packing.storage {
            Storage::F32 => format!("Stored as floats{order}."),
            _ => format!(
                "Stored as codes of {} bits{order}, from the lowest bits of a word on.",
                self.packing.bits()
            ),
        });
        lines.push(format!(
            "{} alone reads them: they may come from a buffer instead.",
            self.name("number")
        ));
        lines
    }

    /// The name of the array.
    fn array_name(&self) -> String {
        let name =
            self.name(if self.packing.storage == Storage::F32 { "numbers" } else { "words" });
        if self.dialect.language == Language::Rust { name.to_uppercase() } else { name }
    }

    /// Members of the array in lines of a hundred columns; a row begins a line where it ends
    /// a word.
    fn rows(&self, members: &[String]) -> String {
        let columns = match self.approximation.shape {
            Shape::Polynomial { .. } => self.packing.count,
            Shape::Surface { columns, .. } | Shape::Spline { size: [columns, _], .. } => columns,
            Shape::Texture { x, .. } => x.size(),
        };
        let bits = columns * self.packing.channels() * self.packing.bits();
        let row = if bits.is_multiple_of(32) { bits / 32 } else { members.len() };
        let mut lines = Vec::new();
        for row in members.chunks(row.max(1)) {
            let mut line = String::new();
            for member in row {
                if line.len() + member.len() + 3 > 100 {
                    lines.push(std::mem::take(&mut line));
                }
                line += if line.is_empty() { "" } else { ", " };
                line += member;
            }
            lines.push(line);
        }
        lines.join(",\n")
    }

    /// The function that reads a number of the array: all channels of it, or channel c.
    pub fn number(&self) -> String {
        let (dialect, array) = (self.dialect, self.array_name());
        let channels = self.packing.channels();
        let lines = match self.packing.per_word() {
            None => match (channels, dialect.is_host()) {
                (1, _) => vec![format!("return {array}[k];")],
                (_, true) => {
                    vec![format!("return {array}[{} * k + c];", dialect.whole_number(2))]
                }
                (_, false) => {
                    let index = format!("{} * k", dialect.whole_number(2));
                    let next = self.plus(&index, 1);
                    dialect.return_pair(
                        &self.pair(),
                        [&format!("{array}[{index}]"), &format!("{array}[{next}]")],
                    )
                }
            },
            Some(_) if dialect.is_host() => self.host_code(),
            Some(per_word) => self.shader_code(per_word),
        };
        let what = if self.is_spline() { "control point" } else { "number" };
        let what = match self.packing.decode(0) {
            Some(_) if self.is_spline() => format!("The code of {what} k"),
            _ => format!("The {what} k"),
        };
        let channel = if self.in_pass(()).is_some() { ", channel c" } else { "" };
        let about = format!("{what}{channel}.");
        self.internal(&about, "number", &[("k", dialect.index)], lines)
    }

    /// Reads a code in a shading language, of all channels.
    fn shader_code(&self, per_word: usize) -> Vec<String> {
        let (dialect, array, bits) = (self.dialect, self.array_name(), self.packing.bits());
        let word = match per_word {
            1 => format!("{array}[k]"),
            _ => {
                let step = 32 / per_word;
                let shift = per_word.ilog2();
                let last = per_word - 1;
                format!("{array}[k >> {shift}u] >> ((k & {last}u) * {step}u)")
            }
        };
        let kind = if dialect.language == Language::Glsl { "highp uint" } else { dialect.index };
        let mut lines = vec![dialect.local(kind, "word", &word)];
        let mask = if bits == 16 { "0xffffu" } else { "0xffu" };
        let low = (dialect.float)(&format!("word & {mask}"));
        if self.packing.channels() == 1 {
            lines.push(format!("return {};", self.decoded(&low, None)));
            return lines;
        }
        let high = match (bits, per_word) {
            (16, _) => format!("word >> {bits}u"),
            _ => format!("(word >> {bits}u) & {mask}"),
        };
        let pair = format!("{}({low}, {})", self.pair(), (dialect.float)(&high));
        if self.is_spline() {
            lines.push(format!("return {pair};"));
        } else {
            lines.push(dialect.local(&self.pair(), "codes", &pair));
            lines.push(format!("return {};", self.decode("codes", None)));
        }
        lines
    }

    /// Reads a code in C or Rust, of channel c.
    fn host_code(&self) -> Vec<String> {
        let (dialect, array, bits) = (self.dialect, self.array_name(), self.packing.bits());
        let whole = |value| dialect.whole_number(value);
        let (per_channel, mask) = (32 / bits, (1u32 << bits) - 1);
        let [_, suffix] = dialect.suffixes;
        let mut lines = Vec::new();
        let n = match self.packing.channels() {
            1 => "k",
            _ => {
                lines.push(dialect.local(dialect.index, "n", &format!("{} * k + c", whole(2))));
                "n"
            }
        };
        let shift = format!("{} * ({n} % {})", whole(bits), whole(per_channel));
        let word =
            format!("({array}[{n} / {}] >> ({shift})) & 0x{mask:x}{suffix}", whole(per_channel));
        let code = (dialect.float)(&word);
        if self.is_spline() {
            lines.push(format!("return {code};"));
            return lines;
        }
        lines.push(dialect.local(dialect.syntax.float, "code", &code));
        let decoded = |channel| self.decoded("code", Some(channel));
        match (self.packing.channels(), dialect.language) {
            (1, _) => lines.push(format!("return {};", decoded(0))),
            (_, Language::Rust) => {
                lines.push(format!("if c == 0 {{ {} }} else {{ {} }}", decoded(0), decoded(1)));
            }
            _ => lines.push(format!("return c == 0u ? {} : {};", decoded(0), decoded(1))),
        }
        lines
    }

    /// The value of a code, or of the codes of all channels; of a spline, whose weights add up to
    /// 1, the sum of codes is decoded instead.
    fn decoded(&self, code: &str, channel: Option<usize>) -> String {
        if self.is_spline() { code.to_owned() } else { self.decode(code, channel) }
    }

    /// code scale + offset
    pub fn decode(&self, code: &str, channel: Option<usize>) -> String {
        let of = |channel| self.packing.decode(channel).map(|pair| pair.map(f64::from));
        match (channel, self.packing.channels(), of(channel.unwrap_or(0))) {
            (_, _, None) => code.to_owned(),
            (None, 2, Some([offset, scale])) => {
                let [other_offset, other_scale] = of(1).unwrap_or_default();
                let number = |value| self.dialect.number(value);
                let pair = |x, y| format!("{}({}, {})", self.pair(), number(x), number(y));
                format!("{code} * {} + {}", pair(scale, other_scale), pair(offset, other_offset))
            }
            (_, _, Some([offset, scale])) => self.dialect.affine(code, scale, offset),
        }
    }
}
