//! `splitsum bake`

mod names;

use super::table_args::{Job, TableArgs};
use super::{config, depfile, output, progress::Progress, resources, standard_output, usage};
use crate::backend::vulkan::gpu::GpuOptions;
use crate::backend::{Backend, BackendChoice};
use crate::encode::{self, metadata::TOOL};
use crate::error::{Error, Result};
use crate::report::Report;
use crate::request::Request;
use crate::table::Table;
use serde::Serialize;
use std::io::Write;

#[derive(clap::Args)]
pub struct BakeArgs {
    #[command(flatten, next_help_heading = "The table")]
    table: TableArgs,
    /// Bake every [[table]] of this TOML file; its keys are the names of the flags above, its outputs relative to it
    #[arg(long, value_name = "FILE", help_heading = "The run", conflicts_with_all = TABLE_FLAGS)]
    config: Option<String>,
    /// auto (Vulkan where a device can do it and the work pays for starting it, else the CPU), vulkan or cpu
    #[arg(long, value_name = "NAME", default_value = "auto", help_heading = "The run")]
    backend: String,
    /// Vulkan device, by UUID or a part of its name that no other has [default: discrete, integrated, virtual,
    /// software]
    #[arg(long, value_name = "NAME|UUID", help_heading = "The run")]
    device: Option<String>,
    /// Run under Vulkan's validation layers; whatever they say is a failure
    #[arg(long, help_heading = "The run")]
    validate: bool,
    /// Texels for each dispatch, instead of measuring what the device does in 40 ms
    #[arg(long, value_name = "N", hide = true)]
    tile: Option<usize>,
    /// CPU threads [default: one for each core]
    #[arg(long, value_name = "N", help_heading = "The run")]
    threads: Option<usize>,
    /// Print the report as JSON on standard output
    #[arg(long, help_heading = "The run")]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long, help_heading = "The run")]
    quiet: bool,
    /// -MD: write a dependency file in Make's syntax, OUTPUT.d or CONFIG.d
    #[arg(long, help_heading = "The run")]
    md: bool,
    /// -MF FILE: write the dependency file there
    #[arg(long, value_name = "FILE", help_heading = "The run")]
    mf: Option<String>,
    /// -MT NAME: the target that the dependency file names, instead of the outputs
    #[arg(long, value_name = "NAME", help_heading = "The run")]
    mt: Option<String>,
}

const TABLE_FLAGS: [&str; 15] = [
    "lut",
    "model",
    "masking",
    "channels",
    "f0",
    "ior",
    "size",
    "x",
    "y",
    "precision",
    "certify",
    "tolerance",
    "rule",
    "format",
    "output",
];

#[derive(Serialize)]
struct Run {
    tool: &'static str,
    tables: Vec<Baked>,
}

#[derive(Serialize)]
struct Baked {
    output: String,
    #[serde(flatten)]
    report: Report,
}

pub fn run(arguments: BakeArgs) -> Result<()> {
    let jobs = match &arguments.config {
        Some(path) => config::read(path)?,
        None => vec![arguments.table.job()?],
    };
    if arguments.json && jobs.iter().any(|job| job.output == "-") {
        return Err(usage(
            "--json",
            "one thing on standard output",
            "the report and the table",
            "write the table to a file",
        ));
    }
    let depfile = dependency_file(&arguments, &jobs)?;
    names::check(&arguments, &jobs, depfile.as_deref())?;
    let bytes = resources::of_bakes(&jobs);
    resources::start(bytes, arguments.threads, resources::FEWER)?;
    let backend = open(&arguments, bytes)?;
    // Last, since it makes the folder of the default output.
    for name in jobs.iter().map(|job| &job.output).chain(&depfile) {
        output::check(name)?;
    }
    if arguments.json {
        standard_output::check()?;
    }
    let tables: Vec<Vec<Baked>> = jobs.iter().map(|job| bake(job, &backend, &arguments)).collect::<Result<_>>()?;
    if let Some(depfile) = depfile {
        let outputs: Vec<&str> = jobs.iter().map(|job| job.output.as_str()).collect();
        let targets = arguments.mt.as_ref().map_or(outputs, |target| vec![target]);
        output::write(&depfile, depfile::rule(&targets, arguments.config.as_deref()).as_bytes())?;
    }
    if arguments.json {
        return super::print_json(&Run { tool: TOOL, tables: tables.into_iter().flatten().collect() });
    }
    Ok(())
}

fn bake(job: &Job, backend: &Backend, arguments: &BakeArgs) -> Result<Vec<Baked>> {
    let Job { requests, format, output } = job;
    let texels = requests.iter().map(|request| request.x.size * request.y.size).sum();
    let progress = Progress::new(output, texels, arguments.quiet);
    let bake = |request: &Request| crate::bake(request, backend, &|texels| progress.advance(texels));
    let baked: Vec<crate::Baked> = requests.iter().map(bake).collect::<Result<_>>()?;
    drop(progress);
    let (tables, reports): (Vec<Table>, Vec<Report>) = baked.into_iter().map(|b| (b.table, b.report)).unzip();
    output::write_with(output, &mut |file| encode::write(&tables, *format, file))?;
    if !arguments.quiet && !arguments.json {
        let name = if output == "-" { "standard output" } else { output };
        for (request, report) in requests.iter().zip(&reports) {
            let layer = request.lut.f0().filter(|_| requests.len() > 1).map(|f0| format!(", layer F0 = {f0}"));
            let ([width, height], layer) = (report.size, layer.unwrap_or_default());
            let _ = writeln!(std::io::stderr(), "wrote     {name}{layer}: {width} x {height}\n{report}");
        }
    }
    Ok(reports.into_iter().map(|report| Baked { output: output.clone(), report }).collect())
}

fn open(arguments: &BakeArgs, bytes: u64) -> Result<Backend> {
    let choice: BackendChoice = arguments.backend.parse()?;
    let options = GpuOptions { device: arguments.device.clone(), validate: arguments.validate, tile: arguments.tile };
    if choice == BackendChoice::Cpu && options != GpuOptions::default() {
        let cure = "leave out --device, --validate and --tile, or choose --backend vulkan";
        return Err(usage("--backend cpu", "flags of the CPU", "flags of a device", cure));
    }
    if options.tile == Some(0) {
        return Err(Error::bad_input("tile", "at least 1", "0", "give a number of texels"));
    }
    resources::open_backend(choice, &options, bytes)
}

fn dependency_file(arguments: &BakeArgs, jobs: &[Job]) -> Result<Option<String>> {
    match (&arguments.mf, arguments.md) {
        (Some(file), _) if file == "-" => Err(usage("-MF", "a file", "-", "name one")),
        (Some(file), _) => Ok(Some(file.clone())),
        (None, true) => match (&arguments.config, jobs) {
            (Some(config), _) => Ok(Some(format!("{config}.d"))),
            (None, [job]) if job.output != "-" => Ok(Some(format!("{}.d", job.output))),
            _ => Err(usage("-MD", "an output that is a file", "-", "name the dependency file with -MF")),
        },
        (None, false) if arguments.mt.is_some() => Err(usage("-MT", "-MD or -MF beside it", "neither", "add one")),
        (None, false) => Ok(None),
    }
}
