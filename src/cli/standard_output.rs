//! Standard output: whether it is open, before work is done for it.

use crate::error::{Error, Result};
use std::io;

/// Whether standard output is open. Rust opens /dev/null for reading and writing where it is not;
/// who wants what is written to be lost opens it for writing.
pub fn check() -> Result<()> {
    if is_closed() {
        let closed = io::Error::new(
            io::ErrorKind::BrokenPipe,
            "it is closed, or is /dev/null opened for reading too",
        );
        return Err(Error::io("write to", "standard output", "redirect it to a file or a pipe")(
            closed,
        ));
    }
    Ok(())
}

#[cfg(target_os = "linux")]
fn is_closed() -> bool {
    use rustix::fs::{FileType, OFlags, fcntl_getfl, fstat, major, minor};
    let out = io::stdout();
    let (Ok(stat), Ok(flags)) = (fstat(&out), fcntl_getfl(&out)) else { return true };
    let null = FileType::from_raw_mode(stat.st_mode) == FileType::CharacterDevice
        && (major(stat.st_rdev), minor(stat.st_rdev)) == (1, 3);
    null && flags & OFlags::RWMODE == OFlags::RDWR
}

#[cfg(not(target_os = "linux"))]
fn is_closed() -> bool {
    false
}
