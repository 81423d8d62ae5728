//! Ways of integrating GGX that are mapped: the loop that engines ship, estimators, quadrature; and sums of many
//! samples.

use crate::backend::rows::{Method, Work, bake_in, rows};
use crate::integrate::ScaleBias;
use crate::integrate::rule::Rule;
use crate::integrate::rules::{H640, L512};
use crate::lanes::{Lanes, Real, Singles};
use crate::lut::Grid;
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::point_set::{Point, PointSet};
use crate::sampling::{HalfVector, Sampler};
use crate::study::textbook::textbook_split_sum;

/// The lobe.
pub const GGX: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

/// A way of integrating.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// What maps call it.
    pub name: &'static str,
    how: How,
}

#[derive(Clone, Copy, Debug)]
enum How {
    /// The loop that engines ship, over so many of Hammersley's points.
    Loop(usize, Bits),
    /// A sampler in f32.
    Samples(Sampler, PointSet, usize),
    /// A rule in f32.
    Rule(Rule),
    /// What summing so many samples adds: one by one, or in blocks.
    Sum(usize, Summed),
}

#[derive(Clone, Copy, Debug)]
enum Bits {
    Single,
    Double,
}

#[derive(Clone, Copy, Debug)]
enum Summed {
    OneByOne,
    InBlocks,
}

/// Methods, from the field's to ours.
pub const METHODS: [Way; 7] = [
    Way { name: "textbook loop, f32", how: How::Loop(1024, Bits::Single) },
    Way { name: "textbook loop, f64", how: How::Loop(1024, Bits::Double) },
    Way { name: "half vectors by D", how: How::Samples(Sampler::HalfVector, PointSet::Hammersley, 1024) },
    Way { name: "visible normals", how: How::Samples(Sampler::Visible, PointSet::Hammersley, 1024) },
    Way { name: "bounded caps, Gauss", how: How::Samples(Sampler::BoundedVisible, PointSet::GaussTrapezoid, 1024) },
    Way { name: "l-space, l512", how: How::Rule(L512) },
    Way { name: "h-space, h640", how: How::Rule(H640) },
];

/// Sums of 65,536 samples.
pub const SUMS: [Way; 2] = [
    Way { name: "one by one", how: How::Sum(65_536, Summed::OneByOne) },
    Way { name: "in blocks of 64", how: How::Sum(65_536, Summed::InBlocks) },
];

impl Way {
    /// (A, B) over a grid of which `truth` is known.
    pub fn bake(&self, grid: &Grid, truth: &[ScaleBias]) -> Vec<ScaleBias> {
        let hammersley = |count| PointSet::Hammersley.points(count, 0);
        match self.how {
            How::Loop(count, Bits::Single) => rows::<Singles, _>(GGX, grid, &Loop(&hammersley(count))),
            How::Loop(count, Bits::Double) => rows::<Lanes, _>(GGX, grid, &Loop(&hammersley(count))),
            How::Samples(sampler, set, count) => {
                bake_in::<Singles>(GGX, grid, Work::Samples(sampler, &set.points(count, 0)))
            }
            How::Rule(rule) => bake_in::<Singles>(GGX, grid, Work::Rule(&rule.integrator())),
            How::Sum(count, summed) => sum(grid, truth, &hammersley(count), summed),
        }
    }
}

/// The truth and what the sum of the samples adds to it in f32, against the sum of the same in f64.
fn sum(grid: &Grid, truth: &[ScaleBias], points: &[Point], summed: Summed) -> Vec<ScaleBias> {
    let work = Work::Samples(Sampler::HalfVector, points);
    let (single, double) = match summed {
        Summed::OneByOne => (rows::<Singles, _>(GGX, grid, &Loop(points)), rows::<Lanes, _>(GGX, grid, &Loop(points))),
        Summed::InBlocks => (bake_in::<Singles>(GGX, grid, work), bake_in::<Lanes>(GGX, grid, work)),
    };
    let off = |((truth, single), double): ((&ScaleBias, ScaleBias), ScaleBias)| ScaleBias {
        a: truth.a + single.a - double.a,
        b: truth.b + single.b - double.b,
    };
    truth.iter().zip(single).zip(double).map(off).collect()
}

/// The textbook's loop over these points.
struct Loop<'a>(&'a [Point]);

impl Method for Loop<'_> {
    #[inline(always)]
    fn texel<R: Real>(&self, _: &[HalfVector], _: Microfacet, mu: R, alpha: R) -> ScaleBias<R> {
        textbook_split_sum(mu, alpha, self.0)
    }
}
