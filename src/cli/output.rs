//! Writing files so that there is always either the old file or the whole new one.

use crate::encode::png::encode_rgb;
use crate::error::{Complaint, Error, Result};
use crate::report::map::Picture;
use std::fs::{self, File, OpenOptions};
use std::io::{self, IsTerminal, Write};
use std::path::Path;

/// Whether `name` can be written: asked before any work is done.
pub fn check(name: &str) -> Result<()> {
    if name == "-" {
        return if io::stdout().is_terminal() {
            let cure = "redirect it, or name a file with -o";
            Err(Error::Usage(Complaint::new("output", "a file or a pipe for binary data", "a terminal", cure)))
        } else {
            Ok(())
        };
    }
    let path = Path::new(name);
    if path.is_dir() || name.ends_with(std::path::is_separator) {
        return Err(failed("write", name, "name a file")(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    let folder = folder_of(path);
    if name == super::table_args::DEFAULT_OUTPUT {
        fs::create_dir_all(folder).map_err(failed("create the folder of", name, "choose another place with -o"))?;
    }
    fs::metadata(folder).map(drop).map_err(failed("find the folder of", name, "create it first"))
}

/// Writes a file, or standard output if its name is `-`.
pub fn write(name: &str, bytes: &[u8]) -> Result<()> {
    if name == "-" {
        let mut out = io::stdout().lock();
        return out.write_all(bytes).and_then(|()| out.flush()).map_err(failed(
            "write to",
            "standard output",
            "check what reads it",
        ));
    }
    write_file(Path::new(name), bytes).map_err(failed("write", name, "make room or choose another place with -o"))
}

/// Whether `name` can be written and is that of a picture.
pub fn check_picture(name: &str) -> Result<()> {
    if !name.ends_with(".png") {
        return Err(Error::bad_input("output", "a name that ends in .png", format!("'{name}'"), "rename it"));
    }
    check(name)
}

/// Writes a picture as PNG.
pub fn write_picture(name: &str, picture: &Picture) -> Result<()> {
    write(name, &encode_rgb(picture.width, picture.height, &picture.rgb)?)
}

/// A temporary file beside the target, synced, renamed over it, the folder synced; a device or pipe is written directly.
fn write_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let existing = fs::metadata(path).ok();
    if existing.as_ref().is_some_and(|existing| !existing.is_file()) {
        let mut file = OpenOptions::new().write(true).open(path)?;
        return file.write_all(bytes).and_then(|()| file.flush());
    }
    // A link stays a link: what it points to is replaced.
    let target = if existing.is_some() { fs::canonicalize(path)? } else { path.to_owned() };
    let folder = folder_of(&target);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".splitsum-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    if let Some(existing) = existing {
        file.as_file().set_permissions(existing.permissions())?;
    }
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(&target).map_err(|error| error.error)?;
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A failure of the system as an error.
pub fn failed<'a>(action: &'static str, name: &'a str, cure: &'static str) -> impl Fn(io::Error) -> Error + 'a {
    move |source| Error::Io { action, path: name.into(), source, cure }
}
