//! The sample of an uncertified table that is measured against the reference: where it lies, and
//! what all slices say of it together.

use crate::certify::deviation::{Deviation, MEASURED};
use crate::numeric::lanes::{F64x8, Vector};
use crate::report::{Checks, Report};
use crate::table;
use crate::table::claim::Claim;

/// Points of each grid of a slice, which has so many of them, of so many slices. A few points cost
/// as much as there are lanes, so that those of a table with many slices lie in some of them.
pub(super) fn points(slice: usize, slices: usize, grids_of_slice: usize) -> usize {
    let grids = slices * grids_of_slice;
    let apart = (F64x8::LANES * grids / MEASURED).max(1);
    if slice.is_multiple_of(apart) { MEASURED.div_ceil(grids.div_ceil(apart)) } else { 0 }
}

/// Gives each part what was measured of it in all slices together.
pub(super) fn share(reports: &mut [Report], parts: &mut [Vec<table::Part>]) {
    let count = parts.first().map_or(0, Vec::len);
    for place in 0..count {
        let mut of_place: Vec<&mut Checks> = reports
            .iter_mut()
            .skip(place)
            .step_by(count)
            .filter_map(|r| r.checks.as_mut())
            .collect();
        let measured: Vec<Deviation> =
            of_place.iter().map(|checks| checks.measured.clone()).collect();
        let all = measured.into_iter().fold(Deviation::default(), Deviation::merge);
        for checks in &mut of_place {
            checks.measured = all.clone();
        }
        for part in parts.iter_mut().filter_map(|parts| parts.get_mut(place)) {
            if let Claim::Uncertified { measured_error, .. } = &mut part.claim {
                *measured_error = (all.max(), all.points);
            }
        }
    }
}
