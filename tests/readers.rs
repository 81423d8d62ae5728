//! Other people's readers on our files. A reader that is not installed is reported as ignored, with
//! the reason; where SPLITSUM_REQUIRE_VULKAN is set (in .ci/run, which installs them), that is a
//! failure instead.

mod common;

use common::{ab, ggx, missing};
use libtest_mimic::{Arguments, Failed, Trial};
use splitsum::backend::Backend;
use splitsum::brdf::Masking;
use splitsum::format::{Format, encode};
use splitsum::numeric::half;
use splitsum::request::Request;
use splitsum::table::precision::Precision;
use std::process::Command;

/// Prints the type, the shape and the values of each channel, then the metadata.
const SCRIPT: &str = "
import OpenEXR, sys
file = OpenEXR.File(sys.argv[1], separate_channels=True)
for name, channel in sorted(file.channels().items()):
    print(name, channel.pixels.dtype, *channel.pixels.shape, *(float(v) for v in \
    channel.pixels.flatten()))
print(file.header()['splitsum'])
";

fn main() {
    let name = "the OpenEXR package of Python reads every value and the metadata".to_owned();
    let trial = match std::env::var_os("SPLITSUM_PYTHON") {
        Some(python) => Trial::test(name, move || openexr_reads(&python)),
        None => missing(name, "SPLITSUM_PYTHON does not name a Python that has OpenEXR".into()),
    };
    libtest_mimic::run(&Arguments::from_args(), vec![trial]).exit();
}

fn openexr_reads(python: &std::ffi::OsStr) -> Result<(), Failed> {
    let lut = ab(ggx(Masking::HeightCorrelated));
    let request = Request::with_default_axes(lut, (5, 3), Precision::F16)?;
    let table = splitsum::bake(&request, &Backend::cpu())?.table;
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("dfg.exr");
    std::fs::write(&file, encode(&table, Format::named("exr")?)?)?;
    let output = Command::new(python).args(["-c", SCRIPT]).arg(&file).output()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    // Blue is empty, green is B, red is A: sorted by name.
    for (line, (name, channel)) in text.lines().zip([("B", None), ("G", Some(1)), ("R", Some(0))]) {
        let mut expected = format!("{name} float16 3 5");
        for texel in (0..15).map(|i| table.texel(0, i % 5, i / 5)) {
            let value =
                channel.map_or(0.0, |channel: usize| half::value(half::round(texel[channel])));
            expected.push_str(&format!(" {value:?}"));
        }
        let numbers = |line: &str| {
            line.split(' ').skip(2).map(|word| word.parse::<f64>().ok()).collect::<Vec<_>>()
        };
        assert_eq!(numbers(line), numbers(&expected), "channel {name}");
        assert!(line.starts_with(&format!("{name} float16 ")), "{line}");
    }
    assert_eq!(text.lines().count(), 4, "{text}");
    let metadata: serde_json::Value =
        serde_json::from_str(text.lines().last().unwrap_or_default())?;
    assert_eq!(metadata["x"]["texel"], "nov = t, t = clamp((i + 0.5)/5, 0, 1)");
    Ok(())
}
