//! Proofs of `splitsum plan` hold in arithmetic of their own, from the words of a plan alone.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::ok;
use splitsum::approximation::{Across, Along, Shape};
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::Microfacet;
use splitsum::integrate::rules::REFERENCE;
use splitsum::planner::candidate::Candidate;
use splitsum::planner::file::PlanFile;
use splitsum::table::axis::{Axis, Mapping, Nodes};
use tempfile::tempdir;

/// N_{i,degree}(t) of uniform knots 0, 1, 2, ... by Cox and de Boor's recurrence.
fn spline(i: usize, degree: usize, t: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from((i as f64..(i + 1) as f64).contains(&t)));
    }
    let (d, i_f) = (degree as f64, i as f64);
    (t - i_f) / d * spline(i, degree - 1, t)
        + (i_f + d + 1.0 - t) / d * spline(i + 1, degree - 1, t)
}

/// The functions of a candidate at a place, from the words of its formulas alone.
fn functions(candidate: &Candidate, region: (f64, [f64; 2]), nov: f64, r: f64) -> Vec<f64> {
    let (least, [low, high]) = region;
    let along = |x: Along, m: f64| match x {
        Along::Nov => m,
        Along::Sqrt => m.sqrt(),
        Along::Cbrt => m.cbrt(),
        Along::Log => m * (1.0 + 1.0 / m).log2(),
        Along::Layer(k) => (m * (1.0 + k * r * r) / (m + k * r * r)).sqrt(),
    };
    let across = |y: Across, r: f64| match y {
        Across::Linear => r,
        Across::Sqrt => r.sqrt(),
        Across::Power(p) => r.powf(p),
    };
    let powers = |x: f64, count: usize| (0..count).map(|i| x.powi(i as i32)).collect::<Vec<f64>>();
    match candidate.shape {
        Shape::Polynomial { x } => {
            powers(2.0 * along(x, nov) - 1.0, candidate.counts[0].max(candidate.counts[1]))
        }
        Shape::Surface { x, y, columns } => {
            let rows = powers(across(y, r), candidate.counts[0] / columns);
            let columns = powers(along(x, nov), columns);
            rows.iter().flat_map(|row| columns.iter().map(move |column| row * column)).collect()
        }
        Shape::Spline { x, y, size: [columns, rows], degree } => {
            let place = |share: f64, count: usize| {
                // The last knot belongs to the last span.
                let spans = (count - degree) as f64;
                (share * spans).min(spans * (1.0 - 1e-16)) + degree as f64
            };
            let u = place(along(x, (nov - least) / (1.0 - least)), columns);
            let share = (across(y, r) - across(y, low)) / (across(y, high) - across(y, low));
            let v = place(share.clamp(0.0, 1.0), rows);
            (0..columns * rows)
                .map(|k| spline(k % columns, degree, u) * spline(k / columns, degree, v))
                .collect()
        }
        Shape::Texture { x, y, .. } => {
            // Tents between the texels, whose middles lie at (i + 1/2)/N or whose ends at 0 and 1.
            let place = |axis: &Axis, p: f64| {
                let (n, t) = (axis.size() as f64, [p, p.sqrt()]);
                let t = t[usize::from(axis.spec().mapping == Mapping::Sqrt)];
                let texel = [t * n - 0.5, t * (n - 1.0)];
                texel[usize::from(axis.spec().nodes == Nodes::Edges)].clamp(0.0, n - 1.0)
            };
            let tent = |i: usize, at: f64| (1.0 - (i as f64 - at).abs()).max(0.0);
            let (u, v, columns) = (place(&x, nov), place(&y, r), x.size());
            (0..columns * y.size()).map(|k| tent(k % columns, u) * tent(k / columns, v)).collect()
        }
    }
}

/// The largest error over the tolerance that any numbers leave, proved by the multipliers of an
/// entry.
fn proved(plan: &PlanFile, index: usize) -> (f64, f64) {
    let entry = &plan.rejected[index];
    let tolerance: f64 = plan.question.tolerance.parse().unwrap();
    let candidate = Candidate::named(&entry.candidate).unwrap();
    // Nets take every n.v where alpha is smaller than the least one somewhere.
    let [low, _] = entry.roughness;
    let least = plan.question.least_nov;
    let region = (if low * low >= least { least } else { 0.0 }, entry.roughness);
    let points: Vec<(f64, f64)> =
        entry.proof.iter().map(|[nov, roughness, ..]| (*nov, roughness * roughness)).collect();
    let lobe = Microfacet::new(plan.question.model, Some(plan.question.masking)).unwrap();
    let truths = bake_points(lobe, &points, &REFERENCE).scale_bias();
    let (mut target, mut size) = (0.0, 0.0);
    let mut sums: Vec<f64> = Vec::new();
    for (&[nov, roughness, f0, weight], truth) in entry.proof.iter().zip(truths) {
        let fresnel = f0 + (1.0 - f0) * (1.0 - nov).powi(5);
        let factors = match candidate.channels.to_string().as_str() {
            "albedo" => vec![1.0],
            "ratio" => vec![fresnel],
            "energy-rest" => vec![fresnel, 1.0 - f0],
            "bias-energy" => vec![1.0 - f0, f0],
            "scale-bias" => vec![f0, 1.0],
            other => unreachable!("{other}"),
        };
        let own = functions(&candidate, region, nov, roughness);
        sums.resize(2 * own.len(), 0.0);
        for (channel, factor) in factors.iter().enumerate() {
            for (k, value) in own.iter().enumerate().take(candidate.counts[channel]) {
                sums[channel * own.len() + k] += weight * factor * value;
            }
        }
        target += weight * truth.at_f0(f0);
        size += weight.abs() * tolerance;
    }
    let rest = sums.iter().fold(0.0_f64, |rest, sum| rest.max(sum.abs())) / size;
    (target.abs() / size, rest)
}

fn plan(arguments: &str) -> (PlanFile, String) {
    let folder = tempdir().unwrap();
    ok(&folder, &format!("plan {arguments} -o a.toml"));
    let text = std::fs::read_to_string(folder.path().join("a.toml")).unwrap();
    (toml::from_str(&text).unwrap(), text)
}

#[test]
fn proofs_hold_in_arithmetic_of_their_own() {
    for arguments in [
        "--roughness 0.3..1 --f0 0.04 --tolerance 0.02",
        "--roughness 0..1 --nov-min 0 --tolerance 0.05",
        "--roughness 0.3,0.7 --tolerance 0.004",
        "--roughness 0.3..1 --tolerance 0.02 --texture ab",
        "--roughness 0.3..1 --f0 0.04 --tolerance 0.004 --texture be --x nov,sqrt,edges",
    ] {
        let (plan, _) = plan(arguments);
        let with_proof = |index: &usize| plan.rejected[*index].bound.is_some();
        let all: Vec<usize> = (0..plan.rejected.len()).filter(with_proof).collect();
        assert!(all.len() > 2, "{arguments}: {} proofs", all.len());
        for index in all {
            let (bound, rest) = proved(&plan, index);
            let stated = plan.rejected[index].bound.unwrap();
            // Numbers up to a thousand times an albedo gain nothing by rounding.
            assert!(rest < 1e-9, "{}: {rest}", plan.rejected[index].candidate);
            assert!(bound > 1.0 && (bound / stated - 1.0).abs() < 1e-3, "{bound}, not {stated}");
        }
    }
}
