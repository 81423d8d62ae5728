//! The formulas of the textbook in WGSL equal their twins where neither fails; in the corners ours
//! hold their bounds on a device.

use crate::DeviceTest;
use crate::twins::{Twin, compare, unit};
use libtest_mimic::Failed;
use splitsum::backend::Gpu;
use splitsum::brdf::Ndf;
use splitsum::compare::device::formula_source;
use splitsum::compare::study::stability::cases;
use splitsum::compare::textbook::{
    lambda, textbook_beckmann, textbook_blinn_phong, textbook_ggx, textbook_sampled_slope,
    textbook_visibility,
};

pub const TESTS: &[DeviceTest] = &[
    ("formulas of the textbook equal their twins", |gpu| {
        let source = formula_source(Ndf::Ggx);
        twins().iter().try_for_each(|twin| compare(gpu, &source, &[], twin))
    }),
    ("what replaces the textbook holds its bounds", ours_hold),
];

fn twins() -> Vec<Twin> {
    // Rough lobes seen from well above the horizon, where what cancels leaves most digits.
    let benign = |random: &mut crate::common::Random| {
        [0.5 + 0.4 * unit(random), 0.5 + 0.4 * unit(random), 0.5, 0.0]
    };
    vec![
        Twin {
            name: "distributions",
            wgsl: "vec4(textbook_ggx(p.x, p.y), textbook_blinn_phong(p.x, 4.0 * p.y), \
                   textbook_beckmann(p.x, p.y), 0.0)",
            rust: Box::new(|[nh, alpha, ..]| {
                [
                    textbook_ggx(nh, alpha),
                    textbook_blinn_phong(nh, 4.0 * alpha),
                    textbook_beckmann(nh, alpha),
                    0.0,
                ]
            }),
            arguments: benign,
            // exp and pow may be off by 3 + 2|x| and by 2^-21 of the logarithm: Vulkan's bounds,
            // for exponents up to 12.
            ulps: 60.0,
            scale: 0.0,
        },
        Twin {
            name: "masking and sampling",
            wgsl: "vec4(lambda(p.x, p.y), textbook_visibility(p.z, p.x, p.y), \
                   textbook_sampled_slope(p.x, p.y), 0.0)",
            rust: Box::new(|[c, alpha, nl, _]| {
                [
                    lambda(c, alpha),
                    textbook_visibility(nl, c, alpha),
                    textbook_sampled_slope(c, alpha),
                    0.0,
                ]
            }),
            arguments: benign,
            // √(1 + x) - 1 loses a digit where x is a tenth.
            ulps: 60.0,
            scale: 0.0,
        },
    ]
}

fn ours_hold(gpu: &Gpu) -> Result<(), Failed> {
    for case in cases() {
        for map in case.maps_on(gpu, [37, 23])?.iter().filter(|map| map.variant.starts_with("ours"))
        {
            let largest = map.largest();
            if largest > case.holds || !map.faults.is_empty() {
                let (name, faults) = (case.name, map.faults.len());
                return Err(format!(
                    "{name}: {largest:e} and {faults} faults; {:e} allowed",
                    case.holds
                )
                .into());
            }
        }
    }
    Ok(())
}
