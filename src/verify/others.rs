//! The channels beside a table's own pair: what else of ours each may be, scaled and shifted.

use super::channel::{Channel, Idle, Texels};
use super::decoding::Decoding;
use super::family::{is_split_sum, numbers};
use super::meaning::Meaning;
use super::sample::{FLOOR, Quantity, trimmed_mean};
use super::search::Hypothesis;
use super::truth::Truth;
use crate::brdf::{Diffuse, Fresnel, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use crate::lut::{Dfg, DfgChannels, Glass, Lut};

/// A channel that is farther off than this share of its spread is none of the table's.
const FARTHEST: f64 = 0.03;

/// The same where scale and offset are fitted, which makes much alike.
const FARTHEST_FITTED: f64 = 0.01;

/// A fit counts where it is so many times nearer than the number as it is.
const GAIN: f64 = 3.0;

/// Fewer digits may cost so much of the distance.
const WORSE: f64 = 1.1;

/// Texels along each axis at which channels are compared.
const SIDE: usize = 24;

/// The meanings of all channels of a slice: the pair of the nearest hypothesis, and what the others
/// are.
pub fn meanings(
    table: &Foreign,
    slice: usize,
    decoding: Decoding,
    channels: &[Channel],
    nearest: &Hypothesis,
) -> Result<Vec<Meaning>> {
    let candidates = candidates(nearest)?;
    let [columns, rows, _] = table.size;
    let step = |size: usize| (0..size).step_by(size.div_ceil(SIDE)).collect::<Vec<_>>();
    let (xs, ys) = (step(columns), step(rows));
    let all = Texels::new(table, slice);
    let points = super::search::points(&nearest.layout, [columns, rows], [&xs, &ys]);
    let of = |(place, channel): (usize, &Channel)| {
        if let Some(&(_, quantity)) = nearest.packing.iter().find(|(own, _)| *own == place) {
            return Meaning::plain(nearest.truth, quantity);
        }
        match channel.idle {
            Some(Idle::Constant(value)) => return Meaning::Constant(value),
            Some(Idle::Copy(of)) => return Meaning::Copy(of),
            Some(Idle::Broken) => return Meaning::Unknown,
            None => (),
        }
        let texel = |(j, i): (&usize, &usize)| decoding.value(&all[j * columns + i], place);
        let pairs = ys.iter().flat_map(|j| xs.iter().map(move |i| (j, i)));
        let values: Vec<f64> = pairs.map(texel).collect();
        nearest_of(&candidates, &points, &values, channel.spread)
    };
    Ok(channels.iter().enumerate().map(of).collect())
}

/// What a channel beside a pair may be.
fn candidates(nearest: &Hypothesis) -> Result<Vec<Meaning>> {
    let tolerance = nearest.truth.tolerance;
    let plain =
        |lut: Lut, channel| Meaning::plain(Truth { lut, tolerance }, Quantity::Channel(channel));
    let mut list = own(nearest.truth);
    if let Integrand::Specular(lobe, _) = nearest.truth.lut.integrand() {
        let own = Dfg::new(lobe, Fresnel::Schlick, DfgChannels::Every)?;
        list.extend([0, 1, 2].map(|channel| plain(Lut::Dfg(own), channel)));
        let tinted = Dfg::new(lobe, Fresnel::SchlickF82, DfgChannels::Every)?;
        list.push(plain(Lut::Dfg(tinted), 2));
    }
    for &masking in Ndf::Charlie.definition().maskings {
        let lobe = Microfacet::new(Ndf::Charlie, Some(masking))?;
        let dfg = Dfg::new(lobe, Fresnel::Schlick, DfgChannels::Every)?;
        list.push(plain(Lut::Dfg(dfg), 2));
    }
    // Lambert's is constant.
    let diffuse = Diffuse::ALL.iter().filter(|diffuse| **diffuse != Diffuse::Lambert);
    list.extend(diffuse.map(|&diffuse| plain(Lut::Diffuse(diffuse), 0)));
    list.extend([Meaning::Nov, Meaning::Roughness]);
    Ok(list)
}

/// The numbers of a table that is no split sum, and of glass those of its other side.
fn own(truth: Truth) -> Vec<Meaning> {
    if is_split_sum(truth) {
        return Vec::new();
    }
    let mut tables = vec![truth];
    if let Lut::Glass(glass) = truth.lut {
        let other = glass.interface().from(glass.interface().side().other());
        tables.push(Truth { lut: Lut::Glass(Glass::new(other, glass.channels())), ..truth });
    }
    let of = |truth: Truth| {
        numbers(&truth.lut).into_iter().map(move |quantity| Meaning::plain(truth, quantity))
    };
    tables.into_iter().flat_map(of).collect()
}

/// The candidate that is nearest to these values, as it is or scaled and shifted.
fn nearest_of(
    candidates: &[Meaning],
    points: &[(f64, f64)],
    values: &[f64],
    spread: f64,
) -> Meaning {
    let mut nearest = (Meaning::Unknown, f64::INFINITY);
    for candidate in candidates {
        let truth = at(candidate, points);
        let plain = distance(values, &truth, (1.0, 0.0)) / spread;
        if plain < FARTHEST && plain < nearest.1 {
            nearest = (candidate.clone(), plain);
        }
        let &Meaning::Number { truth: of, quantity, .. } = candidate else { continue };
        for shifted in [false, true] {
            let (scale, offset) = fitted(values, &truth, shifted);
            let distance = distance(values, &truth, (scale, offset)) / spread;
            // What is fitted has to be worth it.
            let gains = (distance + FLOOR) * GAIN < nearest.1 + FLOOR;
            if distance < FARTHEST_FITTED && gains && scale.abs() > 1e-3 {
                let by = |line| self::distance(values, &truth, line) / spread;
                let (scale, offset) = shortest((scale, offset), by);
                nearest = (Meaning::Number { truth: of, quantity, scale, offset }, distance);
            }
        }
    }
    nearest.0
}

/// The values of a candidate at these points.
fn at(candidate: &Meaning, points: &[(f64, f64)]) -> Vec<f64> {
    match candidate {
        Meaning::Number { truth, quantity, .. } => {
            truth.at(points).iter().map(|values| quantity.value(values)).collect()
        }
        Meaning::Nov => points.iter().map(|point| point.0).collect(),
        _ => points.iter().map(|point| point.1.sqrt()).collect(),
    }
}

fn distance(values: &[f64], truth: &[f64], (scale, offset): (f64, f64)) -> f64 {
    let difference = |(value, truth): (&f64, &f64)| (value - (scale * truth + offset)).abs();
    let mut differences: Vec<f64> = values.iter().zip(truth).map(difference).collect();
    differences.iter_mut().filter(|d| d.is_nan()).for_each(|d| *d = f64::INFINITY);
    trimmed_mean(&mut differences)
}

/// Scale and offset by least squares, three times, each time of the four fifths that fit best.
fn fitted(values: &[f64], truth: &[f64], shifted: bool) -> (f64, f64) {
    let mut pairs: Vec<(f64, f64)> = truth.iter().copied().zip(values.iter().copied()).collect();
    pairs.retain(|(truth, value)| truth.is_finite() && value.is_finite());
    let (all, mut line) = (pairs.len(), (1.0, 0.0));
    for round in 0..3 {
        if round > 0 {
            let off = |&(t, v): &(f64, f64)| (v - line.0 * t - line.1).abs();
            pairs.sort_by(|a, b| off(a).total_cmp(&off(b)));
            pairs.truncate((all * 4).div_ceil(5));
        }
        let count = pairs.len().max(1) as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
        let (t, v) = if shifted { (mean(|p| p.0), mean(|p| p.1)) } else { (0.0, 0.0) };
        let square: f64 = pairs.iter().map(|p| (p.0 - t) * (p.0 - t)).sum();
        let product: f64 = pairs.iter().map(|p| (p.0 - t) * (p.1 - v)).sum();
        let scale = if square > 0.0 { product / square } else { 0.0 };
        line = (scale, v - scale * t);
    }
    line
}

/// Scale and offset to as few digits as the values allow, four at the most: more are noise.
fn shortest((scale, offset): (f64, f64), distance: impl Fn((f64, f64)) -> f64) -> (f64, f64) {
    let rounded = |value: f64, digits: usize| {
        format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
    };
    let fitted = distance((scale, offset));
    let lines = (1..=4).map(|digits| (rounded(scale, digits), rounded(offset, digits)));
    let (scale_only, most) = ((rounded(scale, 4), rounded(offset, 4)), WORSE * (fitted + FLOOR));
    lines.into_iter().find(|&line| distance(line) + FLOOR < most).unwrap_or(scale_only)
}
