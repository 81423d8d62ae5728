//! Fresnel models as bases: the sum of the weights is the model, and the sum of the integrals is
//! the albedo of a lobe with that model, as its paper writes it, by another integral.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::ggx;
use splitsum::backend::{Backend, cpu};
use splitsum::brdf::fresnel::{Basis, schlick_f82_weights, schlick_weights};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::integrate::Integrand;
use splitsum::integrate::rules::REFERENCE;
use splitsum::lut::{Dfg, DfgChannels, Lut};
use splitsum::numeric::quadrature::gauss_legendre::gauss_legendre;
use splitsum::request::{Accuracy, Request};
use splitsum::table::axis::Axis;
use splitsum::table::precision::Precision;
use std::f64::consts::PI;

/// F of a metal as Kutz, Hašan and Edmondson 2021 define it: Schlick's, less what makes it `tint`
/// times Schlick's at cos θ = 1/7.
fn f82(f0: f64, tint: f64, c: f64) -> f64 {
    let schlick = |c: f64| f0 + (1.0 - f0) * (1.0 - c).powi(5);
    let at = 1.0 / 7.0;
    let dip = (schlick(at) - tint * schlick(at)) / (at * (1.0 - at).powi(6));
    schlick(c) - dip * c * (1.0 - c).powi(6)
}

/// a of E = F0 A + B - a C, from the description in the metadata.
fn a(f0: f64, tint: f64) -> f64 {
    (f0 + (1.0 - f0) * (6.0f64 / 7.0).powi(5)) * (1.0 - tint) * 7.0 * (7.0f64 / 6.0).powi(6)
}

#[test]
fn the_sum_of_the_weights_is_the_model() {
    for i in 0..=70 {
        let c = f64::from(i) / 70.0;
        for (f0, tint) in [(0.04, 1.0), (0.9, 0.8), (1.0, 0.0), (0.5, 1.3)] {
            let [w0, w1] = schlick_weights(c);
            assert!((f0 * w0 + w1 - f82(f0, 1.0, c)).abs() < 4.0 * f64::EPSILON);
            let [w0, w1, w2] = schlick_f82_weights(c);
            let f = f0 * w0 + w1 - a(f0, tint) * w2;
            // The weight of a is at most 1/18 of it, and a at most 18.
            assert!((f - f82(f0, tint, c)).abs() < 1e-14, "{c} {f0} {tint}: {f}");
        }
    }
    assert!((f82(0.9, 0.7, 1.0 / 7.0) - 0.7 * (0.9 + 0.1 * (6.0f64 / 7.0).powi(5))).abs() < 1e-15);
}

/// The albedo of a lobe with F82 tint: ∫ F D G / (4 n·v) dω over directions of light, by a product
/// of Gauss rules in n·l and the azimuth. It shares no variable, no map and no form of D and G with
/// the rules; the lobes are rough, so that it converges.
fn albedo(lobe: Microfacet, alpha: f64, mu: f64, f: impl Fn(f64) -> f64) -> f64 {
    let nodes = gauss_legendre(160);
    let sv = (1.0 - mu * mu).sqrt();
    let mut sum = 0.0;
    for light in &nodes {
        // n·l = u², since G has a root at the horizon that is steep for small n·v.
        let x = light.at * light.at;
        let sl = (1.0 - x * x).sqrt();
        for azimuth in &nodes {
            let phi = PI * azimuth.at;
            let lv = x * mu + sl * sv * phi.cos();
            let vh = ((1.0 + lv) / 2.0).sqrt();
            let nh = (x + mu) / (2.0 * vh);
            let (d, lambda): (f64, [f64; 2]) = match lobe.ndf {
                Ndf::Ggx => {
                    let a2 = alpha * alpha;
                    let lambda = |c: f64| 0.5 * ((1.0 + a2 * (1.0 / (c * c) - 1.0)).sqrt() - 1.0);
                    (a2 / (PI * (nh * nh * (a2 - 1.0) + 1.0).powi(2)), [lambda(x), lambda(mu)])
                }
                _ => {
                    let tan2 = 1.0 / (nh * nh) - 1.0;
                    let a2 = alpha * alpha;
                    let lambda = |c: f64| {
                        let a = c / (alpha * (1.0 - c * c).sqrt());
                        0.5 * (libm::erf(a) - 1.0) + (-a * a).exp() / (2.0 * a * PI.sqrt())
                    };
                    ((-tan2 / a2).exp() / (PI * a2 * nh.powi(4)), [lambda(x), lambda(mu)])
                }
            };
            let g = match lobe.masking {
                Masking::HeightCorrelated => 1.0 / (1.0 + lambda[0] + lambda[1]),
                _ => 1.0 / ((1.0 + lambda[0]) * (1.0 + lambda[1])),
            };
            let weight = light.weight * 2.0 * light.at * azimuth.weight * 2.0 * PI;
            sum += weight * f(vh) * d * g / (4.0 * mu);
        }
    }
    sum
}

#[test]
fn the_integrals_add_up_to_the_albedo_of_the_model() {
    let beckmann = Microfacet { ndf: Ndf::Beckmann, masking: Masking::Separable };
    for lobe in [ggx(Masking::HeightCorrelated), ggx(Masking::Separable), beckmann] {
        for (alpha, mu) in [(0.36, 0.2), (0.36, 0.9), (0.64, 0.5), (1.0, 0.1), (1.0, 1.0 - 1e-9)] {
            let at = |f| Integrand::Specular(lobe, f);
            let point = [(mu, alpha)];
            let abc = cpu::bake_points(at(Fresnel::SchlickF82), &point, &REFERENCE);
            let [scale, bias, tinted] = abc.values()[..] else { unreachable!() };
            // Schlick's two are the same numbers.
            let ab = cpu::bake_points(at(Fresnel::Schlick), &point, &REFERENCE);
            assert_eq!(ab.values(), &abc.values()[..2]);
            for (f0, tint) in [(0.04, 1.0), (0.9, 0.75), (1.0, 0.2)] {
                let e = f0 * scale + bias - a(f0, tint) * tinted;
                let truth = albedo(lobe, alpha, mu, |vh| f82(f0, tint, vh));
                assert!((e - truth).abs() < 1e-9, "{lobe:?} {alpha} {mu} {f0} {tint}: {e} {truth}");
            }
        }
    }
}

#[test]
fn a_mirrors_integrals_are_its_weights() {
    let lobe = ggx(Masking::HeightCorrelated);
    for fresnel in Fresnel::samples() {
        for mu in [0.0, 1e-12, 0.3, 6.0 / 7.0, 1.0] {
            let integrals =
                cpu::bake_points(Integrand::Specular(lobe, fresnel), &[(mu, 0.0)], &REFERENCE);
            let weights = match fresnel {
                Fresnel::Schlick => schlick_weights(mu).to_vec(),
                Fresnel::SchlickPower(model) => model.weights(mu).to_vec(),
                Fresnel::SchlickF82 => schlick_f82_weights(mu).to_vec(),
                Fresnel::Dielectric(model) => model.weights(mu).to_vec(),
                Fresnel::Conductor(model) => model.weights(mu).to_vec(),
            };
            assert_eq!(integrals.values().len(), weights.len());
            for (integral, weight) in integrals.values().iter().zip(weights) {
                assert!((integral - weight).abs() < 1e-15, "{fresnel} at {mu}");
            }
        }
    }
}

#[test]
fn every_fresnel_model_is_certified_to_the_last_bit() {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let charlie = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    let beckmann = Microfacet { ndf: Ndf::Beckmann, masking: Masking::HeightCorrelated };
    let lobes = [ggx(Masking::HeightCorrelated), ggx(Masking::Implicit), beckmann, charlie];
    let models = [
        "schlick",
        "schlick:2.5",
        "schlick:9.67",
        "f82",
        "dielectric:1.000001",
        "dielectric:1.5",
        "conductor:0.14,3.697",
    ];
    let every = lobes.iter().flat_map(|&lobe| {
        models.map(|words| (lobe, words.parse::<Fresnel>().unwrap())).into_iter()
    });
    let every = every.filter(|&(lobe, fresnel)| lobe.takes(fresnel));
    for (lobe, fresnel) in every {
        let least = if lobe == charlie { "roughness,min=0.08" } else { "roughness,edges" };
        let lut = Lut::Dfg(Dfg::new(lobe, fresnel, DfgChannels::All).unwrap());
        // The others have no interpolant, and take longer.
        let size = if matches!(fresnel, Fresnel::Schlick | Fresnel::SchlickF82) { 48 } else { 20 };
        let (x, y) = (axis("nov,edges,min=1e-6", size), axis(least, size));
        let request = Request::new(lut, x, y, Accuracy::Rounded, Precision::F16).unwrap();
        let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
        assert_eq!(table.claim(0).certificate().unwrap().undecided, 0, "{lobe:?} {fresnel}");
        let truth = cpu::bake(lut.integrand(), request.grid(), &REFERENCE, &|_| ());
        let rounded = truth.values().iter().map(|&value| Precision::F16.nearest(value));
        let stored = (0..size * size).flat_map(|texel| table.texel(0, texel % size, texel / size));
        assert!(stored.eq(rounded), "{lobe:?} {fresnel}");
    }
}
