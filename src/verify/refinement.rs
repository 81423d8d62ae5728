//! From the nearest hypothesis by few texels to the nearest convention, in turns.

use super::decision;
use super::family::number::tuned;
use super::family::{is_split_sum, metals, relatives};
use super::layout::{COMMON_NODES, Layout, NODES};
use super::sample::{FLOOR, Sample};
use super::search::{EveryLayout, Hypothesis, nearest, sort, with_layouts, with_lobes};
use super::surface::Surface;
use super::truth::Truth;
use crate::brdf::Ndf;
use crate::integrate::Integrand;

/// A lobe tells the layout, the layout the nodes, the nodes the lobe: until they agree.
#[derive(Clone, Copy)]
pub struct Refinement<'a> {
    /// The lobes that are told apart.
    pub lobes: &'a [Truth],
    /// The columns and rows of the table.
    pub size: [usize; 2],
    /// Texels that tell layouts apart.
    pub few: &'a Sample,
    /// Texels that tell a number.
    pub some: &'a Sample,
    /// Texels that tell nodes apart.
    pub many: &'a Sample,
}

/// The nearest hypothesis of each step, and all that were tried there.
pub struct Refined {
    /// The nearest layout.
    pub layout: Hypothesis,
    /// All layouts.
    pub every: Vec<Hypothesis>,
    /// The nearest nodes.
    pub nodes: Hypothesis,
    /// All nodes.
    pub by_nodes: Vec<Hypothesis>,
    /// The nearest lobe.
    pub lobe: Hypothesis,
    /// All lobes.
    pub by_lobe: Vec<Hypothesis>,
}

/// Lobes that are taken in turn at the most.
const TURNS: usize = 4;

/// A table that is farther than this from all lobes is none of them: one turn with few texels tells
/// how far it is.
const HOPELESS: f64 = 0.03;

/// Nodes with which all lobes are tried: those of another lobe may lie a little off.
const LIKELY_NODES: usize = 6;

impl Refinement<'_> {
    /// From what is nearest so far.
    pub fn from(&self, first: &Hypothesis) -> Option<Refined> {
        match (first.distance < HOPELESS, is_split_sum(first.truth)) {
            // Another family too is told by split sums then: none of it is known.
            (false, _) => Refinement { many: self.few, ..*self }.by(first.truth, true),
            (true, true) => self.of_split_sum(first.truth),
            (true, false) => self.of_family(first.truth),
        }
    }

    fn of_split_sum(&self, mut truth: Truth) -> Option<Refined> {
        let mut nearest_so_far: Option<Refined> = None;
        for _ in 0..TURNS {
            let refined = self.by(truth, is_sheen(truth))?;
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

    /// The same for a table of another family, whose layout tells its own number too, and that the
    /// layout; each lobe has the number that suits it.
    fn of_family(&self, mut truth: Truth) -> Option<Refined> {
        let tuned = |hypothesis| tuned(hypothesis, self.size, self.some);
        let mut last = None;
        for _ in 0..TURNS {
            let own = [truth];
            let mut found = Refinement { lobes: &own, many: self.some, ..*self }.by(truth, true)?;
            // Another number may suit other nodes.
            for hypothesis in found.by_nodes.iter_mut().take(LIKELY_NODES) {
                *hypothesis = tuned(hypothesis.clone());
            }
            found.nodes = with_likely_nodes(nearest(&found.by_nodes)?, &found.by_nodes).clone();
            let mut lobes = relatives(found.nodes.truth);
            lobes.extend(metals(truth));
            let lobes = with_lobes(&lobes, &[found.nodes.layout], self.size, self.some);
            found.by_lobe = lobes.into_iter().map(tuned).collect();
            found.lobe = nearest(&found.by_lobe).cloned().unwrap_or(found.lobe);
            let next = found.lobe.truth;
            last = Some(found);
            if next == truth {
                break;
            }
            truth = next;
        }
        last
    }

    /// One turn, with the layouts of this lobe: by a surface where their integrals would take long.
    fn by(&self, truth: Truth, by_surface: bool) -> Option<Refined> {
        let Refinement { lobes, size, few, many, .. } = *self;
        let nodes = if is_split_sum(truth) { &NODES[..] } else { &NODES[..COMMON_NODES] };
        let every = match by_surface {
            true => EveryLayout::of_surface(&Surface::new(truth), size, few, nodes),
            false => EveryLayout::new(truth, size, few, nodes),
        };
        let every = every.hypotheses(few, true);
        let layout = nearest(&every)?.clone();
        let mut by_nodes = with_layouts(truth, &around(layout.layout), size, many);
        sort(&mut by_nodes);
        let nodes = with_likely_nodes(by_nodes.first()?, &by_nodes).clone();
        let mut layouts = vec![nodes.layout];
        let others = by_nodes.iter().take(LIKELY_NODES).map(|other| other.layout);
        layouts.extend(others.filter(|layout| *layout != nodes.layout));
        let by_lobe = with_lobes(lobes, &layouts, size, many);
        let lobe = nearest(&by_lobe)?;
        // The same lobe with the nodes that are likelier.
        let lobe = if lobe.truth == truth { nodes.clone() } else { lobe.clone() };
        Some(Refined { layout, every, nodes, by_nodes, lobe, by_lobe })
    }
}

/// Whether its integrals cost a hundred times those of other lobes.
fn is_sheen(truth: Truth) -> bool {
    matches!(truth.lut.integrand(), Integrand::Specular(lobe, _) if lobe.ndf == Ndf::Charlie)
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
