//! Every failure: what was expected, what was got, and the cure; and the exit code that each kind
//! of failure has.

use std::fmt;

/// The result of everything that can fail here.
pub type Result<T> = std::result::Result<T, Error>;

/// A failure, by kind. The kinds are the exit codes.
#[derive(Debug)]
pub enum Error {
    /// The command line does not make sense.
    Usage(Complaint),
    /// A file could not be read or written.
    Io {
        /// The action, as a verb.
        action: &'static str,
        /// The file, as the user named it.
        path: String,
        /// The system's error.
        source: std::io::Error,
        /// The cure.
        cure: &'static str,
    },
    /// A value, a configuration or a file has wrong content.
    BadInput(Complaint),
    /// No Vulkan device that can do the work.
    NoDevice(Complaint),
    /// A Vulkan device failed at work that it had taken on.
    DeviceFailure(String),
    /// A check found a result that is not what it has to be; nothing was written.
    CheckFailed(String),
    /// The system has not the memory or the threads that the work takes.
    Resources(Complaint),
    /// splitsum itself is at fault.
    Internal(String),
}

// Written out: with a macro for it, a build without features takes a fifth longer.
impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Usage(complaint)
            | Error::BadInput(complaint)
            | Error::NoDevice(complaint)
            | Error::Resources(complaint) => complaint.fmt(f),
            Error::Io { action, path, source, cure } => {
                write!(f, "cannot {action} {path}: {source}; {cure}")
            }
            Error::DeviceFailure(text) => write!(f, "the device failed: {text}"),
            Error::CheckFailed(text) => write!(f, "check failed: {text}"),
            Error::Internal(text) => write!(f, "internal error, please report it: {text}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// An expectation, the finding, and the cure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// The flag, key or thing that is wrong.
    pub what: String,
    /// The expectation.
    pub expected: String,
    /// The finding.
    pub got: String,
    /// The cure.
    pub cure: String,
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Complaint { what, expected, got, cure } = self;
        write!(f, "{what}: expected {expected}, got {got}; {cure}")
    }
}

impl Complaint {
    /// A complaint in its four parts.
    pub fn new(
        what: impl Into<String>,
        expected: impl Into<String>,
        got: impl Into<String>,
        cure: impl Into<String>,
    ) -> Self {
        Complaint {
            what: what.into(),
            expected: expected.into(),
            got: got.into(),
            cure: cure.into(),
        }
    }
}

/// The exit codes of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ExitCode {
    /// All done.
    Success = 0,
    /// splitsum itself is at fault.
    Internal = 1,
    /// The command line does not make sense.
    Usage = 2,
    /// A file could not be read or written.
    Io = 3,
    /// A value or a configuration has wrong content.
    BadInput = 4,
    /// No usable Vulkan device, though one was asked for.
    NoDevice = 5,
    /// The device failed while it worked.
    DeviceFailure = 6,
    /// A check found a wrong result: the device disagrees with the CPU, or a table misses its
    /// bound.
    CheckFailed = 7,
    /// There is not enough memory, or a thread was refused.
    Resources = 8,
}

impl ExitCode {
    /// Every code with its meaning, the text of `--help`.
    pub const MEANINGS: [(ExitCode, &'static str); 9] = [
        (ExitCode::Success, "all done"),
        (ExitCode::Internal, "a fault of splitsum itself"),
        (ExitCode::Usage, "the command line does not make sense"),
        (ExitCode::Io, "a file could not be read or written"),
        (ExitCode::BadInput, "a value or a configuration is wrong"),
        (ExitCode::NoDevice, "no usable Vulkan device, though one was asked for"),
        (ExitCode::DeviceFailure, "the Vulkan device failed at its work"),
        (
            ExitCode::CheckFailed,
            "a check failed: device and CPU differ, or a table misses its bound",
        ),
        (ExitCode::Resources, "not enough memory, or a thread was refused"),
    ];
}

impl Error {
    /// Bad input, in four parts.
    pub fn bad_input(
        what: impl Into<String>,
        expected: impl Into<String>,
        got: impl Into<String>,
        cure: impl Into<String>,
    ) -> Self {
        Error::BadInput(Complaint::new(what, expected, got, cure))
    }

    /// A failure of the system at a file, as an error.
    pub fn io<'a>(
        action: &'static str,
        path: &'a str,
        cure: &'static str,
    ) -> impl Fn(std::io::Error) -> Self + 'a {
        move |source| Error::Io { action, path: path.into(), source, cure }
    }

    /// The error of memory that cannot be had.
    pub fn out_of_memory(what: &str, bytes: usize) -> Self {
        let expected = format!("{} MiB of memory for {what}", bytes.div_ceil(1 << 20));
        Error::Resources(Complaint::new(
            "memory",
            expected,
            "less",
            "give a smaller --size, or free or allow more memory",
        ))
    }

    /// The exit code of this kind of failure.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Error::Usage(_) => ExitCode::Usage,
            Error::Io { .. } => ExitCode::Io,
            Error::BadInput(_) => ExitCode::BadInput,
            Error::NoDevice(_) => ExitCode::NoDevice,
            Error::DeviceFailure(_) => ExitCode::DeviceFailure,
            Error::CheckFailed(_) => ExitCode::CheckFailed,
            Error::Resources(_) => ExitCode::Resources,
            Error::Internal(_) => ExitCode::Internal,
        }
    }
}

/// Text of a file as a part of a line: no control characters, none that turn the direction of
/// writing, and at most so many characters.
#[cfg(feature = "cli")]
pub(crate) fn clean(text: &str, most: usize) -> String {
    let visible = |c: char| {
        let turns = matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(c, '\u{2066}'..='\u{2069}' | '\u{feff}');
        if c.is_control() || turns { ' ' } else { c }
    };
    let mut characters = text.trim().chars().map(visible);
    let mut cleaned: String = characters.by_ref().take(most).collect();
    if characters.next().is_some() {
        cleaned.pop();
        cleaned.push('…');
    }
    cleaned
}
