//! What previews read on the CPU: the curves along a sphere's roughness.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::backend::cpu;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::preview::curve::{Curve, Samples};
use splitsum::preview::{ROUGHNESSES, RULE};
use splitsum::table::axis::{Axis, AxisSpec, Parameter};

/// Half a step of 8 bits where sRGB is steepest (12.92 steps to a step of light), of the
/// hundredfold difference that a scene shows; a third of it is asked for, so that hardly any byte
/// differs.
const HALF_A_STEP: f64 = 1.0 / (2.0 * 255.0 * 12.92 * 100.0);

#[test]
fn interpolated_integrals_are_within_half_a_step_of_the_difference() {
    let rule = RULE;
    for ndf in [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx] {
        let lobe = Microfacet { ndf, masking: ndf.default_masking() };
        for roughness in ROUGHNESSES {
            let alpha = roughness * roughness;
            let curve = Curve::of_integral(lobe, alpha, &rule).unwrap();
            // Evenly along √(n·v), no multiple of the nodes' spacing apart; and in the first cells,
            // which are the worst.
            let even = (0..20_000).map(|i| (f64::from(i) + 0.37) / 20_000.0);
            let first = (1..1000).map(|i| f64::from(i) * 1e-6);
            let mus: Vec<f64> = even.chain(first).map(|root| root * root).collect();
            let points: Vec<(f64, f64)> = mus.iter().map(|&mu| (mu, alpha)).collect();
            let truth = cpu::bake_points(lobe, &points, &rule).scale_bias();
            for (&mu, truth) in mus.iter().zip(&truth) {
                let [a, b] = curve.at(mu);
                let error = (a - truth.a).abs() + (b - truth.b).abs();
                // Before the last node, of 4096 steps, the rule itself jumps: there it is off by
                // what it may err.
                let allowed = if mu.sqrt() > 1.0 - 2.0 / 4096.0 {
                    rule.bound(lobe)
                } else {
                    HALF_A_STEP / 3.0
                };
                assert!(error < allowed, "{ndf:?} {roughness} at {mu}: {error}");
            }
        }
    }
}

#[test]
fn a_curve_of_a_table_is_its_bilinear_lookup() {
    let axis = |parameter| Axis::new(AxisSpec::of(parameter), 16).unwrap();
    let value = |i: i32| (f64::from(i) * 0.37).sin();
    let values = (0..256).map(|i| [value(2 * i), value(2 * i + 1)]).collect();
    let table = Samples { x: axis(Parameter::Nov), y: axis(Parameter::Roughness), values };
    for roughness in ROUGHNESSES {
        let curve = Curve::of_table(&table, roughness);
        for i in 0..=1000 {
            let mu = f64::from(i) / 1000.0;
            let (read, texel) = (curve.at(mu), table.bilinear(mu, roughness));
            // The same sums in another order.
            assert!(
                (read[0] - texel[0]).abs() < 1e-14 && (read[1] - texel[1]).abs() < 1e-14,
                "{mu} {roughness}"
            );
        }
    }
}
