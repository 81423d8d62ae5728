//! The command line: flags and configurations become requests; files are read and written, and people are talked to,
//! here and nowhere else.

mod bake;
mod chart;
mod config;
mod depfile;
mod devices;
mod furnace;
mod message;
mod output;
mod place;
mod preview;
mod progress;
mod resources;
mod standard_output;
mod table_args;
mod temporary;
mod watched;

use crate::error::{Complaint, Error, ExitCode, Result};
use crate::model::{Diffuse, Ndf};
use crate::units::word;
use clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::io::Write;

/// Bakes preintegrated BRDF lookup tables on Vulkan compute or the CPU, checks them, and says how far each is from
/// the truth.
#[derive(Parser)]
#[command(name = "splitsum", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Bake a table, or all tables of a configuration
    Bake(Box<bake::BakeArgs>),
    /// Draw a table, or measure methods and draw what they are worth
    #[command(subcommand)]
    Chart(Box<chart::ChartArgs>),
    /// Report how much energy a material gives back in a white furnace
    Furnace(furnace::FurnaceArgs),
    /// Render spheres lit by a light, a furnace or a sky
    Preview(preview::PreviewArgs),
    /// List the Vulkan devices, the preferred one first
    Devices(devices::DevicesArgs),
}

/// Runs the program with these arguments, the first being its name; what comes back is its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = arguments.into_iter().map(depfile::long_flag);
    let codes = ExitCode::MEANINGS.map(|(code, meaning)| format!("  {}  {meaning}", code as u8)).join("\n");
    let codes = format!("Exit codes:\n{codes}");
    let specular = Ndf::ALL.map(|ndf| format!("  {:<16} {}\n", word(ndf), ndf.summary())).concat();
    let diffuse = Diffuse::ALL.map(|diffuse| format!("  {:<16} {}\n", word(diffuse), diffuse.summary())).concat();
    let models = format!("Models of dfg, sheen and energy:\n{specular}\nModels of diffuse:\n{diffuse}\n{codes}");
    let command = Cli::command().after_help(&codes).mut_subcommands(|command| {
        let takes_models = ["bake", "chart", "furnace"].contains(&command.get_name());
        let command = command.mut_subcommands(|command| {
            let names_no_model = ["stability", "bounds"].contains(&command.get_name());
            command.after_help(if names_no_model { &codes } else { &models })
        });
        command.after_help(if takes_models { &models } else { &codes })
    });
    let cli = match command.try_get_matches_from(arguments).and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error),
    };
    let outcome = match cli.command {
        Command::Bake(arguments) => bake::run(*arguments),
        Command::Chart(arguments) => chart::run(&arguments),
        Command::Furnace(arguments) => furnace::run(&arguments),
        Command::Preview(arguments) => preview::run(&arguments),
        Command::Devices(arguments) => devices::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::Success as u8,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "splitsum: {}", message::shorten(&error.to_string()));
            error.exit_code() as u8
        }
    }
}

/// Prints what the parser has to say: the help that was asked for, or why it cannot go on.
fn refuse(error: &clap::Error) -> u8 {
    if !error.use_stderr() {
        let _ = error.print();
        return ExitCode::Success as u8;
    }
    // The help that stands for a missing command is long, and meant to be.
    let (text, quoting) = (error.to_string(), error.kind() != DisplayHelpOnMissingArgumentOrSubcommand);
    let short = message::shorten(&text);
    let _ = if quoting && short.len() < text.trim_end().len() {
        writeln!(std::io::stderr(), "{short}")
    } else {
        error.print()
    };
    ExitCode::Usage as u8
}

/// Prints to standard output; a closed pipe is an error like any other.
fn print(text: &str) -> Result<()> {
    let failed = output::failed("write to", "standard output", "check what reads it");
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(failed)
}

/// Prints as JSON.
fn print_json(value: &impl serde::Serialize) -> Result<()> {
    standard_output::check()?;
    print(&serde_json::to_string_pretty(value).map_err(|error| Error::Internal(error.to_string()))?)
}

/// A complaint about flags that do not go together.
fn usage(what: &str, expected: &str, got: &str, cure: &str) -> Error {
    Error::Usage(Complaint::new(what, expected, got, cure))
}
