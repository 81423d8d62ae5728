//! Hypotheses against a sample: every layout for a table of ours, or some layouts for many.

use super::family::numbers;
use super::layout::{Layout, cosines, places, roughnesses};
use super::sample::{Packing, Sample};
use super::surface::Surface;
use super::truth::{Truth, Values};
use crate::table::axis::{AxisSpec, Nodes as NodesOfAxis};
use rayon::prelude::*;

/// A hypothesis, and its mean distance from the sample in units of the channels' spreads.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The table of ours.
    pub truth: Truth,
    /// Its axes.
    pub layout: Layout,
    /// Its channels.
    pub packing: Packing,
    /// The distance.
    pub distance: f64,
}

/// The truth at every pair of these n·v and these α.
type OnGrid<'a> = dyn Fn(&[f64], &[f64]) -> Vec<Values> + 'a;

/// What is true at every node that any layout puts at a sampled texel.
pub struct EveryLayout {
    truth: Truth,
    novs: Vec<AxisSpec>,
    roughnesses: Vec<AxisSpec>,
    /// n·v along x and roughness along y; and the other way round.
    grids: [Nodes; 2],
}

/// The truth at pairs of nodes of two axes.
struct Nodes {
    /// Nodes of a hypothesis of n·v, and of one of roughness.
    counts: [usize; 2],
    /// The number of all nodes of n·v.
    width: usize,
    values: Vec<Values>,
}

impl Nodes {
    /// The truth at node `i` of the hypothesis `a` of n·v, and node `j` of `b` of roughness.
    #[inline]
    fn at(&self, (a, i): (usize, usize), (b, j): (usize, usize)) -> Values {
        self.values[(b * self.counts[1] + j) * self.width + a * self.counts[0] + i]
    }
}

impl EveryLayout {
    /// For a table of this size, sampled at these texels, with nodes of these kinds.
    pub fn new(
        truth: Truth,
        size: [usize; 2],
        sample: &Sample,
        nodes_of_axes: &[NodesOfAxis],
    ) -> Self {
        let on_grid = |novs: &[f64], widths: &[f64]| truth.on_grid(novs, widths);
        Self::with(truth, &on_grid, size, sample, nodes_of_axes)
    }

    /// The same by a surface.
    pub fn of_surface(
        surface: &Surface,
        size: [usize; 2],
        sample: &Sample,
        nodes_of_axes: &[NodesOfAxis],
    ) -> Self {
        let on_grid = |novs: &[f64], widths: &[f64]| surface.on_grid(novs, widths);
        Self::with(surface.truth, &on_grid, size, sample, nodes_of_axes)
    }

    fn with(
        truth: Truth,
        on_grid: &OnGrid,
        size: [usize; 2],
        sample: &Sample,
        nodes_of_axes: &[NodesOfAxis],
    ) -> Self {
        let [xs, ys] = &sample.texels;
        let (novs, roughnesses) = (cosines(nodes_of_axes), roughnesses(nodes_of_axes));
        let all = |specs: &[AxisSpec], size: usize, texels: &[usize]| -> Vec<f64> {
            specs.iter().flat_map(|&spec| places(spec, size, texels)).collect()
        };
        let straight = [all(&novs, size[0], xs), all(&roughnesses, size[1], ys)];
        let turned = [all(&novs, size[1], ys), all(&roughnesses, size[0], xs)];
        let nodes = |[novs, widths]: [Vec<f64>; 2], counts| Nodes {
            counts,
            width: novs.len(),
            values: on_grid(&novs, &widths),
        };
        let grids = [nodes(straight, [xs.len(), ys.len()]), nodes(turned, [ys.len(), xs.len()])];
        EveryLayout { truth, novs, roughnesses, grids }
    }

    /// Every layout with its best packing, or with every packing.
    pub fn hypotheses(&self, sample: &Sample, every_packing: bool) -> Vec<Hypothesis> {
        let (novs, widths) = (&self.novs, &self.roughnesses);
        let numbers = &numbers(&self.truth.lut);
        let [columns, rows] = [sample.texels[0].len(), sample.texels[1].len()];
        let layouts = 2 * novs.len() * widths.len();
        let of = |index: usize| {
            let (turned, rest) = (index / (layouts / 2) == 1, index % (layouts / 2));
            let (a, b) = (rest % novs.len(), rest / novs.len());
            let nodes = &self.grids[usize::from(turned)];
            let at = |texel: usize| {
                let (i, j) = (texel % columns, texel / columns);
                if turned { nodes.at((a, j), (b, i)) } else { nodes.at((a, i), (b, j)) }
            };
            let truth: Vec<Values> = (0..columns * rows).map(at).collect();
            let layout = Layout::of(novs[a], widths[b], turned);
            hypotheses(self.truth, layout, sample.distances(&truth, numbers), every_packing)
        };
        (0..layouts).into_par_iter().flat_map_iter(of).collect()
    }
}

/// A table of ours with each of these layouts.
pub fn with_layouts(
    truth: Truth,
    layouts: &[Layout],
    size: [usize; 2],
    sample: &Sample,
) -> Vec<Hypothesis> {
    let [xs, ys] = &sample.texels;
    let numbers = &numbers(&truth.lut);
    let points: Vec<(f64, f64)> =
        layouts.iter().flat_map(|layout| points(layout, size, [xs, ys])).collect();
    let values = truth.at(&points);
    let of = |(layout, values): (&Layout, &[Values])| {
        hypotheses(truth, *layout, sample.distances(values, numbers), false)
    };
    layouts.par_iter().zip(values.par_chunks(xs.len() * ys.len())).flat_map_iter(of).collect()
}

/// Each of these lobes with each of these layouts.
pub fn with_lobes(
    lobes: &[Truth],
    layouts: &[Layout],
    size: [usize; 2],
    sample: &Sample,
) -> Vec<Hypothesis> {
    let of = |&lobe: &Truth| with_layouts(lobe, layouts, size, sample);
    lobes.iter().flat_map(of).collect()
}

/// (n·v, α) of these texels, row by row.
pub fn points(layout: &Layout, size: [usize; 2], [xs, ys]: [&[usize]; 2]) -> Vec<(f64, f64)> {
    let (along, across) = (places(layout.x, size[0], xs), places(layout.y, size[1], ys));
    let transposed = layout.is_transposed();
    let point = move |x: f64, y: f64| if transposed { (y, x) } else { (x, y) };
    across.iter().flat_map(|&y| along.iter().map(move |&x| point(x, y))).collect()
}

fn hypotheses(
    truth: Truth,
    layout: Layout,
    distances: Vec<(Packing, f64)>,
    every_packing: bool,
) -> Vec<Hypothesis> {
    let hypothesis =
        |(packing, distance): (Packing, f64)| Hypothesis { truth, layout, packing, distance };
    match every_packing {
        true => distances.into_iter().map(hypothesis).collect(),
        false => {
            let best = distances.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
            best.map(hypothesis).into_iter().collect()
        }
    }
}

/// Puts the nearest first.
pub fn sort(hypotheses: &mut [Hypothesis]) {
    hypotheses.sort_by(|a, b| a.distance.total_cmp(&b.distance));
}

/// The nearest of hypotheses.
pub fn nearest(hypotheses: &[Hypothesis]) -> Option<&Hypothesis> {
    hypotheses.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))
}
