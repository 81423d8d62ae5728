//! What is found out about a table, for people and for programs.

use super::channel::Channel;
use super::convention::Words;
use super::decision::Decision;
use super::errors::Errors;
use super::fault::Fault;
use crate::brdf::Microfacet;
use crate::table::precision::Precision;
use serde::Serialize;

/// Everything that is found out about a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// What the file says.
    pub file: FileFacts,
    /// Whether its convention is known.
    pub status: Status,
    /// Its lobe, where the data decide it.
    #[serde(skip)]
    pub lobe: Option<Microfacet>,
    /// What it is.
    pub convention: Option<Words>,
    /// The mean distance from it, in units of the channels' spreads.
    pub distance: Option<f64>,
    /// The number of conventions that were tried.
    pub tried: usize,
    /// What the data decide, each with how many times as far off the next choice is.
    pub decisions: Vec<Decision>,
    /// The errors of each channel whose meaning is known.
    pub channels: Vec<ChannelReport>,
    /// What is wrong.
    pub faults: Vec<Fault>,
    /// Seconds that it took.
    pub seconds: f64,
}

/// Whether a convention is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// A convention fits.
    Known,
    /// None does.
    Unknown,
}

/// What a file says of itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileFacts {
    /// Its name.
    pub name: String,
    /// Its container.
    pub container: &'static str,
    /// Columns, rows and slices.
    pub size: [usize; 3],
    /// The storage of its numbers.
    pub storage: Precision,
    /// The steps on which they lie.
    pub steps: Precision,
    /// What else it says.
    pub notes: Vec<String>,
    /// Its channels by their values.
    pub channels: Vec<Channel>,
}

/// A channel whose meaning is known, and its errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelReport {
    /// Its name in the file.
    pub name: String,
    /// Its meaning.
    pub meaning: String,
    /// The errors of the stored values.
    pub stored: Errors,
    /// The errors of a bilinear lookup.
    pub sampled: Errors,
    /// Columns and rows that were measured.
    pub measured: [usize; 2],
    /// Value less truth of those texels, row by row.
    #[serde(skip)]
    pub differences: Vec<f64>,
}

impl Report {
    /// Whether it is to be refused.
    pub fn fails(&self) -> bool {
        self.status == Status::Unknown || !self.faults.is_empty()
    }
}
