// The counts and the nodes of a rule over half vectors: see src/backend/vulkan/bake.rs.

struct Rule {
    radial: u32,
    azimuth: u32,
    radial_horizon: u32,
    azimuth_horizon: u32,
}

// (position, weight), in the order of the fields of Rule.
@group(0) @binding(0) var<storage, read> nodes: array<vec2<f32>>;
