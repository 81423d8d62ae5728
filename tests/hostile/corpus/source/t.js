// splitsum 0.1.0: splitsum bake --lut dfg --model ggx --masking height-correlated --channels ab --size 2x2 --x nov,linear,centres --y roughness,linear,centres --precision f16 --format js
// R = A (scale: E(F0) = F0*A + B)
// G = B (bias: E(F0) = F0*A + B)
// column i: nov = t, t = clamp((i + 0.5)/2, 0, 1)
// row i: roughness = t, t = clamp((i + 0.5)/2, 0, 1)
// 2 x 2 x 1 texels, slice by slice and row by row, components side by side, in f16
// A, B certified: every value is the true integral, rounded once to the nearest, ties to even; BLAKE3 f9a5ceea394a608be225a223ef099c4cd94bbd570dffdccebfab97dc76896d37

export const splitsum_table = new Uint16Array([
0x3a10, 0x3283, 0x3bf0, 0x1627,
0x39bb, 0x2728, 0x390d, 0x16b9
]);

export const width = 2;
export const height = 2;
export const depth = 1;
export const components = 2;
export const channels = ['A', 'B'];
