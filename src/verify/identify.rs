//! Which table of ours a foreign one is: coarse lobes find the layout, layouts the lobe, and more
//! texels the nodes.

use super::candidates::{NUMBERS, likely, sheen, split_sums, unlikely};
use super::channel::{Channel, Texels, channels};
use super::decision::{self, Decision, decide};
use super::decoding::Decoding;
use super::layout::{Layout, NODES};
use super::sample::{FLOOR, Quantity, Sample, distance};
use super::search::{EveryLayout, Hypothesis, nearest, points, with_layouts};
use super::truth::Truth;
use crate::error::Result;
use crate::foreign::Foreign;

/// Texels along each axis that tell layouts apart.
const FEW: usize = 12;

/// Texels along each axis that tell nodes apart.
pub const MANY: usize = 48;

/// A table that is as near as this by the likely lobes is not sought by more, and by all but sheen
/// not by sheen.
const CLOSE: [f64; 3] = [0.004, 0.03, 0.0];

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

/// The nearest hypothesis for a slice; none of a table without a channel that tells something.
pub fn identify(table: &Foreign, slice: usize) -> Result<Option<Identity>> {
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
            let every = EveryLayout::new(truth, size, &few[0]);
            for (found, sample) in found.iter_mut().zip(&few) {
                found.extend(every.hypotheses(sample, &NUMBERS, false));
            }
        }
        let of = |(found, sample): (&mut Vec<Hypothesis>, &Sample)| {
            found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            nearest(&with_lobes(&lobes, &first_layouts(found, LAYOUTS), size, sample)).cloned()
        };
        nearest_of = found.iter_mut().zip(&few).filter_map(of).collect();
        if nearest_of.iter().any(|nearest| nearest.distance < CLOSE[step]) {
            break;
        }
    }
    let Some((k, _)) = first_by_distance(&nearest_of) else { return Ok(None) };
    let (k, encoding) = by_encoding(table, slice, &decodings, &nearest_of, k, &lists);
    let many = Sample::new(table, slice, decodings[k], &lists[k], MANY);
    let search = Refinement { lobes: &lobes, size, few: &few[k], many: &many };
    let Some(refined) = search.refined(nearest_of[k].truth) else { return Ok(None) };
    let Refined { layout, every, nodes, by_nodes, lobe, by_lobe } = refined;
    let mut decisions = vec![encoding];
    decisions.extend(decide(&decision::LAYOUT, &layout, &every));
    decisions.extend(decide(&decision::NODES, &nodes, &by_nodes));
    decisions.extend(decide(&decision::LOBE, &lobe, &by_lobe));
    let channels = lists[k].clone();
    // Each with every pair of channels.
    let tried =
        found.iter().map(Vec::len).sum::<usize>() + every.len() + by_nodes.len() + by_lobe.len();
    Ok(Some(Identity { tried, decoding: decodings[k], channels, nearest: lobe, decisions }))
}

/// A lobe tells the layout, the layout the nodes, the nodes the lobe: until they agree.
struct Refinement<'a> {
    lobes: &'a [Truth],
    size: [usize; 2],
    few: &'a Sample,
    many: &'a Sample,
}

/// The nearest hypothesis of each step, and all that were tried there.
struct Refined {
    layout: Hypothesis,
    every: Vec<Hypothesis>,
    nodes: Hypothesis,
    by_nodes: Vec<Hypothesis>,
    lobe: Hypothesis,
    by_lobe: Vec<Hypothesis>,
}

/// Lobes that are taken in turn at the most.
const TURNS: usize = 4;

/// Nodes with which all lobes are tried: those of another lobe may lie a little off.
const LIKELY_NODES: usize = 6;

impl Refinement<'_> {
    fn refined(&self, first: Truth) -> Option<Refined> {
        let mut truth = first;
        let mut nearest_so_far: Option<Refined> = None;
        for _ in 0..TURNS {
            let refined = self.by(truth)?;
            let next = refined.lobe.truth;
            let nearer = |so_far: &Refined| refined.lobe.distance < so_far.lobe.distance;
            let settled = next == truth;
            if nearest_so_far.as_ref().is_none_or(nearer) || settled {
                nearest_so_far = Some(refined);
            }
            if settled {
                break;
            }
            truth = next;
        }
        nearest_so_far
    }

    /// One turn, with the layouts of this lobe.
    fn by(&self, truth: Truth) -> Option<Refined> {
        let Refinement { lobes, size, few, many } = *self;
        let every = EveryLayout::new(truth, size, few).hypotheses(few, &NUMBERS, true);
        let layout = nearest(&every)?.clone();
        let by_nodes = with_layouts(truth, &around(layout.layout), size, many, &NUMBERS);
        let best = nearest(&by_nodes)?;
        let nodes = with_likely_nodes(best, &by_nodes).clone();
        let mut sorted: Vec<&Hypothesis> = by_nodes.iter().collect();
        sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut layouts = vec![nodes.layout];
        let others = sorted.iter().take(LIKELY_NODES).map(|other| other.layout);
        layouts.extend(others.filter(|layout| *layout != nodes.layout));
        let by_lobe = with_lobes(lobes, &layouts, size, many);
        let lobe = nearest(&by_lobe)?;
        // The same lobe with the nodes that are likelier.
        let lobe = if lobe.truth == truth { nodes.clone() } else { lobe.clone() };
        Some(Refined { layout, every, nodes, by_nodes, lobe, by_lobe })
    }
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

/// Each of these lobes with each of these layouts.
fn with_lobes(
    lobes: &[Truth],
    layouts: &[Layout],
    size: [usize; 2],
    sample: &Sample,
) -> Vec<Hypothesis> {
    let of = |&lobe: &Truth| with_layouts(lobe, layouts, size, sample, &NUMBERS);
    lobes.iter().flat_map(of).collect()
}

/// The layout with every pair of nodes.
pub fn around(layout: Layout) -> Vec<Layout> {
    let pairs = NODES.iter().flat_map(|&nov| NODES.iter().map(move |&roughness| [nov, roughness]));
    pairs.map(|pair| layout.with_nodes(pair)).collect()
}

/// Of hypotheses that fit as well as the nearest the first in the order of [`NODES`]: centres are
/// assumed where nothing speaks against them.
fn with_likely_nodes<'a>(nearest: &'a Hypothesis, all: &'a [Hypothesis]) -> &'a Hypothesis {
    let fits = |hypothesis: &&Hypothesis| {
        hypothesis.distance + FLOOR < decision::DECIDED * (nearest.distance + FLOOR)
    };
    let both = |hypothesis: &&Hypothesis| {
        [hypothesis.layout.nov(), hypothesis.layout.roughness()]
            .iter()
            .all(|spec| spec.nodes == NODES[0])
    };
    all.iter().filter(fits).find(both).unwrap_or(nearest)
}
