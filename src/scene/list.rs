//! A list of materials in JSON, for scenes that are not glTF:
//! `{"materials": [{"name": "oak", "roughness": [0.3, 0.6], "f0": 0.04}]}`.

use super::span::Span;
use super::{Assumptions, Layer, Lobe, MOST_MATERIALS, named};
use crate::error::clean;
use crate::error::{Error, Result};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    materials: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Option<String>,
    roughness: Extent,
    f0: Option<Extent>,
    f90: Option<Extent>,
    layer: Option<Layer>,
}

/// A number, or the ends of an interval.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "expected a number or [low, high]")]
enum Extent {
    One(f64),
    Ends([f64; 2]),
}

/// The lobes of a list.
pub fn lobes(name: &str, json: &[u8], assumptions: &Assumptions) -> Result<Vec<Lobe>> {
    let list: List = serde_json::from_slice(json).map_err(|error| {
        let got = clean(&error.to_string(), 200);
        let cure = "name a glTF file, or see 'splitsum plan --help' for the list";
        Error::bad_input(name, "a list of materials", got, cure)
    })?;
    if list.materials.len() > MOST_MATERIALS {
        let got = list.materials.len().to_string();
        let cure = "give those in use";
        return Err(Error::bad_input(name, "at most 65536 materials", got, cure));
    }
    let entries = list.materials.into_iter().enumerate();
    entries.map(|(index, entry)| lobe(name, index, entry, assumptions)).collect()
}

fn lobe(file: &str, index: usize, entry: Entry, assumptions: &Assumptions) -> Result<Lobe> {
    let material = named(entry.name.as_deref(), index);
    let within = |what: &str, extent: Extent| {
        let (low, high) = match extent {
            Extent::One(value) => (value, value),
            Extent::Ends([low, high]) => (low, high),
        };
        let what = format!("{file}: {what} of {material}");
        let span = Span::new(&what, low, high)?;
        if !span.is_in(Span::UNIT) {
            let (got, cure) = (span.to_string(), "give numbers in that range");
            return Err(Error::bad_input(what, "0 to 1", got, cure));
        }
        Ok(span)
    };
    let roughness = within("roughness", entry.roughness)?;
    Ok(Lobe {
        roughness: assumptions.applied_to(roughness),
        f0: within("f0", entry.f0.unwrap_or(Extent::One(0.04)))?,
        f90: within("f90", entry.f90.unwrap_or(Extent::One(1.0)))?,
        layer: entry.layer.unwrap_or(Layer::Base),
        histogram: None,
        from: vec![format!("roughness {roughness}: the list")],
        material,
    })
}
