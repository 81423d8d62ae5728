//! Lookup code through compilers that do not run it.

use crate::cases::{CASES, splitsum};
use crate::common::printed;
use libtest_mimic::Failed;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

const EXTRAS: &str = "--with turquin,fdez-aguera";

/// Code of every case in a language: that of textures, with slices as layers and in depth and with
/// further functions, and that of an array; whether it is of an array, and whether of layers.
fn texts(folder: &Path, extension: &str) -> Result<Vec<(String, bool, Shape)>, Failed> {
    let mut texts = Vec::new();
    for (_, flags) in CASES {
        let energy = flags.contains("--lut energy");
        let extras = match energy {
            true => "--with diffuse",
            false if flags.contains("1-e --x") => "",
            false => EXTRAS,
        };
        let shapes: &[Shape] =
            if energy { &[Shape::Layers, Shape::Depth] } else { &[Shape::Plane] };
        for shape in shapes {
            let as_depth = if *shape == Shape::Depth { "--slices-as depth" } else { "" };
            let passed = format!("{flags} --format ktx2 {as_depth} {extras} -o code.{extension}");
            splitsum(folder, &format!("lookup {passed}"))?;
            texts.push((
                fs::read_to_string(folder.join(format!("code.{extension}")))?,
                false,
                *shape,
            ));
        }
        splitsum(folder, &format!("bake -q {flags} -o code.{extension}"))?;
        texts.push((
            fs::read_to_string(folder.join(format!("code.{extension}")))?,
            true,
            shapes[0],
        ));
    }
    let bits = format!("bake -q --size 5 --numbers bits -o code.{extension}");
    splitsum(folder, &bits)?;
    texts.push((fs::read_to_string(folder.join(format!("code.{extension}")))?, true, Shape::Plane));
    Ok(texts)
}

/// The shape of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Plane,
    Layers,
    Depth,
}

impl Shape {
    fn third(self) -> &'static str {
        if self == Shape::Plane { "" } else { ", 0.3" }
    }

    fn pick(self, names: [&str; 3]) -> &str {
        names[self as usize]
    }
}

pub fn naga_takes_wgsl() -> Result<(), Failed> {
    let folder = tempdir()?;
    let mut texts: Vec<String> =
        texts(folder.path(), "wgsl")?.into_iter().map(|(text, ..)| text).collect();
    // A file of one slice is a texture of two dimensions.
    let one = splitsum(folder.path(), "lookup --lut energy --z f0 --size 4x4x1 --language wgsl")?;
    texts.push(String::from_utf8(one)?);
    assert!(texts.iter().all(|text| !text.contains("_array<f32>") || text.contains("f0: f32")));
    for text in texts {
        let module = naga::front::wgsl::parse_str(&text)
            .map_err(|error| format!("{}\n{text}", error.emit_to_string(&text)))?;
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        );
        validator.validate(&module).map_err(|error| format!("{error:?}\n{text}"))?;
    }
    Ok(())
}

pub fn glslang() -> Result<(), Failed> {
    let folder = tempdir()?;
    let check = |name: &str, text: &str, flags: &[&str]| -> Result<(), Failed> {
        let path = folder.path().join(name);
        fs::write(&path, text)?;
        // It writes what it makes into the folder where it runs.
        let mut command = Command::new("glslangValidator");
        printed(command.current_dir(folder.path()).args(flags).arg(&path)).map(drop)
    };
    for (text, above, shape) in texts(folder.path(), "glsl")? {
        let sampler = shape.pick(["sampler2D", "sampler2DArray", "sampler3D"]);
        let (uniform, table) = match above {
            true => (String::new(), ""),
            false => (format!("uniform highp {sampler} table_of_main;\n"), "table_of_main, "),
        };
        for version in ["300 es", "330"] {
            let main = format!(
                "#version {version}\nprecision highp float;\nprecision highp int;\n{uniform}\n\
                 {text}\nout vec4 colour;\nvoid main() {{ SplitSum s = \
                 splitsum_exact({table}0.5, 0.5{}); colour = vec4(float(s == s)); }}\n",
                shape.third()
            );
            check("code.frag", &main, &[])?;
        }
    }
    for (text, above, shape) in texts(folder.path(), "hlsl")? {
        check("code.hlsl", &hlsl(&text, above, shape), &["-D", "-S", "frag", "-e", "main", "-V"])?;
    }
    Ok(())
}

/// HLSL around the code of a lookup.
fn hlsl(text: &str, above: bool, shape: Shape) -> String {
    let texture = shape.pick(["Texture2D<float4>", "Texture2DArray<float4>", "Texture3D<float4>"]);
    let (uniform, table) = match above {
        true => (String::new(), ""),
        false => (format!("{texture} t : register(t0);\nSamplerState s : register(s0);\n"), "t, "),
    };
    let filtered = match !above && text.contains("splitsum_filtered") {
        true => format!("n = splitsum_filtered(t, s, 0.5, 0.5{});", shape.third()),
        false => String::new(),
    };
    let members = text.split("struct SplitSum {").nth(1).unwrap_or_default();
    let member = members.split("float ").nth(1).and_then(|rest| rest.split(';').next());
    format!(
        "{text}\n{uniform}float4 main() : SV_Target {{ SplitSum n = splitsum_exact({table}0.5, \
         0.5{}); float4 c = n.{m}; {filtered} return c + n.{m}; }}\n",
        shape.third(),
        m = member.unwrap_or_default()
    )
}

pub fn slangc(program: &Path) -> Result<(), Failed> {
    let folder = tempdir()?;
    for (text, above, shape) in texts(folder.path(), "hlsl")? {
        let path = folder.path().join("main.hlsl");
        fs::write(&path, hlsl(&text, above, shape))?;
        let mut command = Command::new(program);
        command.arg(&path).args(["-lang", "hlsl", "-entry", "main", "-stage", "fragment"]);
        // To a file: it replaces what it writes to, even /dev/null.
        printed(command.args(["-target", "hlsl", "-o"]).arg(folder.path().join("out.hlsl")))?;
    }
    Ok(())
}

pub fn extras_need_their_numbers() -> Result<(), Failed> {
    let folder = tempdir()?;
    for (flags, extra) in [("--channels e", "turquin"), ("--channels be", "diffuse")] {
        let error = splitsum(folder.path(), &format!("lookup {flags} --language c --with {extra}"));
        let said = error.unwrap_err().message().unwrap_or_default().to_owned();
        assert!(said.contains(&format!("with {extra}: expected a table with")), "{said}");
    }
    Ok(())
}
