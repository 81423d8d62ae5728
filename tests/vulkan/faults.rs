//! Devices that lie: what the cross-check must find, on a table spoiled by hand and on a driver that computes nothing.

use crate::common::{ggx, missing};
use libtest_mimic::{Failed, Trial};
use splitsum::axis::{Axis, AxisSpec, Parameter};
use splitsum::backend::cpu;
use splitsum::certify::{cross_check, measure};
use splitsum::error::{Error, ExitCode};
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::{F32_ARITHMETIC, Rule};
use splitsum::lut::Grid;
use splitsum::model::Masking;
use std::process::Command;

pub fn trials() -> Vec<Trial> {
    vec![
        Trial::test("a sound table passes the cross-check", || found_out(|_| ()).map_or(Ok(()), Err)),
        spoiled("a table of zeros", |table| table.fill(ScaleBias::default())),
        spoiled("a workgroup left out", |table| table[7 * 64..8 * 64].fill(ScaleBias::default())),
        spoiled("the last workgroup left out", |table| table[64 * 63..].fill(ScaleBias { a: 0.5, b: 0.1 })),
        spoiled("a workgroup of NaN", |table| table[64..128].fill(ScaleBias { a: f64::NAN, b: 0.0 })),
        spoiled("one NaN", |table| table[1234].a = f64::NAN),
        spoiled("one albedo above 1", |table| table[1234].a = 1.1),
        spoiled("two rows exchanged", |table| (0..64).for_each(|i| table.swap(i, 64 + i))),
        spoiled("an error of 2e-6 everywhere", |table| table.iter_mut().for_each(|value| value.b += 2e-6)),
        Trial::test("a table beyond its bound fails the measurement", a_table_beyond_its_bound_fails),
        a_driver_that_computes_nothing(),
    ]
}

fn grid() -> Grid {
    let axis = |parameter| Axis::new(AxisSpec::of(parameter), 64).unwrap();
    Grid::new(&axis(Parameter::Nov), &axis(Parameter::Roughness)).unwrap()
}

/// The failure of the cross-check of a good table after `spoil`.
fn found_out(spoil: fn(&mut [ScaleBias])) -> Option<Failed> {
    let (lobe, grid, rule) = (ggx(Masking::HeightCorrelated), grid(), Rule::named("h288").unwrap());
    let mut table = cpu::bake(lobe, &grid, &rule, &|_| ());
    spoil(&mut table);
    cross_check(lobe, &grid, &rule, &table).err().map(|error| {
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
    let mut table = cpu::bake(lobe, &grid, &rule, &|_| ());
    assert!(measure(lobe, &grid, &rule, F32_ARITHMETIC, &table)?.largest() <= rule.bound);
    // The rule's bound and the arithmetic's are 1.9e-6 together.
    table.iter_mut().for_each(|value| value.a += 4e-6);
    match measure(lobe, &grid, &rule, F32_ARITHMETIC, &table) {
        Err(Error::CheckFailed(_)) => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

/// The mock driver of Debian's chromium-common says yes to everything and does nothing. SPLITSUM_MOCK_ICD names its JSON.
fn a_driver_that_computes_nothing() -> Trial {
    let name = "a driver that computes nothing is found out, and no file is written".to_owned();
    let Some(icd) = std::env::var_os("SPLITSUM_MOCK_ICD") else {
        return missing(name, "SPLITSUM_MOCK_ICD does not name the JSON file of a mock driver".into());
    };
    Trial::test(name, move || {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("dfg.exr");
        std::fs::write(&file, "the old file")?;
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        let output = command.env("VK_DRIVER_FILES", &icd).args(["bake", "-o"]).arg(&file).output()?;
        assert_eq!(output.status.code(), Some(ExitCode::CheckFailed as i32), "{output:?}");
        assert_eq!(std::fs::read_to_string(&file)?, "the old file");
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    })
}
