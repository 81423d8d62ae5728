//! The bound of what a lookup errs by anywhere: no point that is searched for exceeds it, and it is
//! near the largest error that is found.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

mod common;

use common::Random;
use splitsum::approximation::{Across, Along, Approximation, Channels, Region, Shape, Storage};
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::integrate::interpolant::SMOOTHEST;
use splitsum::numeric::lanes::F32x16;
use splitsum::planner::bound::bound;
use splitsum::planner::candidate::Candidate;
use splitsum::planner::fit::{Effort, Problem};
use splitsum::planner::samples::{Spread, samples};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::Truth;
use std::sync::LazyLock;

static TRUTH: LazyLock<Truth> =
    LazyLock::new(|| Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap()));

/// A candidate with the numbers that fit it.
fn fitted(
    candidate: &Candidate,
    region: Region,
    f0: [f64; 2],
    tolerance: Tolerance,
) -> Approximation {
    let spread = match candidate.shape {
        Shape::Spline { .. } => [Spread::Crowded(6); 2],
        _ => [Spread::Crowded(49), Spread::Crowded(25)],
    };
    let points = samples(&TRUTH, &region, &candidate.shape, spread);
    let Candidate { channels, shape, counts, .. } = *candidate;
    let problem = Problem { region, f0, tolerance, channels, shape, counts, samples: &points };
    let fit = problem.fit(Effort { steps: 12, fails: 1e9, enough: 0.0 }).unwrap();
    candidate.with(&fit, TRUTH.lobe(), region)
}

/// The largest error over its tolerance that a search finds: random places, then smaller and
/// smaller steps from the best of them.
fn found(approximation: &Approximation, f0: [f64; 2], tolerance: Tolerance, from: f64) -> f64 {
    let Region { least_nov, roughness: [low, high] } = approximation.region;
    let low = low.max(from);
    let share = |[x, y]: [f64; 2]| {
        let roughness = low + (high - low) * y * y;
        // The floats that a shader has.
        let roughness = f64::from((roughness as f32).clamp(low as f32, high as f32));
        let along = Along::Layer(3.0).inverse(least_nov, x, roughness);
        let nov = f64::from((along as f32).clamp(least_nov as f32, 1.0));
        let truth = TRUTH.at(&[(nov, roughness.clamp(low, high))])[0];
        let of = |f0: f64| {
            let [nov, roughness] = [nov, roughness].map(F32x16::from);
            let albedo = approximation.albedo(nov, roughness, F32x16::from(f0)).0[0];
            (f64::from(albedo) - truth.at(f0)).abs() / tolerance.at(truth.at(f0))
        };
        of(f0[0]).max(of(f0[1]))
    };
    let mut random = Random(11);
    let mut best: Vec<(f64, [f64; 2])> = (0..3000)
        .map(|_| [random.next(), random.next()])
        .map(|place| (share(place), place))
        .collect();
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    best.truncate(6);
    for (largest, place) in &mut best {
        let mut step = 0.02;
        for _ in 0..150 {
            let near = place.map(|at| (at + step * (2.0 * random.next() - 1.0)).clamp(0.0, 1.0));
            let own = share(near);
            if own > *largest {
                (*largest, *place) = (own, near);
            } else {
                step *= 0.95;
            }
        }
    }
    best.iter().fold(0.0, |largest, (own, _)| own.max(largest))
}

/// The largest error over its tolerance in the cases below: a bound beyond 1 ends early.
const EDGE: f64 = 0.95;

/// A tolerance so many times as large.
fn scaled(tolerance: Tolerance, by: f64) -> Tolerance {
    match tolerance {
        Tolerance::Absolute(error) => Tolerance::Absolute(error * by),
        Tolerance::Relative(share) => Tolerance::Relative(share * by),
        Tolerance::Srgb { steps, radiance, diffuse } => {
            Tolerance::Srgb { steps: steps * by, radiance, diffuse }
        }
    }
}

#[test]
fn nothing_exceeds_the_bound_and_it_is_near() {
    let layer = Along::Layer(3.0);
    let spline = |x, y, size, degree| Shape::Spline { x, y, size, degree };
    let two = |count: usize| [count, count];
    let net = |shape, storage| {
        let Shape::Spline { size: [columns, rows], .. } = shape else { unreachable!() };
        let counts = two(columns * rows);
        Candidate { channels: Channels::EnergyRest, shape, counts, storage }
    };
    let line = |channels, x, counts| Candidate {
        channels,
        shape: Shape::Polynomial { x },
        counts,
        storage: Storage::F32,
    };
    let region = |least_nov, roughness| Region { least_nov, roughness };
    let (all, plastic) = ([0.0, 1.0], [0.04; 2]);
    let practical = region(1e-3, [0.045, 1.0]);
    let absolute = Tolerance::Absolute(4e-3);
    let cubic = net(spline(layer, Across::Sqrt, [7, 9], 3), Storage::Unorm8);
    let quadratic = net(spline(layer, Across::Linear, [8, 7], 2), Storage::Unorm16);
    let bilinear = net(spline(layer, Across::Sqrt, [8, 10], 1), Storage::Unorm16);
    let surface = Candidate {
        channels: Channels::Ratio,
        shape: Shape::Surface { x: Along::Sqrt, y: Across::Linear, columns: 4 },
        counts: [12, 0],
        storage: Storage::F32,
    };
    let ratio = line(Channels::Ratio, Along::Cbrt, [4, 0]);
    let rough = line(Channels::EnergyRest, Along::Log, [3, 3]);
    let pair = line(Channels::EnergyRest, layer, [5, 4]);
    let steps = Tolerance::Srgb { steps: 2.0, radiance: 1.0, diffuse: 0.1 };
    let cases = [
        (cubic, practical, all, absolute),
        (cubic, practical, [0.04, 1.0], Tolerance::Relative(0.05)),
        (cubic, region(0.0, [0.0, 1.0]), all, absolute),
        (quadratic, practical, all, absolute),
        (quadratic, region(1e-3, [0.3, 0.8]), [0.04, 0.9], steps),
        (bilinear, practical, all, absolute),
        (surface, region(1e-3, [0.3, 1.0]), plastic, absolute),
        (surface, region(0.0, [0.3, 1.0]), plastic, absolute),
        (ratio, region(1e-3, [0.5, 0.5]), plastic, absolute),
        (rough, region(1e-3, [0.9, 0.9]), all, absolute),
        (pair, region(1e-3, [0.2, 0.2]), all, absolute),
        (pair, region(0.0, [0.05, 0.05]), all, absolute),
    ];
    for (candidate, region, f0, tolerance) in cases {
        let approximation = fitted(&candidate, region, f0, tolerance);
        let from = region.roughness[0].max(SMOOTHEST);
        let tolerance = scaled(tolerance, found(&approximation, f0, tolerance, from) / EDGE);
        let found = found(&approximation, f0, tolerance, from);
        let bound = bound(&approximation, f0, tolerance, found, &TRUTH).unwrap();
        println!(
            "{candidate}, {region:?}: found {found:.4}, bound {:.4} at {} points",
            bound.share, bound.points
        );
        assert!(bound.from == from, "{bound:?}");
        assert!((found / EDGE - 1.0).abs() < 1e-6, "{candidate}: {found}");
        // The interpolant is the truth of both.
        assert!(found <= bound.share, "{candidate}: {found} exceeds {bound:?}");
        // 0.004 of the tolerance is allowed between points, roundings of f32 count 0.02 for the
        // longest polynomial, and the search misses a little.
        let near = 1.03 * found.max(0.9);
        assert!(bound.share <= near, "{candidate}: {bound:?} is far from {found}");
    }
}
