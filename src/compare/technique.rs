//! Every method that is compared, in one list: the field's estimators, the closed forms fitted to
//! the integral, and ours.

use super::analytic_fit::AnalyticFit;
use super::device::bake_samples;
use super::point_set::PointSet;
use super::rows::{Work, bake_in, rows};
use super::sampling::Sampler;
use crate::backend::device::DeviceBake;
use crate::backend::{Gpu, bake, cpu};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::certify::decision::Task;
use crate::certify::ziv::certify;
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::integrate::ScaleBias;
use crate::integrate::rule::{GRAZING, Method, Rule};
use crate::integrate::rules::RULES;
use crate::lut::{Dfg, DfgChannels, Lut};
use crate::numeric::lanes::{F32x16, F64x8};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use serde::{Deserialize, Serialize};

/// A method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// A sampler, over any of the point sets.
    Samples(Sampler),
    /// A closed form fitted to GGX.
    AnalyticFit(AnalyticFit),
    /// Quadrature over half vectors.
    HalfVectors,
    /// Quadrature over directions of light, the azimuth in closed form.
    LightDirections,
    /// Double exponential quadrature.
    DoubleExponential,
    /// Interpolation between integrals.
    Interpolant,
    /// Every value rounded correctly.
    Certified,
}

/// A method at one of its costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// A sampler over this number of points of a set.
    Samples(Sampler, PointSet, usize),
    /// The closed form.
    AnalyticFit(AnalyticFit),
    /// A rule.
    Rule(Rule),
    /// Certified, stored so.
    Certified(Precision),
}

/// The arithmetic of a CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Sixteen lanes.
    F32,
    /// Eight lanes.
    F64,
}

choice!(Arithmetic, "arithmetic", {
    F32 = "f32", "sixteen lanes";
    F64 = "f64", "eight lanes";
});

/// The baseline of all times: 1,024 half vectors by Hammersley's points.
pub const BASELINE: Setting = Setting::Samples(Sampler::HalfVector, PointSet::Hammersley, 1024);

impl Technique {
    /// Every technique.
    pub fn all() -> impl Iterator<Item = Technique> {
        let ours = [
            Technique::HalfVectors,
            Technique::LightDirections,
            Technique::DoubleExponential,
            Technique::Interpolant,
            Technique::Certified,
        ];
        let samples = Sampler::ALL.iter().copied().map(Technique::Samples);
        samples.chain(AnalyticFit::ALL.iter().copied().map(Technique::AnalyticFit)).chain(ours)
    }

    /// Whether it is one of ours.
    pub fn is_ours(self) -> bool {
        !matches!(self, Technique::Samples(_) | Technique::AnalyticFit(_))
    }

    /// Its name in charts.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Samples(Sampler::Uniform) => "uniform hemisphere",
            Technique::Samples(Sampler::Cosine) => "cosine hemisphere",
            Technique::Samples(Sampler::HalfVector) => "half vectors by D",
            Technique::Samples(Sampler::Visible) => "visible normals",
            Technique::Samples(Sampler::SphericalCap) => "spherical caps",
            Technique::Samples(Sampler::BoundedVisible) => "bounded caps",
            Technique::AnalyticFit(AnalyticFit::KarisMobile) => "Karis's fit",
            Technique::AnalyticFit(AnalyticFit::Lazarov) => "Lazarov's fit",
            Technique::AnalyticFit(AnalyticFit::Materialx) => "MaterialX's fit",
            Technique::HalfVectors => "half vectors",
            Technique::LightDirections => "light directions",
            Technique::DoubleExponential => "double exponential",
            Technique::Interpolant => "interpolant",
            Technique::Certified => "certified",
        }
    }

    /// Its source.
    pub fn source(self) -> &'static str {
        match self {
            Technique::Samples(Sampler::Uniform | Sampler::Cosine) => "Monte Carlo",
            Technique::Samples(Sampler::HalfVector) => "Karis 2013",
            Technique::Samples(Sampler::Visible) => "Heitz 2018",
            Technique::Samples(Sampler::SphericalCap) => "Dupuy, Benyoub 2023",
            Technique::Samples(Sampler::BoundedVisible) => "Eto, Tokuyoshi 2023",
            Technique::AnalyticFit(fit) => fit.source(),
            _ => "ours",
        }
    }

    /// Its settings for a lobe, the cheapest first; none where it does not apply.
    pub fn steps(self, lobe: Microfacet) -> Vec<Setting> {
        // A double exponential rule with few nodes is of no use for Charlie.
        let rules = |wanted: fn(&Method) -> bool| {
            let rules =
                RULES.into_iter().filter(|rule| wanted(&rule.method) && rule.applies_to(lobe));
            rules.filter(|rule| rule.bound(lobe).is_finite()).map(Setting::Rule).collect()
        };
        match self {
            Technique::Samples(sampler) if sampler.applies_to(lobe) => {
                let counts = (2..=8).map(|k| 1 << (2 * k));
                let sets = |count| {
                    PointSet::ALL
                        .iter()
                        .copied()
                        .map(move |set| Setting::Samples(sampler, set, count))
                };
                counts.flat_map(sets).collect()
            }
            Technique::Samples(_) => Vec::new(),
            Technique::AnalyticFit(fit) => {
                let fitted = [Masking::HeightCorrelated, Masking::SchlickSmith];
                let serves = lobe.ndf == Ndf::Ggx && fitted.contains(&lobe.masking);
                serves.then_some(Setting::AnalyticFit(fit)).into_iter().collect()
            }
            Technique::HalfVectors => rules(|method| matches!(method, Method::HalfVectors(_))),
            Technique::LightDirections => {
                rules(|method| matches!(method, Method::LightDirections(_)))
            }
            Technique::DoubleExponential => rules(
                |method| matches!(method, Method::DoubleExponential(rule) if rule.outer < 100),
            ),
            Technique::Interpolant => rules(|method| matches!(method, Method::Interpolant(_))),
            Technique::Certified => {
                vec![Setting::Certified(Precision::F16), Setting::Certified(Precision::F32)]
            }
        }
    }
}

impl Setting {
    /// Its name among the settings of its technique.
    pub fn name(&self) -> String {
        match self {
            Setting::Samples(_, set, count) => format!("{set} {count}"),
            Setting::AnalyticFit(fit) => fit.to_string(),
            Setting::Rule(rule) => rule.name.into(),
            Setting::Certified(precision) => precision.to_string(),
        }
    }

    /// Evaluations of the integrand for a texel of a table of `texels`; of certification, those of
    /// its first stage.
    pub fn evaluations(&self, lobe: Microfacet, texels: usize) -> f64 {
        let of = |rule: Rule| rule.evaluations(texels) as f64 / texels as f64;
        match self {
            Setting::Samples(_, _, count) => *count as f64,
            Setting::AnalyticFit(_) => 1.0,
            Setting::Rule(rule) => of(*rule),
            Setting::Certified(Precision::F32) => Rule::for_cpu(lobe, 1e-6, texels).map_or(0.0, of),
            Setting::Certified(_) => Rule::for_rounding(lobe, GRAZING, texels).map_or(0.0, of),
        }
    }

    /// Whether a CPU can do it in that arithmetic: interpolation, certification and the nodes of
    /// double exponential rules, which come within 3.4e-22 of the ends, are f64 alone.
    pub fn runs_in(&self, arithmetic: Arithmetic) -> bool {
        match self {
            Setting::Samples(..) | Setting::AnalyticFit(_) => true,
            Setting::Rule(rule) => {
                arithmetic == Arithmetic::F64
                    || matches!(rule.method, Method::HalfVectors(_) | Method::LightDirections(_))
            }
            Setting::Certified(_) => arithmetic == Arithmetic::F64,
        }
    }

    /// (A, B) over a grid, on the CPU.
    pub fn run(
        &self,
        lobe: Microfacet,
        grid: &Grid,
        arithmetic: Arithmetic,
        seed: u64,
    ) -> Result<Vec<ScaleBias>> {
        let estimate = |work: Work| match arithmetic {
            Arithmetic::F32 => bake_in::<F32x16>(lobe, grid, work),
            Arithmetic::F64 => bake_in::<F64x8>(lobe, grid, work),
        };
        match self {
            Setting::Samples(sampler, set, count) => {
                Ok(estimate(Work::Samples(*sampler, &set.points(*count, seed))))
            }
            Setting::AnalyticFit(fit) => Ok(estimate(Work::Fit(*fit))),
            Setting::Rule(rule) => match (arithmetic, rule.method) {
                (Arithmetic::F64, _) => Ok(cpu::bake(lobe, grid, rule, &|_| ()).scale_bias()),
                (Arithmetic::F32, Method::HalfVectors(rule)) => {
                    Ok(rows::<F32x16, _>(lobe, grid, &rule.nodes()))
                }
                (Arithmetic::F32, Method::LightDirections(rule)) => {
                    Ok(rows::<F32x16, _>(lobe, grid, &rule.nodes()))
                }
                (Arithmetic::F32, _) => Err(Error::Internal(format!("rule {} in f32", rule.name))),
            },
            Setting::Certified(precision) => {
                let lut = Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All)?).into();
                let (slices, precision) = (1, *precision);
                let task = Task { lut: &lut, grid, slices, precision, tolerance: 1e-6 };
                let (values, _) = certify(&task, None, &|_| ())?;
                Ok(values.chunks_exact(2).map(|ab| ScaleBias { a: ab[0], b: ab[1] }).collect())
            }
        }
    }

    /// The same on a device; `None` where it cannot.
    pub fn run_on(
        &self,
        gpu: &Gpu,
        lobe: Microfacet,
        grid: &Grid,
        seed: u64,
    ) -> Result<Option<DeviceBake>> {
        match self {
            Setting::Samples(sampler, set, count) if sampler.runs_on_device(lobe) => {
                bake_samples(gpu, lobe, grid, *sampler, &set.points(*count, seed)).map(Some)
            }
            Setting::Rule(Rule { method: Method::HalfVectors(rule), .. }) => {
                bake(gpu, (lobe, Fresnel::Schlick), grid, rule, &|_| ()).map(Some)
            }
            _ => Ok(None),
        }
    }
}
