//! Rough interfaces on a device: every function alone beside its twin.

use crate::DeviceTest;
use crate::common::{Random, ggx};
use crate::glass::interface;
use crate::twins::{Twin, compare, unit};
use libtest_mimic::Failed;
use splitsum::backend::Gpu;
use splitsum::backend::vulkan::bake::pair;
use splitsum::backend::wgsl::glass_source;
use splitsum::brdf::Masking;
use splitsum::brdf::fresnel::reflectance_from;
use splitsum::brdf::interface::{Interface, Side};
use splitsum::integrate::glass::ring::{Ring, Zero, azimuth_at, cosine_at, zero_at};
use splitsum::integrate::glass::{GlassNodes, glass, sorted, tangent, view_of};
use splitsum::integrate::rule::Method;
use splitsum::integrate::rules::G560;
use splitsum::numeric::quadrature::slope_map::Power;

pub const TESTS: &[DeviceTest] = &[
    ("functions of glass equal their twins: from outside", |gpu| all(gpu, Side::Outside)),
    ("functions of glass equal their twins: from inside", |gpu| all(gpu, Side::Inside)),
];

const IOR: f64 = 1.5;

/// cos θ_c at [`IOR`].
const CRITICAL: f64 = 0.745_355_992_499_929_9;

/// (n·v, n·v - cos θ_c, α, a slope), a third of them near the critical angle.
fn view(random: &mut Random) -> [f64; 4] {
    let mu = match unit(random) {
        ..0.33 => CRITICAL + (unit(random) - 0.5) * 10f64.powf(-4.0 * unit(random)) * 0.5,
        _ => 0.01 + 0.98 * unit(random),
    };
    let alpha = 10f64.powf(-3.0 * unit(random));
    [mu, mu - CRITICAL, alpha, 10f64.powf(3.0 * unit(random) - 2.5)]
}

/// What a ring has.
fn numbers(Zero { scale, square, t2, slope, .. }: Zero<f64>) -> [f64; 4] {
    [scale, square, t2, slope]
}

/// At C² = a[2] the cosine that vanishes at a[0], 2 (C² - a[0]), from what lies between.
fn cosine(a: [f64; 4]) -> f64 {
    let zero = zero_at(2.0, a[0]);
    let azimuth = azimuth_at(zero.t2 * a[1]);
    cosine_at(zero, azimuth, zero.t2 * (1.0 - a[1]))
}

fn twins(interface: Interface, nodes: &GlassNodes) -> Vec<Twin> {
    let at = move |a: [f64; 4]| view_of(interface, a[0], a[1], a[2]);
    let ring = move |a: [f64; 4]| -> Ring<f64> { at(a).ring_at(a[3]) };
    let (reflecting, transmitting, whole) =
        (nodes.reflected.clone(), nodes.transmitted.clone(), nodes.clone());
    let whole_ring = nodes.reflected.clone();
    vec![
        Twin {
            name: "view_of",
            wgsl: "view_as_vector(view_of(p.x, p.y, p.z))",
            rust: Box::new(move |a| {
                let area = interface.lobe().masking_projected_area(a[0], a[2]);
                [((1.0 - a[0]) * (1.0 + a[0])).sqrt(), a[1], a[2], area]
            }),
            arguments: view,
            ulps: 8.0,
            scale: 0.0,
        },
        Twin {
            name: "tangent",
            wgsl: "vec4(tangent(p.x, p.w), tangent(p.x, p.y), 0.0, 0.0)",
            rust: Box::new(|a| [tangent(a[0], a[3]), tangent(a[0], a[1]), 0.0, 0.0]),
            arguments: view,
            ulps: 3.0,
            scale: 0.0,
        },
        Twin {
            name: "touches",
            wgsl: "vec4(touches(view_of(p.x, p.y, p.z)), 0.0, 0.0)",
            rust: Box::new(move |a| {
                let [near, far] = at(a).touches();
                [near, far, 0.0, 0.0]
            }),
            // The second is a right angle within a rounding where its cosine cancels.
            arguments: |random| {
                let mu = 0.9 + 0.1 * unit(random);
                [mu, mu - CRITICAL, 0.5, 0.0]
            },
            ulps: 12.0,
            scale: 0.0,
        },
        Twin {
            name: "sorted",
            wgsl: "middle_of(sorted(0.1, p, 3.0))",
            rust: Box::new(|a| {
                let ends = sorted(0.1, a, 3.0);
                std::array::from_fn(|k| ends[k + 1])
            }),
            arguments: |random| std::array::from_fn(|_| 4.0 * unit(random)),
            ulps: 1.0,
            scale: 0.0,
        },
        Twin {
            name: "reflected_breaks",
            wgsl: "bounded(middle_of(reflected_breaks(view_of(p.x, p.y, p.z))))",
            rust: Box::new(move |a| {
                let ends = at(a).reflected_breaks();
                std::array::from_fn(|k| ends[k + 1] / (1.0 + ends[k + 1]))
            }),
            arguments: view,
            // A slope near a horizon is as uncertain as the angle: a rounding of 1 in its cosine.
            ulps: 16.0,
            scale: 1.0,
        },
        Twin {
            name: "transmitted_breaks",
            wgsl: "bounded(middle_of(transmitted_breaks(view_of(p.x, p.y, p.z))))",
            rust: Box::new(move |a| {
                let ends = at(a).transmitted_breaks();
                std::array::from_fn(|k| ends[k + 1] / (1.0 + ends[k + 1]))
            }),
            // √((cos θ_c - μ)(cos θ_c + μ)) has the root of a rounding where μ is near cos θ_c.
            arguments: |random| {
                let mut p = view(random);
                if (p[0] - CRITICAL).abs() < 1e-3 {
                    p[0] = 0.5;
                    p[1] = 0.5 - CRITICAL;
                }
                p
            },
            ulps: 500.0,
            scale: 1.0,
        },
        Twin {
            name: "reflectance, transmittance",
            // g² = k + c² rounds where it nearly vanishes; here it is given.
            wgsl: "vec4(reflectance(sqrt(p.x * p.x - min(K, 0.0) * (1.0 - p.x * p.x)), \
                   g2_of(p.x)), transmittance(p.y, p.x), 0.0, 0.0)",
            rust: Box::new(move |a| {
                let k = interface.k();
                let c = (a[0] * a[0] - k.min(0.0) * (1.0 - a[0] * a[0])).sqrt();
                let g2 = a[0] * a[0] * (1.0 + k.min(0.0)) + k.max(0.0);
                let view = at([0.5, 0.5 - CRITICAL, 0.5, 0.0]);
                [view.reflectance(c, g2), view.transmittance(a[1], a[0]), 0.0, 0.0]
            }),
            arguments: |random| [unit(random), 0.05 + 0.95 * unit(random), 0.0, 0.0],
            ulps: 24.0,
            // F → 1 where g → 0; at normal incidence it is 0.04.
            scale: 1.0,
        },
        Twin {
            name: "reflectance_from",
            wgsl: "vec4(reflectance_from(p.x, p.y, 1.0 - p.x * p.x, 1.25), 0.0, 0.0, 0.0)",
            rust: Box::new(|a| {
                [reflectance_from(a[0], a[1], 1.0 - a[0] * a[0], 1.25), 0.0, 0.0, 0.0]
            }),
            arguments: |random| {
                let c = unit(random);
                [c, 1.25 + c * c, 0.0, 0.0]
            },
            ulps: 24.0,
            scale: 1.0,
        },
        Twin {
            name: "ring_at",
            wgsl: "ring_as_vector(ring_at(view_of(p.x, p.y, p.z), p.w))",
            rust: Box::new(move |a| {
                let Ring { secant, middle, swing, versine } = ring(a);
                [secant, middle, swing, versine]
            }),
            arguments: view,
            ulps: 10.0,
            scale: 0.0,
        },
        Twin {
            name: "zero_at, critical_zero",
            wgsl: "zero_as_vector(critical_zero(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, \
                   p.z), p.w)))",
            rust: Box::new(move |a| numbers(at(a).critical_zero(ring(a)))),
            arguments: |random| {
                let mut p = view(random);
                // Below a slope of 0.3 the critical angle is not on most rings.
                p[3] = 0.3 + 3.0 * unit(random);
                p
            },
            // C² is a quotient of a difference of numbers up to 1.
            ulps: 80.0,
            scale: 1.0,
        },
        Twin {
            name: "azimuth_at",
            wgsl: "vec4(azimuth_at(p.x).share, azimuth_at(p.x).cos_half, azimuth_at(p.x).t2, 0.0)",
            rust: Box::new(|a| {
                let azimuth = azimuth_at(a[0]);
                [azimuth.share, azimuth.cos_half, azimuth.t2, 0.0]
            }),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            ulps: 4.0,
            scale: 1.0,
        },
        Twin {
            name: "cosine_at",
            wgsl: "vec4(cosine_of(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(|a| [cosine(a), 0.0, 0.0, 0.0]),
            arguments: |random| [1.5 * unit(random) - 0.5, unit(random), 0.0, 0.0],
            ulps: 12.0,
            scale: 1.0,
        },
        Twin {
            name: "seen, passed",
            wgsl: "vec4(seen(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, p.z), p.w), p.x), \
                   passed(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, p.z), p.w), 0.9, \
                   K + 0.9 * 0.9), 0.0, 0.0)",
            rust: Box::new(move |a| {
                let (view, c) = (at(a), f64::from(0.9f32));
                let passed = view.passed(ring(a), c, interface.k() + c * c);
                [view.seen(ring(a), a[0]), passed, 0.0, 0.0]
            }),
            arguments: view,
            ulps: 40.0,
            scale: 1.0,
        },
        Twin {
            name: "reflected_whole",
            wgsl: "vec4(reflected_whole(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, p.z), \
                   p.w), 0.05, zero_at(0.5, p.x * p.x), FIRST_WHOLE, RULE), 0.0, 0.0, 0.0)",
            rust: Box::new(move |a| {
                let horizon = zero_at(0.5, a[0] * a[0]);
                let t2 = f64::from(0.05f32);
                [at(a).reflected_whole(ring(a), t2, horizon, &whole_ring), 0.0, 0.0, 0.0]
            }),
            arguments: view,
            ulps: 80.0,
            scale: 4.0,
        },
        Twin {
            name: "reflected_ring",
            wgsl: "vec4(reflected_ring(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, p.z), \
                   p.w), RULE.reflected_slopes, RULE), 0.0, 0.0, 0.0)",
            rust: Box::new(move |a| [at(a).reflected_ring(ring(a), &reflecting), 0.0, 0.0, 0.0]),
            arguments: view,
            // As of one azimuth, of which C² of either end is a rounded quotient.
            ulps: 80.0,
            scale: 4.0,
        },
        Twin {
            name: "transmitted_ring",
            wgsl: "vec4(transmitted_ring(view_of(p.x, p.y, p.z), ring_at(view_of(p.x, p.y, p.z), \
                   p.w), FIRST_TRANSMITTED, RULE), 0.0, 0.0, 0.0)",
            rust: Box::new(move |a| {
                [at(a).transmitted_ring(ring(a), &transmitting), 0.0, 0.0, 0.0]
            }),
            arguments: view,
            ulps: 80.0,
            scale: 4.0,
        },
        Twin {
            name: "glass",
            wgsl: "vec4(glass(p.x, p.y, p.z, RULE), 0.0, 0.0)",
            rust: Box::new(move |a| {
                let [reflected, transmitted] = glass(interface, a[0], a[1], a[2], &whole).0;
                [reflected, transmitted, 0.0, 0.0]
            }),
            arguments: view,
            // 9e-7
            ulps: 7.5,
            scale: 1.0,
        },
    ]
}

const HELPERS: &str = "
fn view_as_vector(v: View) -> vec4<f32> {
    return vec4(v.sv, v.from_critical, v.alpha, v.area_v);
}
fn middle_of(ends: array<f32, 6>) -> vec4<f32> {
    return vec4(ends[1], ends[2], ends[3], ends[4]);
}
fn bounded(x: vec4<f32>) -> vec4<f32> { return x / (1.0 + x); }
fn g2_of(x: f32) -> f32 { return x * x * (1.0 + min(K, 0.0)) + max(K, 0.0); }
fn ring_as_vector(r: Ring) -> vec4<f32> { return vec4(r.secant, r.middle, r.swing, r.versine); }
fn zero_as_vector(z: Zero) -> vec4<f32> { return vec4(z.scale, z.square, z.t2, z.slope); }
fn cosine_of(square: f32, place: f32) -> f32 {
    let zero = zero_at(2.0, square);
    return cosine_at(zero, azimuth_at(zero.t2 * place), zero.t2 * (1.0 - place));
}
";

fn all(gpu: &Gpu, side: Side) -> Result<(), Failed> {
    let Method::Glass(rule) = G560.method else { return Err("g560".into()) };
    let [slopes, azimuths, total, transmitted_slopes, transmitted_azimuths] = rule.counts(side);
    let interface = interface(ggx(Masking::HeightCorrelated), IOR, side)?;
    let (eta, k, critical) = (interface.eta(), interface.k(), interface.critical());
    let constants = format!(
        "const ETA: f32 = {eta:e};\nconst K: f32 = {k:e};\nconst CRITICAL: f32 = {critical:e};\n\
         const RULE = Rule({slopes}u, {azimuths}u, {total}u, {transmitted_slopes}u, \
         {transmitted_azimuths}u, ETA, K, CRITICAL);\nconst FIRST_WHOLE = {}u;\n\
         const FIRST_TRANSMITTED = {}u;\n",
        slopes + 2 * azimuths,
        slopes + 2 * (azimuths + total) + transmitted_slopes
    );
    let nodes = rule.nodes(side);
    let data: Vec<[f32; 2]> = nodes.lists().into_iter().flatten().map(pair).collect();
    let source = [&glass_source(interface, Power::Two), &*constants, HELPERS].join("\n");
    twins(interface, &nodes).iter().try_for_each(|twin| compare(gpu, &source, &data, twin))
}
