//! Writing files so that there is always either the old file or the whole new one.

use super::place::resolve;
use super::temporary::Temporary;
use super::watched::fill_file;
use crate::error::{Error, Result};
use crate::format::WriteSeek;
use crate::format::png::encode_rgb;
use crate::image::Picture;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, IsTerminal, Seek, SeekFrom, Write};
use std::path::{Path, absolute};

/// Output to standard output, a device or a pipe, which cannot seek, waits in memory up to this
/// size, then on the disk.
const SPOOLED: usize = 1 << 24;

/// The folder of the default outputs, which is made where it is missing.
pub const DEFAULT_FOLDER: &str = "out";

/// The cure where a file cannot be written.
const CURE: &str = "make room or choose another place with -o";

/// Whether `name` can be written: asked before any work is done.
pub fn check(name: &str) -> Result<()> {
    if name == "-" {
        if io::stdout().is_terminal() {
            let cure = "redirect it, or name a file with -o";
            let expected = "a file or a pipe for binary data";
            return Err(super::usage("output", expected, "a terminal", cure));
        }
        return super::standard_output::check();
    }
    let path = Path::new(name);
    if path.is_dir() || name.ends_with(std::path::is_separator) {
        return Err(Error::io("write", name, "name a file")(io::Error::from(
            io::ErrorKind::IsADirectory,
        )));
    }
    if is_default_folder(folder_of(path)) {
        let failed = Error::io("create the folder of", name, "choose another place with -o");
        fs::create_dir_all(folder_of(path)).map_err(failed)?;
    }
    let target = resolve(path);
    let folder = folder_of(&target);
    fs::metadata(folder).map_err(Error::io("find the folder of", name, "create it first"))?;
    let existing = match fs::metadata(path) {
        Ok(existing) => Some(existing),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        // Links in a circle, for one.
        Err(error) => return Err(Error::io("write", name, "choose another place with -o")(error)),
    };
    if existing.is_some() {
        access(path).map_err(Error::io(
            "write",
            name,
            "make it writable, or choose another place with -o",
        ))?;
    }
    if existing.is_none_or(|existing| existing.is_file()) {
        access(folder).map_err(Error::io(
            "write to the folder of",
            name,
            "choose another place with -o",
        ))?;
    }
    Ok(())
}

/// Whether we may write to what is there.
#[cfg(unix)]
fn access(path: &Path) -> io::Result<()> {
    use rustix::fs::{Access, AtFlags, CWD, accessat};
    Ok(accessat(CWD, path, Access::WRITE_OK, AtFlags::EACCESS)?)
}

#[cfg(not(unix))]
fn access(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Writes a file, or standard output if its name is `-`.
pub fn write(name: &str, bytes: &[u8]) -> Result<()> {
    write_with(name, &mut |out| out.write_all(bytes).map_err(Error::io("write", name, CURE)))
}

/// Writes what `fill` writes to a file, or to standard output if its name is `-`; a file is never
/// held in memory.
pub fn write_with(
    name: &str,
    fill: &mut dyn FnMut(&mut dyn WriteSeek) -> Result<()>,
) -> Result<()> {
    let path = Path::new(name);
    let existing = fs::metadata(path).ok();
    if name != "-" && existing.as_ref().is_none_or(Metadata::is_file) {
        // A link stays a link: what it points to is replaced.
        return replace(&resolve(path), existing.as_ref(), name, fill);
    }
    let mut spool = tempfile::spooled_tempfile(SPOOLED);
    fill_file(&mut spool, fill, Error::io("write", name, CURE))?;
    let failed = if name == "-" {
        Error::io("write to", "standard output", "check what reads it")
    } else {
        Error::io("write", name, CURE)
    };
    copy(&mut spool, name).map_err(failed)
}

/// Whether `name` can be written and is that of a picture.
pub fn check_picture(name: &str) -> Result<()> {
    let extension = Path::new(name).extension().unwrap_or_default();
    if !extension.eq_ignore_ascii_case("png") {
        return Err(Error::bad_input(
            "output",
            "a name that ends in .png",
            format!("'{name}'"),
            "rename it",
        ));
    }
    check(name)
}

/// Writes a picture as PNG.
pub fn write_picture(name: &str, picture: &Picture) -> Result<()> {
    write(name, &encode_rgb(picture.width, picture.height, &picture.rgb)?)
}

/// A temporary file beside the target, renamed over it; permissions are kept, and owners where the
/// system lets us.
fn replace(
    target: &Path,
    existing: Option<&Metadata>,
    name: &str,
    fill: &mut dyn FnMut(&mut dyn WriteSeek) -> Result<()>,
) -> Result<()> {
    let failed = Error::io("write", name, CURE);
    let temporary = Temporary::new(folder_of(target)).map_err(&failed)?;
    if let Some(existing) = existing {
        keep_owner(temporary.file(), existing).map_err(&failed)?;
        temporary.file().set_permissions(existing.permissions()).map_err(&failed)?;
    }
    fill_file(temporary.file(), fill, &failed)?;
    temporary.persist(target).map_err(failed)
}

/// Gives a file the owner and the group of the one that it replaces, or the group alone; only root
/// can do the former.
#[cfg(unix)]
fn keep_owner(file: &File, existing: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, fchown};
    let (new, user, group) = (file.metadata()?, existing.uid(), existing.gid());
    if (new.uid(), new.gid()) != (user, group) {
        let _ = fchown(file, Some(user), Some(group)).or_else(|_| fchown(file, None, Some(group)));
    }
    Ok(())
}

#[cfg(not(unix))]
fn keep_owner(_: &File, _: &Metadata) -> io::Result<()> {
    Ok(())
}

fn copy(spool: &mut (impl io::Read + Seek), name: &str) -> io::Result<()> {
    spool.seek(SeekFrom::Start(0))?;
    let mut out: Box<dyn Write> = if name == "-" {
        Box::new(io::stdout().lock())
    } else {
        Box::new(OpenOptions::new().write(true).open(name)?)
    };
    io::copy(spool, &mut out)?;
    out.flush()
}

/// Whether a folder is that of the default outputs, however it is written.
fn is_default_folder(folder: &Path) -> bool {
    let default = absolute(DEFAULT_FOLDER).ok();
    default.is_some() && absolute(folder).ok() == default
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
