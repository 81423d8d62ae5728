//! Which table of ours a foreign one is: coarse lobes find the layout, layouts the lobe, and more
//! texels the nodes.

use super::candidates::{likely, sheen, split_sums, unlikely};
use super::channel::{Channel, Texels, channels};
use super::decision::{self, Decision, decide};
use super::decoding::Decoding;
use super::family::contest::contest;
use super::family::number::{neighbours, parameter, tuned};
use super::family::seek::seek;
use super::family::{fine, is_split_sum};
use super::layout::{Layout, NODES};
use super::quantisation::rounding;
use super::refinement::{Refined, Refinement};
use super::sample::{FLOOR, Quantity, Sample, distance};
use super::search::{EveryLayout, Hypothesis, nearest, points, sort, with_lobes};
use super::surface::Surface;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::table::precision::Precision;
use crate::units::short;

/// Texels along each axis that tell layouts apart.
const FEW: usize = 12;

/// Texels along each axis that tell the number that is a table's own.
const SOME: usize = 20;

/// Texels along each axis that tell nodes apart.
pub const MANY: usize = 48;

/// A table that is as near as this by the likely lobes is not sought by more, by all but sheen not
/// by sheen, and by all split sums not by other families.
const CLOSE: [f64; 3] = [0.004, 0.015, 0.002];

/// The last of them for tables of one channel.
const CLOSE_ALONE: f64 = 0.001;

/// The layouts with which lobes are told apart.
const LAYOUTS: usize = 24;

/// What a table is nearest to.
#[derive(Clone, Debug)]
pub struct Identity {
    /// How codes become values.
    pub decoding: Decoding,
    /// The channels by their values.
    pub channels: Vec<Channel>,
    /// The nearest hypothesis.
    pub nearest: Hypothesis,
    /// What the data decide.
    pub decisions: Vec<Decision>,
    /// The number of conventions that were tried.
    pub tried: usize,
}

/// The nearest hypothesis for a slice whose numbers lie on these steps; none of a table without a
/// channel that tells something.
pub fn identify(table: &Foreign, slice: usize, steps: Precision) -> Result<Option<Identity>> {
    let size = [table.size[0], table.size[1]];
    let few = |decoding: Decoding| {
        let channels = channels(table, slice, decoding);
        let sample = Sample::new(table, slice, decoding, &channels, FEW);
        (channels, sample)
    };
    // A way that leaves no channel is none: over an alpha of 0 there are no values.
    let mut ways: Vec<(Decoding, (Vec<Channel>, Sample))> =
        Decoding::of(table, slice).into_iter().map(|decoding| (decoding, few(decoding))).collect();
    ways.retain(|(_, (_, sample))| sample.live() > 0);
    if ways.is_empty() {
        return Ok(None);
    }
    let (decodings, both): (Vec<Decoding>, Vec<_>) = ways.into_iter().unzip();
    let (lists, few): (Vec<Vec<Channel>>, Vec<Sample>) = both.into_iter().unzip();
    // Layouts by few lobes, for each way to decode; lobes by the nearest layouts.
    let mut lobes = Vec::new();
    let mut found: Vec<Vec<Hypothesis>> = vec![Vec::new(); decodings.len()];
    let mut nearest_of: Vec<Hypothesis> = Vec::new();
    // Sheen costs most, and is like no other.
    for (step, layouts_by) in [likely()?, unlikely()?, sheen()?].into_iter().enumerate() {
        lobes = split_sums(step == 2)?;
        for truth in layouts_by {
            let surface = Surface::new(truth);
            let every = EveryLayout::of_surface(&surface, size, &few[0], &NODES);
            for (found, sample) in found.iter_mut().zip(&few) {
                found.extend(every.hypotheses(sample, false));
            }
        }
        let of = |(found, sample): (&mut Vec<Hypothesis>, &Sample)| {
            sort(found);
            nearest(&with_lobes(&lobes, &first_layouts(found, LAYOUTS), size, sample)).cloned()
        };
        nearest_of = found.iter_mut().zip(&few).filter_map(of).collect();
        if nearest_of.iter().any(|nearest| nearest.distance < CLOSE[step]) {
            break;
        }
    }
    let (families, families_tried) = ask_families(&nearest_of, size, &few)?;
    let nearest_of_all: Vec<Hypothesis> = nearest_of
        .iter()
        .zip(&families)
        .map(|(split_sum, families)| first_of(split_sum, families).clone())
        .collect();
    let Some((k, _)) = first_by_distance(&nearest_of_all) else { return Ok(None) };
    let (k, encoding) = by_encoding(table, slice, &decodings, &nearest_of_all, k, &lists);
    let many = Sample::new(table, slice, decodings[k], &lists[k], MANY);
    let some = Sample::new(table, slice, decodings[k], &lists[k], SOME);
    let search = Refinement { lobes: &lobes, size, few: &few[k], some: &some, many: &many };
    let Some(split_sum) = search.from(&nearest_of[k]) else { return Ok(None) };
    let rounding = rounding(steps, &lists[k]);
    let (refined, family) = contest(&search, split_sum, &families[k], &rounding);
    let Refined { layout, every, nodes, by_nodes, lobe, by_lobe } = refined;
    let mut decisions = vec![encoding];
    decisions.extend(family);
    decisions.extend(decide(&decision::LAYOUT, &layout, &every));
    decisions.extend(decide(&decision::NODES, &nodes, &by_nodes));
    decisions.extend(decide(&decision::LOBE, &lobe, &by_lobe));
    let lobe = if is_split_sum(lobe.truth) { lobe } else { tuned(fine(lobe), size, &some) };
    // Where all n·v are alike nothing is told of that axis.
    let told = lobe.truth.lut.depends_on_nov();
    decisions.retain(|decision| told || !decision.dimension.ends_with("of nov"));
    decisions.extend(number(&lobe, size, &some));
    let channels = lists[k].clone();
    // Each with every pair of channels.
    let tried = families_tried
        + found.iter().map(Vec::len).sum::<usize>()
        + every.len()
        + by_nodes.len()
        + by_lobe.len();
    Ok(Some(Identity { tried, decoding: decodings[k], channels, nearest: lobe, decisions }))
}

/// For each way to decode the nearest of other families, where no split sum is close, and the
/// number of those that were tried.
fn ask_families(
    split_sums: &[Hypothesis],
    size: [usize; 2],
    few: &[Sample],
) -> Result<(Vec<Vec<Hypothesis>>, usize)> {
    // One channel is much alike: (1-E)/E is close to 1-E at other nodes.
    let close = if few.iter().all(|sample| sample.live() == 1) { CLOSE_ALONE } else { CLOSE[2] };
    let mut nearest = vec![Vec::new(); split_sums.len()];
    if split_sums.iter().any(|split_sum| split_sum.distance < close) {
        return Ok((nearest, 0));
    }
    // By values as they are, and as split sums have them.
    let mut asked = vec![0];
    asked.extend(first_by_distance(split_sums).map(|(k, _)| k).filter(|&k| k > 0));
    let samples: Vec<&Sample> = asked.iter().map(|&k| &few[k]).collect();
    let found = seek(size, &samples)?;
    for (k, families) in asked.into_iter().zip(found.nearest) {
        nearest[k] = families;
    }
    Ok((nearest, found.tried))
}

/// What is decided about the number that is a table's own.
fn number(nearest: &Hypothesis, size: [usize; 2], sample: &Sample) -> Option<Decision> {
    let (name, value, _) = parameter(&nearest.truth.lut)?;
    let others = neighbours(nearest, size, sample);
    let others = others.into_iter().map(|(other, distance)| (short(other), distance)).collect();
    Some(decision::among(name, short(value), nearest.distance, others))
}

/// The nearest of a split sum and of other families.
fn first_of<'a>(split_sum: &'a Hypothesis, families: &'a [Hypothesis]) -> &'a Hypothesis {
    families.first().filter(|family| family.distance < split_sum.distance).unwrap_or(split_sum)
}

/// The nearest of hypotheses with its place.
fn first_by_distance(hypotheses: &[Hypothesis]) -> Option<(usize, &Hypothesis)> {
    let numbered = hypotheses.iter().enumerate();
    numbered.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))
}

/// The decoding, of which the one with this place is the nearest, and how sure it is. Whether alpha
/// divides is seen where it is not 1 alone: all such texels are asked.
fn by_encoding(
    table: &Foreign,
    slice: usize,
    decodings: &[Decoding],
    nearest_of: &[Hypothesis],
    nearest: usize,
    lists: &[Vec<Channel>],
) -> (usize, Decision) {
    let mut distances: Vec<(Decoding, f64)> = decodings
        .iter()
        .zip(nearest_of)
        .map(|(&decoding, hypothesis)| (decoding, hypothesis.distance))
        .collect();
    if !decodings.iter().any(|decoding| decoding.has_divisor()) {
        // Values as they are are assumed where nothing speaks against them: they come first.
        let close = distances[0].1 + FLOOR < decision::DECIDED * (distances[nearest].1 + FLOOR);
        let place = if close { 0 } else { nearest };
        return (place, decision::decoding(distances[place], &distances));
    }
    let hypothesis = &nearest_of[nearest];
    for (k, (decoding, distance)) in distances.iter_mut().enumerate() {
        let divided = where_divided(table, slice, *decoding, hypothesis, &lists[k]);
        *distance = distance.max(divided);
    }
    let place = (0..distances.len()).min_by(|&a, &b| distances[a].1.total_cmp(&distances[b].1));
    let place = place.unwrap_or(nearest);
    (place, decision::decoding(distances[place], &distances))
}

/// The distance of a hypothesis from the texels whose alpha is not 1, decoded so.
fn where_divided(
    table: &Foreign,
    slice: usize,
    decoding: Decoding,
    hypothesis: &Hypothesis,
    channels: &[Channel],
) -> f64 {
    let [columns, rows, _] = table.size;
    let all = Texels::new(table, slice);
    let divided = |texel: &usize| all[*texel].last().is_some_and(|&alpha| alpha < 1.0);
    let places: Vec<usize> = (0..columns * rows).filter(divided).collect();
    // Where alpha is 1 everywhere nothing speaks for a divisor or against it.
    if places.is_empty() {
        return 0.0;
    }
    let step = places.len().div_ceil(MANY * MANY);
    let places: Vec<usize> = places.into_iter().step_by(step).collect();
    let point = |texel: usize| {
        points(&hypothesis.layout, [columns, rows], [&[texel % columns], &[texel / columns]])[0]
    };
    let truth = hypothesis.truth.at(&places.iter().map(|&texel| point(texel)).collect::<Vec<_>>());
    let of = |&(channel, quantity): &(usize, Quantity)| {
        let Some(Channel { spread, .. }) = channels.get(channel) else { return f64::INFINITY };
        let value = |&texel: &usize| decoding.value(&all[texel], channel);
        let values: Vec<f64> = places.iter().map(value).collect();
        distance(&values, &truth, quantity) / spread
    };
    hypothesis.packing.iter().map(of).sum::<f64>() / hypothesis.packing.len().max(1) as f64
}

/// The first layouts of a sorted list that differ in more than nodes.
fn first_layouts(found: &[Hypothesis], count: usize) -> Vec<Layout> {
    let mut layouts: Vec<Layout> = Vec::new();
    for hypothesis in found {
        let centred = |layout: &Layout| layout.with_nodes([NODES[0], NODES[0]]);
        if layouts.iter().all(|layout| centred(layout) != centred(&hypothesis.layout)) {
            layouts.push(hypothesis.layout);
        }
        if layouts.len() == count {
            break;
        }
    }
    layouts
}
