//! Cost against the size of a table, on the CPU and on devices with and without their start: where
//! a device begins to pay.

use super::{Share, speed, timed};
use crate::backend::device::GpuOptions;
use crate::backend::{Gpu, bake, cpu};
use crate::brdf::{Fresnel, Microfacet};
use crate::compare::technique::{Arithmetic, Setting};
use crate::error::Result;
use crate::integrate::rule::{Method, Rule};
use crate::table::precision::Precision;
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
    /// The way it was baked.
    pub way: Way,
    /// Its rule; none where values are certified.
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

/// Sizes from 16 to `largest`, on the CPU and on these devices; a way is left where its next size
/// would take more than `patience` seconds.
pub fn measure(
    lobe: Microfacet,
    largest: usize,
    patience: f64,
    devices: &[GpuOptions],
    share: Share,
) -> Result<Vec<Cost>> {
    let cpu: [Bake; 2] =
        [Box::new(move |size| certified(lobe, size)), Box::new(move |size| on_cpu(lobe, size))];
    let on_devices =
        devices.iter().map(|options| Box::new(move |size| on_device(lobe, size, options)) as Bake);
    let mut bakes: Vec<(Bake, f64)> =
        cpu.into_iter().chain(on_devices).map(|bake| (bake, 0.0)).collect();
    let sizes: Vec<usize> = std::iter::successors(Some(16), |size| Some(2 * size))
        .take_while(|&n| n <= largest)
        .collect();
    // The work grows with the texels, so that the last size takes three quarters of the time.
    let total: f64 = sizes.iter().map(|&size| (size * size) as f64).sum();
    let (mut costs, mut done) = (Vec::new(), 0.0);
    for size in sizes {
        for (bake, last) in bakes.iter_mut().filter(|(_, last)| 4.0 * last <= patience) {
            let new = bake(size)?;
            *last = new.first().map_or(0.0, |cost: &Cost| cost.seconds);
            costs.extend(new);
        }
        done += (size * size) as f64;
        share(done / total);
    }
    Ok(costs)
}

/// A size's costs, the largest first.
type Bake<'a> = Box<dyn Fn(usize) -> Result<Vec<Cost>> + 'a>;

fn certified(lobe: Microfacet, size: usize) -> Result<Vec<Cost>> {
    let grid = speed::grid(size)?;
    let [seconds] = shortest(|| {
        let bake = || Setting::Certified(Precision::F16).run(lobe, &grid, Arithmetic::F64, 0);
        let (values, seconds) = timed(bake);
        values.map(|_| [seconds])
    })?;
    Ok(vec![Cost { way: Way::Certified, rule: None, size, seconds }])
}

fn on_cpu(lobe: Microfacet, size: usize) -> Result<Vec<Cost>> {
    let grid = speed::grid(size)?;
    let Some(rule) = Rule::for_cpu(lobe, tolerance(), grid.len()) else { return Ok(Vec::new()) };
    let [seconds] = shortest(|| Ok([timed(|| cpu::bake(lobe, &grid, &rule, &|_| ())).1]))?;
    Ok(vec![Cost { way: Way::Cpu, rule: Some(rule.name.into()), size, seconds }])
}

fn on_device(lobe: Microfacet, size: usize, options: &GpuOptions) -> Result<Vec<Cost>> {
    let grid = speed::grid(size)?;
    let Some(Rule { name, method: Method::HalfVectors(rule), .. }) =
        Rule::for_device(lobe, tolerance())
    else {
        return Ok(Vec::new());
    };
    let mut device = String::new();
    let [start, bake] = shortest(|| {
        let (gpu, start) = timed(|| Gpu::open(options));
        let gpu = gpu?;
        device = gpu.info().name.clone();
        let (baked, bake) = timed(|| bake(&gpu, (lobe, Fresnel::Schlick), &grid, &rule, &|_| ()));
        baked.map(|_| [start, bake])
    })?;
    let cost = |way, seconds| Cost { way, rule: Some(name.into()), size, seconds };
    Ok(vec![
        cost(Way::DeviceWithStart(device.clone()), start + bake),
        cost(Way::Device(device), bake),
    ])
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

/// Every device, and the smallest size from which on it bakes faster than the CPU, its start
/// included; none where it never does.
pub fn pays(costs: &[Cost]) -> Vec<(&str, Option<usize>)> {
    let of_cpu = |size| {
        costs.iter().find(|cost| cost.way == Way::Cpu && cost.size == size).map(|cost| cost.seconds)
    };
    // Where the CPU was left for being slow, the device is not slower.
    let slower = |cost: &Cost| of_cpu(cost.size).is_some_and(|seconds| cost.seconds >= seconds);
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
