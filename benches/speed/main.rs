//! Speed and errors on this machine: `cargo bench`. The methods are measured by the study behind
//! `splitsum chart speed`, each in turn with the baseline, so that the ratios count; besides, whole
//! processes, and devices from start to result. It prints Markdown.
#![allow(clippy::unwrap_used, reason = "a benchmark fails by panicking")]

mod counted;
mod lobes;

use counted::{Counted, operations};
use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Backend, Gpu, bake as device_bake, list_devices};
use splitsum::brdf::fresnel::Schlick;
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::compare::study::speed::{Measurement, Plan, Who, measure};
use splitsum::compare::study::{Machine, median, timed};
use splitsum::compare::technique::{Arithmetic, Technique};
use splitsum::integrate::half_vectors::half_vectors;
use splitsum::integrate::rule::{Method, Rule};
use std::process::Command;

const LOBE: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

/// Texels along either edge of the table that every method bakes.
const SIZE: usize = 512;

fn main() {
    let processor = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = Machine::processor_in(&processor).unwrap_or("unknown");
    let (threads, version) = (rayon::current_num_threads(), env!("CARGO_PKG_VERSION"));
    println!("CPU: {name}, {threads} threads; splitsum {version}\n");
    methods();
    lobes::lobes();
    processes();
    glass();
    devices();
    lobes::on_devices();
    certified();
}

/// Whether a row is printed: a sampler at the baseline's set and cost, the others in the f64 in
/// which tables are baked. docs/charts/speed.md has all rows of a smaller table.
fn is_shown(measurement: &Measurement) -> bool {
    match measurement.technique {
        Technique::Samples(_) => {
            measurement.who == Who::Cpu(Arithmetic::F32) && measurement.step == "hammersley 1024"
        }
        _ => measurement.who == Who::Cpu(Arithmetic::F64),
    }
}

/// Methods on the CPU against the baseline.
fn methods() {
    let plan = Plan { lobe: LOBE.into(), size: SIZE, seed: 1, quick: false };
    let speed = measure(plan, &[], &|_| ()).unwrap();
    let baseline = 1e3 * speed.baseline_seconds;
    println!(
        "{SIZE} x {SIZE}, A and B, GGX height-correlated; the baseline takes {baseline:.1} ms\n"
    );
    println!(
        "| method | ms | ratio | evaluations | error of A | of B |\n{}",
        "| --- ".repeat(6) + "|"
    );
    for Measurement { technique, step, evaluations, seconds, ratio, errors, .. } in
        speed.measurements.iter().filter(|measurement| is_shown(measurement))
    {
        let (name, ms, [a, b]) = (technique.name(), 1e3 * seconds, errors.max);
        println!(
            "| {name}, {step} | {ms:.1} | {ratio:.3} | {evaluations:.0} | {a:.1e} | {b:.1e} |"
        );
    }
    println!();
}

/// Whole processes, from start to file.
fn processes() {
    let Ok(folder) = tempfile::tempdir() else { return };
    println!("| `splitsum bake --backend cpu`, from start to file | ms |\n| --- | --- |");
    for size in ["64", "128", "256", "512", "1024"] {
        let seconds = process(&folder, 9, &["--backend", "cpu", "--size", size]);
        println!("| --size {size} | {:.1} |", 1e3 * seconds);
    }
    println!();
}

/// The median time of whole bakes with these arguments.
fn process(folder: &tempfile::TempDir, runs: usize, arguments: &[&str]) -> f64 {
    let run = |_| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        command.current_dir(folder).args(["bake", "-q", "-o", "x.exr"]).args(arguments);
        let (status, time) = timed(|| command.status());
        assert!(status.unwrap().success(), "{arguments:?}");
        time
    };
    median((0..runs).map(run).collect())
}

/// Tables of glass over n·v, roughness and 32 indices of refraction, from either side, from start
/// to file: by the CPU, then by every device; ratios are to the first row.
fn glass() {
    let Ok(folder) = tempfile::tempdir() else { return };
    let table = ["--lut", "glass", "--side", "both", "--z", "ior,max=2", "--size", "32x32x32"];
    let ways: [(&str, &[&str]); 3] = [
        ("f32 within 1e-5, certified", &["--precision", "f32", "--tolerance", "1e-5"]),
        (
            "f32 within 1e-5, a sample measured",
            &["--precision", "f32", "--tolerance", "1e-5", "--certify", "off"],
        ),
        ("f16, certified", &[]),
    ];
    println!("| glass, 32 x 32 x 32, R and T from both sides | by | ms | ratio |");
    println!("| --- | --- | --- | --- |");
    let mut first = None;
    let mut row = |name: &str, by: &str, backend: &[&str], way: &[&str]| {
        let seconds = process(&folder, 3, &[&table, backend, way].concat());
        let ratio = seconds / *first.get_or_insert(seconds);
        println!("| {name} | {by} | {:.0} | {ratio:.2} |", 1e3 * seconds);
    };
    for (name, way) in ways {
        row(name, "CPU", &["--backend", "cpu"], way);
    }
    for device in list_devices().unwrap_or_default() {
        let backend = ["--backend", "vulkan", "--device", &device.uuid];
        // What is certified within a tolerance is the CPU's alone.
        for (name, way) in &ways[1..] {
            row(name, &device.name, &backend, way);
        }
    }
    println!();
}

/// Every Vulkan device: start, kernel, transfer and the device's own time.
fn devices() {
    let devices = list_devices().unwrap_or_default();
    if devices.is_empty() {
        println!("No Vulkan device.\n");
        return;
    }
    let grid = lobes::request(lobes::dfg(LOBE), SIZE).grid().clone();
    println!(
        "| device, 512 x 512 | rule | start ms | bake ms | of which on the device ms | FLOP a \
         texel | GFLOP/s |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for device in devices {
        let options = GpuOptions { device: Some(device.uuid.clone()), ..GpuOptions::default() };
        for name in ["h56", "h288", "h640"] {
            let Method::HalfVectors(rule) = Rule::named(name).unwrap().method else { continue };
            let (gpu, start) = timed(|| Gpu::open(&options));
            let Ok(gpu) = gpu else { continue };
            let run = |_| {
                let (baked, wall) = timed(|| {
                    device_bake(&gpu, (LOBE, Fresnel::Schlick), &grid, &rule, &|_| ()).unwrap()
                });
                (wall, baked.device_seconds)
            };
            let runs: Vec<(f64, Option<f64>)> = (0..7).map(run).collect();
            let wall = median(runs.iter().map(|run| run.0).collect());
            let own: Option<f64> =
                runs.iter().map(|run| run.1).collect::<Option<Vec<f64>>>().map(median);
            let nodes = rule.nodes();
            let point = |x: f64| Counted::from(x);
            let flop = operations(|| half_vectors(LOBE, Schlick, point(0.5), point(0.25), &nodes));
            let rate = own.map_or("-".into(), |s| {
                format!("{:.1}", 1e-9 * flop as f64 * grid.len() as f64 / s)
            });
            let own = own.map_or("no clock".into(), |s| format!("{:.2}", 1e3 * s));
            let (start, wall) = (1e3 * start, 1e3 * wall);
            println!(
                "| {} ({}) | `{name}` | {start:.1} | {wall:.1} | {own} | {flop} | {rate} |",
                device.name, device.driver
            );
        }
    }
    println!();
}

/// The hash of a certified table, the same on every machine.
fn certified() {
    let backend = Backend::cpu();
    let baked = splitsum::bake(&lobes::request(lobes::dfg(LOBE), SIZE), &backend).unwrap();
    let hash = baked
        .table
        .claim(0)
        .certificate()
        .map(|certificate| certificate.blake3.clone())
        .unwrap_or_default();
    println!("The certified table of 512 x 512 in half has BLAKE3 {hash}");
}
