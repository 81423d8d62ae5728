//! Estimators and textbook formulas on a device.

use super::point_set::Point;
use super::sampling::Sampler;
use crate::backend::Gpu;
use crate::backend::device::DeviceBake;
use crate::backend::vulkan::bake::{Work, run, words};
use crate::backend::wgsl::{kernel, lobe_functions, lobe_source, module};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::error::Result;
use crate::numeric::quadrature::slope_map::Power;
use crate::table::grid::Grid;

/// Twin of `compare::sampling`.
pub const SAMPLING: &str = include_str!("../../shaders/sampling.wgsl");

/// Twin of `compare::textbook`.
pub const TEXTBOOK: &str = include_str!("../../shaders/textbook.wgsl");

/// The WGSL that estimates by a sampler; it goes with that of a lobe.
fn sampling_source(sampler: Sampler) -> String {
    let draw = match sampler {
        Sampler::Uniform => "uniform_sample",
        Sampler::Cosine => "cosine_sample",
        Sampler::HalfVector => "half_vector_sample",
        Sampler::Visible => "visible_sample",
        Sampler::SphericalCap => "spherical_cap_sample",
        Sampler::BoundedVisible => "bounded_visible_sample",
    };
    format!(
        "{SAMPLING}\nfn draw(view: View, point: Point) -> Sample {{ return {draw}(view, point); }}"
    )
}

/// The WGSL of the estimator of a lobe.
pub fn estimator_source(lobe: Microfacet, fresnel: Fresnel, sampler: Sampler) -> String {
    let lobe = lobe_functions(lobe, fresnel, Power::Four);
    [module::POINTS, &lobe, &sampling_source(sampler)].join("\n")
}

/// The WGSL of the formulas of a distribution, textbooks' and ours.
pub fn formula_source(ndf: Ndf) -> String {
    let lobe = Microfacet { ndf, masking: Masking::HeightCorrelated };
    [&lobe_source(lobe, Fresnel::Schlick, Power::Four), TEXTBOOK].join("\n")
}

/// (A, B) of a lobe at every point of the grid by an estimator over `points`.
pub fn bake_samples(
    gpu: &Gpu,
    lobe: Microfacet,
    grid: &Grid,
    sampler: Sampler,
    points: &[Point],
) -> Result<DeviceBake> {
    let fresnel = Fresnel::Schlick;
    let work = Work {
        kernel: kernel(&estimator_source(lobe, fresnel, sampler), fresnel, "estimate")?,
        nodes: point_data(points),
        rule: words(&[points.len(), 0, 0, 0]),
        count: fresnel.count(),
        critical: 0.0,
    };
    run(gpu, &work, grid, &|_| ())
}

/// The points as the shader reads them: (cos φ, sin² φ), (v, 1 - v), (weight, nothing).
pub fn point_data(points: &[Point]) -> Vec<[f32; 2]> {
    let pairs = |p: &Point| [[p.cosine, p.sine2], [p.v, 1.0 - p.v], [p.weight, 0.0]];
    points.iter().flat_map(pairs).map(|pair| pair.map(|value| value as f32)).collect()
}
