//! `splitsum verify` and `splitsum convert`: files of ours and of others, their faults, exit codes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run};
use std::fs;
use tempfile::{TempDir, tempdir};

/// The program's report of a file, its exit code, and its faults.
fn verified(folder: &TempDir, arguments: &str) -> (serde_json::Value, i32, Vec<String>) {
    let output = run(folder, &format!("verify --json {arguments}"));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    let faults = json["faults"].as_array().cloned().unwrap_or_default();
    let names = faults.iter().map(|fault| fault["name"].as_str().unwrap().to_owned()).collect();
    (json, output.status.code().unwrap(), names)
}

#[test]
fn files_of_ours_are_held_against_their_own_metadata() {
    for (flags, file) in [
        ("", "t.exr"),
        ("--channels b,e,charlie", "t.ktx2"),
        ("--precision unorm16", "t.png"),
        ("--y alpha,edges,flip", "t.h"),
        ("--lut glass --side both", "g.ktx2"),
        ("--lut energy --z f0,sqrt --size 16x16x3", "s.exr"),
        ("--lut diffuse", "d.ktx2"),
    ] {
        let folder = tempdir().unwrap();
        let size = if flags.contains("--size") { "" } else { "--size 16" };
        ok(&folder, &format!("bake -q {flags} {size} -o {file}"));
        let (json, code, faults) = verified(&folder, file);
        assert_eq!((code, faults.len()), (0, 0), "{flags}: {json:#}");
        assert_eq!(json["status"], "known", "{flags}");
    }
}

#[test]
fn a_changed_file_of_ours_is_found_out() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --size 16 -o t.ktx2");
    let bytes = fs::read(folder.path().join("t.ktx2")).unwrap();
    let texels = bytes.len() - 16 * 16 * 4;
    let changed = |name: &str, change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = bytes.clone();
        change(&mut bytes);
        fs::write(folder.path().join(name), bytes).unwrap();
        let (json, code, faults) = verified(&folder, name);
        assert_eq!(code, 7, "{name}: {json:#}");
        assert!(faults.contains(&"not-as-baked".to_owned()), "{name}: {faults:?}");
        json["faults"].to_string()
    };
    // The lowest bit of one value.
    let text = changed("value", &|bytes| bytes[texels + 4 * (16 * 5 + 3)] ^= 1);
    assert!(text.contains("1 of 512 values") && text.contains("texel (3, 5)"), "{text}");
    changed("row", &|bytes| {
        bytes[texels + 64 * 2..][..64].chunks_exact_mut(4).for_each(|t| t.swap(0, 2))
    });
    changed("rows", &|bytes| {
        let rows: Vec<u8> = bytes[texels..].chunks_exact(64).rev().flatten().copied().collect();
        bytes[texels..].copy_from_slice(&rows);
    });
    changed("channels", &|bytes| {
        bytes[texels..].chunks_exact_mut(4).for_each(|texel| texel.rotate_left(2));
    });
    // Every row has the values of the next.
    changed("node", &|bytes| bytes.copy_within(texels + 64.., texels));
    let text = changed("metadata", &|bytes| {
        let field = b"\"masking\":\"height";
        let at = bytes.windows(field.len()).position(|part| part == field).unwrap();
        bytes[at + field.len() - 1] = b'_';
    });
    assert!(text.contains("masking"), "{text}");
}

#[test]
fn a_table_that_is_not_an_engines_is_told_so() {
    let folder = tempdir().unwrap();
    for (flags, preset, wanted) in [
        ("--channels ab --size 16", "threejs", Some("transposed")),
        ("--channels ab --size 16 --y roughness,flip", "bevy", Some("flipped")),
        ("--channels ab --size 32 --y roughness,offset=1.5", "bevy", Some("shifted-nodes")),
        ("--channels ba --size 16", "bevy", Some("wrong-channels")),
        ("--channels ab --masking schlick-smith --size 16", "bevy", Some("wrong-masking")),
        ("--channels ab --model beckmann --size 16", "bevy", Some("wrong-distribution")),
        ("--channels ab --y alpha --size 16", "bevy", Some("wrong-mapping")),
        ("--channels ab --size 16", "bevy", None),
        ("--x roughness --y nov --channels ab --size 16", "threejs", None),
        (
            "--channels b,e --x nov,sqrt,edges --y roughness,edges --size 16",
            "hdrp",
            Some("wrong-size"),
        ),
    ] {
        let flags = flags.replace("--channels ba", "--channels b,a");
        // Raw texels say nothing of themselves.
        ok(&folder, &format!("bake -q {flags} --precision f16 --format raw -o t.raw"));
        let size = if flags.contains("32") { "32x32" } else { "16x16" };
        let (json, code, faults) =
            verified(&folder, &format!("t.raw --raw {size},rg16f --as {preset}"));
        match wanted {
            Some(wanted) => {
                assert_eq!(code, 7, "{flags}");
                assert!(faults.contains(&wanted.to_owned()), "{flags}: {faults:?}");
            }
            None => assert_eq!((code, faults.len()), (0, 0), "{flags}: {json:#}"),
        }
    }
}

#[test]
fn bounds_allowances_pages_and_bad_input() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --size 32 --precision unorm8 -o t.png");
    assert_eq!(verified(&folder, "t.png").1, 7);
    let (_, code, faults) = verified(&folder, "t.png --allow 8-bit --html t.html");
    assert_eq!((code, faults), (0, vec!["8-bit".to_owned()]));
    let page = fs::read_to_string(folder.path().join("t.html")).unwrap();
    assert!(page.contains("8-bit") && page.contains("data:image/png;base64,"));
    // Half a step of 8 bits is 0.00196.
    assert_eq!(verified(&folder, "t.png --allow 8-bit --max-error 0.002").1, 0);
    let (_, code, faults) = verified(&folder, "t.png --allow 8-bit --max-error 0.0019");
    assert_eq!(code, 7);
    assert!(faults.contains(&"beyond-bound".to_owned()));
    fs::write(
        folder.path().join("cut.png"),
        &fs::read(folder.path().join("t.png")).unwrap()[..300],
    )
    .unwrap();
    fs::write(folder.path().join("words"), "no table").unwrap();
    for (arguments, code) in [
        ("nothing.exr", 3),
        ("cut.png", 4),
        ("words", 4),
        ("t.png --max-error nan", 4),
        ("t.png --raw 4x4,rgb9", 4),
        ("t.png --raw 99999999x99999999,rgba32f", 4),
        ("t.png --html t.png", 2),
        ("t.png --as nobody", 2),
        ("", 2),
    ] {
        assert_eq!(
            run(&folder, &format!("verify {arguments}")).status.code(),
            Some(code),
            "{arguments}"
        );
    }
}

#[test]
fn a_table_is_converted_by_a_bake() {
    let folder = tempdir().unwrap();
    let flags =
        "--size 32 --x roughness,edges --y nov,sqrt,flip --precision f16 --format raw -o t.raw";
    ok(&folder, &format!("bake -q {flags}"));
    ok(&folder, "convert -q t.raw t.ktx2 --raw 32x32,rg16f --preset bevy");
    ok(&folder, "bake -q --preset bevy -o b.ktx2");
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("t.ktx2"), read("b.ktx2"));
    fs::write(folder.path().join("n.raw"), vec![0x3c; 1024]).unwrap();
    let refused = run(&folder, "convert n.raw n.ktx2 --raw 16x16,rg16f --preset bevy");
    assert_eq!(refused.status.code(), Some(4));
    assert!(!folder.path().join("n.ktx2").exists());
    // Glass is no table of Bevy's.
    ok(&folder, "bake -q --lut glass --ior 1.5 --size 24 --precision f16 --format raw -o g.raw");
    let refused = run(&folder, "convert g.raw g.ktx2 --raw 24x24,rg16f --preset bevy");
    assert_eq!(refused.status.code(), Some(4));
    assert!(!folder.path().join("g.ktx2").exists());
    assert_eq!(
        run(&folder, "convert t.raw t.raw --raw 32x32,rg16f --preset bevy").status.code(),
        Some(2)
    );
}

#[test]
fn the_catalogue_names_flags_that_bake() {
    let folder = tempdir().unwrap();
    let json = ok(&folder, "verify --catalogue --json").stdout;
    let tables: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let tables = tables.as_array().unwrap();
    assert!(tables.len() >= 10);
    for table in tables {
        let flags = table["convention"].as_str().unwrap();
        ok(
            &folder,
            &format!("bake --dry-run {flags} -o t.ktx2").replace("-o t.ktx2", output(flags)),
        );
        assert!(!table["source"].as_str().unwrap().is_empty());
    }
}

/// A file that has the storage of these flags.
fn output(flags: &str) -> &'static str {
    if flags.contains("--side") { "-o t.exr" } else { "-o t.ktx2" }
}

#[test]
fn odd_files_are_judged_without_a_panic() {
    let folder = tempdir().unwrap();
    let raw = |name: &str, texel: &dyn Fn(usize) -> [u8; 4], count: usize| {
        let bytes: Vec<u8> = (0..count).flat_map(texel).collect();
        fs::write(folder.path().join(name), bytes).unwrap();
    };
    // Alpha divides in the second slice alone; alpha is a channel; alpha is 0 in places; one row.
    raw("slices", &|k| [k as u8, (k / 3) as u8, 7, if k < 256 { 255 } else { 128 }], 512);
    raw("alpha", &|k| [0, 0, (k % 16 * 16) as u8, (k / 16 * 15) as u8], 256);
    raw("holes", &|k| [k as u8, (255 - k) as u8, 0, if k % 3 == 0 { 0 } else { 128 }], 256);
    raw("row", &|k| [k as u8, 3, 4, 255], 64);
    for (file, size) in
        [("slices", "16x16x2"), ("alpha", "16x16"), ("holes", "16x16"), ("row", "64x1")]
    {
        let (json, code, _) = verified(&folder, &format!("{file} --raw {size},rgba8"));
        assert_eq!(code, 7, "{file}: {json:#}");
    }
    // A table of ours with an alpha that is cut out in places.
    ok(&folder, "bake -q --size 16 --channels a,b,0,1 --precision unorm8 --format raw -o t.raw");
    let mut bytes = fs::read(folder.path().join("t.raw")).unwrap();
    bytes.chunks_exact_mut(4).step_by(3).for_each(|texel| texel[3] = 0);
    bytes[7] = 128;
    fs::write(folder.path().join("t.raw"), bytes).unwrap();
    let (json, ..) = verified(&folder, "t.raw --raw 16x16,rgba8");
    assert_eq!(json["status"], "known", "{json:#}");
}

#[test]
fn metadata_neither_take_hours_nor_the_terminal() {
    let folder = tempdir().unwrap();
    let text = "// splitsum 0.1.0: splitsum bake --x \u{1b}[31mRED\u{7}\nT = [1, 2, 3, 4];\n";
    fs::write(folder.path().join("t.js"), text).unwrap();
    let output = run(&folder, "verify t.js");
    assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
    assert_eq!(output.status.code(), Some(7));
    let numbers = vec!["0.5"; 128 * 128].join(", ");
    let command = "--channels e --size 128 --precision f32 --estimator \
                   hammersley,n=1048576,frame=cos --format js";
    let text = format!("// splitsum 0.1.0: splitsum bake {command}\nT = [{numbers}];\n");
    fs::write(folder.path().join("long.js"), text).unwrap();
    let start = std::time::Instant::now();
    let (json, ..) = verified(&folder, "long.js");
    assert!(json["file"]["notes"].to_string().contains("not baked again"), "{json:#}");
    // The bake itself would take a minute and more.
    assert!(start.elapsed().as_secs() < 20);
}

#[test]
fn axes_that_are_the_same_by_other_words_are_no_fault() {
    let folder = tempdir().unwrap();
    for flags in [
        "--size 24x10 --y alpha,sqrt -o t.h",
        "--size 16 --y roughness,square -o t.ktx2",
        "--size 16 --y roughness,offset=0.4 -o t.exr",
        "--model blinn-phong --y exponent --size 16 -o e.exr",
        "--lut glass --side inside --x critical --size 16 -o c.exr",
    ] {
        ok(&folder, &format!("bake -q {flags}"));
        let file = flags.split(' ').next_back().unwrap();
        let file = if file == "t.h" { "t.h --raw 24x10,rg16f" } else { file };
        let (json, code, _) = verified(&folder, file);
        assert_eq!(code, 0, "{flags}: {json:#}");
    }
}

#[test]
fn a_channel_that_an_engine_misses_is_a_fault() {
    let folder = tempdir().unwrap();
    for channels in ["b,e,0", "b,e", "b,e,nov"] {
        ok(&folder, &format!("bake -q --channels {channels} --size 128 --format npy -o t.npy"));
        let (_, code, faults) = verified(&folder, "t.npy --as filament");
        assert_eq!((code, faults), (7, vec!["wrong-channels".to_owned()]), "{channels}");
    }
    // Another masking is one fault, not three.
    ok(&folder, "bake -q --masking separable --size 16 --format npy -o t.npy");
    let faults = verified(&folder, "t.npy --as bevy").2;
    assert_eq!(faults, ["wrong-masking"]);
}

#[test]
fn arrays_of_source_code_are_found_behind_their_lengths_and_types() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --size 8 --precision f32 --format txt -o t.txt");
    let numbers = fs::read_to_string(folder.path().join("t.txt")).unwrap();
    for (text, arguments) in [
        (format!("const float DATA[1][8][8][2] = {{{numbers}}};"), "--array DATA"),
        (format!("static DATA: &'static [f32] = &[{numbers}];"), ""),
        (format!("DATA = np.array([{numbers}], dtype=np.float32).reshape(8, 8, 2)"), ""),
        (numbers.clone(), "--raw 8x8,rg32f"),
    ] {
        fs::write(folder.path().join("source"), &text).unwrap();
        let (json, code, _) = verified(&folder, &format!("source {arguments}"));
        assert_eq!((code, &json["status"]), (0, &"known".into()), "{arguments}: {json:#}");
    }
}
