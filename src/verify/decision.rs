//! What the data decide: in each dimension the best choice, against the best of all others.

use super::decoding::Decoding;
use super::sample::{FLOOR, Packing, Quantity};
use super::search::Hypothesis;
use crate::integrate::Integrand;
use crate::lut::Lut;
use crate::table::axis::{AxisSpec, Mapping, Nodes};
use crate::units::short;
use serde::Serialize;
use std::collections::HashSet;

/// A choice is decided where every other is so many times as far off.
pub const DECIDED: f64 = 1.3;

/// A choice in one dimension.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decision {
    /// What is chosen.
    pub dimension: &'static str,
    /// The choice that fits best.
    pub choice: String,
    /// How many times as far off the best other choice is.
    pub ratio: f64,
    /// Whether the data decide it.
    pub decided: bool,
    /// Whether a sampler proves it, whatever the ratio.
    pub proved: bool,
    /// The other choices that fit as well, the nearest first.
    pub others: Vec<String>,
}

/// The dimensions of a hypothesis, and the choice in each.
type Dimension = (&'static str, fn(&Hypothesis) -> String);

/// Those of axes but for nodes.
pub const LAYOUT: [Dimension; 6] = [
    ("axes", |h| match h.layout.is_transposed() {
        false => "x = nov, y = roughness".into(),
        true => "x = roughness, y = nov".into(),
    }),
    ("direction of nov", |h| direction(h.layout.nov())),
    ("direction of roughness", |h| direction(h.layout.roughness())),
    ("mapping of nov", |h| mapping(h.layout.nov())),
    ("mapping of roughness", |h| mapping(h.layout.roughness())),
    ("channels", |h| channels(h)),
];

/// Those of nodes.
pub const NODES: [Dimension; 2] = [
    ("nodes of nov", |h| nodes(h.layout.nov())),
    ("nodes of roughness", |h| nodes(h.layout.roughness())),
];

/// Those of the lobe.
pub const LOBE: [Dimension; 2] = [
    ("distribution", |h| match h.truth.lut.integrand() {
        Integrand::Specular(lobe, _) => lobe.ndf.to_string(),
        Integrand::Glass(interface) => interface.lobe().ndf.to_string(),
        Integrand::Diffuse(diffuse) => diffuse.to_string(),
    }),
    ("masking", |h| match h.truth.lut.integrand() {
        Integrand::Specular(lobe, _) => lobe.masking.to_string(),
        Integrand::Glass(interface) => interface.lobe().masking.to_string(),
        Integrand::Diffuse(_) => "none".into(),
    }),
];

/// Whether the parameter rises along the axis.
fn direction(spec: AxisSpec) -> String {
    // The complement falls unless it is turned.
    let falls = spec.flip != (spec.mapping == Mapping::SqrtComplement);
    if falls { "falls" } else { "rises" }.into()
}

fn mapping(spec: AxisSpec) -> String {
    format!("{},{}", spec.parameter, spec.mapping)
}

/// The words of nodes.
pub fn nodes(spec: AxisSpec) -> String {
    match spec.nodes {
        Nodes::Edges => "edges".into(),
        Nodes::Offset(0.5) => "centres".into(),
        Nodes::Offset(offset) => format!("offset={}", short(offset)),
    }
}

/// The channels that are known, by the words of ours.
fn channels(hypothesis: &Hypothesis) -> String {
    let word = |&(channel, quantity): &(usize, Quantity)| {
        format!("{channel} = {}", word(&hypothesis.truth.lut, quantity))
    };
    hypothesis.packing.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// The word of a number of ours.
pub fn word(lut: &Lut, quantity: Quantity) -> String {
    let name = |channel: usize| {
        let channels = lut.channels();
        channels.get(channel).map_or_else(String::new, |channel| channel.name.to_lowercase())
    };
    match quantity {
        Quantity::Channel(channel) => name(channel),
        Quantity::Complement(channel) => {
            let name = name(channel);
            match name.strip_prefix("1-") {
                Some(rest) => rest.to_owned(),
                None if name.contains('+') && !name.starts_with('(') => format!("1-({name})"),
                None => format!("1-{name}"),
            }
        }
    }
}

/// The decisions in these dimensions for a hypothesis among others.
pub fn decide(
    dimensions: &[Dimension],
    chosen: &Hypothesis,
    hypotheses: &[Hypothesis],
) -> Vec<Decision> {
    let decision = |&(dimension, choice): &Dimension| {
        let choice_of = choice(chosen);
        let mut others: Vec<(String, f64)> = Vec::new();
        for hypothesis in hypotheses {
            let other = choice(hypothesis);
            let of_both = dimension == "channels" && agree(&chosen.packing, &hypothesis.packing);
            if other == choice_of || of_both {
                continue;
            }
            others.push((other, hypothesis.distance));
        }
        among(dimension, choice_of, chosen.distance, others)
    };
    dimensions.iter().map(decision).collect()
}

/// Whether two pairs of channels can both be right.
fn agree(one: &Packing, other: &Packing) -> bool {
    let differ = |a: &(usize, Quantity), b: &(usize, Quantity)| (a.0 == b.0) != (a.1 == b.1);
    !one.iter().any(|a| other.iter().any(|b| differ(a, b)))
}

/// Whether a dimension is decided.
pub fn is_decided(decisions: &[Decision], dimension: &str) -> bool {
    decisions.iter().any(|decision| decision.dimension == dimension && decision.decided)
}

/// The decision on how codes become values.
pub fn decoding(chosen: (Decoding, f64), all: &[(Decoding, f64)]) -> Decision {
    let others = all.iter().filter(|(other, _)| *other != chosen.0);
    let others = others.map(|&(decoding, distance)| (decoding.to_string(), distance)).collect();
    among("encoding", chosen.0.to_string(), chosen.1, others)
}

/// The decision in a dimension: the choice and its distance against all others and theirs.
pub fn among(
    dimension: &'static str,
    choice: String,
    distance: f64,
    mut others: Vec<(String, f64)>,
) -> Decision {
    others.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut known = HashSet::new();
    others.retain(|(other, _)| known.insert(other.clone()));
    let ratio = |other: f64| (other + FLOOR) / (distance + FLOOR);
    let next = others.first().map_or(f64::INFINITY, |&(_, other)| ratio(other));
    let tied = others.into_iter().filter(|&(_, other)| ratio(other) < DECIDED);
    let others = tied.map(|(other, _)| other).collect();
    Decision { dimension, choice, ratio: next, decided: next >= DECIDED, proved: false, others }
}
