//! Every WGSL function of the estimators alone against its f64 twin, and whole estimates.

use crate::DeviceTest;
use crate::common::ggx;
use crate::twins::{Twin, compare, small, unit};
use glam::DVec3;
use libtest_mimic::Failed;
use splitsum::backend::Gpu;
use splitsum::brdf::{Fresnel, Masking, Microfacet};
use splitsum::choice::Choice;
use splitsum::compare::device::{bake_samples, estimator_source, point_data};
use splitsum::compare::point_set::{Point, PointSet};
use splitsum::compare::rows::{Work, bake_in};
use splitsum::compare::sampling::{
    Sample, Sampler, View, bounded_visible_sample, cosine_sample, estimate, half_vector_sample,
    sampled_half_vectors, spherical_cap_sample, uniform_sample, visible_sample,
};
use splitsum::numeric::lanes::F64x8;
use splitsum::table::grid::Grid;

pub const TESTS: &[DeviceTest] = &[
    ("functions of the estimators equal their twins", |gpu| {
        let sampler = estimator_source(LOBE, Fresnel::Schlick, Sampler::SphericalCap);
        let source = [&sampler, HELPERS].join("\n");
        let nodes = point_data(&points());
        twins().iter().try_for_each(|twin| compare(gpu, &source, &nodes, twin))
    }),
    ("tables by every sampler are those of the CPU", tables_are_those_of_the_cpu),
];

const LOBE: Microfacet =
    Microfacet { ndf: splitsum::brdf::Ndf::Ggx, masking: Masking::HeightCorrelated };

fn points() -> Vec<Point> {
    PointSet::Hammersley.points(64, 0)
}

const HELPERS: &str = "
fn point(u: f32, v: f32) -> Point { return Point(u, (1.0 - u) * (1.0 + u), v, 1.0 - v); }
fn counted(s: Sample) -> vec4<f32> { return vec4(s.nl, s.vh, select(0.0, s.weight, s.nl > 0.0), \
0.0); }
fn view_as_vector(view: View) -> vec4<f32> { return vec4(view.sv, view.visible, view.stretched); }
";

/// A twin of a sampler: n·v, α, cos φ and v; the weight, and what it weighs.
fn sampler(
    name: &'static str,
    wgsl: &'static str,
    draw: fn(&View<f64>, f64, &Point) -> Sample<f64>,
) -> Twin {
    Twin {
        name,
        wgsl,
        rust: Box::new(move |[mu, alpha, cosine, v]| {
            let point = Point {
                cosine,
                sine2: (1.0 - cosine) * (1.0 + cosine),
                v,
                root: v.sqrt(),
                weight: 1.0,
            };
            let sample = draw(&View::seen_from(LOBE, mu, alpha), alpha, &point);
            // Below the horizon nothing counts.
            let weight = if sample.nl > 0.0 { sample.weight } else { 0.0 };
            [sample.nl, sample.vh, weight, 0.0]
        }),
        arguments: |random| {
            [
                0.02 + 0.98 * unit(random),
                small(random).max(0.02),
                2.0 * unit(random) - 1.0,
                0.98 * unit(random),
            ]
        },
        // Some 30 roundings, of numbers up to 1 and of weights that grow to 4/α near the edges.
        ulps: 60.0,
        scale: 1.0,
    }
}

/// The twin of the WGSL function of that name.
macro_rules! sampler {
    ($name:ident, $draw:expr) => {{
        let wgsl =
            concat!("counted(", stringify!($name), "(seen_from(p.x, p.y), point(p.z, p.w)))");
        sampler(stringify!($name), wgsl, $draw)
    }};
}

fn twins() -> Vec<Twin> {
    vec![
        Twin {
            name: "seen_from",
            wgsl: "view_as_vector(seen_from(p.x, p.y))",
            rust: Box::new(|[mu, alpha, ..]| {
                let (sv, visible) =
                    (((1.0 - mu) * (1.0 + mu)).sqrt(), LOBE.ndf.projected_area(mu, alpha));
                [sv, visible, alpha * sv / visible, mu / visible]
            }),
            arguments: |random| [unit(random), small(random), 0.0, 0.0],
            ulps: 12.0,
            scale: 0.0,
        },
        Twin {
            name: "bound, visible_factor",
            wgsl: "vec4(bound(seen_from(p.x, p.y)), visible_factor(seen_from(p.x, p.y)), 0.0, 0.0)",
            rust: Box::new(|[mu, alpha, ..]| {
                // Equation 5 as it stands in the paper.
                let (s, a2) = (1.0 + (1.0 - mu * mu).sqrt(), alpha * alpha);
                let k = (1.0 - a2) * s * s / (s * s + a2 * mu * mu);
                [k, 2.0 * (mu + LOBE.ndf.projected_area(mu, alpha)), 0.0, 0.0]
            }),
            arguments: |random| [unit(random), small(random), 0.0, 0.0],
            ulps: 12.0,
            scale: 1.0,
        },
        Twin {
            name: "distribution",
            wgsl: "vec4(distribution(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(|[t, alpha, ..]| {
                [splitsum::brdf::ndf::ggx::ggx_d(t, alpha), 0.0, 0.0, 0.0]
            }),
            arguments: |random| [1e3 * small(random), small(random), 0.0, 0.0],
            ulps: 20.0,
            scale: 0.0,
        },
        Twin {
            name: "reflected, reflect_stretched",
            wgsl: "vec4(counted(reflected(seen_from(p.x, p.y), p.z, p.w)).xyz, \
                reflect_stretched(seen_from(p.x, p.y), p.z, 0.25, p.w, 2.0).vh)",
            rust: Box::new(|[mu, alpha, x, z]| {
                let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
                let vh = sv * x + mu * z;
                let nl = 2.0 * vh * z - mu;
                let weight = if nl > 0.0 { LOBE.cosine_visibility(nl, mu, alpha) } else { 0.0 };
                let h = DVec3::new(alpha * x, alpha * 0.5, z).normalize();
                [nl, vh, weight, sv * h.x + mu * h.z]
            }),
            arguments: |random| {
                let z = unit(random);
                [
                    0.02 + 0.98 * unit(random),
                    small(random).max(0.02),
                    (1.0 - z * z).sqrt() * unit(random),
                    z,
                ]
            },
            ulps: 60.0,
            scale: 1.0,
        },
        Twin {
            name: "direct",
            wgsl: "counted(direct(seen_from(p.x, p.y), point(p.z, 0.5), p.w, sqrt((1.0 - p.w) * \
                   (1.0 + p.w)), 1.0))",
            rust: Box::new(|[mu, alpha, cosine, z]| {
                let v = DVec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
                let sine = ((1.0 - z) * (1.0 + z)).sqrt();
                let l =
                    DVec3::new(sine * cosine, sine * ((1.0 - cosine) * (1.0 + cosine)).sqrt(), z);
                let h = (v + l).normalize();
                let t = (h.x * h.x + h.y * h.y) / (h.z * h.z);
                [
                    z,
                    v.dot(h),
                    splitsum::brdf::ndf::ggx::ggx_d(t, alpha)
                        * LOBE.cosine_visibility(z, mu, alpha),
                    0.0,
                ]
            }),
            arguments: |random| {
                [unit(random), 0.1 + 0.9 * unit(random), 2.0 * unit(random) - 1.0, unit(random)]
            },
            ulps: 60.0,
            scale: 1.0,
        },
        sampler!(half_vector_sample, |view, alpha, point| {
            half_vector_sample(view, &sampled_half_vectors(LOBE.ndf, alpha, &[*point])[0])
        }),
        sampler!(visible_sample, |view, _, point| visible_sample(view, point)),
        sampler!(spherical_cap_sample, |view, _, point| spherical_cap_sample(view, point)),
        sampler!(bounded_visible_sample, |view, _, point| bounded_visible_sample(view, point)),
        sampler!(uniform_sample, |view, _, point| uniform_sample(view, point)),
        sampler!(cosine_sample, |view, _, point| cosine_sample(view, point)),
        Twin {
            name: "estimate",
            wgsl: "vec4(estimate(p.x, p.y, Rule(64u, 0u, 0u, 0u)), 0.0, 0.0)",
            rust: Box::new(|[mu, alpha, ..]| {
                let value = estimate(
                    Sampler::SphericalCap,
                    &View::seen_from(LOBE, mu, alpha),
                    &points(),
                    &[],
                );
                [value.a, value.b, 0.0, 0.0]
            }),
            arguments: |random| [0.01 + 0.99 * unit(random), small(random).max(0.01), 0.0, 0.0],
            // What f32 arithmetic may add to a rule, 9e-7, but for samples that change sides at the
            // horizon, where they are worth next to nothing.
            ulps: 7.5,
            scale: 1.0,
        },
    ]
}

fn tables_are_those_of_the_cpu(gpu: &Gpu) -> Result<(), Failed> {
    let centres: Vec<f64> = (0..16).map(|i| (f64::from(i) + 0.5) / 16.0).collect();
    let grid = Grid::of(centres.clone(), centres.iter().map(|r| r * r).collect());
    for lobe in [ggx(Masking::HeightCorrelated), ggx(Masking::SchlickSmith)] {
        for sampler in Sampler::ALL.iter().copied().filter(|sampler| sampler.runs_on_device(lobe)) {
            for set in PointSet::ALL {
                let points = set.points(256, 1);
                let device =
                    bake_samples(gpu, lobe, &grid, sampler, &points)?.integrals.scale_bias();
                let truth = bake_in::<F64x8>(lobe, &grid, Work::Samples(sampler, &points));
                for (i, (got, truth)) in device.iter().zip(&truth).enumerate() {
                    // A direction drawn by itself is rounded to 1e-7, which is 1e-7/α of a lobe's
                    // width; where half vectors are drawn, the lobe is met as it stands.
                    let (blind, (_, alpha)) =
                        (matches!(sampler, Sampler::Uniform | Sampler::Cosine), grid.point(i));
                    let allowed =
                        if blind { 2e-6 + 1e-6 / alpha } else { 2e-6 } * truth.e().max(1.0);
                    let close =
                        (got.a - truth.a).abs() <= allowed && (got.b - truth.b).abs() <= allowed;
                    if !close {
                        let at = grid.point(i);
                        return Err(format!(
                            "{sampler:?} of {lobe:?} at {at:?}: {got:?} for {truth:?}"
                        )
                        .into());
                    }
                }
            }
        }
    }
    Ok(())
}
