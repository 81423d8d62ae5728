//! The generated WGSL of approximations on a device, against the CPU in f32.

use crate::DeviceTest;
use crate::approximation_cases::{Case, Expected, allowed, approximation, cases};
use libtest_mimic::Failed;
use splitsum::approximation::{Across, Along, Channels, Region, Shape, Storage};
use splitsum::backend::Gpu;
use splitsum::backend::vulkan::evaluate::evaluate;
use splitsum::backend::wgsl::module;
use splitsum::lookup::Language;

pub const TESTS: &[DeviceTest] = &[
    ("lookups of approximations are those of the CPU", |gpu| {
        cases().iter().try_for_each(|case| compare(gpu, case))
    }),
    ("lookups of a large net are those of the CPU", |gpu| {
        let is_llvmpipe = gpu.info().name.starts_with("llvmpipe");
        compare(gpu, &net(if is_llvmpipe { SMALLER } else { LARGEST }))
    }),
];

const POINTS: usize = 4096;

/// The largest net that plans try.
const LARGEST: [usize; 2] = [28, 42];

/// The net of an error of 4e-4 over every roughness, for llvmpipe: its compiler takes time that
/// grows faster than the square of an array's length, 0.5 s for 128 words, 1.4 s for 256, 7.6 s for
/// 512 and 50 s for the 1,176 of the largest net. A device that takes more than 20 s fails.
const SMALLER: [usize; 2] = [12, 16];

/// A cubic net of this size, in codes of 16 bits.
fn net(size: [usize; 2]) -> Case {
    let shape = Shape::Spline { x: Along::Layer(3.0), y: Across::Sqrt, size, degree: 3 };
    let region = Region { least_nov: 0.0, roughness: [0.0, 1.0] };
    let count = size[0] * size[1];
    let made = approximation(300, shape, Channels::EnergyRest, Storage::Unorm16, region, count);
    Case { name: "net".into(), approximations: vec![made] }
}

/// Compares A, B and E(F0), or E(F0) alone.
fn compare(gpu: &Gpu, case: &Case) -> Result<(), Failed> {
    let points = case.points(POINTS);
    let arguments: Vec<[f32; 4]> = points
        .iter()
        .map(|point| [point.nov, point.roughness, point.f0, point.material as f32])
        .collect();
    let [place, all] = case.arguments(["p.x", "p.y", "i32(p.w)", "p.z"]);
    let name = &case.name;
    let pair = match case.has_scale_bias() {
        true => format!("{name}_scale_bias({place})"),
        false => "vec2<f32>()".into(),
    };
    let expression = format!("vec4<f32>({pair}, {name}_albedo({all}), 0.0)");
    let source = [module::NODES, &case.code(Language::Wgsl)?].join("\n");
    let results = evaluate(gpu, &source, &expression, &[], &arguments)?;
    assert_eq!(results.len(), POINTS);
    for ((result, Expected { values, scale }), point) in
        results.iter().zip(case.expected(&points)).zip(&points)
    {
        let found = if case.has_scale_bias() { &result[..3] } else { &result[2..3] };
        assert_eq!(found.len(), values.len());
        for (found, expected) in found.iter().zip(values) {
            let difference = (f64::from(*found) - expected).abs();
            if difference.is_nan() || difference > allowed(case) * scale {
                return Err(format!("{name} at {point:?}: {found}, not {expected}").into());
            }
        }
    }
    Ok(())
}
