//! A tolerance that no candidate over a range of roughness meets is found out from the largest
//! ones, by proofs; one that may be met is not taken for it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use splitsum::approximation::Shape;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::planner::candidate::over_roughness;
use splitsum::planner::cost::Weights;
use splitsum::planner::domain::{Domain, Piece};
use splitsum::planner::proof::Claim;
use splitsum::planner::reach::out_of_reach;
use splitsum::planner::search::{Task, Verdict, search};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::Truth;
use std::sync::LazyLock;

static TRUTH: LazyLock<Truth> =
    LazyLock::new(|| Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap()));

fn task(roughness: [f64; 2], tolerance: f64) -> Task {
    let piece = Piece { materials: Vec::new(), roughness, f0: [0.0, 1.0] };
    Task {
        domain: Domain { least_nov: 0.0, pieces: vec![piece] },
        tolerance: Tolerance::Absolute(tolerance),
        weights: Weights::default(),
        sampler: None,
    }
}

/// The error of the truth over the smallest tolerance, 3e-8 over 1e-5.
const ERROR: f64 = 3e-3;

#[test]
fn the_largest_of_each_kind_are_proved_to_miss_it() {
    let task = task([0.0, 1.0], 1e-5);
    let trials = out_of_reach(&task, &TRUTH, ERROR).unwrap();
    // Three degrees and two k, powers of √(n·v) and of T, each over two coordinates of roughness;
    // control points are stored in two ways.
    assert_eq!(trials.len(), 2 * 3 * 2 * 2 + 2 * 2);
    let candidates = over_roughness([0.0, 1.0]);
    for trial in &trials {
        let Verdict::Fails { bound, proof } = &trial.verdict else { panic!("{}", trial.candidate) };
        assert!(*bound > 1.1, "{}: {bound}", trial.candidate);
        let is_larger = |other: &&splitsum::planner::candidate::Candidate| {
            let degree = |shape: &Shape| match shape {
                Shape::Spline { degree, .. } => *degree,
                _ => 0,
            };
            degree(&other.shape) == degree(&trial.candidate.shape)
                && other.counts > trial.candidate.counts
        };
        assert!(!candidates.iter().any(|other| is_larger(&other)), "{}", trial.candidate);
        // By the reference rule, as --check does it; a few, since it is slow.
        if matches!(trial.candidate.shape, Shape::Surface { .. }) {
            let Task { tolerance, .. } = task;
            let claim = Claim { candidate: &trial.candidate, region: &trial.region, tolerance };
            let (points, _) = claim.shortened(proof, &TRUTH).unwrap();
            let places: Vec<(f64, f64)> =
                points.iter().map(|point| (point.nov, point.roughness)).collect();
            let holds = claim.bound(&points, &Truth::by_reference(TRUTH.lobe(), &places));
            assert!(holds > 1.0, "{}: {holds}", trial.candidate);
        }
    }
}

#[test]
fn what_may_be_met_is_not_out_of_reach() {
    // 28 x 42 control points, as floats, err by 3e-5 at the least over everything: at 6e-5 one of
    // the first kinds meets it, at 3e-5 it is not far.
    for tolerance in [4e-3, 6e-5, 3e-5] {
        assert!(out_of_reach(&task([0.0, 1.0], tolerance), &TRUTH, ERROR).is_none(), "{tolerance}");
    }
    // docs/plan.md says where it begins.
    assert!(out_of_reach(&task([0.0, 1.0], 2.6e-5), &TRUTH, ERROR).is_some());
    // A constant has no candidates over a range.
    assert!(out_of_reach(&task([0.5, 0.5], 1e-5), &TRUTH, ERROR).is_none());
}

#[test]
fn a_search_ends_early_where_the_tolerance_is_out_of_reach() {
    let outcome = search(&task([0.0, 1.0], 1e-5), &TRUTH);
    assert!(outcome.choice.is_empty());
    // It ends after 256 shapes and the largest of each kind.
    let all = over_roughness([0.0, 1.0]).len();
    assert!(outcome.trials.len() * 10 < all, "{} of {all}", outcome.trials.len());
    assert!(outcome.trials.iter().all(|trial| matches!(trial.verdict, Verdict::Fails { .. })));
}
