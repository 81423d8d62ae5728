//! The names of the files that a bake reads and writes, checked before any work.

use super::BakeArgs;
use crate::cli::table_args::Job;
use crate::cli::{place, usage};
use crate::error::{Error, Result};

/// The names of the files: no two mean the same one.
pub fn check(arguments: &BakeArgs, jobs: &[Job], depfile: Option<&str>) -> Result<()> {
    let mut files = place::Files::default();
    if let Some(config) = &arguments.config {
        files.add("the configuration", config);
    }
    for (name, job) in named(arguments, jobs) {
        let what = if arguments.config.is_some() { format!("the output of {name}") } else { format!("the {name}") };
        if let Some(other) = files.add(what, &job.output) {
            let got = format!("{}, which is {other}", job.output);
            return Err(Error::bad_input(name, "an output of its own", got, "rename one of the two"));
        }
    }
    let Some(depfile) = depfile else { return Ok(()) };
    if let Some(other) = files.add("the dependency file", depfile) {
        let got = format!("{depfile}, which is {other}");
        return Err(usage("-MD or -MF", "a file of its own", &got, "name another one with -MF"));
    }
    Ok(())
}

/// The jobs with what they are called.
fn named<'a>(arguments: &'a BakeArgs, jobs: &'a [Job]) -> impl Iterator<Item = (String, &'a Job)> {
    let name = |index: usize| match &arguments.config {
        Some(config) => format!("{config}, table {}", index + 1),
        None => "output".into(),
    };
    jobs.iter().enumerate().map(move |(index, job)| (name(index), job))
}
