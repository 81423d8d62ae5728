//! `splitsum plan`: what it chooses, that its promises hold at points that it has not seen, and
//! what is refused.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::Random;
use program::{ok, run, stderr};
use splitsum::approximation::{Along, Approximation, Channels, Numbers, Shape};
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::integrate::rules::D10240;
use splitsum::numeric::lanes::F32x16;
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
        sampler: None,
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

/// E(F0) = F of a mirror has one number, and E = 1 - μ ln(1 + 1/μ) at roughness 1 has two: GGX with
/// height-correlated masking, whose integral over the hemisphere has this form at α = 1.
#[test]
fn closed_forms_are_found() {
    let chosen = |roughness: f64, f0: [f64; 2]| {
        let outcome = search(&task(1e-3, 1e-3, f0, &[[roughness; 2]]), &TRUTH);
        let (approximation, _) = outcome.choice.first().unwrap().clone();
        let numbers = |numbers: &Numbers| (0..numbers.len()).map(|i| numbers.get(i)).collect();
        let numbers: Vec<Vec<f64>> = approximation.numbers.iter().map(numbers).collect();
        (approximation, numbers)
    };
    let (mirror, numbers) = chosen(0.0, [0.0, 1.0]);
    assert_eq!(mirror.channels, Channels::EnergyRest);
    assert_eq!(numbers, [vec![1.0], vec![]]);
    let (rough, numbers) = chosen(1.0, [1.0; 2]);
    assert_eq!(rough.shape, Shape::Polynomial { x: Along::Log });
    // E = 1 - ln 2 x with x = (y + 1)/2; halves are right to 2^-12 here, and a best fit uses the
    // tolerance that is left.
    let half = 0.5 * std::f64::consts::LN_2;
    let expected = [1.0 - half, -half];
    assert_eq!(numbers[0].len(), expected.len(), "{numbers:?}");
    let is_near = |(own, expected): (&f64, f64)| (own - expected).abs() < 1e-3;
    assert!(numbers[0].iter().zip(expected).all(is_near), "{numbers:?}");
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

/// Whatever counts, what the search did not try costs no less than its choice: a check looks.
#[test]
fn a_check_misses_no_candidate_whatever_counts() {
    let folder = tempdir().unwrap();
    for (question, cost) in [
        ("--roughness 0.3,0.7 --f0 0.04..1", "operations=1"),
        ("--roughness 0.2,0.5", "operations=1"),
        ("--roughness 0.3,0.9 --f0 0..1", "bytes=1,loads=16,operations=1"),
        ("--roughness 0.6 --f0 0.04", "loads=1"),
        ("--roughness 0.3..1 --tolerance 0.02", "loads=16,operations=1"),
    ] {
        ok(&folder, &format!("plan {question} --cost {cost} -o a.toml"));
        ok(&folder, "plan --check a.toml");
    }
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
