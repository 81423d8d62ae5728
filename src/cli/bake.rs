//! `splitsum bake`

mod names;

use super::device_args::DeviceArgs;
use super::table_args::{Job, TableArgs};
use super::{config, depfile, output, plan, progress::Progress, resources, standard_output, usage};
use crate::backend::Backend;
use crate::backend::device::GpuOptions;
use crate::bake::Plan;
use crate::error::Result;
use crate::format::metadata::TOOL;
use crate::lookup::DEFAULT_PREFIX;
use crate::report::Report;
use serde::Serialize;
use std::io::Write;

#[derive(clap::Args)]
pub struct BakeArgs {
    #[command(flatten, next_help_heading = "The table")]
    table: TableArgs,
    /// Bake every [[table]] of this TOML file; its keys are the names of the flags above, its
    /// outputs relative to it; or write the outputs of a plan of splitsum plan
    #[arg(long, value_name = "FILE", help_heading = "The run", conflicts_with = "TableArgs")]
    config: Option<String>,
    #[command(flatten, next_help_heading = "The run")]
    device: DeviceArgs,
    /// Run under Vulkan's validation layers; any message of theirs is a failure
    #[arg(long)]
    validate: bool,
    /// Texels for each dispatch, instead of as many as the device does in 40 ms
    #[arg(long, value_name = "N", hide = true, value_parser = clap::value_parser!(u32).range(1..))]
    tile: Option<u32>,
    /// CPU threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print the plan, with sizes and the expected time, and bake nothing
    #[arg(long, conflicts_with_all = ["json", "quiet", "md", "mf", "mt"])]
    dry_run: bool,
    /// Print the report as JSON on standard output
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
    /// -MD: write a dependency file in Make's syntax, OUTPUT.d or CONFIG.d
    #[arg(long)]
    md: bool,
    /// -MF FILE: write the dependency file there
    #[arg(long, value_name = "FILE")]
    mf: Option<String>,
    /// -MT NAME: the target that the dependency file names, instead of the outputs
    #[arg(long, value_name = "NAME")]
    mt: Option<String>,
}

#[derive(Serialize)]
struct Run {
    tool: &'static str,
    tables: Vec<Baked>,
}

#[derive(Serialize)]
struct Baked {
    output: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    lookup: Option<String>,
    #[serde(flatten)]
    report: Report,
}

pub fn run(arguments: BakeArgs) -> Result<()> {
    if let Some(path) =
        arguments.config.as_ref().filter(|path| plan::is_plan(path).is_ok_and(|is| is))
    {
        return plan::carry_out(path, arguments.dry_run, arguments.quiet);
    }
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
    resources::start(bytes, arguments.threads.map(usize::from), resources::FEWER)?;
    let tile = arguments.tile.map(|tile| tile as usize);
    let options = GpuOptions { validate: arguments.validate, tile, ..GpuOptions::default() };
    let backend = arguments.device.open(options, bytes)?;
    if arguments.dry_run {
        return print_plans(&jobs, &backend);
    }
    // Last, since it makes the folder of the default output.
    for name in jobs.iter().flat_map(Job::files).chain(depfile.as_deref()) {
        output::check(name)?;
    }
    if arguments.json {
        standard_output::check()?;
    }
    let tables: Vec<Vec<Baked>> =
        jobs.iter().map(|job| bake(job, &backend, &arguments)).collect::<Result<_>>()?;
    if let Some(depfile) = depfile {
        let outputs: Vec<&str> = jobs.iter().flat_map(Job::files).collect();
        let targets = arguments.mt.as_ref().map_or(outputs, |target| vec![target]);
        output::write(&depfile, depfile::rule(&targets, arguments.config.as_deref()).as_bytes())?;
    }
    if arguments.json {
        return super::print_json(&Run {
            tool: TOOL,
            tables: tables.into_iter().flatten().collect(),
        });
    }
    Ok(())
}

/// Prints what would be baked, and how.
fn print_plans(jobs: &[Job], backend: &Backend) -> Result<()> {
    standard_output::check()?;
    let plan = |job: &Job| {
        let plan = Plan::new(&job.request, backend)?;
        let lookup =
            job.lookup.as_ref().map_or(String::new(), |(name, _)| format!("\nlookup    {name}"));
        Ok(format!("output    {}{lookup}\ncommand   {}\n{plan}", job.output, job.command()))
    };
    super::print(&jobs.iter().map(plan).collect::<Result<Vec<_>>>()?.join("\n\n"))
}

fn bake(job: &Job, backend: &Backend, arguments: &BakeArgs) -> Result<Vec<Baked>> {
    let Job { request, encoding, output, lookup } = job;
    let plan = Plan::new(request, backend)?;
    let texels = request.texels() * request.packing().luts().len();
    let progress = Progress::new(output, texels, arguments.quiet);
    let baked = plan.bake(&|texels| progress.advance(texels))?;
    drop(progress);
    output::write_with(output, &mut |file| encoding.write(&baked.table, file))?;
    if !arguments.quiet && !arguments.json {
        let name = if output == "-" { "standard output" } else { output };
        for report in &baked.reports {
            let slice =
                report.slice.as_ref().map_or(String::new(), |slice| format!(", slice {slice}"));
            let channels = report
                .channels
                .as_ref()
                .map_or(String::new(), |channels| format!(", channels {channels}"));
            let [width, height] = report.size;
            let _ = writeln!(
                std::io::stderr(),
                "wrote     {name}{slice}{channels}: {width} x {height}\n{report}"
            );
        }
    }
    if let Some((name, language)) = lookup {
        let code = super::lookup::code(job, *language, &[], DEFAULT_PREFIX)?;
        output::write(name, code.as_bytes())?;
        if !arguments.quiet && !arguments.json {
            let _ = writeln!(std::io::stderr(), "wrote     {name}: lookup code");
        }
    }
    let of_file = |report: Report| Baked {
        output: output.clone(),
        lookup: lookup.as_ref().map(|(name, _)| name.clone()),
        report: Report { command: job.command(), ..report },
    };
    Ok(baked.reports.into_iter().map(of_file).collect())
}

fn dependency_file(arguments: &BakeArgs, jobs: &[Job]) -> Result<Option<String>> {
    match (&arguments.mf, arguments.md) {
        (Some(file), _) if file == "-" => Err(usage("-MF", "a file", "-", "name one")),
        (Some(file), _) => Ok(Some(file.clone())),
        (None, true) => match (&arguments.config, jobs) {
            (Some(config), _) => Ok(Some(format!("{config}.d"))),
            (None, [job]) if job.output != "-" => Ok(Some(format!("{}.d", job.output))),
            _ => Err(usage(
                "-MD",
                "an output that is a file",
                "-",
                "name the dependency file with -MF",
            )),
        },
        (None, false) if arguments.mt.is_some() => {
            Err(usage("-MT", "-MD or -MF beside it", "neither", "add one"))
        }
        (None, false) => Ok(None),
    }
}
