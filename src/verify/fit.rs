//! The offsets of both axes' nodes as numbers: where the texels of a table say that they lie.

use super::candidates::TOLERANCE;
use super::layout::Layout;
use super::sample::{Packing, Sample};
use super::search::points;
use super::truth::Truth;
use crate::table::axis::Nodes;

/// Offsets are sought from this step on down to the last one, in texels.
const STEPS: [f64; 6] = [0.25, 0.1, 0.04, 0.016, 0.006, 0.002];

/// Offsets lie this far beyond an end at the most.
const FARTHEST: f64 = 2.0;

/// The offsets of n·v's and roughness' nodes at which a sample is nearest to the truth; none where
/// nodes are edges, whose spacing differs. A pattern search (Hooke and Jeeves 1961).
pub fn offsets(
    truth: Truth,
    layout: Layout,
    packing: &Packing,
    size: [usize; 2],
    sample: &Sample,
) -> Option<[f64; 2]> {
    let (Nodes::Offset(nov), Nodes::Offset(roughness)) =
        (layout.nov().nodes, layout.roughness().nodes)
    else {
        return None;
    };
    if !truth.lut.depends_on_nov() {
        return None;
    }
    let truth = Truth { tolerance: truth.tolerance.max(TOLERANCE), ..truth };
    let [xs, ys] = &sample.texels;
    let distance = |[nov, roughness]: [f64; 2]| {
        let layout = layout.with_nodes([Nodes::Offset(nov), Nodes::Offset(roughness)]);
        let values = truth.at(&points(&layout, size, [xs, ys]));
        sample.distance(&values, packing)
    };
    let mut best = [nov, roughness];
    let mut least = distance(best);
    for step in STEPS {
        // Each step is tried until it leads no further.
        loop {
            let before = least;
            for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                let mut next = best;
                next[axis] = (next[axis] + sign * step).clamp(-FARTHEST, FARTHEST);
                let distance = distance(next);
                if distance < least {
                    (best, least) = (next, distance);
                }
            }
            if least >= before {
                break;
            }
        }
    }
    Some(best)
}
