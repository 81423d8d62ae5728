//! A progress bar for work that takes more than a second, on a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Once;
use std::time::{Duration, Instant};

/// Work shorter than this needs no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that shows itself when the work turns out to be long.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    shown: Once,
    wanted: bool,
}

impl Progress {
    /// For so many texels of the table `name`.
    pub fn new(name: &str, texels: usize, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(texels as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {percent}% of {len} texels, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(name.to_owned());
        Progress { bar, start: Instant::now(), shown: Once::new(), wanted: !quiet && std::io::stderr().is_terminal() }
    }

    /// So many texels more.
    pub fn advance(&self, texels: usize) {
        self.bar.inc(texels as u64);
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
