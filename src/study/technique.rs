//! Every method that is compared, in one list: the field's estimators, the closed forms that stand in for a table,
//! and ours.

use crate::backend::cpu;
use crate::backend::rows::{Work, bake_in};
use crate::backend::vulkan::bake::{DeviceBake, bake, bake_samples};
use crate::backend::vulkan::gpu::Gpu;
use crate::certify::decision::Task;
use crate::certify::ziv::certify;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rule::{Method, RULES, Rule};
use crate::lanes::{Lanes, Singles};
use crate::lut::{Dfg, DfgChannels, Grid, Lut};
use crate::model::{Masking, Microfacet, Ndf};
use crate::precision::Precision;
use crate::quadrature::point_set::PointSet;
use crate::sampling::Sampler;
use crate::sampling::stand_in::StandIn;
use crate::units::word;
use serde::{Deserialize, Serialize};

/// A method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// A sampler, over any of the point sets.
    Samples(Sampler),
    /// A closed form fitted to GGX.
    StandIn(StandIn),
    /// Quadrature over half vectors.
    HSpace,
    /// Quadrature over directions of light, the azimuth in closed form.
    LSpace,
    /// Double exponential quadrature.
    DoubleExponential,
    /// Interpolation between integrals.
    Surrogate,
    /// Every value rounded correctly.
    Certified,
}

/// A method at one of its costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// So many samples.
    Samples(Sampler, PointSet, usize),
    /// The closed form.
    StandIn(StandIn),
    /// A rule.
    Rule(Rule),
    /// Certified, stored so.
    Certified(Precision),
}

/// In what a CPU computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arithmetic {
    /// Sixteen lanes.
    F32,
    /// Eight lanes.
    F64,
}

/// What everything is timed against: 1,024 half vectors by Hammersley's points.
pub const BASELINE: Step = Step::Samples(Sampler::HalfVector, PointSet::Hammersley, 1024);

impl Technique {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Technique> {
        let ours = [
            Technique::HSpace,
            Technique::LSpace,
            Technique::DoubleExponential,
            Technique::Surrogate,
            Technique::Certified,
        ];
        let samples = Sampler::ALL.into_iter().map(Technique::Samples);
        samples.chain(StandIn::ALL.into_iter().map(Technique::StandIn)).chain(ours)
    }

    /// Whether it is one of ours.
    pub fn is_ours(self) -> bool {
        !matches!(self, Technique::Samples(_) | Technique::StandIn(_))
    }

    /// What charts call it.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Samples(Sampler::Uniform) => "uniform hemisphere",
            Technique::Samples(Sampler::Cosine) => "cosine hemisphere",
            Technique::Samples(Sampler::HalfVector) => "half vectors by D",
            Technique::Samples(Sampler::Visible) => "visible normals",
            Technique::Samples(Sampler::SphericalCap) => "spherical caps",
            Technique::Samples(Sampler::BoundedVisible) => "bounded caps",
            Technique::StandIn(StandIn::KarisMobile) => "Karis's fit",
            Technique::StandIn(StandIn::Lazarov) => "Lazarov's fit",
            Technique::StandIn(StandIn::Materialx) => "MaterialX's fit",
            Technique::HSpace => "h-space",
            Technique::LSpace => "l-space",
            Technique::DoubleExponential => "double exponential",
            Technique::Surrogate => "surrogate",
            Technique::Certified => "certified",
        }
    }

    /// Where it comes from.
    pub fn source(self) -> &'static str {
        match self {
            Technique::Samples(Sampler::Uniform | Sampler::Cosine) => "Monte Carlo",
            Technique::Samples(Sampler::HalfVector) => "Karis 2013",
            Technique::Samples(Sampler::Visible) => "Heitz 2018",
            Technique::Samples(Sampler::SphericalCap) => "Dupuy, Benyoub 2023",
            Technique::Samples(Sampler::BoundedVisible) => "Eto, Tokuyoshi 2023",
            Technique::StandIn(stand_in) => stand_in.source(),
            _ => "ours",
        }
    }

    /// Its steps for a lobe, from cheap to dear; none where it does not apply.
    pub fn steps(self, lobe: Microfacet) -> Vec<Step> {
        // A double exponential rule with few nodes is of no use for Charlie.
        let rules = |wanted: fn(&Method) -> bool| {
            let rules = RULES.into_iter().filter(|rule| wanted(&rule.method) && rule.applies_to(lobe));
            rules.filter(|rule| rule.bound(lobe).is_finite()).map(Step::Rule).collect()
        };
        match self {
            Technique::Samples(sampler) if sampler.applies_to(lobe) => {
                let counts = (2..=8).map(|k| 1 << (2 * k));
                let sets = |count| PointSet::ALL.into_iter().map(move |set| Step::Samples(sampler, set, count));
                counts.flat_map(sets).collect()
            }
            Technique::Samples(_) => Vec::new(),
            Technique::StandIn(stand_in) => {
                let fitted = [Masking::HeightCorrelated, Masking::SchlickSmith];
                let serves = lobe.ndf == Ndf::Ggx && fitted.contains(&lobe.masking);
                serves.then_some(Step::StandIn(stand_in)).into_iter().collect()
            }
            Technique::HSpace => rules(|method| matches!(method, Method::HSpace(_))),
            Technique::LSpace => rules(|method| matches!(method, Method::LSpace(_))),
            Technique::DoubleExponential => {
                rules(|method| matches!(method, Method::Reference(rule) if rule.outer < 100))
            }
            Technique::Surrogate => rules(|method| matches!(method, Method::Surrogate(_))),
            Technique::Certified => vec![Step::Certified(Precision::F16), Step::Certified(Precision::F32)],
        }
    }
}

impl Step {
    /// What tells it from the other steps of its technique.
    pub fn name(&self) -> String {
        match self {
            Step::Samples(_, set, count) => format!("{} {count}", word(set)),
            Step::StandIn(stand_in) => word(stand_in),
            Step::Rule(rule) => rule.name.into(),
            Step::Certified(precision) => word(precision),
        }
    }

    /// Evaluations of the integrand for a texel of a table of `texels`; of certification, those of its first stage.
    pub fn evaluations(&self, lobe: Microfacet, texels: usize) -> f64 {
        let of = |rule: Rule| rule.evaluations(texels) as f64 / texels as f64;
        match self {
            Step::Samples(_, _, count) => *count as f64,
            Step::StandIn(_) => 1.0,
            Step::Rule(rule) => of(*rule),
            Step::Certified(Precision::F32) => Rule::for_cpu(lobe, 1e-6, texels).map_or(0.0, of),
            Step::Certified(_) => Rule::for_rounding(lobe, texels).map_or(0.0, of),
        }
    }

    /// Whether a CPU can do it in that arithmetic: interpolation, certification and the nodes of double exponential
    /// rules, which come within 3.4e-22 of the ends, are f64 alone.
    pub fn runs_in(&self, arithmetic: Arithmetic) -> bool {
        match self {
            Step::Samples(..) | Step::StandIn(_) => true,
            Step::Rule(rule) => {
                arithmetic == Arithmetic::F64 || matches!(rule.method, Method::HSpace(_) | Method::LSpace(_))
            }
            Step::Certified(_) => arithmetic == Arithmetic::F64,
        }
    }

    /// (A, B) over a grid, on the CPU.
    pub fn run(&self, lobe: Microfacet, grid: &Grid, arithmetic: Arithmetic, seed: u64) -> Result<Vec<ScaleBias>> {
        let bake = |work: Work| match arithmetic {
            Arithmetic::F32 => bake_in::<Singles>(lobe, grid, work),
            Arithmetic::F64 => bake_in::<Lanes>(lobe, grid, work),
        };
        Ok(match self {
            Step::Samples(sampler, set, count) => bake(Work::Samples(*sampler, &set.points(*count, seed))),
            Step::StandIn(stand_in) => bake(Work::StandIn(*stand_in)),
            Step::Rule(rule) if arithmetic == Arithmetic::F64 => cpu::bake(lobe, grid, rule, &|_| ()),
            Step::Rule(rule) => bake(Work::Rule(&rule.integrator())),
            Step::Certified(precision) => {
                let lut = Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab });
                let task = Task { lut: &lut, grid, precision: *precision, tolerance: 1e-6 };
                let values = certify(&task, None, &|_| ())?.values;
                values.chunks_exact(2).map(|ab| ScaleBias { a: ab[0], b: ab[1] }).collect()
            }
        })
    }

    /// The same on a device; `None` where it cannot.
    pub fn run_on(&self, gpu: &Gpu, lobe: Microfacet, grid: &Grid, seed: u64) -> Result<Option<DeviceBake>> {
        match self {
            Step::Samples(sampler, set, count) if sampler.runs_on_device(lobe) => {
                bake_samples(gpu, lobe, grid, *sampler, &set.points(*count, seed)).map(Some)
            }
            Step::Rule(Rule { method: Method::HSpace(rule), .. }) => bake(gpu, lobe, grid, rule, &|_| ()).map(Some),
            _ => Ok(None),
        }
    }
}
