//! Which names mean the same file, through links, hard links and `..`: what a command reads and
//! writes is compared before any work is done.

use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// More links than this lead in a circle.
const LINKS: usize = 40;

/// The files of a command so far, each with what it is to the command.
#[derive(Default)]
pub struct Files(Vec<(String, Place)>);

/// Where a file is, or will be.
struct Place {
    path: PathBuf,
    /// Device and inode of what is there.
    id: Option<(u64, u64)>,
    /// The same of its folder, and its name there: a folder can be mounted in two places.
    entry: Option<((u64, u64), OsString)>,
}

impl Files {
    /// Takes note of a file; what comes back is what the same file already was. Devices and pipes
    /// are theirs who write to them: they can be named as often as one likes.
    pub fn add(&mut self, what: impl Into<String>, name: &str) -> Option<&str> {
        let place = Place::of(name)?;
        match self.0.iter().position(|(_, other)| other.is(&place)) {
            Some(index) => Some(&self.0[index].0),
            None => {
                self.0.push((what.into(), place));
                None
            }
        }
    }
}

impl Place {
    fn of(name: &str) -> Option<Self> {
        // Standard output may be a file that is named elsewhere.
        let name = if name == "-" { "/dev/stdout" } else { name };
        let existing = fs::metadata(name).ok();
        if existing.as_ref().map_or(name == "/dev/stdout", |existing| !existing.is_file()) {
            return None;
        }
        let path = canonical(&resolve(Path::new(name)));
        let folder =
            path.parent().and_then(|folder| fs::metadata(folder).ok()).as_ref().and_then(id);
        let entry = folder.zip(path.file_name().map(OsString::from));
        Some(Place { id: existing.as_ref().and_then(id), entry, path })
    }

    fn is(&self, other: &Place) -> bool {
        self.path == other.path
            || self.id.is_some() && self.id == other.id
            || self.entry.is_some() && self.entry == other.entry
    }
}

/// Follows the links of a path, also where nothing is there yet.
pub fn resolve(path: &Path) -> PathBuf {
    // Not all that exists has a path: a link to a pipe leads to none.
    if path.exists() {
        return fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    }
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        let Ok(link) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(link);
    }
    path
}

/// The one spelling of a path. Folders that do not exist are taken as they are written: they are no
/// links once they are made, so that `..` leads out of them again.
fn canonical(path: &Path) -> PathBuf {
    if path.as_os_str().is_empty() {
        return canonical(Path::new("."));
    }
    if let Ok(path) = fs::canonicalize(path) {
        return path;
    }
    match (path.parent(), path.components().next_back()) {
        (Some(folder), Some(Component::Normal(name))) => canonical(folder).join(name),
        (Some(folder), Some(Component::ParentDir)) => {
            let folder = canonical(folder);
            folder.parent().unwrap_or(&folder).to_owned()
        }
        _ => path.to_owned(),
    }
}

#[cfg(unix)]
fn id(metadata: &fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn id(_: &fs::Metadata) -> Option<(u64, u64)> {
    None
}
