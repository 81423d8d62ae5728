//! Known answers of `splitsum plan`: control nets and their errors by an earlier study, which had a
//! coordinate of its own along n·v, another reference and another program.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rayon::prelude::*;
use serde_json::Value;
use splitsum::approximation::{Across, Along, Approximation, Channels, Region, Shape, Storage};
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::numeric::lanes::{F32x16, Vector};
use splitsum::planner::cost::Weights;
use splitsum::planner::domain::{Domain, Piece};
use splitsum::planner::search::{Task, search};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::{Albedo, Truth};
use std::sync::LazyLock;

const FIGURES: &str = include_str!("figures/control_nets.json");

static TRUTH: LazyLock<Truth> =
    LazyLock::new(|| Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap()));

/// The least n·v and the least roughness of the nets.
const LEAST: (f64, f64) = (1e-3, 0.045);

/// A published net.
struct Net {
    size: [usize; 2],
    /// The control points of E and of R.
    points: [Vec<f64>; 2],
    /// The published error of the numbers themselves, and of codes of 16 and of 8 bits.
    errors: [(Storage, f64); 3],
}

impl Net {
    fn of(value: &Value) -> Net {
        let whole = |name: &str| value[name].as_u64().unwrap() as usize;
        let error = |name: &str| value[name].as_f64().unwrap();
        let points = |name: &str| -> Vec<f64> {
            value[name].as_array().unwrap().iter().map(|point| point.as_f64().unwrap()).collect()
        };
        Net {
            size: [whole("N"), whole("M")],
            points: [points("E"), points("R")],
            errors: [
                (Storage::F32, error("max_f64")),
                (Storage::Unorm16, error("max_u16")),
                (Storage::Unorm8, error("max_u8")),
            ],
        }
    }

    /// The net over its own coordinates: t stands for n·v, and y for roughness.
    fn over_its_coordinates(&self, storage: Storage) -> Approximation {
        let (x, y) = (Along::Nov, Across::Linear);
        Approximation {
            lobe: TRUTH.lobe(),
            region: Region { least_nov: 0.0, roughness: [0.0, 1.0] },
            channels: Channels::EnergyRest,
            shape: Shape::Spline { x, y, size: self.size, degree: 3 },
            numbers: self.points.each_ref().map(|points| storage.store(points)).to_vec(),
        }
    }

    fn bytes(&self, storage: Storage) -> usize {
        2 * self.size[0] * self.size[1] * storage.bytes()
    }
}

fn nets() -> Vec<Net> {
    let figures: Value = serde_json::from_str(FIGURES).unwrap();
    let nets: Vec<Net> = figures["nets"].as_array().unwrap().iter().map(Net::of).collect();
    assert_eq!(nets.len(), 6);
    nets
}

/// T, which follows the layer at grazing angles.
fn layer(nov: f64, roughness: f64) -> f64 {
    let width = 3.0 * roughness * roughness;
    (nov * (1.0 + width) / (nov + width)).sqrt()
}

/// (t, y) of a place, by the formulas that were published with the nets.
fn coordinates(nov: f64, roughness: f64) -> (f64, f64) {
    let from = layer(LEAST.0, roughness);
    let first = LEAST.1.powf(0.35);
    let y = (roughness.powf(0.35) - first) / (1.0 - first);
    ((layer(nov, roughness) - from) / (1.0 - from), y)
}

/// The n·v where the published errors were measured: (i/2048)².
fn novs() -> Vec<f64> {
    (0..=2048).map(|i| f64::from(i) / 2048.0).map(|root| root * root).collect()
}

/// The largest error of E(F0) at these n·v of a roughness; it is linear in F0, so that none between
/// 0 and 1 is larger.
fn error_in_row(net: &Approximation, roughness: f64, novs: &[f64], truths: &[Albedo]) -> f64 {
    let mut largest = 0.0f64;
    for (novs, truths) in novs.chunks(16).zip(truths.chunks(16)) {
        let nov = |lane: usize| novs[lane.min(novs.len() - 1)];
        let t = F32x16::gather(|lane| coordinates(nov(lane), roughness).0);
        let y = F32x16::from(coordinates(1.0, roughness).1);
        let channels = net.at(t, y);
        for f0 in [0.0, 1.0] {
            let weights = net.channels.weights(F32x16::gather(nov), F32x16::from(f0));
            let albedo = weights[0] * channels[0] + weights[1] * channels[1];
            for (lane, truth) in truths.iter().enumerate() {
                largest = largest.max((albedo.lane(lane) - truth.at(f0)).abs());
            }
        }
    }
    largest
}

/// What a published figure and ours may differ by. The control points are printed to 6 decimals:
/// half of the last decimal in E and in R is 1e-6. Lookups in f32 sum 16 products up to 4.2, at
/// eight roundings of 6e-8 on the way: 2e-6. The largest difference found is 2.1e-6.
const DECIMALS_AND_FLOATS: f64 = 3e-6;

#[test]
fn nets_err_by_what_was_published() {
    let novs: Vec<f64> = novs().into_iter().filter(|&nov| nov >= LEAST.0).collect();
    let nets = nets();
    let all: Vec<(&Net, Storage, f64, Approximation)> = nets
        .iter()
        .flat_map(|net| net.errors.map(|(storage, error)| (net, storage, error)))
        .map(|(net, storage, error)| (net, storage, error, net.over_its_coordinates(storage)))
        .collect();
    let of_row = |row: u32| -> Vec<f64> {
        let roughness = f64::from(row) / 1024.0;
        let truths = TRUTH.row(roughness, &novs);
        all.iter().map(|one| error_in_row(&one.3, roughness, &novs, &truths)).collect()
    };
    // The published errors are those at multiples of 1/1024. Row 46 lies below the least roughness.
    let rows: Vec<Vec<f64>> = (47..=1024u32).into_par_iter().map(of_row).collect();
    for (index, (net, storage, published, _)) in all.iter().enumerate() {
        let found = rows.iter().map(|row| row[index]).fold(0.0, f64::max);
        let difference = (found - published).abs();
        let size = net.size;
        assert!(difference <= DECIMALS_AND_FLOATS, "{size:?} {storage}: {found}, not {published}");
    }
}

/// The published errors leave the ends of the domain out: the first roughness that was measured is
/// 47/1024, not 0.045, and the first n·v 0.001007. A net runs off at its ends, and so four of the
/// six err by more there, that of 8 by 12 by 1.45 times as much. The planner measures the ends.
#[test]
fn the_ends_of_the_domain_were_left_out() {
    let novs: Vec<f64> = novs().into_iter().filter(|&nov| nov > LEAST.0).chain([LEAST.0]).collect();
    let truths = TRUTH.row(LEAST.1, &novs);
    let beyond = |net: &&Net| {
        let own = net.over_its_coordinates(Storage::F32);
        error_in_row(&own, LEAST.1, &novs, &truths) > 1.1 * net.errors[0].1
    };
    let sizes: Vec<[usize; 2]> = nets().iter().filter(beyond).map(|net| net.size).collect();
    assert_eq!(sizes, [[5, 6], [7, 7], [8, 8], [8, 12]]);
}

#[test]
fn a_plan_takes_no_more_bytes() {
    let piece = Piece { materials: Vec::new(), roughness: [LEAST.1, 1.0], f0: [0.0, 1.0] };
    for net in nets() {
        for (storage, error) in &net.errors[1..] {
            let task = Task {
                domain: Domain { least_nov: LEAST.0, pieces: vec![piece.clone()] },
                tolerance: Tolerance::Absolute(*error),
                weights: Weights::default(),
                sampler: None,
            };
            let outcome = search(&task, &TRUTH);
            assert!(!outcome.choice.is_empty(), "nothing at {error}");
            let (bytes, most) = (outcome.cost.bytes, net.bytes(*storage));
            assert!(bytes <= most, "{bytes} bytes at {error}, not {most}");
        }
    }
}
