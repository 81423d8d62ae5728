//! `splitsum convert`

use super::table_args::TableArgs;
use super::verify::{ReadArgs, read_table};
use super::{choices, output, place, usage};
use crate::backend::Backend;
use crate::bake::Plan;
use crate::error::{Error, Result};
use crate::verify::{Demands, Status, verify};
use std::io::Write;

#[derive(clap::Args)]
pub struct ConvertArgs {
    /// Table of whatever maker, in a file that 'splitsum verify' reads
    file: String,
    /// File to write
    output: String,
    /// Engine in whose convention it is to be ('splitsum presets' lists them)
    #[arg(
        long, value_name = "NAME", value_parser = choices::preset(), hide_possible_values = true,
        required = true
    )]
    preset: String,
    #[command(flatten)]
    read: ReadArgs,
    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(arguments: &ConvertArgs) -> Result<()> {
    let ConvertArgs { file, output, preset, read, quiet } = arguments;
    let mut files = place::Files::default();
    files.add("the table that is read", file);
    if let Some(other) = files.add("the new one", output) {
        let got = format!("{output}, which is {other}");
        return Err(usage("output", "a file of its own", &got, "name another one"));
    }
    let (table, _) = read_table(file, read)?;
    let report = verify(file, &table, &Demands::default())?;
    let lobe = match (report.status, report.lobe) {
        (Status::Known, Some(lobe)) => lobe,
        (Status::Known, None) => {
            let got = "one of another family, or a lobe that the values do not decide";
            let cure = format!("bake what you want: splitsum bake --preset {preset}");
            return Err(Error::bad_input(file, "a split sum of one lobe", got, cure));
        }
        (Status::Unknown, _) => {
            let got = format!("none of {} that were tried", report.tried);
            let cure = "splitsum verify says how far off the nearest is";
            return Err(Error::bad_input(file, "a convention that is known", got, cure));
        }
    };
    let flags = format!("--preset {preset} --model {} --masking {}", lobe.ndf, lobe.masking);
    let mut flags = TableArgs::of_flags(&flags)?;
    flags.output = Some(output.clone());
    let job = flags.job()?;
    output::check(output)?;
    let baked = Plan::new(&job.request, &Backend::cpu())?.bake(&|_| ())?;
    output::write_with(output, &mut |out| job.encoding.write(&baked.table, out))?;
    if !quiet {
        let mut err = std::io::stderr();
        let _ = writeln!(err, "wrote     {output}\ncommand   {}", job.command());
        let own = TableArgs::of_flags(&format!("--preset {preset}"))?.job()?;
        let integrand = own.request.packing().main().integrand();
        if integrand != job.request.packing().main().integrand() {
            let _ = writeln!(
                err,
                "note      {preset} itself has {integrand}; the table that was read has {} and {}",
                lobe.ndf, lobe.masking
            );
        }
    }
    Ok(())
}
