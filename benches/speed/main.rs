//! How fast, and at what error: `cargo bench`. Everything is timed in one run, in turns, so that what counts are the
//! ratios to the baseline; these are medians of several rounds. It prints Markdown.
#![allow(clippy::unwrap_used, reason = "a benchmark fails by panicking")]

mod counted;

use counted::{Counted, operations};
use splitsum::backend::vulkan::bake::bake as device_bake;
use splitsum::backend::vulkan::devices::list_devices;
use splitsum::backend::vulkan::gpu::{Gpu, GpuOptions};
use splitsum::backend::{Backend, cpu};
use splitsum::certify::decision::Task;
use splitsum::certify::ziv::certify;
use splitsum::integrate::ScaleBias;
use splitsum::integrate::h_space::h_space;
use splitsum::integrate::rule::{Method, REFERENCE, Rule};
use splitsum::integrate::rules::D10240;
use splitsum::lut::{Dfg, DfgChannels, Grid, Lut};
use splitsum::model::{Masking, Microfacet, Ndf};
use splitsum::precision::Precision;
use splitsum::quadrature::point_set::PointSet;
use splitsum::request::Request;
use splitsum::study::technique::{Arithmetic, BASELINE, Step, Technique};
use splitsum::study::{Errors, Machine, median, timed};
use std::process::Command;

const LOBE: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };
const LUT: Lut = Lut::Dfg(Dfg { lobe: LOBE, channels: DfgChannels::Ab });
const ROUNDS: usize = 15;

fn request(size: usize, precision: Precision) -> Request {
    Request::with_default_axes(LUT, (size, size), precision).unwrap()
}

/// A table as it comes out of a work.
enum Values {
    Stored(Vec<f64>),
    Integrals(Vec<ScaleBias>),
}

impl Values {
    /// How far they are off.
    fn errors(&self, truth: &[ScaleBias]) -> [f64; 2] {
        let truth = truth.iter().copied();
        let texel = |ab: &[f64]| ScaleBias { a: ab[0], b: ab[1] };
        match self {
            Values::Stored(values) => Errors::between(values.chunks_exact(2).map(texel).zip(truth)).max,
            Values::Integrals(integrals) => Errors::between(integrals.iter().copied().zip(truth)).max,
        }
    }
}

fn main() {
    let processor = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = Machine::processor_in(&processor);
    let threads = rayon::current_num_threads();
    println!("CPU: {}, {threads} threads; splitsum {}\n", name.unwrap_or("unknown"), env!("CARGO_PKG_VERSION"));
    tables();
    evaluations();
    processes();
    devices();
}

/// 512 x 512 against the baseline.
fn tables() {
    type Work<'a> = (String, Box<dyn Fn() -> Values + 'a>);
    let grid = request(512, Precision::F16).grid().unwrap();
    let certified = |precision: Precision, tolerance: f64| {
        let task = Task { lut: &LUT, grid: &grid, precision, tolerance };
        Values::Stored(certify(&task, None, &|_| ()).unwrap().values)
    };
    let by_step = |step: Step, arithmetic| Values::Integrals(step.run(LOBE, &grid, arithmetic, 0).unwrap());
    let mut works: Vec<Work> = vec![
        ("1,024 samples, Hammersley, f32 (the baseline)".into(), Box::new(|| by_step(BASELINE, Arithmetic::F32))),
        ("certified, f16".into(), Box::new(|| certified(Precision::F16, 1e-6))),
        ("certified, f32 within 1e-5".into(), Box::new(|| certified(Precision::F32, 1e-5))),
    ];
    for technique in Technique::all() {
        for step in technique.steps(LOBE) {
            let name = format!("{}, {}", technique.name(), step.name());
            match step {
                Step::Samples(_, PointSet::Hammersley, 1024) if step != BASELINE => {
                    works.push((format!("{name}, f32"), Box::new(move || by_step(step, Arithmetic::F32))));
                }
                // What takes longer than certification tells nothing.
                Step::Rule(rule) if rule.evaluations(grid.len()) <= 1000 * grid.len() => {
                    works.push((name, Box::new(move || by_step(step, Arithmetic::F64))));
                }
                _ => (),
            }
        }
    }
    let truth = cpu::bake(LOBE, &grid, &D10240, &|_| ());
    let mut times = vec![Vec::new(); works.len()];
    for _ in 0..ROUNDS {
        for (times, (_, work)) in times.iter_mut().zip(&works) {
            // Once to warm up: what ran before has cooled the caches and put the threads to sleep.
            drop(work());
            times.push(timed(work).1);
        }
    }
    println!(
        "| 512 x 512, (A, B), GGX height-correlated | ms | ratio | error of A | of B |\n| --- | --- | --- | --- | --- |"
    );
    let base = median(times[0].clone());
    for ((name, work), times) in works.iter().zip(times) {
        let (time, [a, b]) = (median(times), work().errors(&truth));
        println!("| {name} | {:.1} | {:.3} | {a:.1e} | {b:.1e} |", 1e3 * time, time / base);
    }
    println!();
}

/// What a rule takes on a table of 64 x 64.
fn evaluations() {
    let grid = request(64, Precision::F16).grid().unwrap();
    let truth = cpu::bake(LOBE, &grid, &REFERENCE, &|_| ());
    println!("| rule, 64 x 64 | evaluations for a texel | error of A | of B |\n| --- | --- | --- | --- |");
    for name in ["h56", "h130", "l288", "s640", "h288", "h640", "l512", "s2304", "l4608"] {
        let rule = Rule::named(name).unwrap();
        let [a, b] = Values::Integrals(cpu::bake(LOBE, &grid, &rule, &|_| ())).errors(&truth);
        println!("| `{name}` | {:.0} | {a:.1e} | {b:.1e} |", rule.evaluations(grid.len()) as f64 / grid.len() as f64);
    }
    println!();
}

/// Whole processes, from start to file.
fn processes() {
    let Ok(folder) = tempfile::tempdir() else { return };
    println!("| `splitsum bake --backend cpu`, from start to file | ms |\n| --- | --- |");
    for size in ["64", "128", "256", "512", "1024"] {
        let run = |_| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
            command.current_dir(&folder).args(["bake", "--backend", "cpu", "-q", "-o", "x.exr", "--size", size]);
            let (status, time) = timed(|| command.status());
            assert!(status.unwrap().success());
            time
        };
        println!("| --size {size} | {:.1} |", 1e3 * median((0..9).map(run).collect()));
    }
    println!();
}

/// Every Vulkan device: start, kernel, transfer and the device's own time.
fn devices() {
    let devices = list_devices().unwrap_or_default();
    if devices.is_empty() {
        println!("No Vulkan device.");
        return;
    }
    let grid: Grid = request(512, Precision::F16).grid().unwrap();
    println!("| device, 512 x 512 | rule | start ms | bake ms | of which on the device ms | FLOP a texel | GFLOP/s |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for device in devices {
        let options = GpuOptions { device: Some(device.uuid.clone()), ..GpuOptions::default() };
        for name in ["h56", "h288", "h640"] {
            let Method::HSpace(rule) = Rule::named(name).unwrap().method else { continue };
            let (gpu, start) = timed(|| Gpu::open(&options));
            let Ok(gpu) = gpu else { continue };
            let run = |_| {
                let (baked, wall) = timed(|| device_bake(&gpu, LOBE, &grid, &rule, &|_| ()).unwrap());
                (wall, baked.device_seconds)
            };
            let runs: Vec<(f64, Option<f64>)> = (0..7).map(run).collect();
            let wall = median(runs.iter().map(|run| run.0).collect());
            let own: Option<f64> = runs.iter().map(|run| run.1).collect::<Option<Vec<f64>>>().map(median);
            let nodes = rule.nodes();
            let point = |x: f64| Counted::from(x);
            let flop = operations(|| h_space(LOBE, point(0.5), point(0.25), &nodes));
            let rate = own.map_or("-".into(), |s| format!("{:.1}", 1e-9 * flop as f64 * grid.len() as f64 / s));
            let own = own.map_or("no clock".into(), |s| format!("{:.2}", 1e3 * s));
            let (start, wall) = (1e3 * start, 1e3 * wall);
            println!(
                "| {} ({}) | `{name}` | {start:.1} | {wall:.1} | {own} | {flop} | {rate} |",
                device.name, device.driver
            );
        }
    }
    let backend = Backend::cpu();
    let (baked, time) = timed(|| splitsum::bake(&request(512, Precision::F16), &backend, &|_| ()).unwrap());
    let hash = baked.report.certificate().map(|certificate| certificate.blake3.clone()).unwrap_or_default();
    println!("\nThe certified table of 512 x 512 in half: {:.1} ms on the CPU, BLAKE3 {hash}", 1e3 * time);
}
