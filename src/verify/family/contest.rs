//! Whether a table is a split sum or of another family.

use super::kind;
use crate::brdf::Fresnel;
use crate::verify::decision::{self, DECIDED, Decision};
use crate::verify::refinement::{Refined, Refinement};
use crate::verify::sample::{FLOOR, Quantity};
use crate::verify::search::Hypothesis;

/// A split sum is one with another exponent of Schlick's approximation where that is so many times
/// nearer: a number that is fitted suits noise too.
const GAIN: f64 = 3.0;

/// The split sum, or what is nearer than it, refined; and what is decided of that where other
/// families were found, the nearest first.
pub fn contest(
    search: &Refinement,
    split_sum: Refined,
    families: &[Hypothesis],
) -> (Refined, Option<Decision>) {
    let nearer = |family: &Hypothesis, gain: f64| {
        gain * (family.distance + FLOOR) < split_sum.lobe.distance + FLOOR
    };
    // Another exponent that is no nearer than noise makes it is no rival.
    let is_rival = |family: &&Hypothesis| match is_of_another_exponent(family) {
        true => !is_same_for_every_exponent(family) && nearer(family, DECIDED),
        false => true,
    };
    let rivals: Vec<&Hypothesis> = families.iter().filter(is_rival).collect();
    if rivals.is_empty() {
        return (split_sum, None);
    }
    let wins = |family: &Hypothesis| {
        nearer(family, if is_of_another_exponent(family) { GAIN } else { DECIDED })
    };
    let winner = rivals.iter().find(|family| wins(family));
    let winner = winner.and_then(|family| search.from(family)).filter(|found| wins(&found.lobe));
    let family = |hypothesis: &Hypothesis| kind(&hypothesis.truth.lut);
    let split_sums = (family(&split_sum.lobe), split_sum.lobe.distance);
    let refined = winner.unwrap_or(split_sum);
    let own = family(&refined.lobe);
    let others = rivals.into_iter().map(|rival| (family(rival), rival.distance));
    let others = others.chain([split_sums]).filter(|(other, _)| *other != own).collect();
    let decision = decision::among("family", own, refined.lobe.distance, others);
    (refined, Some(decision))
}

/// Whether it is a split sum of another exponent of Schlick's approximation.
fn is_of_another_exponent(hypothesis: &Hypothesis) -> bool {
    matches!(hypothesis.truth.lut.fresnel(), Some(Fresnel::SchlickPower(_)))
}

/// Whether it is of E alone, which is the same for every exponent.
fn is_same_for_every_exponent(hypothesis: &Hypothesis) -> bool {
    let varies = |quantity| matches!(quantity, Quantity::Channel(0 | 1));
    !hypothesis.packing.iter().any(|&(_, quantity)| varies(quantity))
}
