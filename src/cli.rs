//! The command line: flags and configurations become requests; files are read and written, and
//! people are talked to, here and nowhere else.

mod bake;
#[cfg(feature = "compare")]
mod chart;
mod choices;
mod completions;
mod config;
mod convert;
mod depfile;
mod device_args;
mod devices;
mod furnace;
mod lookup;
mod message;
mod output;
mod place;
mod plan;
mod presets;
mod preview;
mod progress;
mod resources;
mod standard_output;
mod table_args;
mod temporary;
mod verify;
mod watched;

// Readers of others' text, for tests with hostile files.
#[cfg(feature = "compare")]
#[doc(hidden)]
pub use chart::draw as draw_study;
#[doc(hidden)]
pub use config::count as count_tables;

use crate::error::{Complaint, Error, ExitCode, Result};
use clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::io::Write;

/// Bakes preintegrated BRDF lookup tables on Vulkan compute or the CPU, checks them, and states how
/// far each is from the truth.
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
    /// Draw a table, or measure methods and draw their speed and accuracy
    #[cfg(feature = "compare")]
    #[command(subcommand)]
    Chart(Box<chart::ChartArgs>),
    /// Find the smallest approximation that a scene needs, and prove that less does not do
    Plan(Box<plan::PlanArgs>),
    /// Report how much energy a material gives back in a white furnace
    Furnace(furnace::FurnaceArgs),
    /// Render spheres lit by a light, a furnace or a sky
    Preview(preview::PreviewArgs),
    /// List the tables that engines expect, or describe one
    Presets(presets::PresetsArgs),
    /// Tell what a table is, of whatever maker, and how wrong
    Verify(verify::VerifyArgs),
    /// Bake a table of whatever maker anew, in the convention of an engine
    Convert(convert::ConvertArgs),
    /// Print code that looks a table up, in a shading language, C or Rust
    Lookup(Box<lookup::LookupArgs>),
    /// List the Vulkan devices, the preferred one first
    Devices(devices::DevicesArgs),
    /// Print completions for a shell
    Completions(completions::CompletionArgs),
    /// Print the manual page, or that of a command
    Man(completions::ManArgs),
}

/// The command line's grammar, with the exit codes in its help.
fn command() -> clap::Command {
    let codes =
        ExitCode::MEANINGS.map(|(code, meaning)| format!("  {}  {meaning}", code as u8)).join("\n");
    let codes = format!("Exit codes:\n{codes}");
    let with_codes = |command: clap::Command| command.after_help(&codes);
    with_codes(Cli::command())
        .mut_subcommands(|command| with_codes(command).mut_subcommands(with_codes))
}

/// Runs the program with these arguments, the first being its name, and returns its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = arguments.into_iter().map(depfile::long_flag);
    let matches = command().try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error),
    };
    let outcome = match cli.command {
        Command::Bake(arguments) => bake::run(*arguments),
        #[cfg(feature = "compare")]
        Command::Chart(arguments) => chart::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Furnace(arguments) => furnace::run(&arguments),
        Command::Preview(arguments) => preview::run(&arguments),
        Command::Presets(arguments) => presets::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Lookup(arguments) => lookup::run(&arguments),
        Command::Devices(arguments) => devices::run(&arguments),
        Command::Completions(arguments) => completions::print_completions(&arguments),
        Command::Man(arguments) => completions::print_manual(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::Success as u8,
        Err(error) => {
            let _ =
                writeln!(std::io::stderr(), "splitsum: {}", message::shorten(&error.to_string()));
            error.exit_code() as u8
        }
    }
}

/// Prints the parser's message: the help that was asked for, or an error.
fn refuse(error: &clap::Error) -> u8 {
    if !error.use_stderr() {
        let _ = error.print();
        return ExitCode::Success as u8;
    }
    // The help that stands for a missing command is long, and meant to be.
    let (text, quoting) =
        (error.to_string(), error.kind() != DisplayHelpOnMissingArgumentOrSubcommand);
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
    let failed = Error::io("write to", "standard output", "check what reads it");
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
