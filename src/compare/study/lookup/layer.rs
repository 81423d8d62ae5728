//! Lookups that follow the layer at grazing angles: exact values of E and R over T, and the nets
//! that the planner fits.
//!
//! Both are judged by the same search as tables over n·v and roughness, at the places of
//! `PLACES`.

use super::{Axes, Lookups, PATIENCE, Reading, axes_of};
use crate::approximation::place::{Across, Along};
use crate::approximation::{Approximation, Channels, Region, Shape, Storage};
use crate::backend::cpu;
use crate::brdf::Microfacet;
use crate::brdf::fresnel::schlick_weight;
use crate::choice::Choice;
use crate::compare::study::Share;
use crate::compare::study::worst::{Domain, FULL, PRACTICAL, Search, rule};
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::numeric::lanes::{F32x16, Vector};
use crate::planner::candidate::Candidate;
use crate::planner::cost::Weights;
use crate::planner::domain::{self, Piece};
use crate::planner::search::{Task, search};
use crate::planner::tolerance::Tolerance;
use crate::planner::truth::Truth;
use crate::table::axis::Axis;
use crate::table::precision::Precision;
use crate::units::alpha_of;
use serde::{Deserialize, Serialize};

/// The words of T's axes in readings: with k = 3, one of the two best for the planner.
pub const LAYER: Axes = ("T,edges", "roughness,edges");

/// T of a table of exact values.
const ALONG: Along = Along::Layer(3.0);

/// The axes of a table at whose places these lookups are judged: the densest of those that are
/// compared where n·v is small.
const PLACES: (Axes, usize) = (("nov,sqrt,edges", "roughness,edges"), 256);

/// The roughness of row 0 of a table of exact values: at 0 itself T is 1 at every n·v, and E and R
/// have no limit for n·v → 0. Here they are functions of n·v/α alone to 1e-12.
const NEXT_TO_MIRROR: f64 = 1e-6;

/// Tolerances of nets, from the largest; a quick study takes the first two.
pub const TOLERANCES: [f64; 4] = [1e-2, 4e-3, 2e-3, 1e-3];

/// Where a net is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Where {
    /// Over [`FULL`].
    Everywhere,
    /// Over [`PRACTICAL`].
    Practical,
}

/// A net that the planner fitted, as it was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Net {
    /// What it is.
    pub candidate: String,
    /// Where it is right.
    pub domain: Where,
    /// The tolerance of E(F0) that it was planned for.
    pub tolerance: f64,
    /// Bytes of its numbers.
    pub bytes: usize,
    /// The largest error of the albedo over its domain: see [`Reading::everywhere`].
    pub largest: f64,
    /// The root of its mean square over places that are spread evenly over everything.
    pub rms: f64,
}

impl Where {
    /// Both.
    pub const ALL: [Where; 2] = [Where::Everywhere, Where::Practical];

    /// The domain of the search.
    fn domain(self) -> Domain {
        match self {
            Where::Everywhere => FULL,
            Where::Practical => PRACTICAL,
        }
    }
}

/// The lookup of an approximation in f32, as a shader computes it.
fn read(approximation: &Approximation, nov: f64, roughness: f64) -> ScaleBias {
    let of = |f0: f64| {
        let (nov, roughness) = (F32x16::from(nov), F32x16::from(roughness));
        approximation.albedo(nov, roughness, F32x16::from(f0)).lane(0)
    };
    let b = of(0.0);
    ScaleBias { a: of(1.0) - b, b }
}

/// What these lookups are judged by.
pub struct Judge {
    lookups: Lookups,
    search: Search,
    /// The axis of roughness of its search.
    y: Axis,
}

impl Judge {
    /// That of a lobe; none where it would take too long.
    pub fn new(lobe: Microfacet) -> Result<Option<Self>> {
        let (x, y) = axes_of(PLACES.0, PLACES.1)?;
        let Some(search) = Search::new(lobe, &x, &y, PATIENCE)? else { return Ok(None) };
        Ok(Some(Judge { lookups: Lookups::new(lobe)?, search, y }))
    }
}

/// A table of exact E and R over T and roughness with `size` texels along each, bilinear.
fn exact(lobe: Microfacet, size: usize, storage: Storage) -> Approximation {
    let region = Region { least_nov: 0.0, roughness: [0.0, 1.0] };
    let place = |i: usize| i as f64 / (size - 1) as f64;
    let point = |index: usize| {
        let (i, j) = (index % size, index / size);
        let roughness = Across::Linear.inverse(&region, place(j)).max(NEXT_TO_MIRROR);
        (ALONG.inverse(0.0, place(i), roughness), alpha_of(roughness))
    };
    let points: Vec<(f64, f64)> = (0..size * size).map(point).collect();
    let values = cpu::bake_points(lobe, &points, &rule(lobe, points.len())).scale_bias();
    let rest = |(value, (nov, _)): (&ScaleBias, &(f64, f64))| {
        value.b - schlick_weight::<f64>(*nov) * value.e()
    };
    let energy: Vec<f64> = values.iter().map(|value| value.e()).collect();
    let rest: Vec<f64> = values.iter().zip(&points).map(rest).collect();
    let shape = Shape::Spline { x: ALONG, y: Across::Linear, size: [size; 2], degree: 1 };
    let numbers = [energy, rest].map(|channel| storage.store(&channel)).into();
    Approximation { lobe, region, channels: Channels::EnergyRest, shape, numbers }
}

/// Tables of exact E and R of this size in these storages.
pub fn tables(judge: &Judge, size: usize, precisions: &[Precision]) -> Result<Vec<Reading>> {
    let Judge { lookups, search, y } = judge;
    let reading = |&precision: &Precision| {
        let storage = Storage::named(precision.word())?;
        let table = exact(lookups.lobe, size, storage);
        let read = |nov: f64, roughness: f64| read(&table, nov, roughness);
        Ok(Reading {
            x: LAYER.0.into(),
            y: LAYER.1.into(),
            size,
            precision,
            bytes: table.bytes(),
            everywhere: search.largest(FULL, &read)?,
            practical: search.largest(PRACTICAL, &read)?,
            rms: lookups.rms(y, &read)?,
        })
    };
    precisions.iter().map(reading).collect()
}

/// The smallest nets with these tolerances over both domains.
pub fn nets(lobe: Microfacet, tolerances: &[f64], share: Share) -> Result<Vec<Net>> {
    let Some(judge) = Judge::new(lobe)? else { return Ok(Vec::new()) };
    let truth = Truth::new(lobe);
    let mut nets = Vec::new();
    for (done, &tolerance) in tolerances.iter().enumerate() {
        for domain in Where::ALL {
            nets.extend(net(&judge, &truth, tolerance, domain)?);
        }
        share((done + 1) as f64 / tolerances.len() as f64);
    }
    Ok(nets)
}

/// The smallest net with this tolerance; none where there is none.
fn net(judge: &Judge, truth: &Truth, tolerance: f64, domain: Where) -> Result<Option<Net>> {
    let Domain { nov, roughness } = domain.domain();
    let piece = Piece { materials: Vec::new(), roughness: [roughness, 1.0], f0: [0.0, 1.0] };
    let task = Task {
        domain: domain::Domain { least_nov: nov, pieces: vec![piece] },
        tolerance: Tolerance::Absolute(tolerance),
        weights: Weights::default(),
        sampler: None,
    };
    let outcome = search(&task, truth);
    let [(net, _)] = &*outcome.choice else { return Ok(None) };
    let read = |nov: f64, roughness: f64| read(net, nov, roughness);
    let Judge { lookups, search: places, y } = judge;
    Ok(Some(Net {
        candidate: Candidate::of(net).to_string(),
        domain,
        tolerance,
        bytes: net.bytes(),
        largest: places.largest(domain.domain(), &read)?,
        rms: lookups.rms(y, &read)?,
    }))
}

/// The nets as lines of CSV.
pub fn to_csv(nets: &[Net]) -> String {
    let mut csv = String::from("candidate,domain,tolerance,bytes,max,rms\n");
    for Net { candidate, domain, tolerance, bytes, largest, rms } in nets {
        let domain = match domain {
            Where::Everywhere => "everywhere",
            Where::Practical => "practical",
        };
        csv += &format!("{candidate},{domain},{tolerance},{bytes},{largest:.6e},{rms:.6e}\n");
    }
    csv
}
