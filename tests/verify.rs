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
