// The entry point that bakes the integrals of a range of a grid's texels, one invocation each: see
// src/backend/vulkan/bake.rs. It needs store, which writes a texel's integrals.

// n.v, and how far it lies above the cosine of the critical angle, or above 0 where there is none.
@group(0) @binding(1) var<storage, read> mus: array<vec2<f32>>;
@group(0) @binding(2) var<storage, read> alphas: array<f32>;

struct Job {
    // The texels from `first` up to, not including, `end`; n.v varies fastest.
    first: u32,
    end: u32,
    rule: Rule,
}

var<immediate> job: Job;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = job.first + id.x;
    if texel >= job.end {
        return;
    }
    let width = arrayLength(&mus);
    store(id.x, integrate(mus[texel % width], alphas[texel / width], job.rule));
}
