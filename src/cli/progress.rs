//! A progress bar for work that takes more than a second, on a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Once;
use std::time::{Duration, Instant};

/// Work shorter than this needs no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Steps of a bar of work.
#[cfg(feature = "compare")]
const SHARES: usize = 1000;

/// A bar that shows itself when the work turns out to be long.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    shown: Once,
    wanted: bool,
}

impl Progress {
    /// A bar for the texels of the table `name`.
    pub fn new(name: &str, texels: usize, quiet: bool) -> Self {
        Progress::with_template(
            name,
            texels,
            "{msg} {bar:40} {percent}% of {len} texels, {eta} left",
            quiet,
        )
    }

    /// A bar for the pixels of the picture `name`.
    pub fn of_pixels(name: &str, pixels: usize) -> Self {
        Progress::with_template(
            name,
            pixels,
            "{msg} {bar:40} {percent}% of {len} pixels, {eta} left",
            false,
        )
    }

    /// A bar for work whose progress is a fraction.
    #[cfg(feature = "compare")]
    pub fn of_work(name: &str, quiet: bool) -> Self {
        Progress::with_template(name, SHARES, "{msg} {bar:40} {percent}%, {eta} left", quiet)
    }

    fn with_template(name: &str, length: usize, template: &str, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(length as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(name.to_owned());
        Progress {
            bar,
            start: Instant::now(),
            shown: Once::new(),
            wanted: !quiet && std::io::stderr().is_terminal(),
        }
    }

    /// Advances by texels or pixels.
    pub fn advance(&self, count: usize) {
        self.bar.inc(count as u64);
        self.show();
    }

    /// This fraction of the work is done.
    #[cfg(feature = "compare")]
    pub fn reach(&self, share: f64) {
        self.bar.set_position((share * SHARES as f64) as u64);
        self.show();
    }

    fn show(&self) {
        if self.wanted && self.start.elapsed() > PATIENCE {
            self.shown.call_once(|| self.bar.set_draw_target(ProgressDrawTarget::stderr()));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
