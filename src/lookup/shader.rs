//! Lookup code in shading languages: one text, in the words of each.

use super::fields::Field;
use super::syntax::{self, Shape, Syntax};
use super::{Language, Lookup, Store, place};
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;

/// Writes the functions of a table in a language.
struct Shader<'a> {
    lookup: &'a Lookup<'a>,
    fields: &'a [Field],
    syntax: &'static Syntax,
    store: Store,
    shape: Shape,
}

/// The struct of numbers and the functions that look them up.
pub fn code(lookup: &Lookup, fields: &[Field], language: Language, store: Store) -> String {
    let shape = match (lookup.third(), lookup.slices_as) {
        (None, _) => Shape::Plane,
        (Some(_), SlicesAs::Layers) => Shape::Layers,
        (Some(_), SlicesAs::Depth) => Shape::Volume,
    };
    let shader = Shader { lookup, fields, syntax: syntax::of(language), store, shape };
    let mut parts = vec![lookup.heading(), shader.numbers(), shader.unpack(), shader.place()];
    parts.push(shader.texel());
    if store == Store::Passed && lookup.filters() {
        parts.push(shader.filtered());
    }
    parts.extend([shader.between(), shader.exact()]);
    parts.join("\n\n") + "\n"
}

impl Shader<'_> {
    /// A function of the table: what it says of itself, its type, its name, its parameters besides
    /// the table, its lines.
    fn function(
        &self,
        about: &str,
        kind: &str,
        name: &str,
        parameters: &[(&str, &str)],
        lines: &[String],
    ) -> String {
        let syntax = self.syntax;
        let parameters: Vec<String> =
            parameters.iter().map(|(name, kind)| (syntax.parameter)(name, kind)).collect();
        let name = format!("{}_{name}", self.lookup.prefix);
        let head = (syntax.function)(kind, &name, &parameters.join(", "));
        let lines: String = lines.iter().map(|line| format!("    {line}\n")).collect();
        format!("// {about}\n{head}\n{lines}}}")
    }

    /// The parameters that name the table, before others.
    fn with_table<'a>(
        &self,
        sampled: bool,
        others: &[(&'a str, &'a str)],
    ) -> Vec<(&'a str, &'a str)> {
        let mut parameters = Vec::new();
        if self.store == Store::Passed {
            parameters.push(("table", (self.syntax.texture)(self.shape)));
            let sampler = self.syntax.sampler.filter(|_| sampled);
            parameters.extend(sampler.map(|sampler| ("table_sampler", sampler)));
        }
        parameters.extend(others);
        parameters
    }

    /// A call with the table as its first argument.
    fn call(&self, name: &str, arguments: &str) -> String {
        let table = if self.store == Store::Passed { "table, " } else { "" };
        format!("{}_{name}({table}{arguments})", self.lookup.prefix)
    }

    fn numbers(&self) -> String {
        let syntax = self.syntax;
        let member = |field: &Field| {
            let member = (syntax.member)(syntax.float, &field.name);
            format!("    {member} // {}\n", field.meaning)
        };
        let members: String = self.fields.iter().map(member).collect();
        format!("struct {} {{\n{members}{}", self.lookup.numbers(), syntax.struct_end)
    }

    fn unpack(&self) -> String {
        let syntax = self.syntax;
        let mut lines = vec![(syntax.variable)(&self.lookup.numbers(), "numbers")];
        lines.extend(self.fields.iter().map(|field| self.assignment(field)));
        lines.push("return numbers;".into());
        let parameters = [("texel", syntax.float4)];
        let about = "The numbers of a texel.";
        self.function(about, &self.lookup.numbers(), "unpack", &parameters, &lines)
    }

    fn assignment(&self, field: &Field) -> String {
        let component = |index: usize| format!("texel.{}", ["x", "y", "z", "w"][index]);
        let value = field.value(component, self.syntax.words.number);
        format!("numbers.{} = {value};", field.name)
    }

    fn place(&self) -> String {
        let (syntax, layout) = (self.syntax, self.lookup.layout);
        let (x, y) =
            (place::along(&layout.x, &syntax.words), place::along(&layout.y, &syntax.words));
        let parameters = [("nov", syntax.float), ("roughness", syntax.float)];
        let lines = [format!("return {}({x}, {y});", syntax.float2)];
        let about = "The place of (n.v, perceptual roughness) in texels: that of column i and row \
                     j is (i, j).";
        self.function(about, syntax.float2, "place", &parameters, &lines)
    }

    /// A texel, with what the hardware does not decode.
    fn texel(&self) -> String {
        let syntax = self.syntax;
        let fetched = match self.store {
            Store::Passed => (syntax.fetch)(self.shape, "i", "j", "k"),
            Store::Above => self.array_texel(),
        };
        let mut lines = self.place_in_array();
        if self.lookup.precision == Precision::Rgbd8 && self.store == Store::Passed {
            lines.push((syntax.local)(syntax.float4, "texel", &fetched));
            let gamma = format!("{}(2.2, 2.2, 2.2)", syntax.float3);
            lines
                .push(format!("return {}(pow(texel.xyz, {gamma}) / texel.w, 1.0);", syntax.float4));
        } else {
            lines.push(format!("return {fetched};"));
        }
        let mut indices = vec![("i", syntax.int), ("j", syntax.int)];
        indices.extend(self.sliced().then_some(("k", syntax.int)));
        let parameters = self.with_table(false, &indices);
        let about = match self.sliced() {
            false => "The texel in column i and row j.",
            true => "The texel in column i and row j of slice k.",
        };
        self.function(about, syntax.float4, "texel", &parameters, &lines)
    }

    fn sliced(&self) -> bool {
        self.lookup.third().is_some()
    }

    /// The index of a texel's first component in the array above.
    fn place_in_array(&self) -> Vec<String> {
        let Lookup { layout, components, .. } = self.lookup;
        let (width, height) = (layout.x.size(), layout.y.size());
        let row = if self.sliced() { format!("(k * {height} + j)") } else { "j".into() };
        let at = format!("({row} * {width} + i) * {components}");
        match self.store {
            Store::Passed => Vec::new(),
            Store::Above => vec![(self.syntax.local)(self.syntax.int, "at", &at)],
        }
    }

    /// A texel from the array of components above.
    fn array_texel(&self) -> String {
        let Lookup { components, array, by_bits, .. } = self.lookup;
        let member = |component: usize| {
            let member = match component {
                0 => format!("{array}[at]"),
                component => format!("{array}[at + {component}]"),
            };
            match component {
                component if component >= *components => ["0.0", "1.0"][component / 3].into(),
                _ if *by_bits => format!("{}({member})", self.syntax.float_of_bits),
                _ => member,
            }
        };
        let members: Vec<String> = (0..4).map(member).collect();
        format!("{}({})", self.syntax.float4, members.join(", "))
    }

    /// A value clamped to the texels of an axis; what is no number becomes 0 where max does so.
    fn clamped(&self, place: &str, size: usize) -> String {
        let words = &self.syntax.words;
        let last = (words.number)(size as f64 - 1.0);
        format!("min({}, {last})", (words.max)(place, &(words.number)(0.0)))
    }

    fn filtered(&self) -> String {
        let (syntax, layout) = (self.syntax, self.lookup.layout);
        let (u, v) = (place::uv(&layout.x, &syntax.words), place::uv(&layout.y, &syntax.words));
        let uv = format!("{}({u}, {v})", syntax.float2);
        let mut lines = vec![(syntax.local)(syntax.float2, "uv", &uv)];
        let sample = |k: &str| (syntax.sample)(self.shape, "uv", k);
        let texel = match self.shape {
            Shape::Plane => sample(""),
            Shape::Volume => {
                let depth = self.lookup.depth() as f64;
                let z = format!("({} + 0.5) / {depth:?}", self.third_place());
                lines.push((syntax.local)(syntax.float, "z", &z));
                sample("z")
            }
            Shape::Layers => {
                lines.extend(self.two_slices());
                let (first, second) = (sample("k"), sample("after"));
                format!("{}({first}, {second}, weight)", syntax.mix)
            }
        };
        lines.push(format!("return {}_unpack({texel});", self.lookup.prefix));
        let parameters = self.with_table(true, &self.arguments());
        let about = "Through a sampler: linear, clamped to the edge, no mips. GPUs blend by \
                     weights of 8 bits.";
        self.function(about, &self.lookup.numbers(), "filtered", &parameters, &lines)
    }

    fn between(&self) -> String {
        let (syntax, layout) = (self.syntax, self.lookup.layout);
        let int = |value: &str| format!("{}({value})", syntax.int);
        let float = |value: &str| format!("{}({value})", syntax.float);
        let next = |value: &str, size: usize| format!("min({value} + 1, {})", size - 1);
        let k = if self.sliced() { ", k" } else { "" };
        let blend = |j: &str| {
            let (left, right) = (format!("i, {j}{k}"), format!("next_i, {j}{k}"));
            let texels = format!("{}, {}", self.call("texel", &left), self.call("texel", &right));
            format!("{}({texels}, x - {})", syntax.mix, float("i"))
        };
        let lines = [
            (syntax.local)(syntax.int, "i", &int("x")),
            (syntax.local)(syntax.int, "j", &int("y")),
            (syntax.local)(syntax.int, "next_i", &next("i", layout.x.size())),
            (syntax.local)(syntax.int, "next_j", &next("j", layout.y.size())),
            (syntax.local)(syntax.float4, "low", &blend("j")),
            (syntax.local)(syntax.float4, "high", &blend("next_j")),
            format!("return {}(low, high, y - {});", syntax.mix, float("j")),
        ];
        let mut places = vec![("x", syntax.float), ("y", syntax.float)];
        places.extend(self.sliced().then_some(("k", syntax.int)));
        let parameters = self.with_table(false, &places);
        let about = match self.sliced() {
            false => "What lies at a place between texels: four of them, each by its share.",
            true => "What lies at a place between texels of slice k: four, each by its share.",
        };
        self.function(about, syntax.float4, "between", &parameters, &lines)
    }

    fn exact(&self) -> String {
        let (syntax, layout) = (self.syntax, self.lookup.layout);
        let place = format!("{}(nov, roughness)", self.lookup.prefixed("place"));
        let mut lines = vec![
            (syntax.local)(syntax.float2, "place", &place),
            (syntax.local)(syntax.float, "x", &self.clamped("place.x", layout.x.size())),
            (syntax.local)(syntax.float, "y", &self.clamped("place.y", layout.y.size())),
        ];
        let slice = |k: &str| self.call("between", &format!("x, y{k}"));
        let texel = if self.lookup.third().is_some() {
            lines.extend(self.two_slices());
            format!("{}({}, {}, weight)", syntax.mix, slice(", k"), slice(", after"))
        } else {
            slice("")
        };
        lines.push(format!("return {}_unpack({texel});", self.lookup.prefix));
        let parameters = self.with_table(false, &self.arguments());
        let about = "In full precision, without a sampler.";
        self.function(about, &self.lookup.numbers(), "exact", &parameters, &lines)
    }

    /// What a lookup takes besides the table.
    fn arguments(&self) -> Vec<(&'static str, &'static str)> {
        let float = self.syntax.float;
        let third = self.lookup.third().map(|third| (third.name, float));
        [("nov", float), ("roughness", float)].into_iter().chain(third).collect()
    }

    fn third_place(&self) -> String {
        let third = self.lookup.third();
        third.map_or("0.0".into(), |third| (third.place)(self.lookup, &self.syntax.words))
    }

    /// The slices on either side of the third argument, and the share of the second.
    fn two_slices(&self) -> [String; 4] {
        let (syntax, depth) = (self.syntax, self.lookup.depth());
        let z = self.clamped(&self.third_place(), depth);
        [
            (syntax.local)(syntax.float, "z", &z),
            (syntax.local)(syntax.int, "k", &format!("{}(z)", syntax.int)),
            (syntax.local)(syntax.int, "after", &format!("min(k + 1, {})", depth - 1)),
            (syntax.local)(syntax.float, "weight", &format!("z - {}(k)", syntax.float)),
        ]
    }
}
