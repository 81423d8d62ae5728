//! The nearest table of another family than split sums.

use super::number::tuned;
use super::{averages, families, kind, metals, relatives};
use crate::error::Result;
use crate::lut::Lut;
use crate::verify::layout::{COMMON_NODES, Layout, NODES};
use crate::verify::sample::Sample;
use crate::verify::search::{EveryLayout, Hypothesis, nearest, sort, with_layouts};
use crate::verify::surface::Surface;
use std::cell::Cell;

/// The least texels of the longer axis by which a number can be fitted.
const LEAST_SIDE: usize = 8;

/// The hypotheses of each kind whose own number is fitted.
const FITTED: usize = 2;

/// The hypotheses that are tried with other lobes.
const WITH_LOBES: usize = 3;

/// Turns of layouts, numbers and lobes at the most.
const TURNS: usize = 3;

/// A table that is farther than this by every family is none of them: other lobes change less.
const FARTHEST: f64 = 0.06;

/// A table that is farther than this by the numbers from which fits begin is none of them.
const FARTHEST_AT_FIRST: f64 = 0.2;

/// What was found for each sample, and the number of hypotheses that were tried.
pub struct Found {
    /// The nearest for each sample, the nearest first.
    pub nearest: Vec<Vec<Hypothesis>>,
    /// How many were tried.
    pub tried: usize,
}

/// The nearest for samples of one table, each decoded otherwise.
pub fn seek(size: [usize; 2], samples: &[&Sample]) -> Result<Found> {
    let mut found = Found { nearest: vec![Vec::new(); samples.len()], tried: 0 };
    let alone = size.contains(&1);
    // Two columns, or two rows, tell no axis.
    if size[0].max(size[1]) < LEAST_SIDE || size.contains(&2) {
        return Ok(found);
    }
    let channels = samples.iter().map(|sample| sample.live()).max().unwrap_or(0);
    let sought = if alone { averages()? } else { families(channels)? };
    let surfaces: Vec<Surface> = sought.into_iter().map(Surface::new).collect();
    for (place, &sample) in samples.iter().enumerate() {
        let mut hypotheses = Vec::new();
        for surface in &surfaces {
            let every = EveryLayout::of_surface(surface, size, sample, &NODES[..COMMON_NODES]);
            let every = every.hypotheses(sample, false);
            found.tried += every.len();
            hypotheses.extend(nearest(&every).cloned());
        }
        let (nearest, tried) = by_number(hypotheses, size, sample);
        found.nearest[place] = nearest;
        found.tried += tried;
    }
    Ok(found)
}

/// These with the numbers, layouts and lobes that suit them, the nearest first; and the number of
/// those that were tried.
fn by_number(
    mut hypotheses: Vec<Hypothesis>,
    size: [usize; 2],
    sample: &Sample,
) -> (Vec<Hypothesis>, usize) {
    let tried = Cell::new(0);
    let count = |more: usize| tried.set(tried.get() + more);
    sort_once(&mut hypotheses);
    hypotheses.retain(|hypothesis| hypothesis.distance < FARTHEST_AT_FIRST);
    let mut kinds: Vec<String> = Vec::new();
    hypotheses.retain(|hypothesis| {
        let own = kind(&hypothesis.truth.lut);
        kinds.push(own.clone());
        kinds.iter().filter(|other| **other == own).count() <= FITTED
    });
    let suited = |hypothesis: Hypothesis| {
        let of = |&metal| with_layouts(metal, &[hypothesis.layout], size, sample);
        let metals: Vec<Hypothesis> = metals(hypothesis.truth).iter().flat_map(of).collect();
        count(metals.len().max(1));
        let nearest = nearest(&metals).cloned();
        nearest.unwrap_or_else(|| tuned(hypothesis, size, sample))
    };
    let mut hypotheses: Vec<Hypothesis> = hypotheses.into_iter().map(&suited).collect();
    sort_once(&mut hypotheses);
    // Number and lobe tell the layout, which tells number and lobe.
    for _ in 0..TURNS {
        let before = nearest(&hypotheses).map(|hypothesis| hypothesis.distance);
        hypotheses.truncate(WITH_LOBES);
        let with_layout = |hypothesis: &Hypothesis| {
            let surface = Surface::new(hypothesis.truth);
            let every = EveryLayout::of_surface(&surface, size, sample, &NODES[..COMMON_NODES]);
            let every = every.hypotheses(sample, false);
            count(every.len());
            nearest(&every).cloned()
        };
        let turned: Vec<Hypothesis> = hypotheses.iter().filter_map(with_layout).collect();
        hypotheses.extend(turned.into_iter().map(&suited));
        sort_once(&mut hypotheses);
        hypotheses.retain(|hypothesis| hypothesis.distance < FARTHEST);
        let of_lobes = |hypothesis: &Hypothesis| {
            let layout = [hypothesis.layout];
            let lobes = relatives(hypothesis.truth).into_iter();
            lobes.flat_map(|lobe| with_layouts(lobe, &layout, size, sample)).collect::<Vec<_>>()
        };
        let mut lobes: Vec<Hypothesis> =
            hypotheses.iter().take(WITH_LOBES).flat_map(of_lobes).collect();
        count(lobes.len());
        sort_once(&mut lobes);
        lobes.truncate(WITH_LOBES);
        hypotheses.extend(lobes.into_iter().map(&suited));
        sort_once(&mut hypotheses);
        if nearest(&hypotheses).map(|hypothesis| hypothesis.distance) >= before {
            break;
        }
    }
    (hypotheses, tried.get())
}

/// The nearest first, each once.
fn sort_once(hypotheses: &mut Vec<Hypothesis>) {
    sort(hypotheses);
    let mut known: Vec<(Lut, Layout)> = Vec::new();
    hypotheses.retain(|hypothesis| {
        let own = (hypothesis.truth.lut, hypothesis.layout);
        let is_new = !known.contains(&own);
        known.push(own);
        is_new
    });
}
