//! The names of the files that a bake reads and writes, checked before any work.

use super::BakeArgs;
use crate::cli::depfile::{Side, complain};
use crate::cli::table_args::Job;
use crate::cli::{place, usage};
use crate::error::{Error, Result};

/// The names of the files: no two mean the same one, and make can read those that it has to.
pub fn check(arguments: &BakeArgs, jobs: &[Job], depfile: Option<&str>) -> Result<()> {
    let mut files = place::Files::default();
    if let Some(config) = &arguments.config {
        files.add("the configuration", config);
    }
    for (name, job) in named(arguments, jobs) {
        let of_table = |what: &str| match arguments.config {
            Some(_) => format!("the {what} of {name}"),
            None => format!("the {what}"),
        };
        let lookup = job.lookup.as_ref().map(|(file, _)| (of_table("lookup code"), file));
        for (what, file) in [(of_table("output"), &job.output)].into_iter().chain(lookup) {
            if let Some(other) = files.add(what, file) {
                let (expected, got) = ("a file of its own", format!("{file}, which is {other}"));
                return Err(Error::bad_input(name, expected, got, "rename one of the two"));
            }
        }
    }
    let Some(depfile) = depfile else { return Ok(()) };
    if let Some(other) = files.add("the dependency file", depfile) {
        let got = format!("{depfile}, which is {other}");
        return Err(usage("-MD or -MF", "a file of its own", &got, "name another one with -MF"));
    }
    check_rule(arguments, jobs)
}

/// Whether make can read the names in the dependency file.
fn check_rule(arguments: &BakeArgs, jobs: &[Job]) -> Result<()> {
    let config = arguments.config.as_deref();
    let of_target =
        arguments.mt.as_deref().and_then(|target| complain("-MT", target, Side::Target));
    let of_flags = of_target.or_else(|| complain("--config", config?, Side::Dependency));
    if let Some(complaint) = of_flags {
        return Err(Error::Usage(complaint));
    }
    let mut outputs = named(arguments, jobs).filter(|_| arguments.mt.is_none());
    match outputs.find_map(|(name, job)| complain(&name, &job.output, Side::Target)) {
        Some(complaint) if config.is_some() => Err(Error::BadInput(complaint)),
        Some(complaint) => Err(Error::Usage(complaint)),
        None => Ok(()),
    }
}

/// The jobs with what they are called.
fn named<'a>(arguments: &'a BakeArgs, jobs: &'a [Job]) -> impl Iterator<Item = (String, &'a Job)> {
    let name = |index: usize| match &arguments.config {
        Some(config) => format!("{config}, table {}", index + 1),
        None => "output".into(),
    };
    jobs.iter().enumerate().map(move |(index, job)| (name(index), job))
}
