//! Ways of integrating GGX that are mapped: the loop that engines ship, estimators, quadrature; and
//! sums of many samples.

use crate::brdf::{Masking, Microfacet, Ndf};
use crate::compare::point_set::{Point, PointSet};
use crate::compare::rows::{Method, Work, bake_in, rows};
use crate::compare::sampling::{HalfVector, Sampler};
use crate::compare::textbook::textbook_split_sum;
use crate::integrate::ScaleBias;
use crate::integrate::half_vectors::HalfVectorRule;
use crate::integrate::light_directions::LightDirectionRule;
use crate::integrate::rules::{H640_NODES, L512_NODES};
use crate::numeric::lanes::{F32x16, F64x8, Real};
use crate::table::grid::Grid;

/// The lobe.
pub const GGX: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

/// A way of integrating.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Its name in maps.
    pub name: &'static str,
    how: How,
}

#[derive(Clone, Copy, Debug)]
enum How {
    /// The loop that engines ship, over this number of Hammersley's points.
    Loop(usize, Bits),
    /// A sampler in f32.
    Samples(Sampler, PointSet, usize),
    /// A rule over half vectors in f32.
    HalfVectors(HalfVectorRule),
    /// A rule over directions of light in f32.
    LightDirections(LightDirectionRule),
    /// The error of a sum of this number of samples.
    Sum(usize, Summed),
}

#[derive(Clone, Copy, Debug)]
enum Bits {
    F32x1,
    Double,
}

#[derive(Clone, Copy, Debug)]
enum Summed {
    OneByOne,
    InBlocks,
}

/// Methods, from the field's to ours.
pub const METHODS: [Way; 7] = [
    Way { name: "textbook loop, f32", how: How::Loop(1024, Bits::F32x1) },
    Way { name: "textbook loop, f64", how: How::Loop(1024, Bits::Double) },
    Way {
        name: "half vectors by D",
        how: How::Samples(Sampler::HalfVector, PointSet::Hammersley, 1024),
    },
    Way {
        name: "visible normals",
        how: How::Samples(Sampler::Visible, PointSet::Hammersley, 1024),
    },
    Way {
        name: "bounded caps, Gauss",
        how: How::Samples(Sampler::BoundedVisible, PointSet::GaussTrapezoid, 1024),
    },
    Way { name: "light directions, l512", how: How::LightDirections(L512_NODES) },
    Way { name: "half vectors, h640", how: How::HalfVectors(H640_NODES) },
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
            How::Loop(count, Bits::F32x1) => {
                rows::<F32x16, _>(GGX, grid, &Loop(&hammersley(count)))
            }
            How::Loop(count, Bits::Double) => {
                rows::<F64x8, _>(GGX, grid, &Loop(&hammersley(count)))
            }
            How::Samples(sampler, set, count) => {
                bake_in::<F32x16>(GGX, grid, Work::Samples(sampler, &set.points(count, 0)))
            }
            How::HalfVectors(rule) => rows::<F32x16, _>(GGX, grid, &rule.nodes()),
            How::LightDirections(rule) => rows::<F32x16, _>(GGX, grid, &rule.nodes()),
            How::Sum(count, summed) => sum(grid, truth, &hammersley(count), summed),
        }
    }
}

/// The truth and what the sum of the samples adds to it in f32, against the sum of the same in f64.
fn sum(grid: &Grid, truth: &[ScaleBias], points: &[Point], summed: Summed) -> Vec<ScaleBias> {
    let work = Work::Samples(Sampler::HalfVector, points);
    let (single, double) = match summed {
        Summed::OneByOne => (
            rows::<F32x16, _>(GGX, grid, &Loop(points)),
            rows::<F64x8, _>(GGX, grid, &Loop(points)),
        ),
        Summed::InBlocks => (bake_in::<F32x16>(GGX, grid, work), bake_in::<F64x8>(GGX, grid, work)),
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
