//! The special functions of the models against values in 50 digits (tests/figures/special.csv), at
//! edges and at random arguments; and in lanes against single numbers, to the bit.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::numeric::lanes::{F64x8, Real};
use splitsum::numeric::special::{exponential, ierfc, log1p_ratio, logarithm};

const FIGURES: &str = include_str!("figures/special.csv");

/// The arguments and values of a function.
fn figures(function: &str) -> Vec<(f64, f64)> {
    let rows = FIGURES.lines().filter(|line| !line.starts_with('#'));
    let fields = rows.map(|row| row.split(',').collect::<Vec<_>>());
    let own = fields.filter(|fields| fields[0] == function);
    own.map(|fields| (fields[1].parse().unwrap(), fields[2].parse().unwrap())).collect()
}

/// The largest error of a function, each divided by what it may be there.
fn worst(function: &str, of: impl Fn(f64) -> f64, may: impl Fn(f64) -> f64) -> f64 {
    let figures = figures(function);
    assert!(figures.len() >= 50, "{} values of {function}", figures.len());
    let error = |&(x, value): &(f64, f64)| (of(x) - value).abs() / may(value);
    figures.iter().map(error).fold(0.0, f64::max)
}

/// A function in eight lanes gives each the bits of the single number.
fn lanes_agree(function: &str, single: impl Fn(f64) -> f64, lanes: impl Fn(F64x8) -> F64x8) {
    let arguments: Vec<f64> = figures(function).into_iter().map(|figure| figure.0).collect();
    for chunk in arguments.chunks(8) {
        let at_once = lanes(F64x8(std::array::from_fn(|i| chunk[i.min(chunk.len() - 1)])));
        for (x, lane) in chunk.iter().zip(at_once.0) {
            assert_eq!(lane.to_bits(), single(*x).to_bits(), "{function} of {x:e}");
        }
    }
}

/// The bounds are those of the functions' doc comments; half a unit more is the figures' rounding.
#[test]
fn special_functions_keep_their_bounds() {
    let unit = |value: f64| libm::exp2(libm::log2(value.abs()).floor() - 52.0);
    let units = |count: f64| move |value: f64| (count + 0.5) * unit(value);
    let errors = [
        worst("exponential", exponential, units(2.0)),
        worst("logarithm", logarithm, |value| units(2.0)(value.abs().max(1.0))),
        worst("log1p_ratio", log1p_ratio, units(4.0)),
        worst("ierfc", ierfc, |_| 3e-16),
    ];
    assert!(errors.iter().all(|error| *error <= 1.0), "{errors:?}");
    // Six units more would be noticed.
    let planted = |x: f64| exponential(x) * (1.0 + 6.0 * f64::EPSILON);
    assert!(worst("exponential", planted, units(2.0)) > 1.0);
}

#[test]
fn a_lane_of_a_special_function_holds_the_bits_of_a_single_number() {
    lanes_agree("exponential", exponential, exponential);
    lanes_agree("logarithm", logarithm, logarithm);
    lanes_agree("log1p_ratio", log1p_ratio, log1p_ratio);
    lanes_agree("ierfc", ierfc, ierfc);
    // What is called, not inlined, computes the same.
    use splitsum::brdf::ndf::beckmann::{ProjectedArea, beckmann_projected_area};
    let (c, alpha) = (F64x8(std::array::from_fn(|i| i as f64 / 7.0)), F64x8::from(0.3));
    let called = c.call::<ProjectedArea>(alpha);
    for (c, called) in c.0.into_iter().zip(called.0) {
        assert_eq!(called.to_bits(), beckmann_projected_area(c, 0.3).to_bits(), "{c}");
    }
}
