//! examples/build_script as its user builds it: a crate elsewhere, whose build script bakes a
//! table.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::ggx;
use splitsum::brdf::Masking;
use splitsum::{Backend, Dfg, DfgChannels, Fresnel, Lut, Precision, Request};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn another_crate_bakes_a_table_and_embeds_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let example = root.join("examples/build_script");
    let folder = tempfile::tempdir().unwrap();
    let copy = |name: &str| fs::copy(example.join(name), folder.path().join(name)).unwrap();
    fs::create_dir(folder.path().join("src")).unwrap();
    copy("build.rs");
    copy("src/main.rs");
    let manifest = fs::read_to_string(example.join("Cargo.toml")).unwrap();
    let path = format!("path = {:?}", root.to_str().unwrap());
    fs::write(folder.path().join("Cargo.toml"), manifest.replace("path = \"../..\"", &path))
        .unwrap();
    // The versions that this crate was built with are at hand; nothing is looked for elsewhere.
    fs::copy(root.join("Cargo.lock"), folder.path().join("Cargo.lock")).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(&folder).args(["run", "--offline", "--quiet"]);
    cargo.env("CARGO_TARGET_DIR", folder.path().join("target"));
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let lobe = ggx(Masking::HeightCorrelated);
    let lut = Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All).unwrap());
    let request = Request::with_default_axes(lut, (64, 64), Precision::F16).unwrap();
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    let [a0, a1, b0, b1] = *table.bytes(0).last_chunk().unwrap();
    let bits = |low, high| u16::from_le_bytes([low, high]);
    let expected = format!("A {:#06x}, B {:#06x}\n", bits(a0, a1), bits(b0, b1));
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
}
