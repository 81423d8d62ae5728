//! Every WGSL function of a model alone against its f64 twin, as tests/vulkan/twins.rs does it.

use crate::twins::{Twin, small, unit};
use splitsum::brdf::fresnel::{
    conductor_reflectance, dielectric_reflectance, schlick_f82_weights, schlick_power_weights,
    schlick_weight, schlick_weights,
};
use splitsum::brdf::masking::{
    approx_projected_area, height_correlated, implicit, neubelt, schlick_smith, separable,
};
use splitsum::brdf::ndf::beckmann::{
    beckmann_projected_area, beckmann_slope_density, beckmann_width, walter_projected_area,
};
use splitsum::brdf::ndf::blinn_phong::{blinn_phong_end, blinn_phong_slope_density};
use splitsum::brdf::ndf::charlie::{
    charlie_lambda, charlie_projected_area, charlie_slope_density, charlie_width,
};
use splitsum::brdf::ndf::ggx::{ggx_projected_area, ggx_slope_density};
use splitsum::numeric::special::{
    atanh_ratio, expm1_reduced, exponential, ierfc, log1p_ratio, logarithm, logarithm_parts,
    power_of_two, power_parts,
};

pub fn twins() -> Vec<Twin> {
    let four = |f: fn([f64; 4]) -> f64| move |a| [f(a), 0.0, 0.0, 0.0];
    let three = |random: &mut crate::common::Random| {
        [small(random), small(random), small(random), small(random)]
    };
    vec![
        Twin {
            name: "schlick_weight",
            wgsl: "vec4(schlick_weight(p.x), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| schlick_weight(a[0]))),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            // 1 - x is exact to an ulp of 1, and its fifth power five times as far off.
            ulps: 8.0,
            scale: 0.0,
        },
        Twin {
            name: "schlick_weights, schlick_f82_weights",
            wgsl: "vec4(schlick_weights(p.x), schlick_f82_weights(p.x).xy)",
            rust: Box::new(|a| {
                let ([a0, b0], [a1, b1, _]) = (schlick_weights(a[0]), schlick_f82_weights(a[0]));
                [a0, b0, a1, b1]
            }),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            ulps: 8.0,
            // 1 - w is off by the rounding of w.
            scale: 1.0,
        },
        Twin {
            name: "schlick_f82_weights, those that vanish",
            wgsl: "vec4(schlick_f82_weights(p.x).yz, 0.0, 0.0)",
            rust: Box::new(|a| {
                let [_, b, c] = schlick_f82_weights(a[0]);
                [b, c, 0.0, 0.0]
            }),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            // As for the weight; once more 1 - x, and two products.
            ulps: 10.0,
            scale: 0.0,
        },
        Twin {
            name: "schlick_power_weights",
            wgsl: "vec4(schlick_power_weights(p.x, 3u, 1u), schlick_power_weights(p.x, 7u, 0u))",
            rust: Box::new(|a| {
                let ([a0, b0], [a1, b1]) =
                    (schlick_power_weights(a[0], 3, 1), schlick_power_weights(a[0], 7, 0));
                [a0, b0, a1, b1]
            }),
            arguments: |random| [unit(random), 0.0, 0.0, 0.0],
            // 1 - x and a product for each factor; 1 - w is off by the rounding of w.
            ulps: 15.0,
            scale: 1.0,
        },
        Twin {
            name: "dielectric_reflectance",
            wgsl: "vec4(dielectric_reflectance(p.x, p.y), dielectric_reflectance(p.x, 1e-6 * p.y), \
                   dielectric_reflectance(p.x, 0.0), 0.0)",
            rust: Box::new(|a| {
                let tiny = f64::from(1e-6 * a[1] as f32);
                [
                    dielectric_reflectance(a[0], a[1]),
                    dielectric_reflectance(a[0], tiny),
                    dielectric_reflectance(a[0], 0.0),
                    0.0,
                ]
            }),
            arguments: |random| [unit(random), 15.0 * unit(random), 0.0, 0.0],
            // Twice what a holds: two roundings of g, doubled by the square, three products, a sum
            // and a quotient.
            ulps: 24.0,
            scale: 0.0,
        },
        Twin {
            name: "conductor_reflectance",
            wgsl: "vec4(conductor_reflectance(p.x, p.y, p.z), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| conductor_reflectance(a[0], a[1], a[2]))),
            arguments: |random| {
                [unit(random), 0.01 + 10.0 * unit(random), 0.5 + 10.0 * unit(random), 0.0]
            },
            // sum - turned cancels where little is reflected.
            ulps: 16.0,
            scale: 1.0,
        },
        Twin {
            name: "ggx_slope_density",
            wgsl: "vec4(ggx_slope_density(p.x), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| ggx_slope_density(a[0]))),
            arguments: |random| [1e6 * small(random) * small(random), 0.0, 0.0, 0.0],
            ulps: 9.0,
            scale: 0.0,
        },
        Twin {
            name: "ggx_projected_area",
            wgsl: "vec4(ggx_projected_area(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| ggx_projected_area(a[0], a[1]))),
            arguments: three,
            ulps: 5.0,
            scale: 0.0,
        },
        Twin {
            name: "height_correlated, separable, schlick_smith",
            wgsl: "vec4(height_correlated(p.x, p.y, p.z, p.w), separable(p.x, p.y, p.z, p.w), \
                   schlick_smith(p.x, p.y, p.z), 0.0)",
            rust: Box::new(|[x, mu, area_l, area_v]| {
                [
                    height_correlated(x, mu, area_l, area_v),
                    separable(x, mu, area_l, area_v),
                    schlick_smith(x, mu, area_l),
                    0.0,
                ]
            }),
            arguments: three,
            ulps: 12.0,
            scale: 0.0,
        },
        Twin {
            name: "exponential, expm1_reduced",
            wgsl: "vec4(exponential(p.x), exponential(-p.x), expm1_reduced(p.y), 0.0)",
            rust: Box::new(|a| [exponential(a[0]), exponential(-a[0]), expm1_reduced(a[1]), 0.0]),
            arguments: |random| [-80.0 * small(random), 0.34 * small(random), 0.0, 0.0],
            ulps: 3.0,
            scale: 0.0,
        },
        Twin {
            name: "logarithm_parts, power_parts, power_of_two",
            wgsl: "power_as_vector(p.x, p.y)",
            // Which of two powers of 2 is the nearer is a matter of rounding, but not their product
            // with the rest.
            rust: Box::new(|a| {
                let (power, rest) = power_parts(a[0], 0.1982421875, a[1]);
                let (k, log) = logarithm_parts(a[0]);
                [power * (1.0 + rest), power_of_two(3.0), k, log]
            }),
            arguments: |random| [small(random), -0.03 * unit(random), 0.0, 0.0],
            ulps: 2.0,
            scale: 0.0,
        },
        Twin {
            name: "atanh_ratio, logarithm, log1p_ratio",
            wgsl: "vec4(atanh_ratio(p.x), logarithm(p.y), log1p_ratio(p.y), log1p_ratio(p.x))",
            rust: Box::new(|a| {
                [atanh_ratio(a[0]), logarithm(a[1]), log1p_ratio(a[1]), log1p_ratio(a[0])]
            }),
            arguments: |random| [small(random) / 9.0, 2.0 + 1e6 * small(random), 0.0, 0.0],
            ulps: 7.0,
            scale: 0.0,
        },
        Twin {
            name: "ierfc",
            wgsl: "vec4(ierfc(p.x), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| ierfc(a[0]))),
            arguments: |random| [7.0 * unit(random), 0.0, 0.0, 0.0],
            // The fit is within 1e-8, and beyond 4 the f64 form itself cancels.
            ulps: 3.0,
            scale: 0.25,
        },
        Twin {
            name: "beckmann_slope_density, beckmann_width",
            wgsl: "vec4(beckmann_slope_density(p.x), beckmann_width(p.y, p.z), 0.0, 0.0)",
            rust: Box::new(|a| {
                [beckmann_slope_density(a[0]), beckmann_width(a[1], a[2]), 0.0, 0.0]
            }),
            arguments: |random| [20.0 * unit(random), unit(random), small(random), 0.0],
            ulps: 5.0,
            scale: 0.0,
        },
        Twin {
            name: "beckmann_projected_area",
            wgsl: "vec4(beckmann_projected_area(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| beckmann_projected_area(a[0], a[1]))),
            arguments: three,
            ulps: 6.0,
            scale: 0.0,
        },
        Twin {
            name: "walter_projected_area",
            wgsl: "vec4(walter_projected_area(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| walter_projected_area(a[0], a[1]))),
            // Away from its jump, on whose side a rounding decides.
            arguments: |random| {
                let (c, alpha) = (small(random), small(random));
                let a = c / beckmann_width(c, alpha);
                [if (a - 1.6).abs() < 1e-3 { 0.5 * c } else { c }, alpha, 0.0, 0.0]
            },
            ulps: 8.0,
            scale: 0.0,
        },
        Twin {
            name: "blinn_phong_slope_density",
            wgsl: "vec4(blinn_phong_slope_density(p.x, p.y), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| blinn_phong_slope_density(a[0], a[1]))),
            arguments: |random| [20.0 * unit(random), small(random), 0.0, 0.0],
            // The exponent, up to 20, is rounded five times, and that is an error of the power.
            ulps: 60.0,
            scale: 0.0,
        },
        Twin {
            name: "blinn_phong_end",
            wgsl: "vec4(blinn_phong_end(p.x, 20.0), 0.0, 0.0, 0.0)",
            rust: Box::new(four(|a| blinn_phong_end(a[0], 20.0))),
            arguments: three,
            // (e^u - 1)/u loses up to 1/u = 10 of its ulps; its series leaves out u⁴/120 = 8e-7. At
            // α = 1, u is 40.
            ulps: 120.0,
            scale: 0.0,
        },
        Twin {
            name: "charlie_width, charlie_slope_density",
            wgsl: "vec4(charlie_width(p.x), charlie_slope_density(p.y, p.x), 0.0, 0.0)",
            rust: Box::new(|a| [charlie_width(a[0]), charlie_slope_density(a[1], a[0]), 0.0, 0.0]),
            arguments: |random| [small(random), 0.1 + 1e4 * small(random), 0.0, 0.0],
            // As for Blinn-Phong: the exponent is up to 20.
            ulps: 60.0,
            scale: 0.0,
        },
        Twin {
            name: "charlie_lambda, charlie_projected_area",
            wgsl: "vec4(charlie_lambda(p.x, p.y), charlie_projected_area(p.z, p.y), 0.0, 0.0)",
            rust: Box::new(|a| {
                [charlie_lambda(a[0], a[1]), charlie_projected_area(a[2], a[1]), 0.0, 0.0]
            }),
            arguments: |random| [0.5 * small(random), small(random), small(random), 0.0],
            // 7e-7 of Λ, which is made of three from n·l = 1/2 up.
            ulps: 13.0,
            scale: 0.0,
        },
        Twin {
            name: "approx_projected_area, implicit, neubelt",
            wgsl: "vec4(approx_projected_area(p.x, p.y), implicit(p.x), neubelt(p.x, p.y), 0.0)",
            rust: Box::new(|a| {
                [approx_projected_area(a[0], a[1]), implicit(a[0]), neubelt(a[0], a[1]), 0.0]
            }),
            arguments: three,
            ulps: 5.0,
            scale: 0.0,
        },
    ]
}
