//! The exact equations of interfaces and Schlick's with other exponents: the formulas beside
//! others, the integrals beside published figures, the words, the files.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::{figures, ggx, number};
use program::{ok, run, stderr};
use splitsum::backend::cpu;
use splitsum::brdf::fresnel::{
    Conductor, conductor_reflectance, dielectric_reflectance, schlick_power_weights,
};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::integrate::Integrand;
use splitsum::integrate::rules::REFERENCE;
use splitsum::lut::{Dfg, DfgChannels, Lut};
use splitsum::units::{F0, Ior};
use std::f64::consts::FRAC_PI_2;
use tempfile::tempdir;

const INTERFACES: &str = include_str!("figures/interfaces.csv");

fn model(words: &str) -> Fresnel {
    words.parse().unwrap()
}

/// Fresnel's law of sines and tangents for dielectrics: no root of the other form, and no c.
fn by_angles(n: f64, angle: f64) -> f64 {
    let inside = (angle.sin() / n).asin();
    let s = ((angle - inside).sin() / (angle + inside).sin()).powi(2);
    let p = ((angle - inside).tan() / (angle + inside).tan()).powi(2);
    0.5 * (s + p)
}

#[test]
fn reflectance_of_a_dielectric_is_the_law_of_sines_and_tangents() {
    for n in [1.0001, 1.1, 1.33, 1.5, 2.4, 4.0] {
        for i in 1..200 {
            let angle = FRAC_PI_2 * f64::from(i) / 200.0;
            let (got, truth) =
                (dielectric_reflectance(angle.cos(), (n - 1.0) * (n + 1.0)), by_angles(n, angle));
            // The difference of two nearly equal angles cancels in the truth, not in the formula.
            assert!((got - truth).abs() < 1e-13 / (n - 1.0), "{n} {angle}: {got} {truth}");
        }
        let f0 = F0::from(Ior::new(n).unwrap()).get();
        assert!((dielectric_reflectance(1.0, (n - 1.0) * (n + 1.0)) - f0).abs() < 1e-15);
    }
}

#[test]
fn light_on_the_inside_is_reflected_whole_beyond_the_critical_angle() {
    for n in [1.000_001, 1.5, 4.0f64] {
        let k = (1.0 / n - 1.0) * (1.0 / n + 1.0);
        let critical = (-k).sqrt();
        for c in [0.0, 0.5 * critical, critical * (1.0 - 1e-12)] {
            assert_eq!(dielectric_reflectance(c, k), 1.0);
        }
        // Reflectance is the same along the same path: c_t² = 1 - (1 - c²)/η².
        for i in 1..50 {
            let c = critical + (1.0 - critical) * f64::from(i) / 50.0;
            let outside = (1.0 - (1.0 - c * c) * n * n).max(0.0).sqrt();
            let (inside, outside) = (
                dielectric_reflectance(c, k),
                dielectric_reflectance(outside, (n - 1.0) * (n + 1.0)),
            );
            assert!((inside - outside).abs() < 1e-7 * outside.max(1e-3), "{n} {c}");
        }
    }
    assert_eq!([0.0, 0.3, 1.0].map(|c| dielectric_reflectance(c, 0.0)), [0.0; 3]);
}

/// Fresnel's equations in complex numbers: r_s = (c - g)/(c + g), r_p = (z² c - g)/(z² c + g) with
/// z = n + ik and g = √(z² - s²), as pairs of real and imaginary part.
fn complex_reflectance(n: f64, k: f64, c: f64) -> f64 {
    let z2 = [n * n - k * k, 2.0 * n * k];
    let w = [z2[0] - (1.0 - c * c), z2[1]];
    let (size, angle) = (w[0].hypot(w[1]).sqrt(), 0.5 * w[1].atan2(w[0]));
    let g = [size * angle.cos(), size * angle.sin()];
    let ratio = |a: [f64; 2], b: [f64; 2]| {
        ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))
            / ((a[0] + b[0]).powi(2) + (a[1] + b[1]).powi(2))
    };
    0.5 * (ratio([c, 0.0], g) + ratio([z2[0] * c, z2[1] * c], g))
}

#[test]
fn reflectance_of_a_conductor_is_that_in_complex_numbers() {
    for (n, k) in
        [(0.01, 0.5), (0.14, 3.697), (0.7, 0.5), (1.38, 1.914), (2.95, 2.93), (20.0, 20.0)]
    {
        for i in 0..=200 {
            let c = f64::from(i) / 200.0;
            let (got, truth) = (conductor_reflectance(c, n, k), complex_reflectance(n, k, c));
            assert!((got - truth).abs() < 4e-15, "{n} {k} {c}: {got} {truth}");
        }
    }
    // Gold at normal incidence: ((n-1)² + k²)/((n+1)² + k²).
    let f0 = (0.86f64.powi(2) + 3.697f64.powi(2)) / (1.14f64.powi(2) + 3.697f64.powi(2));
    assert!((conductor_reflectance(1.0, 0.14, 3.697) - f0).abs() < 1e-15);
}

#[test]
fn a_power_is_a_power() {
    for halves in 2..=40 {
        let p = f64::from(halves) / 2.0;
        for c in [0.0, 0.2, 0.77, 1.0f64] {
            let [rest, w] = schlick_power_weights(c, halves / 2, halves % 2);
            assert!((w - (1.0 - c).powf(p)).abs() < 1e-14 && (rest + w - 1.0).abs() < 1e-15);
        }
    }
}

/// The lobe of a row of the figures.
fn lobe(row: &[&str]) -> Microfacet {
    let ndf = if row[1] == "ggx" { Ndf::Ggx } else { Ndf::Beckmann };
    let masking = match row[2] {
        "corr" => Masking::HeightCorrelated,
        _ => Masking::Separable,
    };
    Microfacet { ndf, masking }
}

#[test]
fn albedos_of_interfaces_are_those_of_two_other_methods() {
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[4] == "outside") {
        let p = |i: usize| number(row[8 + i]);
        let fresnel = match (row[0], row[7]) {
            ("dielectric", _) => model(&format!("dielectric:{}", row[8])),
            ("reflection", "conductor") => Fresnel::Conductor(Conductor::new(p(0), p(1)).unwrap()),
            ("reflection", "schlick") => model(&format!("schlick:{}", row[9])),
            ("reflection", "f82") => model("f82"),
            _ => continue,
        };
        let point = [(number(row[5]), number(row[6]) * number(row[6]))];
        let integrals =
            cpu::bake_points(Integrand::Specular(lobe(row), fresnel), &point, &REFERENCE);
        let albedo = match *integrals.values() {
            [r] => r,
            [a, b] => p(0) * a + p(2) * b,
            [a, b, c] => p(0) * a + b - p(2) * c,
            _ => f64::NAN,
        };
        // The figures agree with each other within 1e-12.
        assert!((albedo - number(row[11])).abs() < 1e-11, "{row:?}: {albedo}");
        rows += 1;
    }
    assert_eq!(rows, 89 + 123);
}

#[test]
fn words_are_read_back_as_they_are_written() {
    for words in ["schlick", "schlick:2.5", "f82", "dielectric:1.5", "conductor:0.14,3.697"] {
        assert_eq!(model(words).to_string(), words);
    }
    assert_eq!(model("schlick:5"), Fresnel::Schlick);
    let list = Fresnel::list("conductor:0.14,3.697, dielectric:1.33,conductor:gold").unwrap();
    assert_eq!(list.len(), 5);
    assert_eq!(list[0], list[2]);
    assert!(list[2].formula().ends_with(
        "gold at 659.5 nm (Johnson and Christy 1972, Phys. Rev. B \
                                         6, 4370)"
    ));
    for wrong in [
        "",
        "cos",
        "schlick:0.5",
        "schlick:21",
        "schlick:x",
        "schlick:NaN",
        "f82:1",
        "dielectric",
        "dielectric:0.9",
        "dielectric:100.1",
        "dielectric:inf",
        "dielectric:1.5,2",
        "conductor:1",
        "conductor:1,0.4",
        "conductor:0,3",
        "conductor:mud",
        "conductor:1,2,3",
    ] {
        assert!(Fresnel::list(wrong).is_err(), "'{wrong}' was taken");
    }
}

#[test]
fn models_are_slices_of_a_file() {
    let folder = tempdir().unwrap();
    let bake = "bake --backend cpu -q --size 8";
    ok(&folder, &format!("{bake} --fresnel conductor:gold -o gold.exr"));
    for (i, index) in ["0.14,3.697", "0.43,2.455", "1.38,1.914"].iter().enumerate() {
        ok(&folder, &format!("{bake} --fresnel conductor:{index} -o {i}.npy --precision f16"));
    }
    ok(&folder, &format!("{bake} --fresnel conductor:gold -o gold.npy --precision f16"));
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let slices: Vec<u8> = (0..3).flat_map(|i| bytes(&format!("{i}.npy"))[128..].to_vec()).collect();
    assert_eq!(bytes("gold.npy")[128..], slices);
    for (arguments, said) in [
        ("--fresnel schlick,f82", "models with the channels of schlick"),
        ("--fresnel schlick,dielectric:1.5", "models with the channels of schlick"),
        ("--fresnel dielectric:1.5,dielectric:1.5", "different values"),
        ("--model charlie --fresnel dielectric:1.5", "one of Schlick's for sheen"),
        ("--lut energy --fresnel dielectric:1.5", "expected schlick for energy"),
        ("--fresnel dielectric:1.5 --channels e", "expected r"),
    ] {
        let output = run(&folder, &format!("bake {arguments} -o a.exr"));
        assert_eq!(output.status.code(), Some(4), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments}: {}", stderr(&output));
    }
    assert!(!folder.path().join("a.exr").exists());
    // With a device or without one.
    let output = run(&folder, "bake --size 4 --fresnel schlick:3.1 -o a.exr");
    assert!(output.status.success() && stderr(&output).contains("a whole exponent"));
}

#[test]
fn sheen_takes_no_interface() {
    let charlie = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    assert!(Dfg::new(charlie, model("dielectric:1.5"), DfgChannels::All).is_err());
    assert!(Dfg::new(charlie, model("schlick:3"), DfgChannels::All).is_ok());
    let lut = Dfg::new(ggx(Masking::Implicit), model("conductor:1,2"), DfgChannels::All);
    assert_eq!(Lut::Dfg(lut.unwrap()).channels()[0].name, "R");
}
