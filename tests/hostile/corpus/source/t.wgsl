// splitsum 0.1.0: splitsum bake --lut dfg --model ggx --masking height-correlated --channels ab --size 2x2 --x nov,linear,centres --y roughness,linear,centres --precision f16 --format wgsl
// R = A (scale: E(F0) = F0*A + B)
// G = B (bias: E(F0) = F0*A + B)
// column i: nov = t, t = clamp((i + 0.5)/2, 0, 1)
// row i: roughness = t, t = clamp((i + 0.5)/2, 0, 1)
// 2 x 2 x 1 texels, slice by slice and row by row, components side by side, in f16
// A, B certified: every value is the true integral, rounded once to the nearest, ties to even; BLAKE3 f9a5ceea394a608be225a223ef099c4cd94bbd570dffdccebfab97dc76896d37

const splitsum_table = array<f32, 8>(
0.7578125, 0.20349121, 0.9921875, 0.001502037,
0.7163086, 0.027954102, 0.63134766, 0.0016412735
);


struct SplitSum {
    A: f32, // scale: E(F0) = F0*A + B
    B: f32, // bias: E(F0) = F0*A + B
    E: f32, // A + B: E at F = 1
}

// The numbers of a texel.
fn splitsum_unpack(texel: vec4<f32>) -> SplitSum {
    var numbers: SplitSum;
    numbers.A = texel.x;
    numbers.B = texel.y;
    numbers.E = numbers.A + numbers.B;
    return numbers;
}

// The place of (n.v, perceptual roughness) in texels: that of column i and row j is (i, j).
fn splitsum_place(nov: f32, roughness: f32) -> vec2<f32> {
    return vec2<f32>(nov * 2.0 - 0.5, roughness * 2.0 - 0.5);
}

// The texel in column i and row j.
fn splitsum_texel(i: i32, j: i32) -> vec4<f32> {
    let at = (j * 2 + i) * 2;
    return vec4<f32>(splitsum_table[at], splitsum_table[at + 1], 0.0, 1.0);
}

// What lies at a place between texels: four of them, each by its share.
fn splitsum_between(x: f32, y: f32) -> vec4<f32> {
    let i = i32(x);
    let j = i32(y);
    let next_i = min(i + 1, 1);
    let next_j = min(j + 1, 1);
    let low = mix(splitsum_texel(i, j), splitsum_texel(next_i, j), x - f32(i));
    let high = mix(splitsum_texel(i, next_j), splitsum_texel(next_i, next_j), x - f32(i));
    return mix(low, high, y - f32(j));
}

// In full precision, without a sampler.
fn splitsum_exact(nov: f32, roughness: f32) -> SplitSum {
    let place = splitsum_place(nov, roughness);
    let x = min(max(place.x, 0.0), 1.0);
    let y = min(max(place.y, 0.0), 1.0);
    return splitsum_unpack(splitsum_between(x, y));
}
