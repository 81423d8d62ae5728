//! The code through compilers that do not run it.

use crate::cases::{Case, cases};
use crate::common::printed;
use libtest_mimic::Failed;
use splitsum::lookup::Language;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

pub fn naga_takes_wgsl() -> Result<(), Failed> {
    for case in cases() {
        let text = case.code(Language::Wgsl)?;
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

/// The code of all cases, and the sum of what they give: an expression of floats.
fn all(language: Language) -> Result<(String, String), Failed> {
    let mut text = String::new();
    let mut terms = Vec::new();
    for case in cases() {
        text += &case.code(language)?;
        text += "\n";
        let Case { name, .. } = &case;
        let [place, all] = case.arguments(["p.x", "p.y", "int(p.w)", "p.z"]);
        if case.has_scale_bias() {
            terms.push(format!("{name}_scale_bias({place}).y"));
        }
        terms.push(format!("{name}_albedo({all})"));
    }
    Ok((text, terms.join(" + ")))
}

pub fn glslang() -> Result<(), Failed> {
    let folder = tempdir()?;
    let (text, sum) = all(Language::Glsl)?;
    for version in ["300 es", "330"] {
        let main = format!(
            "#version {version}\nprecision highp float;\nuniform vec4 p;\nout vec4 colour;\n\
             {text}\n\
             void main() {{ colour = vec4({sum}); }}\n"
        );
        fs::write(folder.path().join("code.frag"), main)?;
        printed(Command::new("glslangValidator").current_dir(folder.path()).arg("code.frag"))?;
    }
    fs::write(folder.path().join("code.hlsl"), hlsl()?)?;
    let mut command = Command::new("glslangValidator");
    command.args(["-D", "-S", "frag", "-e", "main", "-V", "code.hlsl"]);
    printed(command.current_dir(folder.path())).map(drop)
}

/// HLSL around the code.
fn hlsl() -> Result<String, Failed> {
    let (text, sum) = all(Language::Hlsl)?;
    Ok(format!("{text}\nfloat4 main(float4 p : TEXCOORD0) : SV_Target {{ return {sum}; }}\n"))
}

pub fn slangc(program: &Path) -> Result<(), Failed> {
    let folder = tempdir()?;
    let path = folder.path().join("main.hlsl");
    fs::write(&path, hlsl()?)?;
    let mut command = Command::new(program);
    command.arg(&path).args(["-lang", "hlsl", "-entry", "main", "-stage", "fragment"]);
    // To a file: it replaces what it writes to, even /dev/null.
    printed(command.args(["-target", "hlsl", "-o"]).arg(folder.path().join("out.hlsl"))).map(drop)
}
