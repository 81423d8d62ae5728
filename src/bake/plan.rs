//! The plan of a bake, made once: its rules, its device, and the reason; what it takes. A bake
//! carries it out.

use super::{BAND, task};
use crate::backend::{Backend, Chosen, Gpu};
use crate::certify::stages;
use crate::error::{Complaint, Error, Result};
use crate::integrate::rule::{Method, Rule};
use crate::lut::Part;
use crate::request::{Accuracy, Request};
use crate::table::Channel;
use std::fmt;

/// A plan for a request.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    pub(super) request: &'a Request,
    /// The parts of each slice, in the order of the packing's; of a table without slices one's.
    pub(super) slices: Vec<Vec<PartPlan>>,
    /// The device; none where the CPU does it all.
    pub(super) device: Option<&'a Gpu>,
    /// The reason for the device or for the CPU, where there was a choice.
    pub(super) reason: Option<String>,
}

/// The plan for the channels of one table.
#[derive(Clone, Debug)]
pub(super) struct PartPlan {
    pub part: Part,
    /// The rules of the CPU: the stages of a certification, or the one rule of a table that is not
    /// certified.
    pub rules: Vec<Rule>,
    /// The rule of a device, or the reason why a device cannot do the part.
    pub device_rule: std::result::Result<Rule, Complaint>,
}

impl PartPlan {
    /// The one rule of a table that is not certified.
    pub fn rule(&self, on_device: bool) -> Option<Rule> {
        let on_device = self.device_rule.as_ref().ok().filter(|_| on_device);
        on_device.or(self.rules.first()).copied()
    }
}

/// The tolerance of a device's stage in certification: half of it is f32's, and h640 keeps the rest
/// for most lobes.
const DEVICE_STAGE: f64 = 3e-6;

/// The fraction of texels, roughly, that f32 on a device decides and the CPU does not repeat, as
/// measured for halves on lavapipe.
const LEFT_TO_DEVICE: f64 = 0.9;

/// Seconds that a thread takes to decide the values of a texel, measured.
const DECISION: f64 = 40e-9;

/// Bytes besides the table for each texel of a band: the integrals of the first stage and of a
/// device, four of 8 bytes each at the most, what finer stages see of it, its values, and whether
/// it is decided.
const WORKING_BYTES: usize = 128;

impl<'a> Plan<'a> {
    /// The plan for a request on a backend; an error where the backend is ruled out.
    pub fn new(request: &'a Request, backend: &'a Backend) -> Result<Self> {
        let (mut slices, mut saved) = (Vec::new(), 0.0);
        for packing in request.packings() {
            let mut parts = Vec::new();
            for part in packing.parts() {
                let rules = rules(request, &part)?;
                let device_rule = device_rule(request, &part);
                if device_rule.is_ok() {
                    saved += seconds_saved(request, &part, &rules);
                }
                parts.push(PartPlan { part, rules, device_rule });
            }
            slices.push(parts);
        }
        // The CPU does what a device cannot, as long as something is left for the device.
        let all_refused = slices.iter().flatten().all(|part| part.device_rule.is_err());
        let obstacle = slices[0][0].device_rule.as_ref().err().filter(|_| all_refused).cloned();
        let Chosen { gpu, reason } = backend.choose(obstacle, saved)?;
        Ok(Plan { request, slices, device: gpu, reason })
    }

    /// The rules of the CPU for the main part: the stages of a certification, or the one rule of a
    /// table that is not certified.
    pub fn rules(&self) -> &[Rule] {
        &self.slices[0][0].rules
    }

    /// The device and its rule for the main part; none where the CPU does it all.
    pub fn device(&self) -> Option<(&Gpu, Rule)> {
        self.device.zip(self.slices[0][0].device_rule.as_ref().ok().copied())
    }

    /// The reason for the device or for the CPU, where there was a choice.
    pub fn reason(&self) -> Option<&str> {
        self.reason.as_deref()
    }

    /// The approximate time on the CPU's threads, without a device: of the first stage, which
    /// nearly every value needs alone, and of the decisions.
    pub fn seconds(&self) -> f64 {
        let request = self.request;
        let of_part = |PartPlan { part, rules, .. }: &PartPlan| {
            seconds_of_first(request, part, rules) + DECISION * request.grid().len() as f64
        };
        let seconds = self.slices.iter().flatten().map(of_part).sum::<f64>();
        seconds / rayon::current_num_threads() as f64
    }
}

/// Bytes that a bake takes besides the table.
pub fn working_bytes(request: &Request) -> usize {
    request.grid().len().min(BAND.max(request.grid().mus.len())) * WORKING_BYTES
}

/// The rules of the CPU.
fn rules(request: &Request, part: &Part) -> Result<Vec<Rule>> {
    let (integrand, grid) = (part.integrand(), request.grid());
    match request.accuracy() {
        Accuracy::Rounded | Accuracy::Within(_) => Ok(stages::rules(&task(request, part, grid))),
        Accuracy::Rule(rule) => Ok(vec![rule]),
        Accuracy::Estimator(_) => Ok(Vec::new()),
        Accuracy::Tolerance(tolerance) => {
            let rule = Rule::for_cpu(integrand, tolerance, grid.len());
            rule.map(|rule| vec![rule])
                .ok_or_else(|| Error::Internal("no rule for this tolerance".into()))
        }
    }
}

/// The rule by which a device can do the job, or the obstacle.
fn device_rule(request: &Request, part: &Part) -> std::result::Result<Rule, Complaint> {
    let integrand = part.integrand();
    let on_cpu = |what: &str, expected: &str, got: &str| {
        Err(Complaint::new(what, expected, got, "use --backend cpu"))
    };
    if let Some((what, expected, got)) = integrand.obstacle_on_device() {
        return on_cpu(what, expected, &got);
    }
    match request.accuracy() {
        Accuracy::Within(_) => on_cpu(
            "precision",
            "one whose values are rounded once, which a device can decide",
            &format!("{}, certified within a tolerance", request.precision()),
        ),
        // No rule keeps less than the last, so that rounding must not rule it out.
        Accuracy::Rounded => {
            let tolerance = DEVICE_STAGE.max(1.001 * Rule::device_tolerance(integrand));
            Rule::for_device(integrand, tolerance).map_or_else(too_small, Ok)
        }
        Accuracy::Tolerance(tolerance) => {
            Rule::for_device(integrand, tolerance).map_or_else(too_small, Ok)
        }
        Accuracy::Estimator(_) => {
            on_cpu("estimator", "a rule, which a device can run", "an estimator")
        }
        Accuracy::Rule(rule) if rule.runs_on_device() => Ok(rule),
        Accuracy::Rule(rule) => {
            let expected = "one that a device can run: h56 to h6144, or of glass g560 to g2240";
            on_cpu("rule", expected, rule.name)
        }
    }
}

fn too_small() -> std::result::Result<Rule, Complaint> {
    let expected = "one that f32 on a device and its finest rule can keep";
    Err(Complaint::new("tolerance", expected, "a smaller one", "use --backend cpu"))
}

/// The approximate CPU time that a device would save of a slice.
fn seconds_saved(request: &Request, part: &Part, rules: &[Rule]) -> f64 {
    let share = match (request.accuracy(), rules.first()) {
        // An interpolant checks every texel of a device.
        (
            Accuracy::Rounded | Accuracy::Within(_),
            Some(Rule { method: Method::Interpolant(_), .. }),
        ) => 0.0,
        (Accuracy::Rounded | Accuracy::Within(_), _) => LEFT_TO_DEVICE,
        (Accuracy::Tolerance(_) | Accuracy::Rule(_) | Accuracy::Estimator(_), _) => 1.0,
    };
    let first = seconds_of_first(request, part, rules);
    share * first / rayon::current_num_threads() as f64
}

/// The approximate time of the first of these rules on a slice, averages included, on one thread.
fn seconds_of_first(request: &Request, part: &Part, rules: &[Rule]) -> f64 {
    let points = match request.accuracy() {
        Accuracy::Rounded | Accuracy::Within(_) => task(request, part, request.grid()).points(),
        Accuracy::Rule(_) | Accuracy::Estimator(_) | Accuracy::Tolerance(_) => {
            points(request, part)
        }
    };
    rules.first().map_or(0.0, |rule| rule.seconds(part.integrand(), points))
}

/// Points of a slice at which a rule integrates: its texels, and the directions of its averages.
pub(super) fn points(request: &Request, part: &Part) -> usize {
    let grid = request.grid();
    grid.len() + grid.alphas.len() * part.averaged_directions()
}

/// Bytes in words.
fn in_words(bytes: usize) -> String {
    match bytes {
        0..10_240 => format!("{bytes} bytes"),
        10_240..10_485_760 => format!("{:.0} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.0} MiB", bytes as f64 / 1024.0 / 1024.0),
    }
}

impl Plan<'_> {
    /// The rules of a part, named for its lobe where there are several.
    fn write_part(&self, plan: &PartPlan, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = match self.slices[0].len() {
            1 => String::new(),
            _ => format!("{}: ", names_of(&plan.part, &self.request.layout().channels)),
        };
        match self.request.accuracy() {
            Accuracy::Rounded | Accuracy::Within(_) => {
                let device = plan.device_rule.as_ref().ok().filter(|_| self.device.is_some());
                let device = device.iter().map(|rule| format!("{} on the device", rule.name));
                let on_cpu = plan.rules.iter().map(|rule| rule.name.to_owned());
                let stages = device.chain(on_cpu).collect::<Vec<_>>().join(", then ");
                writeln!(f, "certified {of}by {stages}: each decides what the one before leaves")
            }
            Accuracy::Estimator(estimator) => {
                writeln!(f, "estimator {of}{estimator}; not certified")
            }
            Accuracy::Tolerance(_) | Accuracy::Rule(_) => {
                let rule = plan.rule(self.device.is_some()).map_or("none", |rule| rule.name);
                writeln!(f, "rule      {of}{rule}; not certified")
            }
        }
    }
}

/// The names of the channels that a part fills.
pub(super) fn names_of(part: &Part, channels: &[Channel]) -> String {
    let names = part.places().into_iter().map(|place| &*channels[place].name);
    names.collect::<Vec<_>>().join(", ")
}

impl fmt::Display for Plan<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let request = self.request;
        let layout = request.layout();
        let channels =
            layout.channels.iter().map(|channel| &*channel.name).collect::<Vec<_>>().join(", ");
        write!(f, "table     {} x {}", layout.x.size(), layout.y.size())?;
        if let Some(slices) = &layout.slices {
            write!(f, " x {} slices of {}", slices.count(), slices.word())?;
        }
        writeln!(f, ", {channels} in {}: {}", request.precision(), in_words(request.bytes()))?;
        match (&self.device, &self.reason) {
            (None, None) => writeln!(f, "backend   CPU, f64")?,
            (None, Some(reason)) => writeln!(f, "backend   CPU, f64; not Vulkan: {reason}")?,
            (Some(gpu), reason) => {
                let reason = reason.as_ref().map_or(String::new(), |reason| format!("; {reason}"));
                writeln!(f, "backend   Vulkan, f32: {}{reason}", gpu.info().name)?;
            }
        }
        self.slices[0].iter().try_for_each(|part| self.write_part(part, f))?;
        let threads = rayon::current_num_threads();
        let time = format!("{} on {threads} threads", duration(self.seconds()));
        match self.device {
            Some(_) => writeln!(f, "time      at most {time}: the time without the device")?,
            None => writeln!(f, "time      about {time}")?,
        }
        write!(f, "memory    {} besides the table", in_words(working_bytes(request)))
    }
}

/// A time to two digits.
fn duration(seconds: f64) -> String {
    match seconds {
        ..0.1 => format!("{:.1} ms", 1e3 * seconds),
        ..10.0 => format!("{seconds:.1} s"),
        _ => format!("{seconds:.0} s"),
    }
}
