//! Whether a table is a split sum or of another family.

use super::{farthest, kind};
use crate::brdf::Fresnel;
use crate::verify::decision::{self, DECIDED, Decision};
use crate::verify::refinement::{Refined, Refinement};
use crate::verify::sample::{FLOOR, Quantity};
use crate::verify::search::Hypothesis;

/// A split sum is one with another exponent of Schlick's approximation, or of a family that is not
/// known, where that is so many times nearer: a number that is fitted suits noise too.
const GAIN: f64 = 3.0;

/// Of split sums that are known the farthest lay at 0.013.
const KNOWN: f64 = 0.015;

/// The split sum, or what is nearer than it, refined; and what is decided of that where there are
/// other families. `families`: the nearest first; `rounding`: as [`farthest`] has it.
pub fn contest(
    search: &Refinement,
    split_sum: Refined,
    families: &[Hypothesis],
    rounding: &[f64],
) -> (Refined, Option<Decision>) {
    let nearer = |family: &Hypothesis, gain: f64| {
        gain * (family.distance + FLOOR) < split_sum.lobe.distance + FLOOR
    };
    // A fitted exponent is always a little nearer, by noise alone.
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
    // A family that is nearer by little and too far to be known leaves a split sum that may be.
    let counts = |found: &Refined| {
        let is_known = found.lobe.distance <= farthest(&found.lobe, rounding);
        let may_be = split_sum.lobe.distance < KNOWN && !nearer(&found.lobe, GAIN);
        wins(&found.lobe) && (is_known || !may_be)
    };
    let winner = winner.and_then(|family| search.from(family)).filter(counts);
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
