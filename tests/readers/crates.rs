//! The crates `ktx2` and `dds`, and Bevy's loader of images, which a program of its own holds
//! (tests/foreign): they would double the build of ours.

use crate::common::printed;
use crate::files::{File, write_all};
use libtest_mimic::Failed;
use splitsum::table::precision::Precision;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// Whether Bevy refuses a file: wgpu has no such format, or Bevy's loader does not know it.
fn bevy_refuses(file: &File) -> bool {
    file.kind() == "ktx2" && file.precision == Precision::A2b10g10r10
}

pub fn read_everything(program: &Path) -> Result<(), Failed> {
    let folder = tempdir()?;
    let files = write_all(folder.path());
    let files: Vec<&File> =
        files.iter().filter(|file| ["ktx2", "dds"].contains(&file.kind())).collect();
    assert!(files.len() > 40, "{}", files.len());
    let output = printed(Command::new(program).args(files.iter().map(|file| &file.path)))?;
    let text = String::from_utf8(output)?;
    let mut lines = text.lines();
    for file in files {
        for reader in [file.kind(), "bevy"] {
            let line = lines.next().ok_or("too few lines")?;
            let (named, found) = line.rsplit_once('\t').ok_or("no tab")?;
            assert!(named.ends_with(&format!("\t{reader}")), "{line}");
            if reader == "bevy" && bevy_refuses(file) {
                assert!(found.starts_with("refused"), "{line}");
                continue;
            }
            // The crate `dds` gives 10 bits as f32; the others lose nothing.
            let allowed = if file.precision == Precision::A2b10g10r10 { 6e-8 } else { 0.0 };
            let difference: f64 = found.parse().map_err(|_| line.to_owned())?;
            assert!(difference <= allowed, "{line}");
        }
    }
    Ok(())
}
