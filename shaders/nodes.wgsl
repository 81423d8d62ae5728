// The nodes of a rule, in the order of the fields of its Rule: position and weight, then nothing,
// as a uniform's elements have 16 bytes. As many as the smallest uniform that a driver may offer
// has room for. See src/backend/vulkan/buffer.rs.
@group(0) @binding(0) var<uniform> nodes: array<vec4<f32>, 1024>;
