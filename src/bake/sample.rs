//! The sample of an uncertified table that is measured against the reference: where it lies, and
//! what slices say of it together.

use super::plan::{PartPlan, Plan};
use crate::certify::deviation::{Deviation, MEASURED};
use crate::integrate::rule::Rule;
use crate::numeric::lanes::{F64x8, Vector};
use crate::report::Report;
use crate::table;
use crate::table::claim::Claim;

/// For each part of each slice what it has to share with another to be measured with it: the name
/// and the bits of the bound of its rule.
pub(super) struct Groups(Vec<Vec<(&'static str, u64)>>);

impl Groups {
    pub fn of(plan: &Plan) -> Self {
        let on_device = plan.device.is_some();
        let group = |part: &PartPlan| {
            let bound = |rule: Rule| rule.bound(part.part.integrand());
            part.rule(on_device).map_or(("", 0), |rule| (rule.name, bound(rule).to_bits()))
        };
        let of_slice = |parts: &Vec<PartPlan>| parts.iter().map(group).collect();
        Groups(plan.slices.iter().map(of_slice).collect())
    }

    /// Points to measure in each band of a part of a slice, 0 in slices that others speak for: a
    /// few points cost as much as there are lanes.
    pub fn points(&self, slice: usize, part: usize, bands: usize) -> usize {
        let grids = bands * self.0.iter().map(Vec::len).sum::<usize>();
        let apart = (F64x8::LANES * grids / MEASURED).max(1);
        let same = |parts: &&Vec<(&str, u64)>| parts[part] == self.0[slice][part];
        let before = self.0[..slice].iter().filter(same).count();
        if before.is_multiple_of(apart) { MEASURED.div_ceil(grids.div_ceil(apart)) } else { 0 }
    }

    /// Gives each part what was measured in all slices of its group.
    pub fn share(&self, reports: &mut [Report], parts: &mut [Vec<table::Part>]) {
        let places: Vec<(usize, usize)> = (0..self.0.len())
            .flat_map(|slice| (0..self.0[slice].len()).map(move |part| (slice, part)))
            .collect();
        let measured: Vec<Deviation> = places
            .iter()
            .map(|&(slice, part)| {
                let same = |other: &usize| {
                    let (at, place) = places[*other];
                    place == part && self.0[at][place] == self.0[slice][part]
                };
                let checks =
                    (0..places.len()).filter(same).filter_map(|at| reports[at].checks.as_ref());
                checks
                    .map(|checks| checks.measured.clone())
                    .fold(Deviation::default(), Deviation::merge)
            })
            .collect();
        for ((report, measured), (slice, part)) in reports.iter_mut().zip(measured).zip(places) {
            let claim = &mut parts[slice][part].claim;
            if let Claim::Uncertified { measured_error, .. } = claim {
                *measured_error = (measured.max(), measured.points);
            }
            report.claim = claim.clone();
            if let Some(checks) = &mut report.checks {
                checks.measured = measured;
            }
        }
    }
}
