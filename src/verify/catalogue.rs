//! Tables that others ship, as they were measured.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// A table that somebody ships.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shipped {
    /// Whose it is.
    pub name: String,
    /// The version that was measured.
    pub version: String,
    /// Where it lies.
    pub file: String,
    /// Its convention, as flags of `splitsum bake`.
    pub convention: String,
    /// The sampler that made it.
    pub sampler: String,
    /// What is wrong with it.
    pub fault: String,
    /// What measured it.
    pub source: String,
}

#[derive(Deserialize)]
struct Catalogue {
    table: Vec<Shipped>,
}

/// All of them.
pub fn catalogue() -> Result<Vec<Shipped>> {
    let text = include_str!("catalogue.toml");
    let wrong = |error| Error::Internal(format!("catalogue: {error}"));
    toml::from_str::<Catalogue>(text).map(|catalogue| catalogue.table).map_err(wrong)
}
