//! Who computes a table, and that it does not matter: the rule of `--backend auto`, and the same
//! bytes on any number of threads. That devices give them too is tested in
//! tests/vulkan/certified.rs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use program::{ok, run, splitsum, stderr};
use splitsum::backend::{Backend, BackendChoice, VULKAN_START};
use splitsum::brdf::Microfacet;
use std::fs;
use tempfile::tempdir;

/// A bake that is worth a device's while.
const LARGE: &str = "bake --model beckmann --fresnel dielectric:1.5 --size 192 -o a.exr";

#[test]
fn the_same_request_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = tempdir().unwrap();
    let lobes = Microfacet::all().map(|Microfacet { ndf, masking }| {
        // Charlie's albedo is infinite at n.v = 0, and certified from a roughness of 0.07 on.
        format!(
            "--model {ndf} --masking {masking} --size 128 --x nov,min=1e-4 --y roughness,min=0.07"
        )
    });
    for table in ["--size 512".to_owned()].into_iter().chain(lobes) {
        let bytes = |threads| {
            ok(&folder, &format!("bake --backend cpu {table} -q -o - --threads {threads}")).stdout
        };
        let one = bytes(1);
        assert!(one.len() > 500);
        assert!([2, 5].into_iter().all(|threads| bytes(threads) == one), "{table}");
    }
}

#[test]
fn auto_takes_a_device_when_it_saves_more_than_starting_it_costs() {
    let auto = Backend::open(BackendChoice::Auto, &Default::default()).unwrap();
    let small = auto.choose(None, 0.5 * VULKAN_START).unwrap();
    assert!(small.gpu.is_none() && small.reason.unwrap().contains("starting one takes 200 ms"));
    // Where there is a device it is taken, else the reason is that there is none.
    let large = auto.choose(None, 2.0 * VULKAN_START).unwrap();
    assert_eq!(large.gpu.is_some(), large.reason.unwrap().contains("it saves 400 ms"));
    let folder = tempdir().unwrap();
    for (bake, reason) in [
        ("bake -o a.exr", "would save 0.0 ms"),
        ("bake --size 8 --model beckmann -o a.exr", "and starting one takes 200 ms"),
        (
            "bake --precision f32 --model beckmann -o a.exr",
            "one whose values are rounded once, which a device can decide, got f32",
        ),
        ("bake --lut diffuse -o a.exr", "closed forms"),
    ] {
        let text = stderr(&ok(&folder, bake));
        assert!(
            text.contains("computed  by CPU, f64; not on Vulkan: ") && text.contains(reason),
            "{bake}: {text}"
        );
    }
    let text = stderr(&ok(&folder, LARGE));
    assert!(text.contains("by Vulkan, f32: ") || text.contains("not on Vulkan: Vulkan"), "{text}");
}

#[test]
fn what_only_the_cpu_can_do_is_an_error_on_vulkan_and_a_reason_on_auto() {
    // Without a driver both end at the missing device, so this looks at the choice alone.
    let folder = tempdir().unwrap();
    let output = run(&folder, "bake --size 4 --rule l288 -o a.exr");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("computed  by CPU, f64; not on Vulkan: rule: expected"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn without_a_driver_auto_says_why_and_vulkan_fails() {
    let folder = tempdir().unwrap();
    let with_drivers = |drivers: &str, arguments: &str| {
        splitsum(folder.path(), arguments).env("VK_DRIVER_FILES", drivers).output().unwrap()
    };
    fs::write(folder.path().join("bad.json"), "not JSON").unwrap();
    let driver = r#"{"library_path":"./nothing.so","api_version":"1.3.0"}"#;
    let library = format!(r#"{{"file_format_version":"1.0.0","ICD":{driver}}}"#);
    fs::write(folder.path().join("missing.json"), library).unwrap();
    for drivers in ["/nowhere.json", "bad.json", "missing.json"] {
        let drivers = folder.path().join(drivers).to_string_lossy().into_owned();
        let output = with_drivers(&drivers, LARGE);
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(stderr(&output).contains("not on Vulkan: Vulkan"), "{}", stderr(&output));
        let output = with_drivers(&drivers, "bake --size 8 --backend vulkan -o b.exr");
        assert_eq!(output.status.code(), Some(5), "{}", stderr(&output));
        assert!(stderr(&output).contains("--backend cpu") && !folder.path().join("b.exr").exists());
        let output = with_drivers(&drivers, "devices");
        assert_eq!(output.status.code(), Some(5), "{}", stderr(&output));
    }
    // No loader at all: a library of that name that is none.
    fs::create_dir(folder.path().join("lib")).unwrap();
    fs::write(folder.path().join("lib/libvulkan.so.1"), "xx").unwrap();
    let library_path = folder.path().join("lib");
    let output =
        splitsum(folder.path(), LARGE).env("LD_LIBRARY_PATH", library_path).output().unwrap();
    assert!(
        output.status.success() && stderr(&output).contains("not on Vulkan: Vulkan"),
        "{}",
        stderr(&output)
    );
}
