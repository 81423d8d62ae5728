//! Some texels of a table, and how far a hypothesis is from them.

use super::channel::{Channel, Texels};
use super::decoding::Decoding;
use super::truth::Values;
use crate::foreign::Foreign;

/// The share of texels that decide: one grazing texel of an estimate with few samples is farther
/// off than all others together.
const KEPT: f64 = 0.8;

/// What a rule's error and an axis' end may put between a table and the truth, in units of the
/// spread: distances below are the same.
pub const FLOOR: f64 = 2e-5;

/// A number of a texel of ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// The channel with this number.
    Channel(usize),
    /// 1 less that channel.
    Complement(usize),
}

/// Which channel of a file is which number of ours.
pub type Packing = Vec<(usize, Quantity)>;

/// Texels at evenly spread columns and rows.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The columns and the rows.
    pub texels: [Vec<usize>; 2],
    /// The channels that tell something: number, unit of errors, values row by row.
    live: Vec<(usize, f64, Vec<f64>)>,
}

/// So many of the texels of an axis, evenly spread, both ends included.
pub fn spread(size: usize, count: usize) -> Vec<usize> {
    match size {
        size if size <= count => (0..size).collect(),
        size => (0..count).map(|k| (k * (size - 1) + (count - 1) / 2) / (count - 1)).collect(),
    }
}

impl Sample {
    /// `count` x `count` texels of a slice, or all where there are fewer.
    pub fn new(
        table: &Foreign,
        slice: usize,
        decoding: Decoding,
        channels: &[Channel],
        count: usize,
    ) -> Self {
        let [columns, rows, _] = table.size;
        let (xs, ys) = (spread(columns, count), spread(rows, count));
        let all = Texels::new(table, slice);
        let value = |component: usize| {
            let at = |(i, j): (&usize, &usize)| decoding.value(&all[j * columns + i], component);
            ys.iter().flat_map(|j| xs.iter().map(move |i| (i, j))).map(at).collect()
        };
        let live = channels.iter().enumerate().filter(|(_, channel)| channel.idle.is_none());
        let live = live.map(|(place, channel)| (place, channel.spread, value(place))).collect();
        Sample { texels: [xs, ys], live }
    }

    /// The number of channels that tell something.
    pub fn live(&self) -> usize {
        self.live.len()
    }

    /// The distance of one packing from the truth at these texels.
    pub fn distance(&self, truth: &[Values], packing: &Packing) -> f64 {
        let of = |&(place, number): &(usize, Quantity)| {
            let channel = self.live.iter().find(|(live, ..)| *live == place);
            channel.map_or(f64::INFINITY, |(_, spread, values)| {
                distance(values, truth, number) / spread
            })
        };
        packing.iter().map(of).sum::<f64>() / packing.len().max(1) as f64
    }

    /// The distance of every packing from the truth at these texels, row by row: of pairs of
    /// channels, and of one where there is one. `numbers`: the channels of ours that it may be.
    pub fn distances(&self, truth: &[Values], numbers: &[Quantity]) -> Vec<(Packing, f64)> {
        let table: Vec<Vec<f64>> = self
            .live
            .iter()
            .map(|(_, spread, values)| {
                let of = |&number: &Quantity| distance(values, truth, number) / spread;
                numbers.iter().map(of).collect()
            })
            .collect();
        let mut distances = Vec::new();
        if let [(place, ..)] = self.live[..] {
            for (&number, &distance) in numbers.iter().zip(&table[0]) {
                distances.push((vec![(place, number)], distance));
            }
            return distances;
        }
        for (a, (first, ..)) in self.live.iter().enumerate() {
            for (b, (second, ..)) in self.live.iter().enumerate().skip(a + 1) {
                for (p, &one) in numbers.iter().enumerate() {
                    for (q, &other) in numbers.iter().enumerate() {
                        // A pair of the same number, or of a number and its complement, is one.
                        if channel(one) == channel(other) {
                            continue;
                        }
                        let mean = 0.5 * (table[a][p] + table[b][q]);
                        distances.push((vec![(*first, one), (*second, other)], mean));
                    }
                }
            }
        }
        distances
    }
}

fn channel(number: Quantity) -> usize {
    match number {
        Quantity::Channel(channel) | Quantity::Complement(channel) => channel,
    }
}

impl Quantity {
    /// Its value.
    #[inline]
    pub fn value(self, values: &Values) -> f64 {
        match self {
            Quantity::Channel(channel) => values[channel],
            Quantity::Complement(channel) => 1.0 - values[channel],
        }
    }
}

/// The mean of the smallest differences of values from a number of ours.
pub fn distance(values: &[f64], truth: &[Values], number: Quantity) -> f64 {
    let difference = |(value, truth): (&f64, &Values)| {
        let difference = (value - number.value(truth)).abs();
        if difference.is_nan() { f64::INFINITY } else { difference }
    };
    let mut differences: Vec<f64> = values.iter().zip(truth).map(difference).collect();
    trimmed_mean(&mut differences)
}

/// The mean of the smallest four fifths; infinite where there are none.
pub fn trimmed_mean(differences: &mut [f64]) -> f64 {
    if differences.is_empty() {
        return f64::INFINITY;
    }
    let kept = ((differences.len() as f64 * KEPT).ceil() as usize).clamp(1, differences.len());
    differences.select_nth_unstable_by(kept - 1, f64::total_cmp);
    differences[..kept].iter().sum::<f64>() / kept as f64
}
