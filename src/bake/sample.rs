//! The sample of an uncertified table that is measured against the reference: where it lies, and
//! what slices say of it together.

use super::plan::{PartPlan, Plan};
use crate::certify::deviation::{Deviation, MEASURED};
use crate::integrate::rule::Rule;
use crate::numeric::lanes::{F64x8, Vector};
use crate::report::Report;
use crate::table;
use crate::table::claim::Claim;
use std::collections::HashMap;

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
        let groups = || self.0.iter().flat_map(|parts| parts.iter().enumerate());
        let mut measured: HashMap<_, Deviation> = HashMap::new();
        for (group, report) in groups().zip(&*reports) {
            if let Some(checks) = &report.checks {
                let so_far = measured.entry(group).or_default();
                *so_far = std::mem::take(so_far).merge(checks.measured.clone());
            }
        }
        let parts = parts.iter_mut().flatten();
        for ((group, report), part) in groups().zip(reports).zip(parts) {
            let Some(all) = measured.get(&group) else { continue };
            if let Claim::Uncertified { measured_error, .. } = &mut part.claim {
                *measured_error = (all.max(), all.points);
            }
            report.claim = part.claim.clone();
            if let Some(checks) = &mut report.checks {
                checks.measured = all.clone();
            }
        }
    }
}
