//! Generated code of approximations at work: in C, C++ and Rust, in GLSL and WGSL in a browser, in
//! Metal's words through a C++ compiler, against the approximation itself in f32; and every
//! language through a compiler. What is not installed is reported as ignored, with the reason;
//! where SPLITSUM_REQUIRE_READERS is set, that is a failure instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../common/mod.rs"]
mod common;
mod browser;
mod cases;
mod compilers;
mod native;
mod properties;

use common::{with_modules, with_named, with_program};
use libtest_mimic::{Arguments, Trial};

/// A test that fails by panicking.
fn holds(name: &str, test: fn()) -> Trial {
    Trial::test(name, move || {
        test();
        Ok(())
    })
}

fn main() {
    let trials = vec![
        holds("words hold the numbers", properties::words_hold_the_numbers),
        holds("costs are those counted by hand", properties::costs_are_those_counted_by_hand),
        holds("what has no code is refused", properties::what_has_no_code_is_refused),
        Trial::test("naga takes WGSL", compilers::naga_takes_wgsl),
        Trial::test("rustc takes the code, and it gives the values", native::rust),
        with_program("gcc", "gcc takes the code, and it gives the values", native::c),
        with_program("g++", "g++ takes the same code as C++", native::cpp),
        with_program("g++", "g++ takes Metal's words, and they give the values", native::metal),
        with_program("glslangValidator", "glslang takes GLSL and HLSL", compilers::glslang),
        with_named("SPLITSUM_SLANGC", "slangc takes HLSL", |slangc| compilers::slangc(&slangc)),
        with_modules("a browser gives the values, by WebGL2 and by WebGPU", browser::every_case),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
