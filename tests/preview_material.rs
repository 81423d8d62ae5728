//! Previews of glass, a coat and a metal: the brute force under the sky against sums over light
//! directions, which know no half vectors, and against the rules that tables are baked by.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec3;
use splitsum::backend::cpu;
use splitsum::brdf::fresnel::{Basis, Dielectric, metal};
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::integrate::Integrand;
use splitsum::integrate::rules::REFERENCE;
use splitsum::preview::ROUGHNESSES;
use splitsum::preview::curve::Curve;
use splitsum::preview::material::{Light, Material, Way, lit, spheres};
use splitsum::preview::moments::{MOMENT_NODES, Moments, View};
use std::f64::consts::PI;

const GGX: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

const IOR: f64 = 1.5;

fn glass() -> (Interface, Dielectric) {
    let masking = TransmissionMasking::Correlated;
    (Interface::new(GGX, IOR, Side::Outside, masking).unwrap(), Dielectric::new(IOR).unwrap())
}

/// n·v from grazing to upright, the ends included.
const MUS: [f64; 7] = [0.0, 0.003, 0.05, 0.2, 0.5, 0.9, 1.0];

#[test]
fn the_light_of_all_directions_is_what_a_table_holds() {
    let (interface, medium) = glass();
    let [conductor, ..] = metal("gold").unwrap();
    for roughness in ROUGHNESSES {
        let alpha = roughness * roughness;
        let points = MUS.map(|mu| (mu, alpha));
        let truth = |of| cpu::bake_points(of, &points, &REFERENCE).values().to_vec();
        let of_glass = truth(Integrand::Glass(interface));
        let of_metal = truth(Integrand::Specular(GGX, Fresnel::Conductor(conductor)));
        for (i, &mu) in MUS.iter().enumerate() {
            let view = View::new(mu, alpha);
            let reflected = view.reflected(GGX, |c| medium.weights(c)[0])[0];
            let transmitted = view.transmitted(interface)[0];
            let metal = view.reflected(GGX, |c| conductor.weights(c)[0])[0];
            let pairs = [
                (reflected, of_glass[2 * i]),
                (transmitted, of_glass[2 * i + 1]),
                (metal, of_metal[i]),
            ];
            for (value, truth) in pairs {
                // Half a step of 8 bits where sRGB is steepest, of a hundredfold difference.
                assert!((value - truth).abs() < 1.5e-6, "{roughness} {mu}: {value} {truth}");
            }
        }
    }
}

#[test]
fn curves_keep_what_they_promise_between_their_nodes() {
    let (interface, medium) = glass();
    let mus: Vec<f64> = (0..400).map(|i| ((f64::from(i) + 0.37) / 400.0).powi(2)).collect();
    let mus: Vec<f64> = mus.into_iter().chain((0..400).map(|i| 1e-8 * f64::from(i * i))).collect();
    for roughness in ROUGHNESSES {
        let alpha = roughness * roughness;
        let at = |mu| View::new(mu, alpha).transmitted(interface);
        let of_metal = |mu| View::new(mu, alpha).reflected(GGX, |c| medium.weights(c)[0]);
        for moments in [&at as &(dyn Fn(f64) -> Moments + Sync), &of_metal] {
            let curve = Curve::of(MOMENT_NODES, moments).unwrap();
            for &mu in &mus {
                for (value, truth) in curve.at(mu).into_iter().zip(moments(mu)) {
                    assert!((value - truth).abs() < 2e-5, "{roughness} {mu}: {value} {truth}");
                }
            }
        }
        let points: Vec<(f64, f64)> = mus.iter().map(|&mu| (mu, alpha)).collect();
        let [conductor, ..] = metal("gold").unwrap();
        for fresnel in [Fresnel::Conductor(conductor), Fresnel::Dielectric(medium)] {
            let of = Integrand::Specular(GGX, fresnel);
            let curve: Curve<1> = Curve::of_integral(of, alpha, &REFERENCE).unwrap();
            let truth = cpu::bake_points(of, &points, &REFERENCE);
            for (&mu, truth) in mus.iter().zip(truth.values()) {
                // A third of half a step of 8 bits of a hundredfold difference.
                let error = (curve.at(mu)[0] - truth).abs();
                assert!(error < 5e-7, "{fresnel} {roughness} {mu}: {error}");
            }
        }
    }
}

/// D and G₂ of GGX (Walter et al. 2007, equations 33 and 34; Heitz 2014, equation 99).
fn density(cosine: f64, alpha: f64) -> f64 {
    let d = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
    alpha * alpha / (PI * d * d)
}

fn masking(mu: f64, x: f64, alpha: f64) -> f64 {
    let lambda = |c: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
    1.0 / (1.0 + lambda(mu) + lambda(x))
}

/// F of a dielectric (Born and Wolf 1999, section 1.5).
fn reflectance(c: f64) -> f64 {
    let t = (1.0 - (1.0 - c * c) / (IOR * IOR)).sqrt();
    let (s, p) = ((c - IOR * t) / (c + IOR * t), (IOR * c - t) / (IOR * c + t));
    0.5 * (s * s + p * p)
}

/// The moments of f |n·l| over a hemisphere of l, by the midpoint rule; `sign` -1 for the lower.
fn by_light_directions(mu: f64, sign: f64, f: impl Fn(DVec3, DVec3) -> f64) -> Moments {
    const COUNT: usize = 1200;
    let v = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
    let mut sum = [0.0; 6];
    for i in 0..COUNT {
        // Crowded at the horizon: x = u², dx = 2u du.
        let u = (i as f64 + 0.5) / COUNT as f64;
        let x = u * u;
        for j in 0..COUNT {
            let phi = PI * (j as f64 + 0.5) / COUNT as f64;
            let sine = (1.0 - x * x).sqrt();
            let l = DVec3::new(sine * phi.cos(), sine * phi.sin(), sign * x);
            let weight = 2.0 * u * 2.0 * PI / (COUNT * COUNT) as f64 * f(l, v) * x;
            let odd = l.x / v.x;
            let powers = [1.0, l.z, odd, l.z * l.z, l.z * odd, l.x * l.x];
            sum.iter_mut().zip(powers).for_each(|(sum, power)| *sum += weight * power);
        }
    }
    sum
}

#[test]
fn moments_are_those_of_sums_over_light_directions() {
    let (interface, medium) = glass();
    for (mu, alpha) in [(0.1, 0.36), (0.6, 0.2), (0.95, 1.0), (0.3, 0.64)] {
        let view = View::new(mu, alpha);
        let brdf = |l: DVec3, v: DVec3| {
            let h = (l + v).normalize();
            let g = masking(v.z, l.z, alpha);
            reflectance(v.dot(h)) * density(h.z, alpha) * g / (4.0 * l.z * v.z)
        };
        // Walter et al. 2007, equation 21.
        let btdf = |l: DVec3, v: DVec3| {
            let h = (-(v + IOR * l)).normalize();
            let h = if h.z < 0.0 { -h } else { h };
            let (vh, lh) = (v.dot(h), l.dot(h));
            if vh <= 0.0 || lh >= 0.0 {
                return 0.0;
            }
            let g = masking(v.z, -l.z, alpha);
            let passed = (1.0 - reflectance(vh)) * density(h.z, alpha) * g;
            let jacobian = IOR * IOR / (vh + IOR * lh).powi(2);
            vh * -lh / (v.z * -l.z) * jacobian * passed
        };
        let reflected = view.reflected(GGX, |c| medium.weights(c)[0]);
        let transmitted = view.transmitted(interface);
        // The midpoint rule has 1,200 steps along each axis, and errs by their square where the
        // integrand is smooth. Refracted light ends where h lies on the horizon, at which D of GGX
        // is not 0: that jump costs a step (1.8e-4 with 1,200, 8e-5 with 2,400, 5e-5 with 4,800).
        for (moments, truth, allowed) in [
            (reflected, by_light_directions(mu, 1.0, brdf), 5e-6),
            (transmitted, by_light_directions(mu, -1.0, btdf), 4e-4),
        ] {
            for (value, truth) in moments.into_iter().zip(truth) {
                assert!((value - truth).abs() < allowed, "{mu} {alpha}: {moments:?} {truth}");
            }
        }
    }
}

/// The moments of one light direction about a normal, its sine across the plane of v left out as
/// in all moments.
fn of_one(l: DVec3, n: DVec3) -> Moments {
    let t = (DVec3::Z - n.z * n).normalize();
    let (ln, lt, sine) = (l.dot(n), l.dot(t), (1.0 - n.z * n.z).sqrt());
    [1.0, ln, lt / sine, ln * ln, ln * lt / sine, lt * lt]
}

/// A normal in the plane of v and l, an angle away from v.
fn in_plane_of(l: DVec3, angle: f64) -> DVec3 {
    let across = DVec3::new(l.x, l.y, 0.0).normalize();
    angle.cos() * DVec3::Z + angle.sin() * across
}

#[test]
fn the_sky_depends_on_the_heights_of_light_alone() {
    let l = DVec3::new(0.48, 0.6, 0.64);
    let sky = |l: DVec3| lit(of_one(l, in_plane_of(l, 0.3)), in_plane_of(l, 0.3));
    let first = sky(l);
    assert!(first.min_element() > 0.1, "{first}");
    for angle in [-1.2, 0.7, 1.5] {
        let n = in_plane_of(l, angle);
        assert!((lit(of_one(l, n), n) - first).abs().max_element() < 1e-14, "{angle}");
    }
    // Of the same height, whatever else.
    let other = DVec3::new(-0.64, 0.6, -0.48);
    assert!((sky(other) - first).abs().max_element() < 1e-14, "{} {first}", sky(other));
    // A lobe is even across the plane of v: there light and its mirror image come together.
    for n in [DVec3::new(0.48, -0.6, 0.64), DVec3::new(-0.8, 0.36, 0.48)] {
        let across = n.cross(DVec3::Z).normalize();
        let mirrored = l - 2.0 * l.dot(across) * across;
        let both = 0.5 * (sky(l) + sky(mirrored));
        assert!((lit(of_one(l, n), n) - both).abs().max_element() < 1e-14, "{n}");
    }
}

#[test]
fn a_table_and_the_integral_agree_as_far_as_a_lookup_and_a_split_can() {
    for material in [Material::Glass, Material::Coat, Material::Metal] {
        let spheres = spheres(material).unwrap();
        assert_eq!(spheres.len(), ROUGHNESSES.len());
        for (sphere, roughness) in spheres.iter().zip(ROUGHNESSES) {
            for mu in [0.2, 0.4, 0.6, 0.8, 0.97] {
                let side = f64::sqrt(1.0 - mu * mu);
                let n = DVec3::new(0.6 * side, 0.8 * side, mu);
                let apart = |light| {
                    let [table, integral] =
                        [Way::Table, Way::Integral].map(|way| sphere.radiance(light, way, n));
                    assert!(integral.min_element() > 0.0 && integral.max_element() <= 1.0);
                    (table - integral).abs().max_element()
                };
                // A clamped lookup beyond the last texel centre is off by 1e-2; elsewhere a
                // bilinear one of 64 texels by 1e-3.
                let lookup = if roughness == 1.0 { 2e-2 } else { 2e-3 };
                assert!(apart(Light::Furnace) < lookup, "{material:?} {roughness} {mu}");
                // A sharp lobe looks where its kernel does.
                let split = if roughness < 0.2 { 0.02 } else { 0.2 };
                assert!(apart(Light::Sky) < split, "{material:?} {roughness} {mu}");
            }
        }
    }
}
