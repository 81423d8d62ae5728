//! Every WGSL function that integrates, alone, on 1,024 arguments, against its f64 twin; and how
//! that is done.

use crate::common::{Random, ggx};
use crate::{DeviceTest, model_twins};
use libtest_mimic::Failed;
use splitsum::backend::Gpu;
use splitsum::backend::vulkan::bake::node_data;
use splitsum::backend::vulkan::evaluate::evaluate;
use splitsum::backend::wgsl::{lobe_source, module};
use splitsum::brdf::fresnel::{Basis, KINDS, Schlick, SchlickF82};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::integrate::half_vectors::{
    HalfVectorNodes, HalfVectorRule, View, cut_circle, full_circle, half_vectors, integrand,
    radial_weight, ring,
};
use splitsum::integrate::{Integrals, mirror};
use splitsum::numeric::quadrature::slope_map::{
    MappedSlope, Power, slope_at, slope_complement, slope_interval,
};

pub const TESTS: &[DeviceTest] = &[
    ("functions of models equal their twins", |gpu| {
        let (lobe, nodes) = (ggx(Masking::HeightCorrelated), H288.nodes());
        let mut modules = vec![source(lobe, Fresnel::Schlick, &nodes)];
        for kind in KINDS.iter().filter(|kind| kind.wgsl.1 != "schlick_weights") {
            modules.push(kind.wgsl.0.into());
        }
        let source = modules.join("\n");
        let data = node_data(&nodes);
        model_twins::twins().iter().try_for_each(|twin| compare(gpu, &source, &data, twin))
    }),
    ("functions of a lobe equal their twins: GGX", |gpu| {
        all(gpu, Ndf::Ggx, Masking::HeightCorrelated, SCHLICK, Power::Four)
    }),
    ("functions of a lobe equal their twins: GGX, p = 2", |gpu| {
        all(gpu, Ndf::Ggx, Masking::Separable, SCHLICK, Power::Two)
    }),
    ("functions of a lobe equal their twins: GGX, F82 tint", |gpu| {
        all(
            gpu,
            Ndf::Ggx,
            Masking::HeightCorrelated,
            (Fresnel::SchlickF82, SchlickF82),
            Power::Four,
        )
    }),
    ("functions of a lobe equal their twins: Beckmann", |gpu| {
        all(gpu, Ndf::Beckmann, Masking::HeightCorrelated, SCHLICK, Power::Four)
    }),
    ("functions of a lobe equal their twins: Blinn-Phong", |gpu| {
        all(gpu, Ndf::BlinnPhong, Masking::Implicit, SCHLICK, Power::Four)
    }),
    ("functions of a lobe equal their twins: Charlie", |gpu| {
        all(gpu, Ndf::Charlie, Masking::Neubelt, SCHLICK, Power::Four)
    }),
];

/// A Fresnel model, and the same as a type.
const SCHLICK: (Fresnel, Schlick) = (Fresnel::Schlick, Schlick);

const COUNT: usize = 1024;

/// One ulp of f32, relative.
const ULP: f64 = 1.0 / 8388608.0;

pub struct Twin {
    pub name: &'static str,
    /// The call in WGSL, as a vec4; `p` holds the arguments.
    pub wgsl: &'static str,
    /// The same in Rust.
    pub rust: Box<dyn Fn([f64; 4]) -> [f64; 4]>,
    /// Arguments from random numbers.
    pub arguments: fn(&mut Random) -> [f64; 4],
    /// Ulps that the result may be off, of its own size and of `scale`: about one for each rounding
    /// on the longest path, and two and a half where a division or a root is one of them, since
    /// Vulkan allows that much.
    pub ulps: f64,
    /// The size below which errors are counted as absolute.
    pub scale: f64,
}

pub fn unit(random: &mut Random) -> f64 {
    random.next()
}

/// A number from 1e-6 to 1, evenly by its logarithm.
pub fn small(random: &mut Random) -> f64 {
    10f64.powf(-6.0 * random.next())
}

fn sine(mu: f64) -> f64 {
    ((1.0 - mu) * (1.0 + mu)).sqrt()
}

/// As many numbers as there are weights, and zeros.
fn filled<const N: usize>(values: [f64; N]) -> [f64; 4] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

const H288: HalfVectorRule = HalfVectorRule {
    radial: 16,
    azimuth: 8,
    radial_horizon: 20,
    azimuth_horizon: 8,
    power: Power::Four,
    crowded: false,
};

fn twins<const N: usize, B: Basis<N>>(
    lobe: Microfacet,
    basis: B,
    nodes: &HalfVectorNodes,
) -> Vec<Twin> {
    let power = nodes.power;
    let nodes = || nodes.clone();
    let (full, cut, whole, whole_or_mirror) = (nodes(), nodes(), nodes(), nodes());
    let mirror = move |mu: f64| filled(mirror(lobe, basis, mu).map(|integral| integral.value));
    let three = |random: &mut Random| [small(random), small(random), small(random), small(random)];
    vec![
        Twin {
            name: "cosine_visibility, slope_width",
            wgsl: "vec4(cosine_visibility(p.x, p.y, p.z), slope_width(p.z), 0.0, 0.0)",
            rust: Box::new(move |a| {
                [lobe.cosine_visibility(a[0], a[1], a[2]), lobe.ndf.width(a[2]), 0.0, 0.0]
            }),
            arguments: three,
            ulps: 16.0,
            scale: 0.0,
        },
        Twin {
            name: "slope_complement",
            wgsl: "vec4(slope_complement(p.x), 0.0, 0.0, 0.0)",
            rust: Box::new(move |a| [slope_complement(a[0], power), 0.0, 0.0, 0.0]),
            arguments: |random| [1e9 * small(random) * small(random), 0.0, 0.0, 0.0],
            ulps: 8.0,
            scale: 0.0,
        },
        Twin {
            name: "slope_interval",
            wgsl: "interval_as_vector(slope_interval(p.x, p.y))",
            rust: Box::new(move |a| {
                let i = slope_interval(a[0], a[1], power);
                [i.w0, i.plus0, i.minus1, i.width]
            }),
            arguments: |random| {
                let y = 1e3 * small(random);
                let below = if unit(random) < 0.5 { -y } else { 0.5 * y };
                [below, y, 0.0, 0.0]
            },
            ulps: 10.0,
            // w0 and the length are differences of numbers up to 2.
            scale: 2.0,
        },
        Twin {
            name: "slope_at",
            wgsl: "mapped_as_vector(slope_at(p.x, SlopeInterval(p.y, 1.0 + p.y, p.z, 1.0 - p.y - \
                   p.z)))",
            rust: Box::new(move |a| {
                let (w0, minus1) = (a[1], a[2]);
                let interval = splitsum::numeric::quadrature::slope_map::SlopeInterval {
                    w0,
                    plus0: 1.0 + w0,
                    minus1,
                    width: 1.0 - w0 - minus1,
                };
                let MappedSlope { y, dy } = slope_at(a[0], interval, power);
                [y, dy, 0.0, 0.0]
            }),
            arguments: |random| [unit(random), 0.5 * unit(random), 0.01 + 0.3 * unit(random), 0.0],
            // The power of a rounding in 1 - w: 2p + 1 = 9 times that of three operations, and two
            // divisions.
            ulps: 40.0,
            scale: 0.0,
        },
        Twin {
            name: "ring",
            wgsl: "ring_as_vector(ring(p.x, p.y, p.z))",
            rust: Box::new(|a| {
                let r = ring(a[0], a[1], a[2]);
                [r.m, r.s, r.secant2, r.half_secant]
            }),
            arguments: |random| [unit(random), unit(random), 10.0 * unit(random), 0.0],
            ulps: 9.0,
            scale: 0.0,
        },
        Twin {
            name: "integrand",
            wgsl: "filled(integrand(p.x, p.y, p.z, p.w))",
            rust: Box::new(move |a| {
                filled(integrand(View::new(lobe, basis, a[1], a[2]), a[0], a[3]))
            }),
            // v·h = (x + μ) half_secant stays below 1.
            arguments: |random| {
                let (x, mu) = (unit(random), unit(random));
                [x, mu, small(random), unit(random) / (x + mu)]
            },
            ulps: 30.0,
            // g (1 - F) is off by the rounding of F, at most an ulp of 1; g stays below 2 by some.
            scale: 1.0,
        },
        Twin {
            name: "full_circle",
            wgsl: "full(p.x, p.y, p.z)",
            rust: Box::new(move |a| {
                let tau = a[2] * a[0] / (1.0 + sine(a[0]));
                let view = View::new(lobe, basis, a[0], a[1]);
                filled(full_circle(view, ring(a[0], sine(a[0]), tau), &full.azimuth).0)
            }),
            arguments: |random| [unit(random), small(random), unit(random), 0.0],
            // 8 terms of the integrand; at the horizon x is the difference of two numbers up to 1.
            ulps: 15.0,
            scale: 8.0,
        },
        Twin {
            name: "cut_circle",
            wgsl: "cut(p.x, p.y, p.z)",
            rust: Box::new(move |a| {
                let t1 = a[0] / (1.0 + sine(a[0]));
                let tau = t1 * (1.0 + a[2] * (1.0 / (t1 * t1) - 1.0));
                let view = View::new(lobe, basis, a[0], a[1]);
                filled(cut_circle(view, ring(a[0], sine(a[0]), tau), &cut.azimuth_horizon).0)
            }),
            arguments: |random| {
                let mu = 0.05 + 0.9 * unit(random);
                [mu, small(random).max(0.05), 0.05 + 0.9 * unit(random), 0.0]
            },
            // The same, and the cut's angle, whose cosine is a rounded quotient.
            ulps: 20.0,
            scale: 8.0,
        },
        Twin {
            name: "radial_weight",
            wgsl: "vec4(radial_weight(p.x, p.y, p.z), slope_density(p.z * p.z, p.x), 0.0, 0.0)",
            rust: Box::new(move |a| {
                let density = lobe.ndf.slope_density(a[2] * a[2], a[0]);
                [radial_weight(lobe, a[0], a[1], a[2]), density, 0.0, 0.0]
            }),
            arguments: |random| [small(random), unit(random), 3.0 * small(random).max(0.1), 0.0],
            // An exponent of up to 18 has so many roundings of its own size, and it is an error of
            // the power.
            ulps: 90.0,
            scale: 0.0,
        },
        Twin {
            name: "half_vectors",
            wgsl: "filled(half_vectors(p.x, p.y, Rule(16u, 8u, 20u, 8u)))",
            rust: Box::new(move |a| filled(half_vectors(lobe, basis, a[0], a[1], &whole).0)),
            arguments: |random| [unit(random), small(random), 0.0, 0.0],
            // What f32 arithmetic may add to a rule (integrate::rule::f32_arithmetic) is 1.2e-6;
            // here there are fewer nodes.
            ulps: 7.5,
            scale: 1.0,
        },
        Twin {
            name: "integrate",
            wgsl: "filled(integrate(vec2(p.x, p.x), p.y, Rule(16u, 8u, 20u, 8u)))",
            rust: Box::new(move |a| match a {
                [mu, 0.0, ..] => mirror(mu),
                [mu, alpha, ..] => filled(half_vectors(lobe, basis, mu, alpha, &whole_or_mirror).0),
            }),
            arguments: |random| {
                let alpha = if unit(random) < 0.3 { 0.0 } else { small(random) };
                [0.001 + 0.999 * unit(random), alpha, 0.0, 0.0]
            },
            ulps: 7.5,
            scale: 1.0,
        },
        Twin {
            name: "mirror",
            wgsl: "filled(mirror(p.x))",
            rust: Box::new(move |a| mirror(a[0])),
            arguments: |random| [0.001 + 0.999 * unit(random), 0.0, 0.0, 0.0],
            ulps: 7.5,
            scale: 1.0,
        },
        Twin {
            name: "add",
            wgsl: "filled(sum_of_multiples(p.x))",
            // 1 + 2 + … + 20 times the argument.
            rust: Box::new(|a| {
                let mut sum = Integrals::<N>::zero();
                let term = std::array::from_fn(|k| if k == 1 { -a[0] } else { a[0] });
                (1..=20).for_each(|i| sum.add(f64::from(i), term));
                filled(sum.0)
            }),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            ulps: 12.0,
            scale: 0.0,
        },
    ]
}

const HELPERS: &str = "
fn interval_as_vector(i: SlopeInterval) -> vec4<f32> { return vec4(i.w0, i.plus0, i.minus1, \
i.width); }
fn mapped_as_vector(m: MappedSlope) -> vec4<f32> { return vec4(m.y, m.dy, 0.0, 0.0); }
fn ring_as_vector(r: Ring) -> vec4<f32> { return vec4(r.m, r.s, r.secant2, r.half_secant); }
fn sine(mu: f32) -> f32 { return sqrt((1.0 - mu) * (1.0 + mu)); }
fn full(mu: f32, alpha: f32, place: f32) -> vec4<f32> {
    let r = ring(mu, sine(mu), place * mu / (1.0 + sine(mu)));
    return filled(full_circle(mu, alpha, r, 16u, 8u));
}
fn cut(mu: f32, alpha: f32, place: f32) -> vec4<f32> {
    let t1 = mu / (1.0 + sine(mu));
    let r = ring(mu, sine(mu), t1 * (1.0 + place * (1.0 / (t1 * t1) - 1.0)));
    return filled(cut_circle(mu, alpha, r, 44u, 8u));
}
fn power_as_vector(x: f32, rest: f32) -> vec4<f32> {
    let parts = power_parts(x, 0.1982421875, rest);
    return vec4(parts.x * (1.0 + parts.y), power_of_two(3.0), logarithm_parts(x));
}
fn sum_of_multiples(x: f32) -> Weights {
    var sum = Sum(Weights(0.0), Weights(0.0));
    for (var i = 0u; i < 20u; i++) { add(&sum, i, f32(i + 1u) * alternating(x)); }
    return sum.total + sum.block;
}
fn quadrature(mu: f32, alpha: f32, rule: Rule) -> Weights { return half_vectors(mu, alpha, rule); }
";

/// What depends on the number of weights.
const OF_TWO: &str = "
fn filled(w: Weights) -> vec4<f32> { return vec4(w, 0.0, 0.0); }
fn alternating(x: f32) -> Weights { return Weights(x, -x); }
";
const OF_THREE: &str = "
fn filled(w: Weights) -> vec4<f32> { return vec4(w, 0.0); }
fn alternating(x: f32) -> Weights { return Weights(x, -x, x); }
";

fn all<const N: usize, B: Basis<N>>(
    gpu: &Gpu,
    ndf: Ndf,
    masking: Masking,
    (fresnel, basis): (Fresnel, B),
    power: Power,
) -> Result<(), Failed> {
    let lobe = Microfacet { ndf, masking };
    let nodes = HalfVectorRule { power, ..H288 }.nodes();
    let (source, data) = (source(lobe, fresnel, &nodes), node_data(&nodes));
    twins(lobe, basis, &nodes).iter().try_for_each(|twin| compare(gpu, &source, &data, twin))
}

fn source(lobe: Microfacet, fresnel: Fresnel, nodes: &HalfVectorNodes) -> String {
    let lobe = lobe_source(lobe, fresnel, nodes.power);
    let of_weights = if fresnel.count() == 2 { OF_TWO } else { OF_THREE };
    [&lobe, module::INTEGRATE, HELPERS, of_weights].join("\n")
}

pub fn compare(gpu: &Gpu, source: &str, nodes: &[[f32; 2]], twin: &Twin) -> Result<(), Failed> {
    let mut random = Random(20261122);
    let arguments: Vec<[f32; 4]> =
        (0..COUNT).map(|_| (twin.arguments)(&mut random).map(|argument| argument as f32)).collect();
    let results = evaluate(gpu, source, twin.wgsl, nodes, &arguments)?;
    for (argument, result) in arguments.iter().zip(results) {
        let truth = (twin.rust)(argument.map(f64::from));
        for (got, truth) in result.map(f64::from).into_iter().zip(truth) {
            let allowed = twin.ulps * ULP * truth.abs().max(twin.scale);
            // Written so that NaN fails.
            let close = (got - truth).abs() <= allowed;
            if !close {
                return Err(format!(
                    "{} of {argument:?}: {got:e} for {truth:e}, {allowed:e} allowed",
                    twin.name
                )
                .into());
            }
        }
    }
    Ok(())
}
