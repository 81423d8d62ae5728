//! Rough interfaces of two dielectrics: reflection and transmission on either side, beside published
//! figures, theorems and each other.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{figures, number};
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::integrate::double_exponential::DoubleExponentialRule;
use splitsum::integrate::view_polar::{ViewPolarNodes, view_polar};
use splitsum::numeric::special::log_beta;

const INTERFACES: &str = include_str!("figures/interfaces.csv");

/// The interface of a row of the figures.
fn interface(row: &[&str]) -> Interface {
    let ndf = if row[1] == "ggx" { Ndf::Ggx } else { Ndf::Beckmann };
    let masking = match row[2] {
        "corr" => Masking::HeightCorrelated,
        _ => Masking::Separable,
    };
    let side = if row[4] == "inside" { Side::Inside } else { Side::Outside };
    let transmission = match row[3] {
        "corr" => TransmissionMasking::Correlated,
        "sep" => TransmissionMasking::Separable,
        _ => TransmissionMasking::Beta,
    };
    Interface::new(Microfacet { ndf, masking }, number(row[8]), side, transmission).unwrap()
}

#[test]
fn albedos_in_polar_coordinates_about_v_are_the_published_figures() {
    let nodes = ViewPolarNodes::of(DoubleExponentialRule { outer: 160, inner: 160 });
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[0] == "dielectric") {
        let (interface, mu, r) = (interface(row), number(row[5]), number(row[6]));
        let got = view_polar(interface, mu, mu - interface.critical(), r * r, &nodes).0;
        for (got, truth) in got.into_iter().zip([number(row[11]), number(row[12])]) {
            // The figures' two methods agree within 1e-12.
            assert!((got - truth).abs() < 2e-12, "{row:?}: {got}");
        }
        rows += 1;
    }
    assert_eq!(rows, 239);
}

#[test]
fn the_logarithm_of_the_beta_function_keeps_its_digits() {
    // B(1, q) = 1/q, and B(2, q) = 1/(q (q + 1)).
    for q in [1.0, 3.7, 15.9, 16.0, 1e3, 1e9, 1e150] {
        let one = (log_beta(1.0, q) + f64::ln(q)).abs();
        let two = (log_beta(q, 2.0) + f64::ln(q) + f64::ln(q + 1.0)).abs();
        let allowed = 1e-14 * (1.0 + f64::ln(q));
        assert!(one < allowed && two < 2.0 * allowed, "{q}: {one} {two}");
    }
    // B(p, p+1) = B(p, p)/2, on both sides of where the formulas change.
    for p in [1.5, 15.2, 15.9, 17.0, 250.0, 1e6] {
        let halved = log_beta(p, p) - std::f64::consts::LN_2;
        assert!((log_beta(p, p + 1.0) - halved).abs() < 1e-14 * (1.0 + halved.abs()), "{p}");
    }
}
