//! Who does a job: whether a device can, and whether it pays.

use super::task;
use crate::certify::stages;
use crate::error::Complaint;
use crate::integrate::Integrand;
use crate::integrate::rule::{Method, Rule};
use crate::lut::Grid;
use crate::precision::Precision;
use crate::request::{Accuracy, Request};

/// The tolerance of a device's stage in certification: half of it is f32's, and h640 keeps the rest for most lobes.
const DEVICE_STAGE: f64 = 3e-6;

/// The rule by which a device can do the job, or what stands in the way.
pub(super) fn device_rule(request: &Request) -> Result<Rule, Complaint> {
    let integrand = request.lut.integrand();
    let on_cpu = |what: &str, expected: &str, got: &str| Err(Complaint::new(what, expected, got, "use --backend cpu"));
    if let Integrand::Diffuse(_) = integrand {
        return on_cpu("lut", "one that is integrated", "diffuse, whose closed forms the CPU has at once");
    }
    match request.accuracy {
        Accuracy::Certified(_) if request.precision == Precision::F32 => on_cpu(
            "precision",
            "one with coarser steps than the f32 in which a device computes",
            "certified f32, of which a device could decide no value",
        ),
        // No rule keeps less than the last, so that rounding must not rule it out.
        Accuracy::Certified(_) => {
            let tolerance = DEVICE_STAGE.max(1.001 * Rule::device_tolerance(integrand));
            Rule::for_device(integrand, tolerance).map_or_else(too_small, Ok)
        }
        Accuracy::Tolerance(tolerance) => Rule::for_device(integrand, tolerance).map_or_else(too_small, Ok),
        Accuracy::Rule(rule) if rule.runs_on_device() => Ok(rule),
        Accuracy::Rule(rule) => on_cpu("rule", "one that a device can run, beginning with h", rule.name),
    }
}

fn too_small() -> Result<Rule, Complaint> {
    let expected = "one that f32 on a device and its finest rule can keep";
    Err(Complaint::new("tolerance", expected, "a smaller one", "use --backend cpu"))
}

/// The share of texels, about, that f32 on a device decides and the CPU does not repeat.
const LEFT_TO_DEVICE: f64 = 0.9;

/// About how many seconds of the CPU's work a device would take over.
pub(super) fn seconds_saved(request: &Request, grid: &Grid) -> f64 {
    let (integrand, texels) = (request.lut.integrand(), grid.len());
    let whole = |rule: &Rule| rule.seconds(integrand, texels);
    let seconds = match request.accuracy {
        Accuracy::Rule(rule) => whole(&rule),
        Accuracy::Tolerance(tolerance) => Rule::for_cpu(integrand, tolerance, texels).as_ref().map_or(0.0, whole),
        // A surrogate checks every texel of a device.
        Accuracy::Certified(tolerance) => match stages::rules(&task(request, grid, tolerance)).first() {
            Some(first) if !matches!(first.method, Method::Surrogate(_)) => LEFT_TO_DEVICE * whole(first),
            _ => 0.0,
        },
    };
    seconds / rayon::current_num_threads() as f64
}
