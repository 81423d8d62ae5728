//! Devices that lie or fail: what the cross-check must find, on tables spoiled by hand and on
//! drivers that compute nothing or leave something out; and that every failed call ends in an error
//! with everything freed.

use crate::common::{VULKAN, field, ggx, missing};
use libtest_mimic::{Failed, Trial};
use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Gpu, cpu};
use splitsum::brdf::Masking;
use splitsum::certify::deviation::{MEASURED, cross_check, measure};
use splitsum::error::{Error, ExitCode};
use splitsum::integrate::ScaleBias;
use splitsum::integrate::errors::f32_arithmetic;
use splitsum::integrate::rule::Rule;
use splitsum::table::axis::{Axis, AxisSpec, Parameter};
use splitsum::table::grid::Grid;
use std::path::Path;
use std::process::Command;

pub fn trials() -> Vec<Trial> {
    let mut trials = vec![
        Trial::test("a sound table passes the cross-check", || {
            found_out(|_| ()).map_or(Ok(()), Err)
        }),
        spoiled("a table of zeros", |table| table.fill(ScaleBias::default())),
        spoiled("a workgroup left out", |table| table[7 * 64..8 * 64].fill(ScaleBias::default())),
        spoiled("the last workgroup left out", |table| {
            table[64 * 63..].fill(ScaleBias { a: 0.5, b: 0.1 })
        }),
        spoiled("a workgroup of NaN", |table| {
            table[64..128].fill(ScaleBias { a: f64::NAN, b: 0.0 })
        }),
        spoiled("one NaN", |table| table[1234].a = f64::NAN),
        spoiled("one albedo above 1", |table| table[1234].a = 1.1),
        spoiled("two rows exchanged", |table| (0..64).for_each(|i| table.swap(i, 64 + i))),
        spoiled("an error of 2e-6 everywhere", |table| {
            table.iter_mut().for_each(|value| value.b += 2e-6)
        }),
        Trial::test(
            "a table beyond its bound fails the measurement",
            a_table_beyond_its_bound_fails,
        ),
        a_driver_that_computes_nothing(),
        a_broken_manifest("driver", &["bake", "--backend", "vulkan"]),
        a_broken_manifest("layer", &["bake", "--backend", "vulkan", "--validate"]),
    ];
    trials.extend(FAULTS.map(faulty_driver));
    trials
}

fn grid() -> Grid {
    let axis = |parameter| Axis::new(AxisSpec::of(parameter), 64).unwrap();
    Grid::new(&axis(Parameter::Nov), &axis(Parameter::Roughness)).unwrap()
}

/// The failure of the cross-check of a good table after `spoil`.
fn found_out(spoil: fn(&mut [ScaleBias])) -> Option<Failed> {
    let (lobe, grid, rule) = (ggx(Masking::HeightCorrelated), grid(), Rule::named("h288").unwrap());
    let mut table = cpu::bake(lobe, &grid, &rule, &|_| ()).scale_bias();
    spoil(&mut table);
    cross_check(lobe, &grid, &rule, &field(&table)).err().map(|error| {
        assert_eq!(error.exit_code(), ExitCode::CheckFailed);
        error.to_string().into()
    })
}

fn spoiled(what: &str, spoil: fn(&mut [ScaleBias])) -> Trial {
    Trial::test(format!("{what} is found out"), move || match found_out(spoil) {
        Some(_) => Ok(()),
        None => Err("it passed".into()),
    })
}

fn a_table_beyond_its_bound_fails() -> Result<(), Failed> {
    let (lobe, grid, rule) = (ggx(Masking::HeightCorrelated), grid(), Rule::named("h640").unwrap());
    let mut table = cpu::bake(lobe, &grid, &rule, &|_| ()).scale_bias();
    let allowed = rule.bound(lobe) + f32_arithmetic(lobe);
    assert!(
        measure(lobe, &grid, &rule, allowed, &field(&table), MEASURED)?.max() <= rule.bound(lobe)
    );
    // The rule's bound and the arithmetic's are 1.9e-6 together.
    table.iter_mut().for_each(|value| value.a += 4e-6);
    match measure(lobe, &grid, &rule, allowed, &field(&table), MEASURED) {
        Err(Error::CheckFailed(_)) => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

/// The mock driver of Debian's chromium-common says yes to everything and does nothing.
/// SPLITSUM_MOCK_ICD names its JSON.
fn a_driver_that_computes_nothing() -> Trial {
    let name = "a driver that computes nothing is found out, and no file is written".to_owned();
    let Some(icd) = std::env::var_os("SPLITSUM_MOCK_ICD") else {
        return missing(
            VULKAN,
            name,
            "SPLITSUM_MOCK_ICD does not name the JSON file of a mock driver".into(),
        );
    };
    Trial::test(name, move || {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("dfg.exr");
        std::fs::write(&file, "the old file")?;
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        let output = command
            .env("VK_DRIVER_FILES", &icd)
            .args(["bake", "--backend", "vulkan", "-o"])
            .arg(&file)
            .output()?;
        assert_eq!(output.status.code(), Some(ExitCode::CheckFailed as i32), "{output:?}");
        assert_eq!(std::fs::read_to_string(&file)?, "the old file");
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    })
}

/// The loader calls a manifest that it cannot read a want of memory.
fn a_broken_manifest(kind: &'static str, arguments: &'static [&str]) -> Trial {
    let name = format!("a broken manifest of a {kind} is no device, and is named as what it is");
    if !LOADERS.iter().any(|path| Path::new(path).exists()) {
        return missing(VULKAN, name, "there is no Vulkan loader where Linux has it".into());
    }
    Trial::test(name, move || {
        let folder = tempfile::tempdir()?;
        let layers = folder.path().join("vulkan/explicit_layer.d");
        std::fs::create_dir_all(&layers)?;
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        if kind == "layer" {
            std::fs::write(layers.join("broken.json"), "{")?;
            command.env("XDG_DATA_HOME", folder.path());
        } else {
            std::fs::write(folder.path().join("broken.json"), "{")?;
            command.env("VK_DRIVER_FILES", folder.path().join("broken.json"));
        }
        let output = command
            .current_dir(&folder)
            .args(arguments)
            .args(["--size", "2", "-o", "a.exr"])
            .output()?;
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(ExitCode::NoDevice as i32), "{text}");
        assert!(text.contains("manifest") && text.contains("VK_DRIVER_FILES"), "{text}");
        assert!(!folder.path().join("a.exr").exists());
        Ok(())
    })
}

const LOADERS: [&str; 3] = [
    "/usr/lib/x86_64-linux-gnu/libvulkan.so.1",
    "/usr/lib64/libvulkan.so.1",
    "/usr/lib/libvulkan.so.1",
];

/// A call that fails, and the exit code that it has to end in; `-4` is VK_ERROR_DEVICE_LOST, `-1`,
/// `-2` out of memory, `-3` VK_ERROR_INITIALIZATION_FAILED, `-5` VK_ERROR_MEMORY_MAP_FAILED, `2`
/// VK_TIMEOUT.
const FAULTS: [(&str, ExitCode); 21] = [
    ("vkCreateInstance=-9@1", ExitCode::NoDevice),
    ("vkEnumeratePhysicalDevices=-3@1", ExitCode::NoDevice),
    ("vkCreateDevice=-3@1", ExitCode::NoDevice),
    ("vkCreateBuffer=-2@3", ExitCode::DeviceFailure),
    ("vkAllocateMemory=-2@1", ExitCode::DeviceFailure),
    ("vkAllocateMemory=-2@4", ExitCode::DeviceFailure),
    ("vkBindBufferMemory=-2@2", ExitCode::DeviceFailure),
    ("vkMapMemory=-5@2", ExitCode::DeviceFailure),
    ("vkCreateShaderModule=-1@1", ExitCode::DeviceFailure),
    ("vkCreateDescriptorSetLayout=-1@1", ExitCode::DeviceFailure),
    ("vkCreatePipelineLayout=-1@1", ExitCode::DeviceFailure),
    ("vkCreateComputePipelines=-3@1", ExitCode::DeviceFailure),
    ("vkCreateDescriptorPool=-2@1", ExitCode::DeviceFailure),
    ("vkAllocateDescriptorSets=-2@1", ExitCode::DeviceFailure),
    ("vkCreateCommandPool=-2@1", ExitCode::DeviceFailure),
    ("vkAllocateCommandBuffers=-2@1", ExitCode::DeviceFailure),
    ("vkCreateFence=-2@1", ExitCode::DeviceFailure),
    ("vkQueueSubmit=-4@1", ExitCode::DeviceFailure),
    ("vkQueueSubmit=-4@3", ExitCode::DeviceFailure),
    ("vkWaitForFences=2@2", ExitCode::DeviceFailure),
    ("vkCmdDispatch=drop", ExitCode::CheckFailed),
];

/// The program on a real driver behind tests/vulkan/faulty_loader.rs, under the validation layers,
/// which tell of every object that is left when the device goes.
fn faulty_driver((fault, code): (&'static str, ExitCode)) -> Trial {
    let name = format!("{fault} ends in exit code {} with everything freed", code as u8);
    let shim =
        Path::new(env!("CARGO_BIN_EXE_splitsum")).with_file_name("examples/libfaulty_loader.so");
    if !shim.exists() {
        return missing(
            VULKAN,
            name,
            format!("{} is not built: run the whole of cargo test", shim.display()),
        );
    }
    let Some(loader) = LOADERS.into_iter().find(|path| Path::new(path).exists()) else {
        return missing(VULKAN, name, "there is no Vulkan loader where Linux has it".into());
    };
    if let Err(error) = Gpu::open(&GpuOptions { validate: true, ..GpuOptions::default() }) {
        return missing(VULKAN, name, error.to_string());
    }
    Trial::test(name, move || {
        let folder = tempfile::tempdir()?;
        std::os::unix::fs::symlink(&shim, folder.path().join("libvulkan.so.1"))?;
        let output = Command::new(env!("CARGO_BIN_EXE_splitsum"))
            .current_dir(&folder)
            .env("LD_LIBRARY_PATH", folder.path())
            .env("SPLITSUM_REAL_LOADER", loader)
            .env("SPLITSUM_FAULT", fault)
            .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
            .args("bake --backend vulkan --size 64 --tile 512 -o a.exr".split(' '))
            .output()?;
        let (out, err) =
            (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code as i32), "{out}{err}");
        assert!(!folder.path().join("a.exr").exists());
        // The layers print what they have to say on standard output.
        assert_eq!(out, "", "the validation layers found something");
        Ok(())
    })
}
