//! Other people's readers on our files: every container in every storage, read back value by value.
//! A reader that is not installed is reported as ignored, with the reason; where
//! SPLITSUM_REQUIRE_READERS is set (in .ci/run, which installs them), that is a failure instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../common/mod.rs"]
mod common;
mod crates;
mod files;
mod python;
mod web;

use common::{with_modules, with_named};
use libtest_mimic::Arguments;

fn main() {
    let trials = vec![
        with_named(
            "SPLITSUM_PYTHON",
            "OpenEXR, OpenImageIO, NumPy, Pillow and Panda3D read every value",
            |python| python::read_everything(&python),
        ),
        with_named(
            "SPLITSUM_PYTHON",
            "the metadata is where OpenEXR and OpenImageIO look for it",
            |python| python::metadata_is_found(&python),
        ),
        with_named(
            "SPLITSUM_FOREIGN",
            "the crates ktx2 and dds and Bevy's loader read every value",
            |program| crates::read_everything(&program),
        ),
        with_modules(
            "ktx-parse, three.js and Babylon.js read what they can, and the docs say the rest",
            web::read_everything,
        ),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
