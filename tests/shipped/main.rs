//! The tables that engines ship, against ours in the same convention: three.js, Bevy, Babylon.js
//! and Filament's cmgen. SPLITSUM_SHIPPED names the folder that tests/shipped/fetch has filled;
//! without it the tests are reported as ignored, or fail where SPLITSUM_REQUIRE_READERS is set.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../common/mod.rs"]
mod common;

use common::{printed, read_npy, with_named};
use libtest_mimic::{Arguments, Failed, Trial};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// How far two tables are apart: the mean, the largest of 99 %, the largest of all.
#[derive(Clone, Copy, Debug)]
struct Apart {
    mean: f64,
    most: f64,
    largest: f64,
}

/// A shipped table, the flags of its convention, and how far it is from the truth.
struct Shipped {
    name: &'static str,
    file: &'static str,
    flags: &'static str,
    /// Channels that are compared.
    channels: usize,
    decode: fn([f64; 4]) -> [f64; 4],
    /// Mean, 99 % and largest as another measurement found them, each with half a unit of its last
    /// digit; of 99 % with a whole one, since rules differ in which value that is.
    published: [(f64, f64); 3],
}

const SHIPPED: [Shipped; 5] = [
    Shipped {
        name: "three.js",
        file: "three.npy",
        flags: "--channels ab --x roughness --y nov --size 16",
        channels: 2,
        decode: |texel| texel,
        published: [(4.2e-4, 5e-6), (8.6e-3, 1e-4), (0.0142, 5e-5)],
    },
    Shipped {
        name: "Bevy",
        file: "bevy.ktx2.npy",
        flags: "--channels ab --size 64",
        channels: 2,
        decode: |texel| texel,
        published: [(1.3e-4, 5e-6), (2.4e-3, 1e-4), (6.3e-3, 5e-5)],
    },
    Shipped {
        name: "Babylon.js",
        file: "babylon_raw_rgba8.npy",
        // The nodes that it has, a texel too rough.
        flags: "--channels be --y roughness,offset=1.5 --size 256",
        channels: 2,
        decode: rgbd,
        published: [(1.06e-3, 5e-6), (4.4e-3, 1e-4), (0.019, 5e-4)],
    },
    Shipped {
        name: "Babylon.js, OpenPBR",
        file: "babylon_openpbr_raw_rgba8.npy",
        flags: "--fresnel f82 --channels b,e,c*16 --size 128",
        channels: 2,
        // As its loader decodes it, though it was written on the curve of sRGB.
        decode: rgbd,
        published: [(3.6e-3, 5e-5), (0.0117, 1e-4), (0.0143, 5e-5)],
    },
    Shipped {
        name: "cmgen",
        file: "cmgen.exr.npy",
        flags: "--channels ab --y roughness,offset=1.5,flip --size 64",
        channels: 2,
        decode: |texel| texel,
        published: [(7.8e-4, 5e-6), (8.2e-3, 1e-4), (0.0110, 5e-5)],
    },
];

/// (code/255)^2.2 over the divisor.
fn rgbd(codes: [f64; 4]) -> [f64; 4] {
    codes.map(|code| (code / 255.0).powf(2.2) / (codes[3] / 255.0))
}

fn main() {
    let by = |name: &str, test: fn(&Path) -> Result<(), Failed>| {
        with_named("SPLITSUM_SHIPPED", name, move |folder| test(&folder))
    };
    let trials: Vec<Trial> = vec![
        by("shipped tables are as far from ours as others measured", as_far_as_published),
        by("the estimator repeats three.js and cmgen to half precision", repeated),
        by("cloth is Charlie with Neubelt's visibility", cloth),
        by("verify tells what shipped tables are", told),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// The texels of a table that splitsum bakes, of as many channels.
fn baked(flags: &str) -> Result<(usize, Vec<f64>), Failed> {
    let folder = tempdir()?;
    let words = format!("bake -q {flags} -o t.npy");
    let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
    printed(command.args(words.split_whitespace()).current_dir(&folder))?;
    Ok(read_npy(&fs::read(folder.path().join("t.npy"))?))
}

/// The differences of a shipped table from another, channel by channel of each texel.
fn differences(folder: &Path, shipped: &Shipped, flags: &str) -> Result<Vec<f64>, Failed> {
    let (theirs_width, theirs) = read_npy(&fs::read(folder.join(shipped.file))?);
    let (width, ours) = baked(flags)?;
    assert_eq!(theirs.len() / theirs_width, ours.len() / width, "{}", shipped.name);
    let texels = theirs.chunks(theirs_width).zip(ours.chunks(width));
    let of_texel = |(theirs, ours): (&[f64], &[f64])| {
        let mut texel = [0.0; 4];
        texel[..theirs_width].copy_from_slice(theirs);
        let decoded = (shipped.decode)(texel);
        (0..shipped.channels).map(|c| (decoded[c] - ours[c]).abs()).collect::<Vec<f64>>()
    };
    Ok(texels.flat_map(of_texel).collect())
}

fn apart(mut differences: Vec<f64>) -> Apart {
    differences.sort_by(f64::total_cmp);
    let count = differences.len();
    Apart {
        mean: differences.iter().sum::<f64>() / count as f64,
        most: differences[count * 99 / 100],
        largest: differences[count - 1],
    }
}

fn as_far_as_published(folder: &Path) -> Result<(), Failed> {
    for shipped in &SHIPPED {
        let flags = format!("{} --precision f32", shipped.flags);
        let found = apart(differences(folder, shipped, &flags)?);
        println!("{}: {found:?}", shipped.name);
        for (found, (published, half_unit)) in
            [found.mean, found.most, found.largest].into_iter().zip(shipped.published)
        {
            assert!(
                (found - published).abs() <= 1.05 * half_unit,
                "{}: {found} where {published} was published",
                shipped.name
            );
        }
    }
    Ok(())
}

fn repeated(folder: &Path) -> Result<(), Failed> {
    for (name, estimator) in
        [("three.js", "hammersley,n=4096,frame=sin"), ("cmgen", "hammersley,n=1024,frame=cos")]
    {
        let shipped = SHIPPED.iter().find(|shipped| shipped.name == name).unwrap();
        let flags = format!("{} --precision f32 --estimator {estimator}", shipped.flags);
        let found = apart(differences(folder, shipped, &flags)?);
        println!("{name}: {found:?}");
        // Half a step of halves below 1, and what their arithmetic in f32 adds.
        assert!(found.largest <= 2.5e-4 + 1e-4, "{name}: {found:?}");
        assert!(found.mean <= 1e-4, "{name}: {found:?}");
    }
    Ok(())
}

fn cloth(folder: &Path) -> Result<(), Failed> {
    let shipped = Shipped {
        name: "cmgen, cloth",
        file: "cmgen_cloth.exr.npy",
        flags: "",
        channels: 3,
        decode: |texel| texel,
        published: [(0.0, 0.0); 3],
    };
    let flags = "--channels b,e,charlie --y roughness,offset=1.5,flip --size 64 --precision f32";
    let found = differences(folder, &shipped, flags)?;
    let blue: Vec<f64> = found.into_iter().skip(2).step_by(3).collect();
    println!("cloth: {:?}", apart(blue.clone()));
    // Uniform directions, 4,096 of them, in halves, whose steps are 8e-3 at 9: what separates
    // Neubelt's term from another is a thousand times as much.
    let mean = apart(blue).mean;
    assert!(mean < 1.5e-4, "{mean}");
    Ok(())
}

/// What `splitsum verify` is to say of a file.
struct Told {
    arguments: &'static str,
    /// The axes, and the channels.
    x: &'static str,
    y: &'static str,
    channels: &'static [&'static str],
    sampler: Option<&'static str>,
    faults: &'static [&'static str],
    /// Dimensions that the values do not decide.
    undecided: &'static [&'static str],
}

const CENTRED: &str = "nov,linear,centres";
const LATE: &str = "roughness,linear,offset=1.5,flip";
const CMGEN: Option<&str> = Some("hammersley,n=1024,frame=cos");

const CMGEN_EXR: Told = Told {
    arguments: "cmgen.exr",
    x: CENTRED,
    y: LATE,
    channels: &["R: a", "G: b", "B: 0"],
    sampler: CMGEN,
    faults: &["shifted-nodes"],
    undecided: &[],
};

const TOLD: [Told; 12] = [
    Told {
        arguments: "three.js",
        x: "roughness,linear,centres",
        y: CENTRED,
        channels: &["R: a", "G: b"],
        sampler: Some("hammersley,n=4096,frame=sin"),
        faults: &[],
        undecided: &[],
    },
    Told {
        arguments: "bevy.ktx2",
        x: CENTRED,
        y: "roughness,linear,centres",
        channels: &["R: a", "G: b"],
        sampler: None,
        faults: &[],
        undecided: &[],
    },
    Told {
        arguments: "babylon.js --array _environmentBRDFBase64Texture",
        x: CENTRED,
        y: "roughness,linear,offset=1.5",
        channels: &["R: b", "G: e", "B: charlie"],
        sampler: None,
        faults: &["8-bit", "above-one"],
        // Half a texel is less than a step of 8 bits.
        undecided: &["nodes of nov", "nodes of roughness"],
    },
    Told {
        arguments: "babylon.js --array _openPBREnvironmentBRDFBase64Texture",
        x: CENTRED,
        y: "roughness,linear,centres",
        channels: &["R: b", "G: e", "B: c*16", "A: 1"],
        sampler: None,
        faults: &["srgb-encoded", "8-bit"],
        undecided: &["nodes of nov", "nodes of roughness"],
    },
    CMGEN_EXR,
    Told { arguments: "cmgen.dds", channels: &["R: a", "G: b", "B: 0", "A: 1"], ..CMGEN_EXR },
    Told {
        arguments: "cmgen.h",
        // The first row of an array is the bottom one there.
        y: "roughness,linear,offset=1.5",
        channels: &["R: a", "G: b"],
        ..CMGEN_EXR
    },
    Told {
        arguments: "cmgen.png",
        sampler: None,
        faults: &["8-bit", "shifted-nodes"],
        ..CMGEN_EXR
    },
    Told { arguments: "cmgen_32.dds", channels: &["R: a", "G: b", "B: 0", "A: 1"], ..CMGEN_EXR },
    Told { arguments: "cmgen_128.exr", channels: &["R: b", "G: e", "B: 0"], ..CMGEN_EXR },
    Told { arguments: "cmgen_cloth.exr", channels: &["R: b", "G: e", "B: charlie"], ..CMGEN_EXR },
    Told {
        arguments: "ltc.js --array LTC_MAT_2",
        x: "roughness,linear,edges",
        y: "nov,sqrt-complement,edges",
        channels: &["R: e", "G: b", "B: 0", "A: unknown"],
        sampler: None,
        faults: &["border"],
        undecided: &[],
    },
];

fn told(folder: &Path) -> Result<(), Failed> {
    let report = |arguments: &str| -> Result<serde_json::Value, Failed> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        let words = format!("verify --json {arguments}");
        let output = command.args(words.split_whitespace()).current_dir(folder).output()?;
        Ok(serde_json::from_slice(&output.stdout)?)
    };
    for Told { arguments, x, y, channels, sampler, faults, undecided } in TOLD {
        let report = report(arguments)?;
        println!("{arguments}: {} s", report["seconds"]);
        let convention = &report["convention"];
        assert_eq!((&convention["x"], &convention["y"]), (&x.into(), &y.into()), "{arguments}");
        assert_eq!(convention["channels"], serde_json::json!(channels), "{arguments}");
        assert_eq!(convention["sampler"]["estimator"], serde_json::json!(sampler), "{arguments}");
        let list = |key: &str, wanted: &dyn Fn(&serde_json::Value) -> bool, name: &str| {
            let all = report[key].as_array().cloned().unwrap_or_default();
            let names = all.iter().filter(|entry| wanted(entry)).map(|entry| entry[name].clone());
            serde_json::Value::Array(names.collect())
        };
        assert_eq!(list("faults", &|_| true, "name"), serde_json::json!(faults), "{arguments}");
        let open = list("decisions", &|decision| decision["decided"] == false, "dimension");
        assert_eq!(open, serde_json::json!(undecided), "{arguments}");
        let lobe = list("decisions", &|d| d["dimension"] == "masking", "choice");
        assert_eq!(lobe, serde_json::json!(["height-correlated"]), "{arguments}");
    }
    // The matrices of linearly transformed cosines are no table of a BRDF.
    let matrices = report("ltc.js --array LTC_MAT_1")?;
    assert_eq!(matrices["status"], "unknown");
    Ok(())
}
