//! What previews read on the CPU: the curves along a sphere's roughness.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::axis::{Axis, AxisSpec, Parameter};
use splitsum::backend::cpu;
use splitsum::lut::{Dfg, DfgChannels, Grid, Lut};
use splitsum::model::{Microfacet, Ndf};
use splitsum::precision::Precision;
use splitsum::preview::curve::Curve;
use splitsum::preview::{ROUGHNESSES, RULE};
use splitsum::table::Table;

/// Half a step of 8 bits where sRGB is steepest (12.92 steps to a step of light), of the hundredfold difference that a
/// scene shows; a third of it is asked for, so that hardly any byte differs.
const HALF_A_STEP: f64 = 1.0 / (2.0 * 255.0 * 12.92 * 100.0);

#[test]
fn interpolated_integrals_are_within_half_a_step_of_the_difference() {
    let rule = RULE;
    for ndf in [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx] {
        let lobe = Microfacet { ndf, masking: ndf.default_masking() };
        for roughness in ROUGHNESSES {
            let alpha = roughness * roughness;
            let curve = Curve::of_integral(lobe, alpha, &rule).unwrap();
            // Evenly along √(n·v), no multiple of the nodes' spacing apart; and in the first cells, which are the
            // worst.
            let even = (0..20_000).map(|i| (f64::from(i) + 0.37) / 20_000.0);
            let first = (1..1000).map(|i| f64::from(i) * 1e-6);
            let mus: Vec<f64> = even.chain(first).map(|root| root * root).collect();
            let points: Vec<(f64, f64)> = mus.iter().map(|&mu| (mu, alpha)).collect();
            let truth = cpu::bake_points(lobe, &points, &rule);
            for (&mu, truth) in mus.iter().zip(&truth) {
                let error = (curve.at(mu).a - truth.a).abs() + (curve.at(mu).b - truth.b).abs();
                // Before the last node, of 4096 steps, the rule itself jumps: there it is off by what it may err.
                let allowed = if mu.sqrt() > 1.0 - 2.0 / 4096.0 { rule.bound(lobe) } else { HALF_A_STEP / 3.0 };
                assert!(error < allowed, "{ndf:?} {roughness} at {mu}: {error}");
            }
        }
    }
}

#[test]
fn a_curve_of_a_table_is_its_bilinear_lookup() {
    let ndf = Ndf::Ggx;
    let lut = Lut::Dfg(Dfg { lobe: Microfacet { ndf, masking: ndf.default_masking() }, channels: DfgChannels::Ab });
    let axis = |parameter| Axis::new(AxisSpec::of(parameter), 16).unwrap();
    let axes = (axis(Parameter::Nov), axis(Parameter::Roughness));
    let grid = Grid::new(&axes.0, &axes.1).unwrap();
    let values: Vec<f64> = (0..2 * grid.len()).map(|i| (i as f64 * 0.37).sin()).collect();
    let values = grid.stored(&lut, Precision::F64, &values).unwrap();
    let (channels, provenance) = (lut.channels().to_vec(), lut.provenance());
    let table = Table { x: axes.0, y: axes.1, channels, values, provenance };
    for roughness in ROUGHNESSES {
        let curve = Curve::of_table(&table, roughness);
        for i in 0..=1000 {
            let mu = f64::from(i) / 1000.0;
            let (read, texel) = (curve.at(mu), table.bilinear(mu, roughness));
            // The same sums in another order.
            assert!((read.a - texel[0]).abs() < 1e-14 && (read.b - texel[1]).abs() < 1e-14, "{mu} {roughness}");
        }
    }
}
