//! The program as its users meet it: what it prints, what it writes, how it refuses.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, splitsum, stderr};
use std::fs;
use std::process::Command;
use tempfile::tempdir;

/// The command fails with this code and says these things, and leaves no file behind.
fn refused(arguments: &str, code: i32, said: &[&str]) {
    let folder = tempdir().unwrap();
    let output = run(&folder, arguments);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments}: {text}");
    for words in said {
        assert!(text.contains(words), "{arguments}: no '{words}' in: {text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{arguments} left a file");
}

const CPU: &str = "bake --backend cpu --size 8";

#[test]
fn a_bake_says_who_computed_it_and_how_exact_it_is() {
    let folder = tempdir().unwrap();
    let text = stderr(&ok(&folder, "bake --backend cpu --size 16x8 -o a.exr"));
    for words in [
        "a.exr: 16 x 8",
        "computed  by CPU, f64",
        "certified every value",
        "l2048",
        "blake3",
        " ms",
    ] {
        assert!(text.contains(words), "no '{words}' in: {text}");
    }
    assert!(fs::read(folder.path().join("a.exr")).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let text = stderr(&ok(&folder, "bake --backend cpu --size 16x8 -o a.exr --certify off"));
    for words in ["not certified", "at most ", "measured  at 128 points"] {
        assert!(text.contains(words), "no '{words}' in: {text}");
    }
}

#[test]
fn a_clamp_that_acts_is_reported() {
    let folder = tempdir().unwrap();
    let kulla = "bake --backend cpu --model charlie --masking height-correlated --size 4 --rule \
                 h288 -o a.exr";
    let clamped = stderr(&ok(&folder, &format!("{kulla} --x nov,edges,min=1e-4")));
    assert!(clamped.contains("clamped   1 columns and 0 rows"), "{clamped}");
    assert!(!stderr(&ok(&folder, kulla)).contains("clamped"));
}

#[test]
fn the_default_output_is_made_with_its_folder() {
    let folder = tempdir().unwrap();
    assert_eq!(stderr(&ok(&folder, &format!("{CPU} -q"))), "");
    assert!(folder.path().join("out/dfg.exr").exists());
    for command in ["chart table --size 8", "bake --backend cpu --size 4 --precision unorm8 -q"] {
        let folder = tempdir().unwrap();
        ok(&folder, command);
        assert!(folder.path().join("out/dfg.png").exists(), "{command}");
    }
    let folder = tempdir().unwrap();
    ok(&folder, &format!("{CPU} -q -o ./out/a.exr"));
}

#[test]
fn the_command_in_the_report_repeats_the_bake() {
    let folder = tempdir().unwrap();
    let flags = "--masking separable --channels be --size 7x9 --x roughness,sqrt,edges,flip \
                 --precision f32 --tolerance 1e-4";
    let report = ok(&folder, &format!("bake --backend cpu {flags} --json -o a.exr"));
    let report: serde_json::Value = serde_json::from_slice(&report.stdout).unwrap();
    let table = &report["tables"][0];
    assert_eq!((&table["output"], &table["computed"]["kind"]), (&"a.exr".into(), &"cpu".into()));
    assert_eq!(table["certificate"]["texels"], 63);
    assert!(table["stages"][0]["decided"].is_u64());
    let command = table["command"].as_str().unwrap().strip_prefix("splitsum ").unwrap();
    ok(&folder, &format!("{command} --backend cpu -q -o b.exr"));
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.exr"), read("b.exr"));
}

#[test]
fn every_choice_bakes() {
    let folder = tempdir().unwrap();
    for flags in [
        "--masking schlick-smith --channels e -o a.exr",
        "--y nov -o b.exr",
        "--x alpha,sqrt --y nov,sqrt-complement,edges -o c.png",
        "--rule l288 -o d.png --precision unorm8",
        "--rule reference -o e.exr --precision f32",
        "--format png -o f.data",
        "--size 1 -o g.exr",
        "--size 1x5 --x nov,edges --y roughness,edges -o h.exr",
        "--certify off --tolerance 1e-12 -o i.exr",
        "--model beckmann --masking separable -o j.exr",
        "--lut energy -o o.exr",
        "--lut sheen -o t.exr",
        "--lut diffuse -o u.exr",
        "--lut diffuse --model eon --x roughness -o v.exr",
        "--lut energy --channels average --size 1x8 -o p.exr",
        "--lut energy --channels kulla-conty --model beckmann -o q.exr",
        "--lut energy --channels turquin -o r.exr",
        "--lut energy --channels split --ior 1.33 -o s.exr",
        "--lut energy --f0 0.02,0.04,0.08,0.5 -o w.exr",
        "--lut energy --z f0,sqrt,offset=0,min=0.02 --size 6x5x3 -o x.exr",
        "--fresnel f82 --channels abc -o y.exr",
        "--model beckmann-walter -o k.exr",
        "--model blinn-phong --y exponent,edges -o l.exr",
        "--model charlie --channels e -o m.exr",
        "--model charlie --precision f32 -o m32.exr",
        "--model beckmann-walter --precision f32 -o k32.exr",
        "--model charlie --masking height-correlated --x nov,edges,min=1e-4 --y \
         roughness,min=0.07 -o n.exr",
    ] {
        let size = if flags.contains("--size") { "" } else { "--size 6x5" };
        ok(&folder, &format!("bake --backend cpu {size} {flags}"));
    }
}

#[test]
fn a_configuration_bakes_several_tables_beside_itself() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("assets")).unwrap();
    let text = r#"
        [[table]]
        output = "dfg.exr"
        size = 8

        [[table]]
        output = "sheared axes.png"
        size = "8x4"
        masking = "separable"
        x = "roughness,edges"
        certify = "off"
        tolerance = 1e-4

        [[table]]
        output = "layers.exr"
        size = 4
        lut = "energy"
        f0 = [0.02, 0.04]
    "#;
    fs::write(folder.path().join("assets/luts.toml"), text).unwrap();
    ok(&folder, "bake --backend cpu --config assets/luts.toml -MD");
    let assets = folder.path().join("assets");
    assert!(assets.join("dfg.exr").exists() && assets.join("sheared axes.png").exists());
    let rule = fs::read_to_string(assets.join("luts.toml.d")).unwrap();
    assert_eq!(
        rule,
        "assets/dfg.exr assets/sheared\\ axes.png assets/layers.exr: assets/luts.toml\n"
    );
}

#[test]
fn dependency_files_are_those_of_compilers() {
    let folder = tempdir().unwrap();
    ok(&folder, &format!("{CPU} -q -o a.exr -MD"));
    assert_eq!(fs::read_to_string(folder.path().join("a.exr.d")).unwrap(), "a.exr:\n");
    ok(&folder, &format!("{CPU} -q -o a.exr -MF deps -MT $name"));
    assert_eq!(fs::read_to_string(folder.path().join("deps")).unwrap(), "$$name:\n");
    refused(&format!("{CPU} -o a.exr -MT x"), 2, &["-MD or -MF"]);
}

#[test]
fn wrong_configurations_say_where() {
    let folder = tempdir().unwrap();
    for (text, said) in [
        ("", "at least one [[table]]"),
        ("[[table]]\nsize = 8", "table 1: expected an output file"),
        ("[[table]]\noutput = 'a.exr'\nrougness = 1", "unknown field `rougness`"),
        ("[[table]]\noutput = 'a.exr'\nsize = -1", "got '-1'"),
        ("[[table]]\noutput = 'a.exr'\nsize = 1.5", "line 3"),
        (
            "[[table]]\noutput = 'a.exr'\n[[table]]\noutput = 'a.exr'",
            "table 2: expected a file of its own",
        ),
        ("[[table]]\noutput = 'a.exr'\nprecision = 'f32'\ntolerance = nan", "1e-13 to 0.1"),
        ("[[table]]\noutput = 'a.exr'\ntolerance = 1e-3\nrule = 'h56'", "got both"),
        ("[[table", "line 1"),
        ("[[table]]\noutput = 'a.exr'\ncertify = 'perhaps'", "expected on, off, got 'perhaps'"),
        ("[[table]]\noutput = 'a.exr'\nrule = 'simpson'", "g4536, got 'simpson'"),
        ("[[table]]\noutput = 'a.exr'\nmodel = 'phong'", "charlie, got 'phong'"),
        ("[[table]]\noutput = 'a.exr'\nmasking = 'none'", "neubelt, got 'none'"),
        (
            "[[table]]\noutput = 'a.exr'\nlut = 'velvet'",
            "expected dfg, sheen, energy, glass, diffuse, got 'velvet'",
        ),
        ("[[table]]\noutput = 'a.exr'\nchannels = 'rgb'", "expected ab, be, e, or terms"),
        ("[[table]]\noutput = 'a.exr'\nprecision = 'f64'", "f16 or f32 for .exr"),
        ("[[table]]\noutput = 'a.exr'\nformat = 'bmp'", "format: expected exr, png, ktx2"),
    ] {
        fs::write(folder.path().join("bad.toml"), text).unwrap();
        let output = run(&folder, "bake --backend cpu --config bad.toml");
        assert_eq!(output.status.code(), Some(4), "{text}");
        assert!(stderr(&output).contains(said), "no '{said}' in: {}", stderr(&output));
    }
    fs::write(folder.path().join("bad.toml"), [0xff, 0xfe]).unwrap();
    assert_eq!(run(&folder, "bake --config bad.toml").status.code(), Some(4));
    fs::write(folder.path().join("bad.toml"), vec![b' '; 2 << 20]).unwrap();
    assert_eq!(run(&folder, "bake --config bad.toml").status.code(), Some(4));
    refused("bake --config nowhere.toml", 3, &["cannot read nowhere.toml", "name a TOML file"]);
    refused("bake --config x.toml --size 8", 2, &["--size", "cannot be used with"]);
}

#[test]
fn wrong_values_are_refused_with_what_was_expected() {
    refused("bake --size 0", 4, &["expected 1 to 16384", "got 0"]);
    refused("bake --size 16385", 4, &["got 16385"]);
    refused("bake --size 99999999999999999999", 4, &["a number"]);
    refused("bake --size -4x4", 4, &["got '-4x4'"]);
    refused("bake --size 4x", 4, &["got '4x'", "64x32"]);
    refused("bake --certify off --tolerance 1e-14", 4, &["1e-13 to 0.1"]);
    refused("bake --tolerance 1e-4", 4, &["f16 correctly", "set certify to off"]);
    refused("bake --certify on --rule h56", 4, &["none where values are certified"]);
    refused("bake --certify perhaps", 2, &["possible values: on, off", "'perhaps'"]);
    refused("bake --precision f32 --tolerance -1e-5", 4, &["1e-13 to 0.1"]);
    refused("bake --precision f32 --tolerance inf", 4, &["1e-13 to 0.1"]);
    refused("bake --rule simpson", 2, &["h56", "reference", "'simpson'"]);
    refused("bake --model phong", 2, &["ggx", "blinn-phong", "'phong'"]);
    refused("bake --model charlie --masking joint", 2, &["neubelt", "'joint'"]);
    let approx = "height-correlated-approx";
    refused(
        &format!("bake --model charlie --masking {approx}"),
        4,
        &["neubelt", &format!("got {approx}")],
    );
    refused(
        "bake --model charlie --masking height-correlated --x nov,edges",
        4,
        &["n.v > 0", "min=1e-4"],
    );
    refused("bake --model charlie --precision f32 --tolerance 1e-8", 4, &["from 2e-6 to 0.1"]);
    refused("bake --model beckmann --rule l288", 4, &["h56 to h6144"]);
    refused("bake --lut velvet", 2, &["dfg, sheen", "'velvet'"]);
    refused("bake --lut diffuse --model ggx", 4, &["burley", "got 'ggx'"]);
    refused("bake --lut diffuse --masking implicit", 4, &["leave them out"]);
    refused("bake --lut diffuse --rule h288", 4, &["closed-form"]);
    refused("bake --rule closed-form", 4, &["h56 to h6144"]);
    refused("bake --f0 0.04", 4, &["f0: expected the split of energy", "got --lut dfg"]);
    refused(
        "bake --lut energy --channels average --ior 2",
        4,
        &["ior: expected glass or the split", "--channels average"],
    );
    refused("bake --lut energy --f0 -1e-3", 4, &["expected 0 to 1, got -0.001"]);
    refused("bake --lut energy --f0 -.02,0.04", 4, &["expected 0 to 1, got -0.02"]);
    refused("bake --lut energy --ior -2", 4, &["at least 1", "got -2"]);
    refused("bake --fresnel f82 --channels be", 4, &["expected abc, e, or terms"]);
    refused("bake --lut energy --f0 1", 4, &["less than 1"]);
    refused("bake --lut energy --f0 nan", 4, &["expected 0 to 1"]);
    refused("bake --lut energy --f0 0.1,0.1", 4, &["different values"]);
    refused("bake --lut energy --f0 0.1,x", 4, &["numbers with commas", "0.1,x"]);
    refused("bake --lut energy --f0 0.1,0.2 -o a.png", 4, &["one slice in a .png", "choose .exr"]);
    refused("bake --lut energy --ior 0.5", 4, &["at least 1"]);
    refused("bake --lut energy --model charlie", 4, &["albedo stays below 1"]);
    refused("bake --lut energy --channels ab", 4, &["split", "got 'ab'"]);
    refused("bake --masking none", 2, &["height-correlated", "schlick-smith"]);
    refused("bake --channels rgb", 4, &["ab, be, e, or terms"]);
    refused("bake --precision f64", 2, &["f16", "unorm8"]);
    refused("bake --precision unorm8 -o a.exr", 4, &["f16 or f32 for .exr"]);
    refused("bake -o table.bmp", 4, &[".exr, .png, .ktx2", "'table.bmp'"]);
    refused("bake --format bmp", 2, &["exr, png", "'bmp'"]);
    refused("bake --x nov --y nov", 4, &["x = nov, y = nov"]);
    refused("bake --x mu", 4, &["nov, critical, roughness, alpha, exponent", "got 'mu'"]);
    refused("bake --y roughness,offset=1e-9", 4, &["texel 0", "raise the axis's min"]);
    refused("bake --threads 0", 2, &["1..=1024"]);
    refused("bake --threads 1025", 2, &["1..=1024"]);
    refused("bake --tile 0", 2, &["--tile"]);
    refused("bake --backend metal", 2, &["auto, vulkan, cpu"]);
}

#[test]
fn flags_that_make_no_sense_are_usage_errors() {
    refused("bake --frobnicate", 2, &["--frobnicate"]);
    refused("bake --rule h56 --tolerance 1e-3", 2, &["cannot be used with"]);
    for command in ["bake", "preview"] {
        let given = format!("{command} --backend cpu --device llvmpipe");
        refused(&given, 2, &["no flag of a device, got --device"]);
    }
    refused("bake --dry-run --quiet", 2, &["--quiet"]);
    refused("chart table --precision f16", 2, &["flags of a picture, got --precision"]);
    refused("man bake table", 2, &["no further word, got table", "leave it out"]);
    refused("bake --backend cpu --json -o -", 2, &["write the table to a file"]);
    refused("bake --backend cpu -o - -MD", 2, &["-MF"]);
    refused("frobnicate", 2, &["frobnicate"]);
}

#[test]
fn an_unwritable_output_is_an_io_error_before_any_work() {
    refused(&format!("{CPU} -o nowhere/a.exr"), 3, &["nowhere/a.exr", "create it first"]);
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("a.exr")).unwrap();
    let output = run(&folder, &format!("{CPU} -o a.exr"));
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_io_error() {
    let folder = tempdir().unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.path().join("full.exr")).unwrap();
    let output = run(&folder, &format!("{CPU} -o full.exr"));
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("No space left"), "{}", stderr(&output));
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = splitsum(folder.path(), &format!("{CPU} -q -o -")).stdout(full).status().unwrap();
    assert_eq!(status.code(), Some(3));
}

#[cfg(unix)]
#[test]
fn the_old_file_survives_a_failed_write() {
    // A limit on file sizes fails the write in the middle: the signal is ignored, so that the call
    // returns an error.
    let folder = tempdir().unwrap();
    let file = folder.path().join("a.exr");
    fs::write(&file, "the old file").unwrap();
    let program = env!("CARGO_BIN_EXE_splitsum");
    let script =
        format!("trap '' XFSZ; ulimit -f 1; exec {program} bake --backend cpu --size 64 -o a.exr");
    let output = Command::new("bash").current_dir(&folder).args(["-c", &script]).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(&file).unwrap(), "the old file");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a temporary file was left");
}

#[cfg(unix)]
#[test]
fn links_and_permissions_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempdir().unwrap();
    let (file, link) = (folder.path().join("real.exr"), folder.path().join("link.exr"));
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).unwrap();
    symlink("real.exr", &link).unwrap();
    ok(&folder, &format!("{CPU} -o link.exr"));
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::metadata(&file).unwrap().len() > 500);
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
}

#[test]
fn a_furnace_is_reported_and_drawn() {
    let folder = tempdir().unwrap();
    let text = String::from_utf8(ok(&folder, "furnace --size 8 -o furnace.png").stdout).unwrap();
    assert!(
        text.contains("0.04  naive         0.0857") && text.contains("0.04  reciprocal    1.0000"),
        "{text}"
    );
    assert!(fs::read(folder.path().join("furnace.png")).unwrap().starts_with(b"\x89PNG"));
    let json = ok(
        &folder,
        "furnace --size 8 --json --multiple-scattering turquin --diffuse burley --model beckmann",
    )
    .stdout;
    let report: serde_json::Value = serde_json::from_slice(&json).unwrap();
    // Five F0 by two splits: the reciprocal one is for Lambert alone.
    assert_eq!(report["furnaces"].as_array().unwrap().len(), 10);
    assert_eq!(report["furnaces"][1]["split"], "albedo");
    refused("furnace --size 1", 2, &["2..=1024"]);
    refused("furnace --model charlie", 4, &["albedo stays below 1"]);
    refused("furnace --model ggx --masking neubelt", 4, &["height-correlated"]);
    refused("furnace --multiple-scattering magic", 2, &["kulla-conty", "'magic'"]);
    refused("furnace -o furnace.exr", 4, &[".png"]);
}

#[test]
fn tables_are_drawn() {
    let folder = tempdir().unwrap();
    let text = ok(&folder, "chart table --lut sheen --size 9x7 -o sheen.png").stdout;
    // Charlie exceeds 1 by far, which no unorm of a table could hold.
    assert!(String::from_utf8(text).unwrap().starts_with("E: 0 to 1.6570"));
    assert!(fs::read(folder.path().join("sheen.png")).unwrap().starts_with(b"\x89PNG"));
    refused("chart table -o sheen.exr", 4, &[".png"]);
    // A row of panels for each slice.
    let text = ok(&folder, "chart table --lut energy --f0 0.02,0.5 --size 4 -o split.png").stdout;
    assert!(String::from_utf8(text).unwrap().starts_with("1-F: 0 to 0.9"));
}

#[test]
fn spheres_are_previewed() {
    let folder = tempdir().unwrap();
    for scene in ["punctual", "furnace", "sky", "glass", "coat", "metal"] {
        ok(&folder, &format!("preview --scene {scene} --size 16 --backend cpu -o {scene}.png"));
        assert!(
            fs::read(folder.path().join(format!("{scene}.png"))).unwrap().starts_with(b"\x89PNG")
        );
    }
    refused("preview --scene moon", 2, &["punctual, furnace, sky, glass, coat, metal"]);
    refused("preview --size 4", 2, &["16..=512"]);
    refused("preview -o preview.exr", 4, &[".png"]);
    refused("preview --backend opencl", 2, &["auto, vulkan, cpu"]);
}
