//! Temporary files beside a target. Where the system can, they have no name until they are whole,
//! so that nothing is left of them whatever ends the program; those with a name are locked while
//! they are written, and removed later if they were left.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::{NamedTempFile, TempPath};

const PREFIX: &str = ".splitsum-";
const SUFFIX: &str = ".tmp";

/// Random letters between the two.
const RANDOM: usize = 6;

/// A file without a lock that is younger than this may be about to get one.
const STALE: Duration = Duration::from_secs(60);

/// A file that will take another's place.
pub struct Temporary {
    file: File,
    folder: PathBuf,
    /// None while it has no name.
    path: Option<TempPath>,
}

impl Temporary {
    /// An empty file in the folder of its target.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let (file, path) = match nameless(folder) {
            Some(file) => (file, None),
            None => {
                let (file, path) = builder().tempfile_in(folder)?.into_parts();
                (file, Some(path))
            }
        };
        // Where a file system has no locks, what was left is not removed: nobody can tell whether
        // it is still written.
        let _ = file.try_lock();
        remove_stale(folder, &file);
        Ok(Temporary { file, folder: folder.to_owned(), path })
    }

    pub fn file(&self) -> &File {
        &self.file
    }

    /// Puts the file in the target's place, once all of it is on the disk.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        let path = match self.path {
            Some(path) => path,
            None => builder()
                .make_in(&self.folder, |path| link(&self.file, path))
                .map(NamedTempFile::into_temp_path)?,
        };
        path.persist(target).map_err(|error| error.error)?;
        if cfg!(unix) {
            File::open(&self.folder)?.sync_all()?;
        }
        Ok(())
    }
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).rand_bytes(RANDOM).suffix(SUFFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

/// A file without a name that can be given one.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    let mode = Mode::from_raw_mode(0o666);
    let file =
        File::from(open(folder, OFlags::RDWR | OFlags::TMPFILE | OFlags::CLOEXEC, mode).ok()?);
    descriptor(&file).exists().then_some(file)
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path) -> Option<File> {
    None
}

/// Gives a file without a name one.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    Ok(linkat(CWD, descriptor(file), CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(target_os = "linux")]
fn descriptor(file: &File) -> PathBuf {
    use std::os::fd::AsRawFd;
    format!("/proc/self/fd/{}", file.as_raw_fd()).into()
}

/// Removes what killed programs have left in the folder: files of the owner of `ours` that nobody
/// writes any more.
fn remove_stale(folder: &Path, ours: &File) {
    let (Ok(entries), Ok(ours)) = (fs::read_dir(folder), ours.metadata()) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let length = PREFIX.len() + RANDOM + SUFFIX.len();
        let ours_by_name =
            name.starts_with(PREFIX) && name.ends_with(SUFFIX) && name.len() == length;
        if ours_by_name && is_stale(&entry, &ours).unwrap_or(false) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn is_stale(entry: &fs::DirEntry, ours: &fs::Metadata) -> io::Result<bool> {
    let metadata = entry.metadata()?;
    let old = metadata.modified()?.elapsed().is_ok_and(|age| age > STALE);
    if !old || !metadata.is_file() || !same_owner(&metadata, ours) {
        return Ok(false);
    }
    Ok(File::open(entry.path())?.try_lock().is_ok())
}

#[cfg(unix)]
fn same_owner(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    a.uid() == b.uid()
}

#[cfg(not(unix))]
fn same_owner(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}
