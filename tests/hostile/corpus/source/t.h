#pragma once

// splitsum 0.1.0: splitsum bake --lut dfg --model ggx --masking height-correlated --channels ab --size 2x2 --x nov,linear,centres --y roughness,linear,centres --precision f16 --format h
// R = A (scale: E(F0) = F0*A + B)
// G = B (bias: E(F0) = F0*A + B)
// column i: nov = t, t = clamp((i + 0.5)/2, 0, 1)
// row i: roughness = t, t = clamp((i + 0.5)/2, 0, 1)
// 2 x 2 x 1 texels, slice by slice and row by row, components side by side, in f16
// A, B certified: every value is the true integral, rounded once to the nearest, ties to even; BLAKE3 f9a5ceea394a608be225a223ef099c4cd94bbd570dffdccebfab97dc76896d37

#include <math.h>
#include <stdint.h>
#include <string.h>

static const uint16_t splitsum_table[8] = {
0x3a10, 0x3283, 0x3bf0, 0x1627,
0x39bb, 0x2728, 0x390d, 0x16b9
};


typedef struct {
    float A; // scale: E(F0) = F0*A + B
    float B; // bias: E(F0) = F0*A + B
    float E; // A + B: E at F = 1
} SplitSum;

// The value of a half: its exponent is moved from a bias of 15 to one of 127 by a product, which
// makes normal numbers of subnormal ones too.
static inline float splitsum_half(uint16_t half) {
    uint32_t bits = (uint32_t)(half & 0x7fff) << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    value *= 5.192296858534828e33f; // 2^112
    return half & 0x8000 ? -value : value;
}

// In full precision: the texels around a place, each by its share.
static inline SplitSum splitsum_exact(float nov, float roughness) {
    float x = fminf(fmaxf(nov * 2.0f - 0.5f, 0.0f), 1.0f);
    float y = fminf(fmaxf(roughness * 2.0f - 0.5f, 0.0f), 1.0f);
    int i = (int)x, j = (int)y;
    float texel[2] = {0};
    for (int corner = 0; corner < 4; ++corner) {
        int right = corner & 1, below = corner >> 1 & 1;
        float share = (right ? x - (float)i : 1.0f - (x - (float)i))
            * (below ? y - (float)j : 1.0f - (y - (float)j));
        int column = i + right < 2 ? i + right : i;
        int row = j + below < 2 ? j + below : j;
        int at = (row * 2 + column) * 2;
        for (int c = 0; c < 2; ++c) {
            texel[c] += share * (splitsum_half(splitsum_table[at + c]));
        }
    }
    SplitSum numbers;
    numbers.A = texel[0];
    numbers.B = texel[1];
    numbers.E = numbers.A + numbers.B;
    return numbers;
}

// The texture coordinate for a sampler that is linear and clamps to the edge.
static inline void splitsum_uv(float nov, float roughness, float uv[2]) {
    uv[0] = nov;
    uv[1] = roughness;
}
