//! The baseline: what most bakers do, written as carefully as our own. 1,024 points of Hammersley's set choose half vectors by
//! GGX's distribution (Karis, "Real Shading in Unreal Engine 4", 2013), in f32, as many texels at a time as the CPU's vectors
//! hold (16 with AVX-512), fused multiplications and all, the samples' half vectors worked out once for a row and no trigonometry in
//! the loop.

use pulp::Simd;
use rayon::prelude::*;

pub const SAMPLES: u32 = 1024;
/// A half vector in the plane's coordinates: what of it meets v, and 4/n·h.
struct Sample {
    x: f32,
    z: f32,
    weight: f32,
}

/// The half vectors of a row.
fn samples(alpha: f64) -> Vec<Sample> {
    let sample = |i: u32| {
        let (u, v) = (f64::from(i) / f64::from(SAMPLES), f64::from(i.reverse_bits()) / 4_294_967_296.0);
        let tan2 = alpha * alpha * v / (1.0 - v);
        let z = 1.0 / (1.0 + tan2).sqrt();
        let x = z * tan2.sqrt() * (std::f64::consts::TAU * u).cos();
        Sample { x: x as f32, z: z as f32, weight: (4.0 / (z * f64::from(SAMPLES))) as f32 }
    };
    (0..SAMPLES).map(sample).collect()
}

struct Row<'a> {
    alpha: f32,
    samples: &'a [Sample],
    mus: &'a [f32],
    texels: &'a mut [[f32; 2]],
}

impl pulp::WithSimd for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let splat = |value| simd.splat_f32s(value);
        let (zero, one, alpha2) = (splat(0.0), splat(1.0), splat(self.alpha * self.alpha));
        let b2 = splat((1.0 - self.alpha) * (1.0 + self.alpha));
        // √(α² + b2 c²)
        let smith = |c| simd.sqrt_f32s(simd.mul_add_f32s(simd.mul_f32s(c, c), b2, alpha2));
        let (mus, rest) = S::as_simd_f32s(self.mus);
        assert!(rest.is_empty(), "a table of whole vectors");
        let width = self.mus.len() / mus.len();
        for (&mu, texels) in mus.iter().zip(self.texels.chunks_mut(width)) {
            let sv = simd.sqrt_f32s(simd.mul_f32s(simd.sub_f32s(one, mu), simd.add_f32s(one, mu)));
            let smu = smith(mu);
            let (mut a, mut b) = (zero, zero);
            for sample in self.samples {
                let vh = simd.mul_add_f32s(sv, splat(sample.x), simd.mul_f32s(mu, splat(sample.z)));
                let x = simd.sub_f32s(simd.mul_f32s(vh, splat(2.0 * sample.z)), mu);
                // f n·l / pdf = 4 V n·l v·h / n·h, V = 1/(2 (n·l √(α²+b2 μ²) + μ √(α²+b2 (n·l)²)))
                let over = simd.mul_f32s(simd.mul_f32s(x, vh), splat(0.5 * sample.weight));
                let under = simd.mul_add_f32s(x, smu, simd.mul_f32s(mu, smith(x)));
                let g = simd.select_f32s(simd.greater_than_f32s(x, zero), simd.div_f32s(over, under), zero);
                let c = simd.sub_f32s(one, vh);
                let c2 = simd.mul_f32s(c, c);
                let f = simd.mul_f32s(g, simd.mul_f32s(simd.mul_f32s(c2, c2), c));
                a = simd.add_f32s(a, simd.sub_f32s(g, f));
                b = simd.add_f32s(b, f);
            }
            let (a, b): (&[f32], &[f32]) =
                (bytemuck::cast_slice(std::slice::from_ref(&a)), bytemuck::cast_slice(std::slice::from_ref(&b)));
            for (texel, (&a, &b)) in texels.iter_mut().zip(a.iter().zip(b)) {
                *texel = [a, b];
            }
        }
    }
}

/// (A, B) of height-correlated GGX at these n·v and α, n·v varying fastest.
pub fn bake(mus: &[f64], alphas: &[f64]) -> Vec<[f32; 2]> {
    let mus: Vec<f32> = mus.iter().map(|&mu| mu as f32).collect();
    let mut table = vec![[0.0; 2]; mus.len() * alphas.len()];
    table.par_chunks_mut(mus.len()).zip(alphas).for_each(|(texels, &alpha)| {
        pulp::Arch::new().dispatch(Row { alpha: alpha as f32, samples: &samples(alpha), mus: &mus, texels });
    });
    table
}
