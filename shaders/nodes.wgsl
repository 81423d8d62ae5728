// The nodes of a rule, in the order of the fields of its Rule: (position, weight). See
// src/backend/vulkan/bake.rs.
@group(0) @binding(0) var<storage, read> nodes: array<vec2<f32>>;
