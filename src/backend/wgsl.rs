//! From WGSL modules to SPIR-V: the modules of a kernel joined, compiled by naga with every option
//! spelled out, and the sizes that the host needs read off the result.

use crate::brdf::fresnel::{Basis, Dielectric};
use crate::brdf::interface::{Interface, Side, TransmissionMasking};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::integrate::half_vectors::TAIL_DEPTH;
use crate::numeric::quadrature::slope_map::Power;
use naga::back::spv;
use naga::valid::{Capabilities, ShaderStages, SubgroupOperationSet, ValidationFlags, Validator};

/// The WGSL modules that every kernel shares; a model has its own in its definition.
pub mod module {
    /// Twin of `numeric::special`.
    pub const SPECIAL: &str = include_str!("../../shaders/special.wgsl");
    /// Twin of `brdf::fresnel::schlick`, as far as every Fresnel model takes it.
    pub const FRESNEL: &str = include_str!("../../shaders/fresnel.wgsl");
    /// Twin of `brdf::masking`.
    pub const MASKING: &str = include_str!("../../shaders/masking.wgsl");
    /// Twin of `numeric::quadrature::slope_map`.
    pub const SLOPE_MAP: &str = include_str!("../../shaders/slope_map.wgsl");
    /// The nodes of a rule.
    pub const NODES: &str = include_str!("../../shaders/nodes.wgsl");
    /// The points of an estimator, in place of nodes.
    pub const POINTS: &str = include_str!("../../shaders/points.wgsl");
    /// The weights of slopes, and their sum.
    pub const RADIAL: &str = include_str!("../../shaders/radial.wgsl");
    /// Twin of `integrate::glass::ring`.
    pub const GLASS_RING: &str = include_str!("../../shaders/glass_ring.wgsl");
    /// Twin of `integrate::glass`.
    pub const GLASS: &str = include_str!("../../shaders/glass.wgsl");
    /// Twin of `integrate::half_vectors`.
    pub const HALF_VECTORS: &str = include_str!("../../shaders/half_vectors.wgsl");
    /// Twin of `backend::cpu`, as far as it takes care of α = 0.
    pub const INTEGRATE: &str = include_str!("../../shaders/integrate.wgsl");
    /// The entry point of a bake.
    pub const BAKE: &str = include_str!("../../shaders/bake.wgsl");
}

/// A compiled compute shader, and its sizes for the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// SPIR-V 1.3 with the entry point `main`.
    pub spirv: Vec<u32>,
    /// Invocations in a workgroup.
    pub workgroup: usize,
    /// Its bindings 0, 1, … of set 0.
    pub bindings: Vec<Binding>,
    /// Bytes of its push constants.
    pub push_bytes: u32,
}

/// What a kernel reads or writes a buffer as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// `var<uniform>`
    Uniform,
    /// `var<storage>`
    Storage,
}

/// The WGSL that integrates a lobe over half vectors.
pub fn lobe_source(lobe: Microfacet, fresnel: Fresnel, power: Power) -> String {
    [module::NODES, &lobe_functions(lobe, fresnel, power)].join("\n")
}

/// The same but for the nodes.
pub fn lobe_functions(lobe: Microfacet, fresnel: Fresnel, power: Power) -> String {
    let (of_mirror, visibility) = lobe.masking.wgsl();
    let limit = if lobe.ndf.definition().becomes_mirror { of_mirror } else { "0.0" };
    let glue = format!(
        "fn cosine_visibility(x: f32, mu: f32, alpha: f32) -> f32 {{ return {visibility}; }}
fn smooth_limit(mu: f32) -> f32 {{ return {limit}; }}
"
    );
    let slopes = slope_source(lobe.ndf, lobe.ndf.definition().wgsl.slope_end, power);
    [&slopes, module::HALF_VECTORS, &fresnel_source(fresnel), &glue].join("\n")
}

/// The WGSL that integrates a rough interface, and its type of integrals, but for ETA, K and
/// CRITICAL: interfaces that differ by these alone share a source.
pub fn glass_source(interface: Interface, power: Power) -> String {
    let visibility = |separable| match separable {
        true => "separable(x, mu, area_l, area_v)",
        false => "height_correlated(x, mu, area_l, area_v)",
    };
    let reflected = visibility(interface.lobe().masking == Masking::Separable);
    let transmitted = visibility(interface.transmission() == TransmissionMasking::Separable);
    let inside = interface.side() == Side::Inside;
    let arguments = "(x: f32, mu: f32, area_l: f32, area_v: f32) -> f32";
    let glue = format!(
        "const INSIDE = {inside};
fn reflected_visibility{arguments} {{ return {reflected}; }}
fn transmitted_visibility{arguments} {{ return {transmitted}; }}
"
    );
    // The end of the CPU's, without which other nodes and another rule's error would be compared.
    let ndf = interface.lobe().ndf;
    let slopes = slope_source(ndf, &format!("{:e}", ndf.slope_end(1.0, TAIL_DEPTH)), power);
    let (fresnel, _) = Dielectric::DEFINITION.wgsl;
    [module::NODES, &slopes, fresnel, module::GLASS_RING, module::GLASS, &glue].join("\n")
}

/// The modules that every integral over half vectors takes, and a distribution's functions.
fn slope_source(ndf: Ndf, slope_end: &str, power: Power) -> String {
    let wgsl = ndf.definition().wgsl;
    let power = match power {
        Power::Two => 2,
        Power::Four => 4,
    };
    let glue = format!(
        "const POWER = {power}u;
fn slope_width(alpha: f32) -> f32 {{ return {}; }}
fn slope_end(alpha: f32) -> f32 {{ return {slope_end}; }}
fn slope_density(y2: f32, alpha: f32) -> f32 {{ return {}; }}
fn projected_area(c: f32, alpha: f32) -> f32 {{ return {}; }}
",
        wgsl.width, wgsl.slope_density, wgsl.projected_area
    );
    // A distribution may take functions of another's module.
    let mut models: Vec<&str> = Vec::new();
    for source in Ndf::ALL.iter().map(|ndf| ndf.definition().wgsl.source) {
        if !models.contains(&source) {
            models.push(source);
        }
    }
    let modules = [module::SPECIAL, module::MASKING, module::SLOPE_MAP, module::RADIAL];
    [&models.join("\n"), &modules.join("\n"), &glue].map(String::as_str).join("\n")
}

/// The WGSL of a Fresnel model: its module, and the type of its weights and integrals.
fn fresnel_source(fresnel: Fresnel) -> String {
    let (source, weights) = fresnel.definition().wgsl;
    let arguments = fresnel.wgsl_arguments();
    let of_type = match fresnel.count() {
        1 => "f32".into(),
        count => format!("vec{count}<f32>"),
    };
    format!(
        "{}
{source}
alias Weights = {of_type};
fn fresnel_weights(vh: f32) -> Weights {{ return {weights}(vh{arguments}); }}
",
        module::FRESNEL
    )
}

/// The WGSL that writes the integrals of a texel side by side.
fn store_source(count: usize) -> String {
    let components = if count == 1 { vec![""] } else { vec![".x", ".y", ".z", ".w"] };
    let store = |(k, component): (usize, &&str)| {
        format!("    integrals[{count}u * texel + {k}u] = value{component};\n")
    };
    let stores: String = components.iter().take(count).enumerate().map(store).collect();
    format!(
        "@group(0) @binding(3) var<storage, read_write> integrals: array<f32>;
fn store(texel: u32, value: Weights) {{
{stores}}}
"
    )
}

/// The kernel that bakes the integrals of a lobe over half vectors.
pub fn bake_kernel(lobe: Microfacet, fresnel: Fresnel, power: Power) -> Result<Kernel> {
    kernel(&lobe_source(lobe, fresnel, power), fresnel, "half_vectors")
}

/// The kernel that bakes the integrals that `function` of a lobe's source gives for a texel.
pub fn kernel(source: &str, fresnel: Fresnel, function: &str) -> Result<Kernel> {
    let quadrature = format!(
        "fn quadrature(mu: f32, alpha: f32, rule: Rule) -> Weights {{ return {function}(mu, alpha, \
         rule); }}"
    );
    let store = store_source(fresnel.count());
    compile(&[source, &store, &quadrature, module::INTEGRATE, module::BAKE].join("\n"))
}

/// The kernel that bakes R and T of a rough interface where they have to be integrated; zeros at
/// α = 0.
pub fn glass_kernel(interface: Interface, power: Power) -> Result<Kernel> {
    let integrate = "var<private> ETA: f32;
var<private> K: f32;
var<private> CRITICAL: f32;
fn integrate(view: vec2<f32>, alpha: f32, rule: Rule) -> Weights {
    if alpha == 0.0 {
        return Weights(0.0);
    }
    ETA = rule.eta;
    K = rule.k;
    CRITICAL = rule.critical;
    return glass(view.x, view.y, alpha, rule);
}
";
    let source = glass_source(interface, power);
    compile(&[&source, &store_source(2), integrate, module::BAKE].join("\n"))
}

/// Compiles WGSL whose compute entry point is `main`.
pub fn compile(source: &str) -> Result<Kernel> {
    let internal =
        |what: &str, text: String| Error::Internal(format!("{what} of a shader: {text}"));
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| internal("parsing", error.emit_to_string(source)))?;
    // Only what the poorest driver has: no f16, no f64, no subgroups.
    let info = Validator::new(ValidationFlags::all(), Capabilities::IMMEDIATES)
        .subgroup_stages(ShaderStages::empty())
        .subgroup_operations(SubgroupOperationSet::empty())
        .validate(&module)
        .map_err(|error| internal("validation", error.emit_to_string(source)))?;
    let bound = |(_, variable): (_, &naga::GlobalVariable)| {
        let kind = match variable.space {
            naga::AddressSpace::Uniform => Binding::Uniform,
            _ => Binding::Storage,
        };
        variable.binding.map(|binding| (binding, kind))
    };
    let mut bindings: Vec<_> = module.global_variables.iter().filter_map(bound).collect();
    bindings.sort_by_key(|(binding, _)| binding.binding);
    let binding_map: spv::BindingMap = bindings
        .iter()
        .map(|&(binding, _)| {
            let info = spv::BindingInfo {
                descriptor_set: binding.group,
                binding: binding.binding,
                binding_array_size: None,
            };
            (binding, info)
        })
        .collect();
    let push =
        module.global_variables.iter().filter(|(_, v)| v.space == naga::AddressSpace::Immediate);
    let push_bytes = push.map(|(_, v)| module.types[v.ty].inner.size(module.to_ctx())).sum();
    let entry = module.entry_points.iter().find(|entry| entry.name == "main");
    let workgroup = entry.map_or(0, |entry| entry.workgroup_size.iter().product::<u32>());
    let bindings = bindings.into_iter().map(|(_, kind)| kind).collect();
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
        // Every loop here counts up to a bound that is uniform over the dispatch, and every divisor
        // is an array's length.
        force_loop_bounding: false,
        emit_int_div_checks: false,
        ..spv::Options::default()
    };
    let pipeline = spv::PipelineOptions {
        shader_stage: naga::ShaderStage::Compute,
        entry_point: "main".into(),
    };
    let spirv = spv::write_vec(&module, &info, &options, Some(&pipeline))
        .map_err(|error| internal("code generation", error.to_string()))?;
    Ok(Kernel { spirv, workgroup: workgroup as usize, bindings, push_bytes })
}
