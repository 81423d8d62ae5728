//! `splitsum completions` and `splitsum man`

use super::command;
use crate::error::{Error, Result};
use crate::format::metadata::TOOL;
use clap_complete::Shell;

#[derive(clap::Args)]
pub struct CompletionArgs {
    /// Shell
    shell: Shell,
}

#[derive(clap::Args)]
pub struct ManArgs {
    /// Command, as in 'chart speed' [default: the program itself]
    #[arg(value_name = "COMMAND")]
    path: Vec<String>,
}

pub fn print_completions(CompletionArgs { shell }: &CompletionArgs) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(*shell, &mut command(), "splitsum", &mut text);
    print_bytes(text)
}

pub fn print_manual(ManArgs { path }: &ManArgs) -> Result<()> {
    let mut page = command();
    // Names and usages of commands hold the whole path once it is built.
    page.build();
    for name in path {
        let known =
            page.get_subcommands().map(|command| command.get_name().to_owned()).collect::<Vec<_>>();
        page = page.find_subcommand(name).cloned().ok_or_else(|| match known.is_empty() {
            true => super::usage("command", "no further word", name, "leave it out"),
            false => super::usage("command", &known.join(", "), name, "name one of these"),
        })?;
    }
    let mut text = Vec::new();
    let failed = |error: std::io::Error| Error::Internal(format!("manual: {error}"));
    clap_mangen::Man::new(page)
        .source(TOOL)
        .manual("splitsum")
        .render(&mut text)
        .map_err(failed)?;
    print_bytes(text)
}

fn print_bytes(text: Vec<u8>) -> Result<()> {
    super::standard_output::check()?;
    super::print(String::from_utf8_lossy(&text).trim_end())
}
