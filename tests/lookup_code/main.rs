//! Generated lookup code at work: in C, C++ and Rust, in GLSL and WGSL in a browser, in Metal's
//! words through a C++ compiler, against bilinear lookup of the stored values in f64; and every
//! language through a compiler. What is not installed is reported as ignored, with the reason;
//! where SPLITSUM_REQUIRE_READERS is set, that is a failure instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../common/mod.rs"]
mod common;
mod browser;
mod cases;
mod compilers;
mod native;
mod spheres;

use common::{with_modules, with_named, with_program};
use libtest_mimic::{Arguments, Trial};

fn main() {
    let trials = vec![
        Trial::test("fields undo what channels were scaled by", cases::fields_are_the_integrals),
        Trial::test("further functions need their numbers", compilers::extras_need_their_numbers),
        Trial::test("naga takes WGSL", compilers::naga_takes_wgsl),
        Trial::test("rustc takes the code, and it gives the values", native::rust),
        with_program("gcc", "gcc takes the code, and it gives the values", native::c),
        with_program("g++", "g++ takes the same header as C++", native::cpp),
        with_program("g++", "g++ takes Metal's words, and they give the values", native::metal),
        with_program("glslangValidator", "glslang takes GLSL and HLSL", compilers::glslang),
        with_named("SPLITSUM_SLANGC", "slangc takes HLSL", |slangc| compilers::slangc(&slangc)),
        with_modules(
            "a browser reads every preset's table, by WebGL2 and by WebGPU",
            browser::every_preset,
        ),
        with_modules("three.js renders the same spheres with our table", spheres::are_the_same),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
