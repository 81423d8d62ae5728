//! Presets: each is what its flags say, prints them, and bakes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, stderr};
use splitsum::preset::presets;
use std::fs;
use tempfile::tempdir;

fn stdout(arguments: &str) -> String {
    let folder = tempdir().unwrap();
    String::from_utf8(ok(&folder, arguments).stdout).unwrap()
}

#[test]
fn every_preset_of_the_issue_is_there_and_described() {
    let names: Vec<&str> = presets().map(|preset| preset.name).collect();
    for name in [
        "filament",
        "filament-mobile",
        "babylon",
        "babylon-openpbr",
        "gltf",
        "threejs",
        "bevy",
        "unreal",
        "hdrp",
        "hdrp-charlie",
        "godot",
        "o3de",
        "donut",
        "cycles-e",
        "cycles-eavg",
        "eevee",
        "materialx",
        "ospray",
        "openpbr",
        "learnopengl",
        "vtk",
        "ltc-magnitude",
    ] {
        assert!(names.contains(&name), "no {name}");
    }
    let list = stdout("presets");
    let json: serde_json::Value = serde_json::from_str(&stdout("presets --json")).unwrap();
    for (preset, entry) in presets().zip(json.as_array().unwrap()) {
        assert!(list.contains(&format!("{:16} {}", preset.name, preset.about)));
        assert_eq!(entry["flags"], preset.flags);
        let page = stdout(&format!("presets {}", preset.name));
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        for text in [preset.stored, preset.lookup, preset.import, preset.faults, preset.source] {
            assert!(page.contains(text), "{}: {text}", preset.name);
        }
        assert!(page.contains(&preset.command()));
    }
    assert_eq!(run(&tempdir().unwrap(), "presets nothing").status.code(), Some(2));
}

#[test]
fn a_preset_is_its_flags() {
    for preset in presets() {
        // Small, since the size is not what is tested; one row where there is one.
        let size = if preset.flags.contains("32x1") { "8x1" } else { "8x4" };
        let folder = tempdir().unwrap();
        ok(&folder, &format!("bake -q --preset {} --size {size}", preset.name));
        let by_name = fs::read(folder.path().join("out").join(preset.file)).unwrap();
        let command = preset.command();
        let flags = command.strip_prefix("splitsum bake ").unwrap();
        let words: Vec<&str> = flags.split(' ').filter(|word| !word.is_empty()).collect();
        let place = words.iter().position(|word| *word == "--size").unwrap();
        let mut words = words;
        words[place + 1] = size;
        ok(&folder, &format!("bake -q {}", words.join(" ").replace('\'', "")));
        let by_flags = fs::read(folder.path().join(preset.file)).unwrap();
        assert_eq!(by_name, by_flags, "{}", preset.name);
    }
}

#[test]
fn flags_beside_a_preset_change_it_and_another_file_has_its_own_format() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --preset threejs --size 4 -o a.js");
    let text = fs::read_to_string(folder.path().join("a.js")).unwrap();
    assert!(text.contains("export const DATA = new Uint16Array([") && text.contains("width = 4;"));
    ok(&folder, "bake -q --preset babylon --size 4 --precision f16 -o b.dds");
    let dds = fs::read(folder.path().join("b.dds")).unwrap();
    assert_eq!(dds.len(), 148 + 4 * 4 * 8);
    ok(&folder, "bake -q --preset filament --size 4 -o c.ktx2");
    assert!(fs::read(folder.path().join("c.ktx2")).unwrap().starts_with(b"\xabKTX 20"));
    let refused = run(&folder, "bake -q --preset babylon --precision a2b10g10r10");
    assert_eq!(refused.status.code(), Some(4));
    assert!(stderr(&refused).contains("a2b10g10r10"), "{}", stderr(&refused));
    // In a configuration too.
    fs::write(
        folder.path().join("luts.toml"),
        "[[table]]\npreset = 'bevy'\nsize = 4\noutput = 'd.ktx2'\nlookup = 'd.wgsl'\n",
    )
    .unwrap();
    ok(&folder, "bake -q --config luts.toml");
    assert!(fs::read_to_string(folder.path().join("d.wgsl")).unwrap().contains("nov * 4.0 - 0.5"));
}

#[test]
fn the_readme_has_a_line_for_each_engine() {
    let readme = include_str!("../README.md");
    for preset in presets().filter(|preset| preset.name != "filament-mobile") {
        let table = readme.lines().filter(|line| line.contains("--preset"));
        let named = |line: &str| {
            line.contains(&format!("--preset {}`", preset.name))
                || line.contains(&format!("`{}`", preset.name))
        };
        assert!(table.into_iter().any(named), "{}", preset.name);
    }
}

#[test]
fn code_never_replaces_the_table_that_it_is_for() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --size 4 -o t.rs");
    let table = fs::read(folder.path().join("t.rs")).unwrap();
    for arguments in
        ["lookup t.rs -o t.rs", "lookup t.rs -o ./t.rs", "lookup t.rs --language c -o u.rs"]
    {
        let refused = run(&folder, arguments);
        assert_eq!(refused.status.code(), Some(2), "{arguments}: {}", stderr(&refused));
    }
    assert_eq!(fs::read(folder.path().join("t.rs")).unwrap(), table);
    assert!(!folder.path().join("u.rs").exists());
    ok(&folder, "lookup t.rs -o u.rs");
}

#[test]
fn a_file_tells_the_command_that_repeats_it() {
    for (flags, file) in [
        ("--channels=-0.5,b*2,e-1 --size 4", "a.ktx2"),
        ("--size 4 --numbers bits --symbol my_table", "b.h"),
        ("--lut energy --f0 0.02,0.04 --size 4 --slices-as depth", "c.ktx2"),
        ("--size 4 --components 4 --precision f32", "d.exr"),
        ("--size 4 --channels a,b,0,1 --precision unorm8", "e.png"),
    ] {
        let folder = tempdir().unwrap();
        ok(&folder, &format!("bake -q {flags} -o {file}"));
        let bytes = fs::read(folder.path().join(file)).unwrap();
        let plan =
            String::from_utf8(ok(&folder, &format!("bake --dry-run {flags} -o {file}")).stdout);
        let plan = plan.unwrap();
        let command =
            plan.lines().find_map(|line| line.strip_prefix("command   splitsum ")).unwrap();
        let json = command.split('\'').collect::<String>();
        ok(&folder, &format!("{json} -q -o again-{file}"));
        assert_eq!(
            fs::read(folder.path().join(format!("again-{file}"))).unwrap(),
            bytes,
            "{command}"
        );
        // The file says the same, with its format.
        assert!(String::from_utf8_lossy(&bytes).contains(command), "{file}: {command}");
        ok(&folder, &format!("lookup {file} -o code.wgsl"));
    }
}
