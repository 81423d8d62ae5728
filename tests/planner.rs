//! `splitsum plan`: what it chooses, that its promises hold at points that it has not seen, and
//! that its proofs hold in arithmetic of their own.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::Random;
use program::{ok, run, stderr};
use splitsum::approximation::{Across, Along, Approximation, Shape};
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::integrate::rules::{D10240, REFERENCE};
use splitsum::numeric::lanes::F32x16;
use splitsum::planner::candidate::Candidate;
use splitsum::planner::cost::Weights;
use splitsum::planner::domain::{Domain, Piece};
use splitsum::planner::file::PlanFile;
use splitsum::planner::search::{Outcome, Task, Verdict, search};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::Truth;
use std::sync::LazyLock;
use tempfile::tempdir;

static TRUTH: LazyLock<Truth> =
    LazyLock::new(|| Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap()));

fn task(least_nov: f64, tolerance: f64, f0: [f64; 2], roughnesses: &[[f64; 2]]) -> Task {
    let piece = |&roughness: &[f64; 2]| Piece { materials: Vec::new(), roughness, f0 };
    Task {
        domain: Domain { least_nov, pieces: roughnesses.iter().map(piece).collect() },
        tolerance: Tolerance::Absolute(tolerance),
        weights: Weights::default(),
    }
}

/// Roughness from 0.045, n·v from 1e-3.
const PRACTICAL: (f64, [f64; 2]) = (1e-3, [0.045, 1.0]);

/// All of both.
const FULL: (f64, [f64; 2]) = (0.0, [0.0, 1.0]);

fn bytes((least_nov, roughness): (f64, [f64; 2]), tolerance: f64, f0: [f64; 2]) -> usize {
    let outcome = search(&task(least_nov, tolerance, f0, &[roughness]), &TRUTH);
    assert!(!outcome.choice.is_empty(), "nothing for {roughness:?} at {tolerance}");
    outcome.cost.bytes
}

#[test]
fn it_takes_no_more_bytes_than_was_found_by_hand() {
    // Fitted cubic B-splines, by an earlier study of every F0 at these tolerances.
    let known = [
        (PRACTICAL, 1e-2, 84),
        (PRACTICAL, 4e-3, 126),
        (PRACTICAL, 2e-3, 256),
        (PRACTICAL, 1e-3, 480),
        (FULL, 1e-2, 126),
        (FULL, 4e-3, 160),
        (FULL, 2e-3, 480),
        (FULL, 1e-3, 768),
    ];
    for (domain, tolerance, most) in known {
        let bytes = bytes(domain, tolerance, [0.0, 1.0]);
        assert!(bytes <= most, "{domain:?} at {tolerance}: {bytes} bytes, not {most}");
    }
    // A rough dielectric: three or four coefficients of E(0.04).
    let outcome = search(&task(1e-3, 4e-3, [0.04; 2], &[[1.0, 1.0]]), &TRUTH);
    assert!(outcome.cost.bytes <= 16 && outcome.cost.loads == 0, "{:?}", outcome.cost);
    // A mirror: A = 1 - (1 - n.v)^5 and B = (1 - n.v)^5.
    let outcome = search(&task(1e-3, 1e-5, [0.0, 1.0], &[[0.0, 0.0]]), &TRUTH);
    assert_eq!(outcome.cost.bytes, 2);
}

#[test]
fn a_larger_tolerance_or_a_narrower_domain_never_costs_more() {
    let all = [0.0, 1.0];
    let within = |roughness| (1e-3, roughness);
    let base = bytes(within([0.1, 0.9]), 6e-3, all);
    assert!(bytes(within([0.1, 0.9]), 9e-3, all) <= base);
    assert!(bytes(within([0.3, 0.8]), 6e-3, all) <= base);
    assert!(bytes((1e-2, [0.1, 0.9]), 6e-3, all) <= base);
    assert!(bytes(within([0.1, 0.9]), 6e-3, [0.04, 0.04]) <= base);
    assert!(bytes(within([0.1, 0.9]), 6e-3, [0.2, 0.5]) <= base);
}

/// The largest error of E(F0) at random places, by a rule that the planner does not use for GGX.
fn unseen_error(approximation: &Approximation, f0: [f64; 2], random: &mut Random) -> f64 {
    let [low, high] = approximation.region.roughness;
    let least = approximation.region.least_nov;
    let place = |random: &mut Random| {
        // Crowded where the integrals change most.
        let (u, v) = (random.next(), random.next());
        (least + (1.0 - least) * u * u * u, low + (high - low) * v * v)
    };
    let places: Vec<(f64, f64)> = (0..2000).map(|_| place(random)).collect();
    let points: Vec<(f64, f64)> = places.iter().map(|&(nov, r)| (nov, r * r)).collect();
    let lobe = approximation.lobe;
    let truths = bake_points(lobe, &points, &D10240).scale_bias();
    let mut worst = 0.0_f64;
    for ((nov, roughness), truth) in places.into_iter().zip(truths) {
        for f0 in f0 {
            let [nov, roughness] = [nov, roughness].map(F32x16::from);
            let albedo = approximation.albedo(nov, roughness, F32x16::from(f0));
            worst = worst.max((f64::from(albedo.0[0]) - truth.at_f0(f0)).abs());
        }
    }
    worst
}

#[test]
fn no_unseen_point_is_beyond_the_tolerance() {
    let mut random = Random(7);
    for _ in 0..12 {
        let low = random.next() * 0.8;
        let high = (low + 0.1 + random.next() * 0.9).min(1.0);
        let f0 = [0.02 + 0.1 * random.next(), 0.2 + 0.8 * random.next()];
        let tolerance = 2e-3 + 8e-3 * random.next();
        let pieces =
            if random.next() < 0.5 { vec![[low, high]] } else { vec![[low; 2], [high; 2]] };
        let task = task(1e-3, tolerance, f0, &pieces);
        for (approximation, _) in search(&task, &TRUTH).choice {
            let worst = unseen_error(&approximation, f0, &mut random);
            assert!(worst <= tolerance, "{approximation:?}: {worst} beyond {tolerance}");
        }
    }
}

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
            powers(along(x, nov), candidate.counts[0].max(candidate.counts[1]))
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

#[test]
fn a_check_finds_one_wrong_number_and_one_wrong_multiplier() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.toml");
    ok(&folder, "plan --roughness 0.4..0.9 --f0 0.04 --tolerance 0.01 -o a.toml");
    ok(&folder, "plan --check a.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let good: PlanFile = toml::from_str(&text).unwrap();
    let refused = |plan: &PlanFile, words: &str| {
        std::fs::write(&path, toml::to_string(plan).unwrap()).unwrap();
        let output = run(&folder, "plan --check a.toml");
        assert_eq!(output.status.code(), Some(7), "{}", stderr(&output));
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    };
    let with_proof = good.rejected.iter().position(|entry| entry.bound.is_some()).unwrap();
    let mut plan = good.clone();
    plan.rejected[with_proof].proof[0][3] *= 1.001;
    refused(&plan, "the multipliers prove");
    let mut plan = good.clone();
    plan.rejected.pop();
    refused(&plan, "is not among the rejected");
    let mut plan = good.clone();
    plan.choice[0].bound.as_mut().unwrap().share -= 1e-6;
    refused(&plan, "the bound of the error is");
    let mut plan = good.clone();
    plan.question.pieces[0].roughness[1] = 0.95;
    refused(&plan, "nothing in the choice is for roughness");
    let mut plan = good.clone();
    if let splitsum::planner::file::ChannelText::Codes { codes, .. } =
        &mut plan.choice[0].channels[0]
    {
        codes[3] ^= 1;
    }
    refused(&plan, "are not those that were written");
    // With the hash of the wrong number the error itself is found.
    let splitsum::planner::file::ChannelText::Codes { codes, .. } = &mut plan.choice[0].channels[0]
    else {
        unreachable!("a table of codes")
    };
    codes[3] ^= 128;
    let (task, lobe) = plan.task().unwrap();
    plan.choice[0].blake3 = plan.choice[0].approximation(&task, lobe).unwrap().blake3();
    refused(&plan, "E(F0) errs by");
}

#[test]
fn a_proof_is_of_the_candidates_that_cost_less() {
    let task = task(1e-3, 8e-3, [0.0, 1.0], &[[0.2, 1.0]]);
    let Outcome { trials, cost, .. } = search(&task, &TRUTH);
    let cheaper = trials
        .iter()
        .filter(|trial| trial.cost.weighed(&task.weights) < cost.weighed(&task.weights));
    for trial in cheaper {
        assert!(!matches!(trial.verdict, Verdict::Passes(_)), "{}", trial.candidate);
    }
}

#[test]
fn wrong_input_is_an_error_with_a_cure() {
    let folder = tempdir().unwrap();
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    file("empty.json", "{\"materials\":[]}");
    file("bad.toml", "tool = 3");
    file("scene.gltf", "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}]}");
    for (arguments, code, words) in [
        ("plan", 2, "a scene"),
        ("plan scene.gltf --roughness 1", 2, "leave one of them out"),
        ("plan missing.gltf", 3, "missing.gltf"),
        ("plan empty.json", 4, "a layer that is base or clearcoat"),
        ("plan scene.gltf --model charlie", 4, "a layer that is sheen"),
        ("plan --roughness 2", 4, "from 0 to 1"),
        ("plan --roughness 0.9..0.1", 4, "in order"),
        ("plan --roughness nan", 4, "from 0 to 1"),
        ("plan --roughness 1 --f0 -1", 2, "-1"),
        ("plan --roughness 1 --tolerance 0", 4, "1e-5 to 0.5"),
        ("plan --roughness 1 --tolerance srgb:x", 4, "srgb:STEPS"),
        ("plan --roughness 1 --nov-min 1", 4, "0 to below 1"),
        ("plan --roughness 1 --nov-min nan", 4, "0 to below 1"),
        ("plan --roughness 1 --cost bytes=-1", 4, "such weights"),
        ("plan --roughness 1 --cost bytes=0", 4, "such weights"),
        ("plan --roughness 1 --code a.txt", 4, ".wgsl"),
        ("plan --roughness 1 -o a.toml --code a.toml.wgsl --prefix 1x", 4, "prefix"),
        ("plan --roughness 1 -o a.wgsl --code a.wgsl", 2, "a file of its own"),
        ("plan --roughness 1 -o -", 2, "a file"),
        ("plan --check bad.toml", 4, "a plan of splitsum"),
        ("plan --check missing.toml", 3, "missing.toml"),
    ] {
        let output = run(&folder, arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {text}");
        assert!(text.contains(words), "{arguments}: {text}");
    }
    assert!(!folder.path().join("a.toml").exists());
}

#[test]
fn several_scenes_have_one_plan_and_sheen_has_its_own() {
    let folder = tempdir().unwrap();
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    file("a.json", "{\"materials\":[{\"roughness\":0.5,\"f0\":0.04}]}");
    file(
        "b.json",
        "{\"materials\":[{\"roughness\":[0.6,0.8],\"f0\":0.04},\
         {\"roughness\":0.5,\"f0\":0.5,\"layer\":\"sheen\"}]}",
    );
    ok(&folder, "plan a.json b.json -o a.toml --code a.wgsl --code a.rs");
    let text = std::fs::read_to_string(folder.path().join("a.toml")).unwrap();
    let plan: PlanFile = toml::from_str(&text).unwrap();
    assert_eq!(plan.question.pieces.len(), 2);
    assert_eq!(plan.choice[0].roughness, [0.5, 0.8]);
    ok(&folder, "plan b.json --model charlie --tolerance rel:0.01 -o s.toml --code s.wgsl");
    ok(&folder, "plan --check s.toml");
}

#[test]
fn a_bake_carries_a_plan_out() {
    let folder = tempdir().unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    std::fs::create_dir(folder.path().join("out")).unwrap();
    ok(&folder, "plan --roughness 0.5,1 --f0 0.04 -o out/a.toml --code out/a.wgsl --code b.h");
    let (wgsl, header) = (read("out/a.wgsl"), read("b.h"));
    assert!(wgsl.contains("fn splitsum_albedo(") && header.contains("splitsum_albedo("));
    std::fs::remove_file(folder.path().join("out/a.wgsl")).unwrap();
    std::fs::remove_file(folder.path().join("b.h")).unwrap();
    ok(&folder, "bake --config out/a.toml");
    assert_eq!((read("out/a.wgsl"), read("b.h")), (wgsl, header));
    // Control points too.
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    ok(&folder, "plan --roughness 0.4..0.9 --f0 0.04 --tolerance 0.01 -o n.toml --table n.npy");
    let table = bytes("n.npy");
    std::fs::remove_file(folder.path().join("n.npy")).unwrap();
    ok(&folder, "bake --config n.toml");
    assert_eq!(bytes("n.npy"), table);
    let wrong = read("out/a.toml").replacen("halves = [", "halves = [1.0, ", 1);
    std::fs::write(folder.path().join("out/a.toml"), wrong).unwrap();
    assert_eq!(run(&folder, "bake --config out/a.toml").status.code(), Some(4));
}

#[test]
fn thousands_of_roughnesses_take_no_longer_than_a_range() {
    let folder = tempdir().unwrap();
    let material = |i: usize| format!("{{\"roughness\":{},\"f0\":0.04}}", 0.2 + 1e-5 * i as f64);
    let materials: Vec<String> = (0..40_000).map(material).collect();
    let text = format!("{{\"materials\":[{}]}}", materials.join(","));
    std::fs::write(folder.path().join("a.json"), text).unwrap();
    let started = std::time::Instant::now();
    ok(&folder, "plan a.json -o a.toml");
    // One by one they would take half an hour.
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
}
