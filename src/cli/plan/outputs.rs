//! Plans and what is made of them, on the disk.

use super::PlanArgs;
use crate::approximation::code::Code;
use crate::approximation::table::Promise;
use crate::cli::lookup::language_of;
use crate::cli::{output, print, standard_output};
use crate::error::{Error, Result};
use crate::format::{Format, encode};
use crate::lookup::{Language, check_name};
use crate::planner::file::{Output, PlanFile};
use crate::planner::report::range;
use crate::table::precision::Precision;
use std::io::{Read, Write};
use std::path::Path;

/// A plan larger than this is a mistake.
const LARGEST_PLAN: u64 = 64 << 20;

/// Writes lookup code or control points, as the name says.
pub fn write_output(plan: &PlanFile, name: &str, prefix: &str) -> Result<()> {
    if let Ok(language) = language_of(name) {
        return output::write(name, code(plan, prefix, language)?.as_bytes());
    }
    let ([approximation], [chosen]) = (&*plan.approximations()?, &*plan.choice) else {
        let got = format!("{} polynomials", plan.choice.len());
        let cure = "write code instead, as in --code FILE.wgsl";
        return Err(Error::bad_input("table", "a net of control points", got, cure));
    };
    let promise = Promise {
        tolerance: plan.question.tolerance.clone(),
        f0: chosen.f0,
        measured_error: (chosen.error.abs(), chosen.points),
        command: plan.command.clone(),
    };
    let table = approximation.table(&promise)?;
    let is_texture = plan.question.sampler.is_some();
    output::write(name, &encode(&table, table_format(name, is_texture)?)?)
}

/// The format of control points with this name; code is written by --code, and EXR has no codes.
pub fn table_format(name: &str, is_texture: bool) -> Result<&'static Format> {
    let format = Format::of_file(name)?;
    let refused = |cure: &str| {
        let expected = ".png, .ktx2, .dds, .npy, .raw, .js, .ts or .txt";
        Err(Error::bad_input("table", expected, format!("'{name}'"), cure))
    };
    if language_of(name).is_ok() {
        return refused("write code with --code");
    }
    // Control points are codes of 8 or 16 bits.
    if !is_texture && !format.precisions().contains(&Precision::Unorm16) {
        return refused("name a format that stores whole numbers");
    }
    Ok(format)
}

/// The lookup code of a plan.
pub fn code(plan: &PlanFile, prefix: &str, language: Language) -> Result<String> {
    let approximations = plan.approximations()?;
    let code = Code { approximations: &approximations, prefix, about: about(plan)? };
    code.write(language)
}

/// What the code says of itself.
fn about(plan: &PlanFile) -> Result<Vec<String>> {
    let question = &plan.question;
    let mut lines = vec![
        format!("Lookup of E(F0) of {}, {}.", question.model, question.masking),
        format!("{}: {}", plan.tool, plan.command),
        format!("nodes: {}; tolerance of E(F0): {}", plan.nodes, question.tolerance),
        format!("right for n.v from {} to 1, and:", question.least_nov),
    ];
    for (index, chosen) in plan.choice.iter().enumerate() {
        let (roughness, f0) = (range(chosen.roughness), range(chosen.f0));
        let error = chosen.error.abs();
        let name =
            if plan.choice.len() > 1 { format!("material {index}: ") } else { String::new() };
        lines.push(format!("{name}roughness {roughness}, F0 {f0}: error {error:.2e} at the most"));
    }
    Ok(lines)
}

/// An output of the plan, relative to the plan's own folder where it lies below.
pub fn output_of(plan: &str, name: &str, arguments: &PlanArgs) -> Output {
    let folder = Path::new(plan).parent().unwrap_or(Path::new(""));
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (folder, path) = (absolute(folder), absolute(Path::new(name)));
    let file = path.strip_prefix(&folder).unwrap_or(&path).to_string_lossy().into_owned();
    Output { file, prefix: arguments.prefix.clone() }
}

/// Whether a configuration is a plan.
pub fn is_plan(path: &str) -> Result<bool> {
    let failed = Error::io("read", path, "name a TOML file that can be read");
    let bytes = read_at_most(Path::new(path), LARGEST_PLAN).map_err(failed)?.unwrap_or_default();
    let mut lines = bytes.split(|byte| *byte == b'\n');
    Ok(lines.any(|line| line.trim_ascii() == b"[question]"))
}

/// Writes the files that a plan names; `only_names` prints them instead.
pub fn carry_out(path: &str, only_names: bool, quiet: bool) -> Result<()> {
    let plan = read_plan(path)?;
    if plan.outputs.is_empty() {
        let cure = "repeat the plan with --code FILE";
        return Err(Error::bad_input(path, "outputs that it names", "none", cure));
    }
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    let name = |output: &Output| folder.join(&output.file).to_string_lossy().into_owned();
    if only_names {
        standard_output::check()?;
        return print(&plan.outputs.iter().map(name).collect::<Vec<_>>().join("\n"));
    }
    plan.outputs.iter().try_for_each(|output| output::check(&name(output)))?;
    for output in &plan.outputs {
        check_name("prefix", &output.prefix)?;
        let name = name(output);
        write_output(&plan, &name, &output.prefix)?;
        if !quiet {
            let _ = writeln!(std::io::stderr(), "wrote     {name}");
        }
    }
    Ok(())
}

/// The bytes of a file; none of one that is larger than `most`, or has no end.
pub fn read_at_most(path: &Path, most: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// Reads a plan.
pub fn read_plan(path: &str) -> Result<PlanFile> {
    let failed = Error::io("read", path, "name a plan that can be read");
    let wrong = |got: String| {
        Err(Error::bad_input(path, "a plan of splitsum in TOML", got, "repeat the plan"))
    };
    let Some(bytes) = read_at_most(Path::new(path), LARGEST_PLAN).map_err(failed)? else {
        return wrong("more than 64 MiB".into());
    };
    let Ok(text) = String::from_utf8(bytes) else {
        return wrong("bytes that are not UTF-8".into());
    };
    toml::from_str(&text).or_else(|error| wrong(format!("\n{}", error.to_string().trim_end())))
}
