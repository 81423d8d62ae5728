//! Cost against the size of a table, on the CPU and on devices with and without their start: where a device begins to pay.

use super::{Device, Share, speed, timed};
use crate::backend::cpu;
use crate::backend::vulkan::bake::bake;
use crate::backend::vulkan::gpu::{Gpu, GpuOptions};
use crate::error::Result;
use crate::integrate::rule::{Method, Rule};
use crate::model::Microfacet;
use crate::precision::Precision;
use crate::study::technique::{Arithmetic, Step};
use serde::{Deserialize, Serialize};

/// A way of baking.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// The CPU, every value certified, stored as halves.
    Certified,
    /// The CPU, integrals within what befits halves.
    Cpu,
    /// The device of that name, integrals within the same, with its start.
    DeviceWithStart(String),
    /// The same without.
    Device(String),
}

/// A table's time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// How it was baked.
    pub way: Way,
    /// By which rule; none where values are certified.
    pub rule: Option<String>,
    /// Texels along either edge.
    pub size: usize,
    /// The shortest time of three, or of one where that took more than half a second.
    pub seconds: f64,
}

/// The largest error of the integrals where they are not certified: what befits halves.
pub fn tolerance() -> f64 {
    Precision::F16.default_tolerance()
}

/// Sizes from 16 to `largest`, on the CPU and on these devices.
pub fn measure(lobe: Microfacet, largest: usize, devices: &[GpuOptions], share: Share) -> Result<Vec<Cost>> {
    let mut costs = Vec::new();
    let sizes: Vec<usize> =
        std::iter::successors(Some(16), |size| Some(2 * size)).take_while(|&n| n <= largest).collect();
    // The work grows with the texels, so that the last size takes three quarters of the time.
    let total: f64 = sizes.iter().map(|&size| (size * size) as f64).sum();
    let mut done = 0.0;
    for size in sizes {
        let grid = speed::grid(size)?;
        let certified = Step::Certified(Precision::F16);
        let [seconds] = shortest(|| {
            let (values, seconds) = timed(|| certified.run(lobe, &grid, Arithmetic::F64, 0));
            values.map(|_| [seconds])
        })?;
        costs.push(Cost { way: Way::Certified, rule: None, size, seconds });
        if let Some(rule) = Rule::for_cpu(lobe, tolerance(), grid.len()) {
            let [seconds] = shortest(|| Ok([timed(|| cpu::bake(lobe, &grid, &rule, &|_| ())).1]))?;
            costs.push(Cost { way: Way::Cpu, rule: Some(rule.name.into()), size, seconds });
        }
        for options in devices {
            let Some(Rule { name, method: Method::HSpace(rule), .. }) = Rule::for_device(lobe, tolerance()) else {
                continue;
            };
            let mut device = String::new();
            let [start, bake] = shortest(|| {
                let (gpu, start) = timed(|| Gpu::open(options));
                let gpu = gpu?;
                device = Device::from(gpu.info()).name;
                let (baked, bake) = timed(|| bake(&gpu, lobe, &grid, &rule, &|_| ()));
                baked?;
                Ok([start, bake])
            })?;
            let cost = |way, seconds| Cost { way, rule: Some(name.into()), size, seconds };
            costs.push(cost(Way::DeviceWithStart(device.clone()), start + bake));
            costs.push(cost(Way::Device(device), bake));
        }
        done += (size * size) as f64;
        share(done / total);
    }
    Ok(costs)
}

/// The shortest times of three, part by part; of one where that took more than half a second.
fn shortest<const N: usize>(mut work: impl FnMut() -> Result<[f64; N]>) -> Result<[f64; N]> {
    let mut best = [f64::INFINITY; N];
    for _ in 0..3 {
        let times = work()?;
        best.iter_mut().zip(times).for_each(|(best, time)| *best = best.min(time));
        if times.iter().sum::<f64>() > 0.5 {
            break;
        }
    }
    Ok(best)
}

/// Every device, and the smallest size from which on it bakes faster than the CPU, its start included; none where it never does.
pub fn pays(costs: &[Cost]) -> Vec<(&str, Option<usize>)> {
    let of_cpu = |size| costs.iter().find(|cost| cost.way == Way::Cpu && cost.size == size).map(|cost| cost.seconds);
    let slower = |cost: &Cost| of_cpu(cost.size).is_none_or(|seconds| cost.seconds >= seconds);
    let mut devices: Vec<(&str, Option<usize>)> = Vec::new();
    for cost in costs {
        let Way::DeviceWithStart(name) = &cost.way else { continue };
        match devices.iter_mut().find(|(device, _)| device == name) {
            Some((_, from)) => *from = if slower(cost) { None } else { from.or(Some(cost.size)) },
            None => devices.push((name, (!slower(cost)).then_some(cost.size))),
        }
    }
    devices
}

/// The measurements as lines of CSV.
pub fn to_csv(costs: &[Cost]) -> String {
    let mut csv = String::from("way,rule,size,seconds\n");
    for Cost { way, rule, size, seconds } in costs {
        let rule = rule.as_deref().unwrap_or("-");
        let way = match way {
            Way::Certified => "CPU certified".into(),
            Way::Cpu => "CPU".into(),
            Way::DeviceWithStart(device) => format!("{device} with its start"),
            Way::Device(device) => device.clone(),
        };
        csv += &format!("\"{way}\",{rule},{size},{seconds:.6e}\n");
    }
    csv
}
