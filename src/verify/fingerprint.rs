//! The sampler that made a table: the estimator that engines bake with repeats its numbers to the
//! last digits where nodes, masking, count and frame are right, and proves all of them at once.

use super::channel::{Channel, Texels};
use super::decoding::Decoding;
use super::layout::Layout;
use super::sample::Packing;
use super::search::points;
use super::truth::{Truth, Values};
use crate::brdf::Fresnel;
use crate::brdf::Ndf;
use crate::brdf::fresnel::Schlick;
use crate::choice::Choice;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use crate::integrate::hammersley::{Frame, Hammersley, estimate};
use crate::lut::Lut;
use rayon::prelude::*;

/// Counts of points that engines use.
const COUNTS: [u32; 9] = [16, 32, 64, 128, 256, 512, 1024, 2048, 4096];

/// Texels at which an estimator is tried, and those at which the nearest one is held.
const FEW: usize = 24;
const MANY: usize = 120;

/// An estimator is found where nine texels in ten are so many times nearer to it than to the truth.
/// The middle texel need not be: it may differ by no more than its rounding from both.
const NEARER: f64 = 4.0;

/// A sampler that repeats a table's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fingerprint {
    /// The points.
    pub points: Hammersley,
    /// The layout with which they repeat it.
    pub layout: Layout,
    /// The middle and the largest difference that is left.
    pub left: (f64, f64),
}

/// A table with a convention that may be that of an estimator.
#[derive(Clone, Copy)]
pub struct Suspect<'a> {
    /// The table.
    pub table: &'a Foreign,
    /// Its slice.
    pub slice: usize,
    /// How codes become values.
    pub decoding: Decoding,
    /// Its channels.
    pub channels: &'a [Channel],
    /// The channels that are known.
    pub packing: &'a Packing,
    /// The table of ours.
    pub truth: Truth,
}

/// The sampler of a table with one of these layouts; none where none repeats it.
pub fn fingerprint(suspect: Suspect, layouts: &[Layout]) -> Option<Fingerprint> {
    let (Lut::Dfg(_), Integrand::Specular(lobe, Fresnel::Schlick)) =
        (suspect.truth.lut, suspect.truth.lut.integrand())
    else {
        return None;
    };
    if lobe.ndf != Ndf::Ggx {
        return None;
    }
    let few = suspect.texels(FEW);
    let of = |points: Hammersley| {
        let samples = points.points();
        // It divides by n·v.
        let estimate = move |(mu, alpha): (f64, f64)| {
            let [a, b] = estimate(lobe, Schlick, (mu.max(1e-6), alpha), &samples);
            [a, b, a + b, 0.0]
        };
        // The right one repeats grazing texels too, in which others differ most.
        let mean = |layout: &Layout| {
            let values = suspect.points(layout, &few).into_iter().map(&estimate).collect();
            let differences = suspect.differences(values, &few);
            differences.iter().sum::<f64>() / differences.len().max(1) as f64
        };
        let tried = layouts.iter().map(|layout| (points, *layout, mean(layout)));
        tried.min_by(|a, b| a.2.total_cmp(&b.2))
    };
    let counts = COUNTS.par_iter();
    let samplers = counts
        .flat_map_iter(|&count| Frame::ALL.iter().map(move |&frame| Hammersley { count, frame }));
    let tried: Vec<_> = samplers.filter_map(of).collect();
    let (points, layout, _) = tried.into_iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
    let many = suspect.texels(MANY);
    let places = suspect.points(&layout, &many);
    let samples = points.points();
    let estimates = places.iter().map(|&(mu, alpha)| {
        let [a, b] = estimate(lobe, Schlick, (mu.max(1e-6), alpha), &samples);
        [a, b, a + b, 0.0]
    });
    let left = suspect.differences(estimates.collect(), &many);
    let truth = suspect.differences(suspect.truth.at(&places), &many);
    let nearer = share(&left, 0.9) * NEARER < share(&truth, 0.9);
    let largest = left.last().copied().unwrap_or(0.0);
    (nearer && share(&left, 0.5) <= share(&truth, 0.5)).then(|| Fingerprint {
        points,
        layout,
        left: (share(&left, 0.5), largest),
    })
}

/// The difference that a share of them does not exceed.
fn share(sorted: &[f64], share: f64) -> f64 {
    sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(f64::INFINITY)
}

impl Suspect<'_> {
    /// So many texels, spread by the plastic number over all of them.
    fn texels(&self, count: usize) -> Vec<(usize, usize)> {
        let [columns, rows, _] = self.table.size;
        // The powers of 1/1.32472 (Roberts 2018, the sequence R2).
        let place = |k: usize, step: f64, size: usize| {
            let share = (0.5 + k as f64 * step).fract();
            ((share * size as f64) as usize).min(size - 1)
        };
        (0..count)
            .map(|k| (place(k, 0.754_877_666, columns), place(k, 0.569_840_29, rows)))
            .collect()
    }

    /// (n·v, α) of these texels.
    fn points(&self, layout: &Layout, texels: &[(usize, usize)]) -> Vec<(f64, f64)> {
        let [columns, rows, _] = self.table.size;
        let of = |&(i, j): &(usize, usize)| points(layout, [columns, rows], [&[i], &[j]]);
        texels.iter().flat_map(of).collect()
    }

    /// How far the known channels are from these values at these texels, in units of their spreads,
    /// ascending; what is no number is left out.
    fn differences(&self, values: Vec<Values>, at: &[(usize, usize)]) -> Vec<f64> {
        let all = Texels::new(self.table, self.slice);
        let mut differences = Vec::new();
        for (&(i, j), values) in at.iter().zip(&values) {
            for &(channel, quantity) in self.packing {
                let value = self.decoding.value(&all[j * self.table.size[0] + i], channel);
                let difference = (value - quantity.value(values)).abs();
                differences.push(difference / self.channels[channel].spread);
            }
        }
        differences.retain(|difference| difference.is_finite());
        differences.sort_by(f64::total_cmp);
        differences
    }
}
