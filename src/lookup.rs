//! Code that looks a table up: in a texture through a sampler, and in full precision from its
//! texels; in shading languages, C and Rust. Where the texels lie is said once, in
//! [`crate::table::axis`]; the code says it again in the words of the language.

pub mod extras;
pub mod fields;
mod host;
pub mod place;
mod shader;
pub(crate) mod syntax;

pub use extras::Extra;

use crate::choice::choice;
use crate::error::{Error, Result};
use crate::table::Layout;
use crate::table::axis::{Parameter, Words};
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;
use fields::{Field, fields};

/// A language of lookup code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// WebGPU's.
    Wgsl,
    /// OpenGL's and Vulkan's, from ES 3.00 and 3.30 on.
    Glsl,
    /// Direct3D's.
    Hlsl,
    /// Metal's.
    Msl,
    /// C from 1999 on, and C++.
    C,
    /// Rust.
    Rust,
}

choice!(Language, "language", {
    Wgsl = "wgsl", "WebGPU's";
    Glsl = "glsl", "OpenGL's and Vulkan's, from ES 3.00 and 3.30 on";
    Hlsl = "hlsl", "Direct3D's";
    Msl = "msl", "Metal's";
    C = "c", "C from 1999 on, and C++";
    Rust = "rust", "Rust";
});

/// The place of the stored numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// A texture; of C and Rust an array that the caller passes.
    Passed,
    /// The array of numbers that stands above the code.
    Above,
}

/// A table to be looked up.
#[derive(Clone, Debug)]
pub struct Lookup<'a> {
    /// Axes, slices and channels.
    pub layout: &'a Layout,
    /// The storage.
    pub precision: Precision,
    /// What slices are.
    pub slices_as: SlicesAs,
    /// Components of a texel.
    pub components: usize,
    /// What begins all names.
    pub prefix: &'a str,
    /// The name of the array of numbers.
    pub array: &'a str,
    /// Whether the array has floats by their bits.
    pub by_bits: bool,
    /// What is said of the table, line by line.
    pub about: Vec<String>,
}

/// The third argument of a lookup in slices.
struct Third {
    /// Its name.
    name: &'static str,
    /// The place among the slices, as an expression of it.
    place: fn(&Lookup, &Words) -> String,
}

/// Words that one of the languages has, and names in the code itself.
#[rustfmt::skip]
const TAKEN: &[&str] = &[
    "as", "asm", "auto", "await", "bool", "break", "case", "catch", "char", "class", "const",
    "constant", "continue", "default", "delete", "device", "discard", "do", "double", "else",
    "enum", "export", "extern", "false", "final", "float", "float2", "float3", "float4", "fn",
    "for", "function", "goto", "half", "if", "impl", "import", "in", "inline", "inout", "int",
    "kernel", "let", "long", "loop", "match", "mod", "move", "mut", "namespace", "new", "null",
    "operator", "out", "package", "private", "protected", "pub", "public", "ref", "register",
    "return", "sampler", "self", "short", "signed", "sizeof", "static", "struct", "super",
    "switch", "template", "texture", "this", "thread", "throw", "trait", "true", "try", "type",
    "typedef", "uint", "uniform", "union", "unsafe", "unsigned", "use", "using", "var", "vec2",
    "vec3", "vec4", "vertex", "void", "volatile", "where", "while", "with", "yield",
    "at", "between", "channels", "components", "depth", "exact", "filtered", "height", "nov",
    "numbers", "place", "roughness", "share", "table", "texel", "uv", "weight", "width", "main",
    "fragment", "memcpy", "sqrtf", "fminf", "fmaxf", "powf", "log2f", "sqrt", "min", "max", "mix",
    "lerp", "clamp", "pow", "log2", "sample", "sampler2D", "i", "j", "k", "x", "y", "z", "f0",
    "std", "unix", "linux", "eval", "module", "abstract", "become", "virtual", "typename",
    "friend", "NULL", "INFINITY", "NAN", "M_PI", "uint8_t", "uint16_t", "uint32_t", "slice",
    "after",
];

/// Refuses a name that is none in every language.
pub fn check_name(what: &str, name: &str) -> Result<()> {
    let letter = |c: char| c.is_ascii_alphabetic();
    let follows = |c: char| c.is_ascii_alphanumeric() || c == '_';
    // Languages reserve what begins with an underscore or has two.
    let is_name = name.starts_with(letter) && name.chars().all(follows);
    if is_name && name.len() <= 64 && !name.contains("__") && !TAKEN.contains(&name) {
        return Ok(());
    }
    let expected = "a letter, then letters, digits and single underscores, 64 at the most, and no \
                    word of a language or of the code";
    Err(Error::bad_input(what, expected, format!("'{name}'"), "rename it"))
}

/// What a reader has to know of a table, line by line.
pub fn about(layout: &Layout, components: &[String], command: &str) -> Vec<String> {
    let mut lines = vec![format!("{TOOL}: {command}")];
    lines.extend_from_slice(components);
    lines.push(format!("column i: {}", layout.x.formula()));
    lines.push(format!("row i: {}", layout.y.formula()));
    if let Some(slices) = &layout.slices {
        lines.push(match slices.axis() {
            Some(axis) => format!("slice i: {}", axis.formula()),
            None => {
                let label = |slice| slices.label(slice);
                format!("slices: {}", (0..slices.count()).map(label).collect::<Vec<_>>().join(", "))
            }
        });
    }
    lines
}

impl Lookup<'_> {
    /// The code, with further functions.
    ///
    /// # Errors
    ///
    /// [`Error::BadInput`] where a further function needs numbers that the table has not.
    pub fn code(&self, language: Language, store: Store, extras: &[Extra]) -> Result<String> {
        let fields = self.fields()?;
        let mut code = match language {
            Language::Wgsl | Language::Glsl | Language::Hlsl | Language::Msl => {
                shader::code(self, &fields, language, store)
            }
            Language::C => host::c(self, &fields, store),
            Language::Rust => host::rust(self, &fields, store),
        };
        for extra in extras {
            code += &extra.code(self, &fields, language)?;
        }
        Ok(code)
    }

    /// The numbers that a lookup gives.
    fn fields(&self) -> Result<Vec<Field>> {
        let Layout { x, y, .. } = self.layout;
        if [x, y].iter().any(|axis| axis.spec().parameter == Parameter::Critical) {
            let got = "n.v centred on the critical angle";
            let cure =
                "write it by hand after the formula in the metadata, or lay nov along the axis";
            return Err(Error::bad_input("lookup", "an axis of n.v itself", got, cure));
        }
        let fields = fields(self.layout);
        if fields.is_empty() {
            let got = "constants and parameters alone";
            return Err(Error::bad_input("channels", "one to look up", got, "bake another table"));
        }
        Ok(fields)
    }

    /// The number of slices; 1 of a table over two axes.
    fn depth(&self) -> usize {
        self.layout.slice_count()
    }

    /// Whether a sampler may blend texels: it blends codes, which of RGBD are no values.
    fn filters(&self) -> bool {
        self.precision != Precision::Rgbd8
    }

    /// The third argument, where there are slices.
    fn third(&self) -> Option<Third> {
        // A file of one slice is like one without slices.
        let slices = self.layout.slices.as_ref().filter(|slices| slices.count() > 1)?;
        Some(match slices.axis() {
            Some(_) => Third { name: "f0", place: place::along_slices },
            None => Third { name: "slice", place: |_, _| "slice".into() },
        })
    }

    /// What is said of the table, as a comment.
    fn heading(&self) -> String {
        let line = |line: &String| format!("// {line}").trim_end().to_owned();
        self.about.iter().map(line).collect::<Vec<_>>().join("\n")
    }

    /// A name with the prefix.
    fn prefixed(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// The name of the struct of numbers.
    fn numbers(&self) -> String {
        match self.prefix {
            DEFAULT_PREFIX => "SplitSum".into(),
            prefix => format!("{prefix}_numbers"),
        }
    }
}

/// The tool and its version.
pub const TOOL: &str = concat!("splitsum ", env!("CARGO_PKG_VERSION"));

/// What begins all names without a wish.
pub const DEFAULT_PREFIX: &str = "splitsum";

/// The array's name without a wish.
pub const DEFAULT_ARRAY: &str = "splitsum_table";
