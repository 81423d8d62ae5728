//! From WGSL modules to SPIR-V: the modules of a bake joined, compiled by naga with every option spelled out, and the
//! sizes that the host needs read off the result.

use crate::error::{Error, Result};
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::slope_map::Power;
use crate::sampling::Sampler;
use naga::back::spv;
use naga::valid::{Capabilities, ShaderStages, SubgroupOperationSet, ValidationFlags, Validator};

/// The WGSL modules.
pub mod wgsl {
    /// Twin of `special`.
    pub const SPECIAL: &str = include_str!("../../shaders/special.wgsl");
    /// Twin of `model::fresnel`.
    pub const FRESNEL: &str = include_str!("../../shaders/fresnel.wgsl");
    /// Twin of `model::ggx`.
    pub const GGX: &str = include_str!("../../shaders/ggx.wgsl");
    /// Twin of `model::beckmann`.
    pub const BECKMANN: &str = include_str!("../../shaders/beckmann.wgsl");
    /// Twin of `model::blinn_phong`.
    pub const BLINN_PHONG: &str = include_str!("../../shaders/blinn_phong.wgsl");
    /// Twin of `model::charlie`.
    pub const CHARLIE: &str = include_str!("../../shaders/charlie.wgsl");
    /// Twin of `model::masking`.
    pub const MASKING: &str = include_str!("../../shaders/masking.wgsl");
    /// Twin of `quadrature::slope_map`.
    pub const SLOPE_MAP: &str = include_str!("../../shaders/slope_map.wgsl");
    /// The counts and the nodes of a rule.
    pub const RULE: &str = include_str!("../../shaders/rule.wgsl");
    /// Twin of `integrate::h_space`.
    pub const H_SPACE: &str = include_str!("../../shaders/h_space.wgsl");
    /// Twin of `sampling`.
    pub const SAMPLING: &str = include_str!("../../shaders/sampling.wgsl");
    /// Twin of `study::textbook`.
    pub const TEXTBOOK: &str = include_str!("../../shaders/textbook.wgsl");
    /// Twin of `integrate`.
    pub const INTEGRATE: &str = include_str!("../../shaders/integrate.wgsl");
    /// Twin of `preview`.
    pub const PREVIEW: &str = include_str!("../../shaders/preview.wgsl");
    /// The entry point of a bake.
    pub const BAKE: &str = include_str!("../../shaders/bake.wgsl");
}

/// A compiled compute shader and what the host has to know of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// SPIR-V 1.3 with the entry point `main`.
    pub spirv: Vec<u32>,
    /// Invocations in a workgroup.
    pub workgroup: usize,
    /// Its storage buffers are bindings 0 to this, exclusive, of set 0.
    pub buffers: u32,
    /// Bytes of its push constants.
    pub push_bytes: u32,
}

/// The WGSL that integrates a lobe over half vectors.
pub fn lobe_source(lobe: Microfacet, power: Power) -> String {
    // Tails are cut where exp(-20) = 2e-9 of a lobe lies beyond; a slope of 1e9 squares to far less than f32 holds.
    let (width, end, density, smith) = match lobe.ndf {
        Ndf::Ggx => ("alpha", "1e9", "ggx_slope_density(y2)", "ggx_smith(c, alpha)"),
        Ndf::Beckmann => ("alpha", "4.47", "beckmann_slope_density(y2)", "beckmann_smith(c, alpha)"),
        Ndf::BeckmannWalter => ("alpha", "4.47", "beckmann_slope_density(y2)", "walter_smith(c, alpha)"),
        Ndf::BlinnPhong => (
            "alpha",
            "blinn_phong_end(alpha, 20.0)",
            "blinn_phong_slope_density(y2, alpha)",
            "beckmann_smith(c, alpha)",
        ),
        Ndf::Charlie => ("charlie_width(alpha)", "1e9", "charlie_slope_density(y2, alpha)", "charlie_smith(c, alpha)"),
    };
    let visibility = match lobe.masking {
        Masking::HeightCorrelated => "height_correlated(x, mu, smith(x, alpha), smith(mu, alpha))",
        Masking::Separable => "separable(x, mu, smith(x, alpha), smith(mu, alpha))",
        Masking::SchlickSmith => "schlick_smith(x, mu, alpha)",
        Masking::Joint => "height_correlated(x, mu, joint_smith(x, alpha), joint_smith(mu, alpha))",
        Masking::Implicit => "implicit(x)",
        Masking::Neubelt => "neubelt(x, mu)",
    };
    let limit = match (lobe.ndf, lobe.masking) {
        (Ndf::Charlie, _) => "0.0",
        (_, Masking::Implicit) => "mu * mu",
        _ => "1.0",
    };
    let power = match power {
        Power::Two => 2,
        Power::Four => 4,
    };
    let glue = format!(
        "const POWER = {power}u;
fn slope_width(alpha: f32) -> f32 {{ return {width}; }}
fn slope_end(alpha: f32) -> f32 {{ return {end}; }}
fn slope_density(y2: f32, alpha: f32) -> f32 {{ return {density}; }}
fn smith(c: f32, alpha: f32) -> f32 {{ return {smith}; }}
fn cosine_visibility(x: f32, mu: f32, alpha: f32) -> f32 {{ return {visibility}; }}
fn smooth_limit(mu: f32) -> f32 {{ return {limit}; }}
"
    );
    let models = [wgsl::FRESNEL, wgsl::GGX, wgsl::BECKMANN, wgsl::BLINN_PHONG, wgsl::CHARLIE, wgsl::MASKING].join("\n");
    [wgsl::SPECIAL, &models, wgsl::RULE, wgsl::SLOPE_MAP, wgsl::H_SPACE, &glue].join("\n")
}

/// The shader that bakes the numbers of a lobe.
pub fn bake_kernel(lobe: Microfacet, power: Power) -> Result<Kernel> {
    compile(&[&lobe_source(lobe, power), &quadrature("h_space"), wgsl::INTEGRATE, wgsl::BAKE].join("\n"))
}

/// The shader that bakes the same by a sampler.
pub fn samples_kernel(lobe: Microfacet, sampler: Sampler) -> Result<Kernel> {
    let lobe = lobe_source(lobe, Power::Four);
    let (sampling, estimate) = (sampling_source(sampler), quadrature("estimate"));
    compile(&[&lobe, &sampling, &estimate, wgsl::INTEGRATE, wgsl::BAKE].join("\n"))
}

/// The WGSL that estimates by a sampler; it goes with that of a lobe.
pub fn sampling_source(sampler: Sampler) -> String {
    let draw = match sampler {
        Sampler::Uniform => "uniform_sample",
        Sampler::Cosine => "cosine_sample",
        Sampler::HalfVector => "half_vector_sample",
        Sampler::Visible => "visible_sample",
        Sampler::SphericalCap => "spherical_cap_sample",
        Sampler::BoundedVisible => "bounded_visible_sample",
    };
    format!("{}\nfn draw(view: View, point: Point) -> Sample {{ return {draw}(view, point); }}", wgsl::SAMPLING)
}

/// The WGSL that makes a function the one by which a texel is integrated.
pub fn quadrature(function: &str) -> String {
    format!("fn quadrature(mu: f32, alpha: f32, rule: Rule) -> vec2<f32> {{ return {function}(mu, alpha, rule); }}")
}

/// The shader that renders a row of a preview.
pub fn preview_kernel(lobe: Microfacet, power: Power) -> Result<Kernel> {
    compile(&[&lobe_source(lobe, power), wgsl::PREVIEW].join("\n"))
}

/// Compiles WGSL whose compute entry point is `main`.
pub fn compile(source: &str) -> Result<Kernel> {
    let internal = |what: &str, text: String| Error::Internal(format!("{what} of a shader: {text}"));
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| internal("parsing", error.emit_to_string(source)))?;
    // Only what the poorest driver has: no f16, no f64, no subgroups.
    let info = Validator::new(ValidationFlags::all(), Capabilities::IMMEDIATES)
        .subgroup_stages(ShaderStages::empty())
        .subgroup_operations(SubgroupOperationSet::empty())
        .validate(&module)
        .map_err(|error| internal("validation", error.emit_to_string(source)))?;
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    let binding_map: spv::BindingMap = bindings
        .map(|binding| {
            let info =
                spv::BindingInfo { descriptor_set: binding.group, binding: binding.binding, binding_array_size: None };
            (binding, info)
        })
        .collect();
    let push = module.global_variables.iter().filter(|(_, v)| v.space == naga::AddressSpace::Immediate);
    let push_bytes = push.map(|(_, v)| module.types[v.ty].inner.size(module.to_ctx())).sum();
    let entry = module.entry_points.iter().find(|entry| entry.name == "main");
    let workgroup = entry.map_or(0, |entry| entry.workgroup_size.iter().product::<u32>());
    let buffers = binding_map.len() as u32;
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::empty(),
        fake_missing_bindings: false,
        binding_map,
        bounds_check_policies: naga::proc::BoundsCheckPolicies {
            index: naga::proc::BoundsCheckPolicy::Restrict,
            buffer: naga::proc::BoundsCheckPolicy::Restrict,
            image_load: naga::proc::BoundsCheckPolicy::Restrict,
            binding_array: naga::proc::BoundsCheckPolicy::Restrict,
        },
        // Every loop here counts up to a bound that is uniform over the dispatch, and every divisor is an array's
        // length.
        force_loop_bounding: false,
        emit_int_div_checks: false,
        ..spv::Options::default()
    };
    let pipeline = spv::PipelineOptions { shader_stage: naga::ShaderStage::Compute, entry_point: "main".into() };
    let spirv = spv::write_vec(&module, &info, &options, Some(&pipeline))
        .map_err(|error| internal("code generation", error.to_string()))?;
    Ok(Kernel { spirv, workgroup: workgroup as usize, buffers, push_bytes })
}
