//! The generated WGSL of approximations on a device, against the CPU in f32.

use crate::DeviceTest;
use crate::approximation_cases::{Case, Expected, allowed, cases};
use libtest_mimic::Failed;
use splitsum::backend::Gpu;
use splitsum::backend::vulkan::evaluate::evaluate;
use splitsum::lookup::Language;

pub const TESTS: &[DeviceTest] = &[("lookups of approximations are those of the CPU", |gpu| {
    cases().iter().try_for_each(|case| compare(gpu, case))
})];

const POINTS: usize = 4096;

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
    let results = evaluate(gpu, &case.code(Language::Wgsl)?, &expression, &[], &arguments)?;
    for ((result, Expected { values, scale }), point) in
        results.iter().zip(case.expected(&points)).zip(&points)
    {
        let found = if case.has_scale_bias() { &result[..3] } else { &result[2..3] };
        for (found, expected) in found.iter().zip(values) {
            let difference = (f64::from(*found) - expected).abs();
            if difference.is_nan() || difference > allowed(case) * scale {
                return Err(format!("{name} at {point:?}: {found}, not {expected}").into());
            }
        }
    }
    Ok(())
}
