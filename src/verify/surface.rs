//! A table of ours between the nodes of a fixed grid: near enough to tell layouts apart, and far
//! cheaper than the integrals of every layout.

use super::truth::{Truth, Values};

/// Nodes of sqrt(n·v): between them values are off by 1e-3 at the most but for the ring where total
/// reflection begins.
const COSINES: usize = 64;

/// Nodes of sqrt(α).
const WIDTHS: usize = 40;

/// The values at the nodes.
pub struct Surface {
    /// The table.
    pub truth: Truth,
    columns: usize,
    values: Vec<Values>,
}

impl Surface {
    /// For a table that does not depend on n·v one column does.
    pub fn new(truth: Truth) -> Self {
        let columns = if truth.lut.depends_on_nov() { COSINES } else { 1 };
        let values = truth.on_grid(&squares(columns), &squares(WIDTHS));
        Surface { truth, columns, values }
    }

    /// The channels at every pair of these n·v and these α, n·v varying fastest.
    pub fn on_grid(&self, mus: &[f64], alphas: &[f64]) -> Vec<Values> {
        let along: Vec<Place> = mus.iter().map(|&mu| Place::of(mu, self.columns)).collect();
        let across = alphas.iter().map(|&alpha| Place::of(alpha, WIDTHS));
        let row = |row: usize| &self.values[row * self.columns..][..self.columns];
        let of_row = |place: Place| {
            let nodes: Vec<Values> = row(place.first)
                .iter()
                .zip(row(place.next))
                .map(|(first, next)| between(first, next, place.weight))
                .collect();
            let at = |place: &Place| between(&nodes[place.first], &nodes[place.next], place.weight);
            along.iter().map(at).collect::<Vec<Values>>()
        };
        across.flat_map(of_row).collect()
    }
}

/// Two nodes and the weight of the second.
#[derive(Clone, Copy)]
struct Place {
    first: usize,
    next: usize,
    weight: f64,
}

impl Place {
    /// Of a value among the squares of evenly spread nodes.
    fn of(value: f64, nodes: usize) -> Self {
        let last = nodes - 1;
        let place = value.clamp(0.0, 1.0).sqrt() * last as f64;
        let first = (place as usize).min(last.saturating_sub(1));
        Place { first, next: (first + 1).min(last), weight: place - first as f64 }
    }
}

fn squares(count: usize) -> Vec<f64> {
    let last = (count - 1).max(1) as f64;
    (0..count).map(|node| (node as f64 / last).powi(2)).collect()
}

fn between(first: &Values, next: &Values, weight: f64) -> Values {
    std::array::from_fn(|channel| first[channel] + weight * (next[channel] - first[channel]))
}
