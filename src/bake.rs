//! From a request to a table: planned, computed, checked. A table is baked slice by slice and in
//! bands of rows of one α each, so that it takes no more memory than its own bytes and a band's
//! numbers.

mod integration;
pub mod plan;
mod sample;

pub use integration::on_device;
pub use plan::Plan;
use plan::{PartPlan, names_of};

use crate::backend::cpu::Baker;
use crate::backend::{Backend, Gpu, Progress};
use crate::certify::decision::Task;
use crate::certify::deviation::{Deviation, MEASURED, measure};
use crate::certify::stages::Stages;
use crate::certify::tally::{Tally, unbounded};
use crate::certify::ziv::{DeviceTable, certify_band};
use crate::error::{Error, Result};
use crate::integrate::Field;
use crate::integrate::estimator::Estimator;
use crate::integrate::rule::Rule;
use crate::integrate::rules::REFERENCE;
use crate::lut::sheet::Sheet;
use crate::lut::{Packing, Part};
use crate::numeric::ball::Ball;
use crate::report::{Checks, Computed, Report, Seconds};
use crate::request::{Accuracy, Request};
use crate::table::claim::{Claim, Stage};
use crate::table::grid::Grid;
use crate::table::packed::Packed;
use crate::table::{self, Table};
use integration::{Checked, Integration, by_estimator, evaluations, sum};
use sample::Groups;
use std::time::Instant;

/// A baked table, and a report for each part of each of its slices.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The table.
    pub table: Table,
    /// The reports, in the order of the slices, and of their parts in each.
    pub reports: Vec<Report>,
}

/// Texels of a band: enough to fill any number of cores, and 32 MiB of numbers at the most.
const BAND: usize = 1 << 18;

/// Bakes a table. It has passed its checks when it comes back: see [`crate::certify`].
///
/// # Errors
///
/// [`Error::BadInput`] where a value does not fit the storage or a channel leaves no bound of its
/// error, [`Error::CheckFailed`] where stages or devices differ, [`Error::DeviceFailure`] and
/// [`Error::NoDevice`] from Vulkan, [`Error::Resources`] without memory.
pub fn bake(request: &Request, backend: &Backend) -> Result<Baked> {
    Plan::new(request, backend)?.bake(&|_| ())
}

impl Plan<'_> {
    /// Carries the plan out; `progress` is told of texels as they are integrated.
    pub fn bake(&self, progress: Progress) -> Result<Baked> {
        let request = self.request;
        let layout = request.layout();
        let packings = request.packings();
        let count = packings.len() * layout.values_of_slice();
        let mut values = Packed::zeros(request.precision(), count)?;
        let size = layout.values_of_slice() * request.precision().bytes();
        let (mut parts, mut reports, mut rounding) = (Vec::new(), Vec::new(), 0.0f64);
        let groups = Groups::of(self);
        let slices = packings.iter().zip(values.bytes_mut().chunks_exact_mut(size));
        for (index, (packing, bytes)) in slices.enumerate() {
            let grid = &request.grids()[index];
            let slice = Slice {
                plan: self,
                groups: &groups,
                index,
                packing,
                grid,
                parts: &self.slices[index],
                progress,
            };
            let (outcomes, coarser) = slice.bake(bytes)?;
            rounding = rounding.max(request.precision().half_step() + coarser);
            let several = outcomes.len() > 1;
            let mut of_slice = Vec::new();
            for (part, Outcome { claim, stages, checks, computed, seconds }) in outcomes {
                reports.push(Report {
                    command: request.to_string(),
                    slice: layout.slices.as_ref().map(|slices| slices.label(index)),
                    channels: several.then(|| names_of(&part, &layout.channels)),
                    size: [layout.x.size(), layout.y.size()],
                    clamped: [layout.x.clamped(), layout.y.clamped()],
                    computed,
                    claim: claim.clone(),
                    stages,
                    checks,
                    seconds,
                });
                let (channels, provenance) = (part.places(), part.provenance());
                of_slice.push(table::Part { channels, provenance, claim });
            }
            parts.push(of_slice);
        }
        if let Accuracy::Tolerance(_) | Accuracy::Rule(_) = request.accuracy() {
            groups.share(&mut reports, &mut parts);
        }
        let table = Table::new(layout.clone(), values, parts, rounding, request.to_string())?;
        Ok(Baked { table, reports })
    }
}

/// A slice of a table.
struct Slice<'a> {
    plan: &'a Plan<'a>,
    groups: &'a Groups,
    index: usize,
    packing: &'a Packing,
    grid: &'a Grid,
    /// The plans of its parts.
    parts: &'a [PartPlan],
    progress: Progress<'a>,
}

/// The outcome of a part of a slice besides its values.
struct Outcome {
    claim: Claim,
    stages: Vec<Stage>,
    checks: Option<Checks>,
    computed: Computed,
    seconds: Seconds,
}

impl Slice<'_> {
    /// Fills in the bytes of the slice, part by part.
    ///
    /// Also returns by how much storing a value errs more than [`Precision::half_step`].
    ///
    /// [`Precision::half_step`]: crate::table::precision::Precision::half_step
    fn bake(&self, bytes: &mut [u8]) -> Result<(Vec<(Part, Outcome)>, f64)> {
        let request = self.plan.request;
        let precision = request.precision();
        let mut sheet = Sheet::new(self.packing, self.grid, precision, bytes);
        let mut outcomes = Vec::new();
        for (place, (part, plan)) in self.packing.parts().into_iter().zip(self.parts).enumerate() {
            let on = PartOfSlice { slice: self, place, part: &part, plan };
            let outcome = match request.accuracy() {
                Accuracy::Rounded | Accuracy::Within(_) => on.certified(&mut sheet)?,
                Accuracy::Tolerance(_) | Accuracy::Rule(_) => on.uncertified(&mut sheet)?,
                Accuracy::Estimator(estimator) => on.estimated(&mut sheet, estimator)?,
            };
            outcomes.push((part, outcome));
        }
        sheet.fill();
        let coarser = sheet.finish()?;
        let hash = hash(bytes);
        for (_, outcome) in &mut outcomes {
            match &mut outcome.claim {
                Claim::Certificate(certificate) => {
                    certificate.blake3.clone_from(&hash);
                    certificate.bound += coarser;
                }
                Claim::Uncertified { .. } | Claim::Estimated { .. } | Claim::Fitted { .. } => (),
            }
            if let Some(checks) = &mut outcome.checks {
                checks.rounding += coarser;
            }
        }
        Ok((outcomes, coarser))
    }

    /// Points of a band that are measured against the reference.
    fn measured_points(&self) -> usize {
        MEASURED.div_ceil(self.bands().count() * self.plan.slices.len())
    }

    /// The bands of the grid, each with the row of the grid at which it begins.
    fn bands(&self) -> impl Iterator<Item = (usize, Grid)> + use<'_> {
        let grid = self.grid;
        let rows = (BAND / grid.mus.len()).max(1);
        (0..grid.alphas.len()).step_by(rows).map(move |first| (first, grid.band(first, rows)))
    }
}

/// A part of a slice.
struct PartOfSlice<'a> {
    slice: &'a Slice<'a>,
    /// Its place among the parts of the slice.
    place: usize,
    part: &'a Part,
    plan: &'a PartPlan,
}

impl PartOfSlice<'_> {
    /// The device and its rule; none where the CPU does the part.
    fn device(&self) -> Option<(&Gpu, Rule)> {
        self.slice.plan.device.zip(self.plan.device_rule.as_ref().ok().copied())
    }

    fn computed(&self, device_seconds: Option<f64>) -> Computed {
        let plan = self.slice.plan;
        match (plan.device, self.device()) {
            (_, Some((gpu, _))) => Computed::Vulkan {
                device: gpu.info().clone(),
                reason: plan.reason.clone(),
                device_seconds,
            },
            (None, None) => Computed::Cpu { reason: plan.reason.clone() },
            (Some(_), None) => {
                let obstacle = self.plan.device_rule.as_ref().err();
                Computed::Cpu { reason: obstacle.map(ToString::to_string) }
            }
        }
    }

    /// Certifies every value.
    fn certified(&self, sheet: &mut Sheet) -> Result<Outcome> {
        let (request, part) = (self.slice.plan.request, self.part);
        let (device, progress) = (self.device(), self.slice.progress);
        let whole = task(request, part, self.slice.grid);
        let (mut seconds, mut device_seconds, mut tally) =
            (Seconds::default(), None, Tally::default());
        let start = Instant::now();
        let stages = Stages::by(&whole, &self.plan.rules);
        seconds.integrate += start.elapsed().as_secs_f64();
        for (first, band) in self.slice.bands() {
            let start = Instant::now();
            let by_device = match &device {
                Some((gpu, rule)) => {
                    let baked = on_device(gpu, part.integrand(), &band, rule, progress)?;
                    device_seconds = sum(device_seconds, baked.device_seconds);
                    seconds.integrate += start.elapsed().as_secs_f64();
                    Some((gpu, rule, baked.integrals))
                }
                None => None,
            };
            let start = Instant::now();
            let by_device = by_device.as_ref().map(|(gpu, rule, integrals)| DeviceTable {
                integrals,
                rule,
                name: &gpu.info().name,
            });
            let progress = if device.is_some() { &|_| () } else { progress };
            let band = task(request, part, &band);
            let (values, found) = certify_band(&band, &stages, by_device, progress)?;
            sheet.put(part, first, &values);
            let took = if device.is_some() { &mut seconds.check } else { &mut seconds.integrate };
            *took += start.elapsed().as_secs_f64();
            tally = tally.merge(found);
        }
        let claim = Claim::Certificate(tally.certificate(&whole, &stages, String::new())?);
        let computed = self.computed(device_seconds);
        Ok(Outcome { claim, stages: tally.stages, checks: None, computed, seconds })
    }

    /// Integrates by one rule, and checks a sample.
    fn uncertified(&self, sheet: &mut Sheet) -> Result<Outcome> {
        let (request, part) = (self.slice.plan.request, self.part);
        let integrand = part.integrand();
        let rule = self.plan.rule(self.device().is_some());
        let rule = rule.ok_or_else(|| Error::Internal("no rule for this tolerance".into()))?;
        let start = Instant::now();
        let mut integration = Integration {
            integrand,
            baker: Baker::new(integrand, &rule),
            gpu: self.device().map(|(gpu, _)| gpu),
            measured_points: self.slice.groups.points(
                self.slice.index,
                self.place,
                self.slice.bands().count(),
            ),
            checked: Checked::default(),
        };
        integration.checked.seconds.integrate += start.elapsed().as_secs_f64();
        let mut bound = 0.0f64;
        for (first, band) in self.slice.bands() {
            let points = integration.over(&band, self.slice.progress)?;
            let averages = match part.needs_averages() {
                true => integration.averages(&band, &part.averaged())?,
                false => vec![Vec::new(); band.alphas.len()],
            };
            let (values, error) = self.channels(&integration, &band, &points, &averages);
            bound = bound.max(error);
            sheet.put(part, first, &values);
        }
        if !bound.is_finite() {
            return Err(unbounded());
        }
        let (on_device, grid) = (integration.gpu.is_some(), self.slice.grid);
        let Checked { cross_check, measured, seconds, device_seconds } = integration.checked;
        let computed = self.computed(device_seconds);
        let claim = Claim::Uncertified {
            rule: rule.name,
            error_bound: bound,
            measured_error: (measured.max(), measured.points),
            computed_by: computed.to_string(),
        };
        let checks = Checks {
            evaluations: rule.evaluations(plan::points(request, part)) as f64 / grid.len() as f64,
            cross_check: on_device.then_some(cross_check),
            measured,
            integrals: integrand.names(),
            rounding: request.precision().half_step(),
        };
        Ok(Outcome { claim, stages: Vec::new(), checks: Some(checks), computed, seconds })
    }

    /// Repeats an engine's own numbers, and measures how far they are from the truth.
    fn estimated(&self, sheet: &mut Sheet, estimator: Estimator) -> Result<Outcome> {
        let (part, request) = (self.part, self.slice.plan.request);
        let integrand = part.integrand();
        let start = Instant::now();
        let (mut measured, mut seconds) = (Deviation::default(), Seconds::default());
        let measured_points = self.slice.measured_points();
        for (first, band) in self.slice.bands() {
            let field = by_estimator(integrand, &band, estimator, self.slice.progress)?;
            let value = |(i, integrals): (usize, &[f64])| {
                let balls: Vec<Ball> = integrals.iter().copied().map(Ball::exact).collect();
                let values = part.values(band.point(i).0, &balls, &[]);
                values.map(|ball| request.precision().stored(ball.value)).into_iter()
            };
            let values = field.iter().enumerate().flat_map(|texel| value(texel).take(part.count()));
            sheet.put(part, first, &values.collect::<Vec<f64>>());
            let found =
                measure(integrand, &band, &REFERENCE, f64::INFINITY, &field, measured_points)?;
            measured = measured.merge(found);
        }
        seconds.integrate += start.elapsed().as_secs_f64();
        let claim = Claim::Estimated {
            estimator: estimator.to_string(),
            measured_error: (measured.max(), measured.points),
        };
        let checks = Checks {
            evaluations: evaluations(estimator),
            cross_check: None,
            measured,
            integrals: integrand.names(),
            rounding: request.precision().half_step(),
        };
        let computed = self.computed(None);
        Ok(Outcome { claim, stages: Vec::new(), checks: Some(checks), computed, seconds })
    }

    /// The values of a band that is not certified, and the largest error of any of them: of values
    /// above 1 relative.
    fn channels(
        &self,
        integration: &Integration,
        band: &Grid,
        points: &Field,
        averages: &[Vec<Ball>],
    ) -> (Vec<f64>, f64) {
        let (part, precision) = (self.part, self.slice.plan.request.precision());
        let count = part.count();
        let (mut values, mut worst) = (Vec::with_capacity(points.len() * count), 0.0f64);
        for (i, integrals) in points.iter().enumerate() {
            let (mu, alpha) = band.point(i);
            let integrals = integration.within_bound(alpha, integrals, 0.0);
            let channels = part.values(mu, &integrals, &averages[i / band.mus.len()]);
            for (Ball { value, error }, &(low, high)) in
                channels.into_iter().zip(part.ranges()).take(count)
            {
                worst = worst.max(error / value.abs().max(1.0));
                // An estimate that the storage does not hold, beyond what the channel can be.
                let beyond =
                    value < low && value + error >= low || value > high && value - error <= high;
                let held = precision.holds(precision.nearest(value));
                let value = if beyond && !held { value.clamp(low, high) } else { value };
                values.push(precision.stored(value));
            }
        }
        (values, worst)
    }
}

/// BLAKE3 of the bytes of a slice.
pub fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// The certification of a part of a table.
fn task<'a>(request: &Request, lut: &'a Part, grid: &'a Grid) -> Task<'a> {
    let tolerance = match request.accuracy() {
        Accuracy::Within(tolerance) | Accuracy::Tolerance(tolerance) => tolerance,
        Accuracy::Rounded | Accuracy::Rule(_) | Accuracy::Estimator(_) => {
            request.precision().default_tolerance()
        }
    };
    let slices = request.packings().len();
    Task { lut, grid, slices, precision: request.precision(), tolerance }
}
