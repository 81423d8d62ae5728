//! Files that encoders fill, and what the system said when one could not be written.

use crate::error::{Error, Result};
use crate::format::WriteSeek;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

/// Fills a file through a buffer. What the system said is the error, whatever an encoder makes of
/// it.
pub fn fill_file(
    file: impl WriteSeek,
    fill: &mut dyn FnMut(&mut dyn WriteSeek) -> Result<()>,
    failed: impl Fn(io::Error) -> Error,
) -> Result<()> {
    let mut out = BufWriter::with_capacity(1 << 20, Watched { file, failure: None });
    let outcome = fill(&mut out);
    let flushed = out.flush();
    let failure = out.into_parts().0.failure;
    match (failure, outcome, flushed) {
        (Some(failure), ..) => Err(failed(failure)),
        (None, Ok(()), flushed) => flushed.map_err(failed),
        (None, outcome, _) => outcome,
    }
}

/// A file that remembers its first failure.
struct Watched<T> {
    file: T,
    failure: Option<io::Error>,
}

impl<T> Watched<T> {
    fn note<U>(&mut self, outcome: io::Result<U>) -> io::Result<U> {
        if let (None, Err(error)) = (&self.failure, &outcome)
            && error.kind() != io::ErrorKind::Interrupted
        {
            self.failure = Some(
                error
                    .raw_os_error()
                    .map_or_else(|| io::Error::from(error.kind()), io::Error::from_raw_os_error),
            );
        }
        outcome
    }
}

impl<T: Write> Write for Watched<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let outcome = self.file.write(bytes);
        self.note(outcome)
    }

    fn flush(&mut self) -> io::Result<()> {
        let outcome = self.file.flush();
        self.note(outcome)
    }
}

impl<T: Seek> Seek for Watched<T> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let outcome = self.file.seek(to);
        self.note(outcome)
    }
}
