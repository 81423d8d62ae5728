//! Files that are written: what they may not be written over, what is left beside them, and whose
//! they are.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, splitsum, stderr};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use std::time::{Duration, SystemTime};
use tempfile::{TempDir, tempdir};

const CPU: &str = "bake --backend cpu --size 2";

/// What the files of a folder hold, by name.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.path().is_file());
    files
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .collect()
}

/// The command is refused with this code and these words, and every file is what it was.
fn refused(folder: &TempDir, arguments: &str, code: i32, said: &[&str]) {
    let before = contents(folder.path());
    let output = run(folder, arguments);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments}: {text}");
    for words in said {
        assert!(text.contains(words), "{arguments}: no '{words}' in: {text}");
    }
    assert!(contents(folder.path()) == before, "{arguments} changed a file");
}

/// A configuration with these outputs, as EXR.
fn configure(folder: &TempDir, name: &str, outputs: &[&str]) {
    let table =
        |output: &&str| format!("[[table]]\noutput = '{output}'\nformat = 'exr'\nsize = 2\n");
    fs::write(folder.path().join(name), outputs.iter().map(table).collect::<String>()).unwrap();
}

#[test]
fn a_configuration_is_no_output() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    for output in ["luts.toml", "./luts.toml", "in/../luts.toml"] {
        configure(&folder, "luts.toml", &["a.exr", output]);
        let said = [
            "luts.toml, table 2: expected a file of its own",
            "which is the configuration",
            "rename",
        ];
        refused(&folder, "bake --backend cpu --config luts.toml", 4, &said);
    }
    configure(&folder, "luts.toml", &["a.exr"]);
    let said = ["a file of its own", "luts.toml, which is the configuration", "-MF"];
    refused(&folder, "bake --backend cpu --config luts.toml -MF ./luts.toml", 2, &said);
}

#[test]
fn a_dependency_file_is_no_table() {
    let folder = tempdir().unwrap();
    refused(&folder, &format!("{CPU} -o z.exr -MF z.exr"), 2, &["z.exr, which is the output"]);
    refused(&folder, &format!("{CPU} -o ./z.exr -MF z.exr"), 2, &["z.exr, which is the output"]);
    configure(&folder, "luts.toml", &["a.exr", "luts.toml.d"]);
    refused(
        &folder,
        "bake --backend cpu --config luts.toml -MD",
        2,
        &["which is the output of luts.toml, table 2"],
    );
    // The folder of the default output does not exist yet.
    refused(
        &folder,
        "bake --backend cpu --size 2 -MF out/dfg.exr",
        2,
        &["out/dfg.exr, which is the output"],
    );
}

#[test]
fn two_outputs_are_two_files() {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    let absolute = folder.path().join("a.exr");
    for second in ["a.exr", "./a.exr", "in/../a.exr", ".//a.exr", absolute.to_str().unwrap()] {
        configure(&folder, "luts.toml", &["a.exr", second]);
        refused(
            &folder,
            "bake --backend cpu --config luts.toml",
            4,
            &["table 2", "the output of luts.toml, table 1"],
        );
    }
    configure(&folder, "luts.toml", &["a.exr", "in/a.exr", "b.exr"]);
    ok(&folder, "bake --backend cpu --config luts.toml");
}

#[cfg(unix)]
#[test]
fn links_are_what_they_lead_to() {
    use std::os::unix::fs::symlink;
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    configure(&folder, "luts.toml", &["link.exr"]);
    symlink("luts.toml", at("link.exr")).unwrap();
    refused(
        &folder,
        "bake --backend cpu --config luts.toml",
        4,
        &["link.exr, which is the configuration"],
    );
    fs::remove_file(at("link.exr")).unwrap();
    fs::hard_link(at("luts.toml"), at("link.exr")).unwrap();
    refused(
        &folder,
        "bake --backend cpu --config luts.toml",
        4,
        &["link.exr, which is the configuration"],
    );
    // Links to what is not there yet, and through a folder.
    symlink("new.exr", at("dangling.exr")).unwrap();
    symlink(".", at("here")).unwrap();
    for pair in [["dangling.exr", "new.exr"], ["here/new.exr", "new.exr"]] {
        configure(&folder, "other.toml", &pair);
        refused(
            &folder,
            "bake --backend cpu --config other.toml",
            4,
            &["which is the output of other.toml, table 1"],
        );
    }
    ok(&folder, &format!("{CPU} -o dangling.exr"));
    assert!(fs::symlink_metadata(at("dangling.exr")).unwrap().is_symlink());
    assert!(fs::symlink_metadata(at("new.exr")).unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn devices_may_be_named_twice() {
    let folder = tempdir().unwrap();
    configure(&folder, "luts.toml", &["/dev/null", "/dev/null"]);
    ok(&folder, "bake --backend cpu --config luts.toml -MF /dev/null");
}

#[test]
fn measurements_are_no_chart() {
    let folder = tempdir().unwrap();
    let saved = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/figures/stability.json");
    fs::create_dir(folder.path().join("f")).unwrap();
    fs::copy(saved, folder.path().join("stability.md")).unwrap();
    let said = ["stability.md, which is the file of measurements", "another folder"];
    refused(&folder, "chart stability --from stability.md -o ./", 2, &said);
    // The measurements' own file is only read.
    fs::copy(saved, folder.path().join("f/stability.json")).unwrap();
    ok(&folder, "chart stability --from f/stability.json -o f");
    assert!(contents(&folder.path().join("f"))["stability.json"] == fs::read(saved).unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn a_killed_bake_leaves_nothing() {
    use std::os::unix::process::ExitStatusExt;
    // A file system in memory can make files without a name; the limit's signal kills as kill -9
    // does, and always in time.
    let folder = tempfile::tempdir_in("/dev/shm").unwrap();
    fs::write(folder.path().join("a.exr"), "the old file").unwrap();
    let script = format!(
        "ulimit -c 0 -f 1; exec {} bake --backend cpu --size 64 -o a.exr",
        env!("CARGO_BIN_EXE_splitsum")
    );
    let status = std::process::Command::new("bash")
        .current_dir(&folder)
        .args(["-c", &script])
        .status()
        .unwrap();
    assert!(status.signal().is_some(), "{status}");
    assert_eq!(
        contents(folder.path()),
        BTreeMap::from([("a.exr".into(), b"the old file".to_vec())])
    );
}

#[test]
fn what_killed_bakes_have_left_is_removed() {
    let folder = tempdir().unwrap();
    let file = |name: &str, age: u64| {
        let file = File::create(folder.path().join(name)).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).unwrap();
        file
    };
    fs::create_dir(folder.path().join(".splitsum-folder.tmp")).unwrap();
    drop((
        file(".splitsum-oldone.tmp", 120),
        file(".splitsum-recent.tmp", 5),
        file(".splitsum-notes.txt", 120),
    ));
    // Ours have six letters.
    drop(file(".splitsum-my-notes.tmp", 120));
    let written = file(".splitsum-writes.tmp", 120);
    written.lock().unwrap();
    ok(&folder, &format!("{CPU} -o a.exr"));
    let kept = [
        ".splitsum-my-notes.tmp",
        ".splitsum-notes.txt",
        ".splitsum-recent.tmp",
        ".splitsum-writes.tmp",
        "a.exr",
    ];
    assert_eq!(contents(folder.path()).into_keys().collect::<Vec<_>>(), kept);
    assert!(folder.path().join(".splitsum-folder.tmp").exists());
}

#[cfg(unix)]
#[test]
fn a_replaced_file_stays_whose_it_was() {
    use std::os::unix::fs::{MetadataExt, chown};
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    fs::write(&path, "old").unwrap();
    // Root alone can give files away; for others the file is their own.
    let given = chown(&path, Some(65534), Some(65533)).is_ok();
    let owner = || fs::metadata(&path).map(|metadata| (metadata.uid(), metadata.gid())).unwrap();
    let before = owner();
    assert!(!given || before == (65534, 65533));
    ok(&folder, &format!("{CPU} -o a.exr"));
    assert_eq!(owner(), before);
    assert_ne!(fs::read(&path).unwrap(), b"old");
}

#[cfg(unix)]
#[test]
fn a_file_that_is_not_ours_to_write_is_refused() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // Root may write everything, and so becomes nobody, who can reach the program only here.
    fs::copy(env!("CARGO_BIN_EXE_splitsum"), at("program")).unwrap();
    let root = fs::metadata(at("program")).unwrap().uid() == 0;
    fs::write(at("a.exr"), "old").unwrap();
    fs::set_permissions(at("a.exr"), PermissionsExt::from_mode(0o444)).unwrap();
    fs::create_dir(at("locked")).unwrap();
    if root {
        chown(&folder, Some(65534), Some(65534)).unwrap();
    }
    fs::set_permissions(at("locked"), PermissionsExt::from_mode(0o555)).unwrap();
    for (name, words) in [
        ("a.exr", "cannot write a.exr: Permission denied"),
        ("locked/b.exr", "cannot write to the folder of locked/b.exr"),
    ] {
        let mut arguments =
            vec!["./program", "bake", "--backend", "cpu", "--size", "2", "-o", name];
        if root {
            arguments.splice(
                0..0,
                ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"],
            );
        }
        let output = std::process::Command::new(arguments[0])
            .args(&arguments[1..])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    assert_eq!(fs::read(at("a.exr")).unwrap(), b"old");
    fs::set_permissions(at("locked"), PermissionsExt::from_mode(0o755)).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn closed_standard_output_is_an_error_before_any_work() {
    let folder = tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_splitsum");
    let code = |arguments: &str| {
        let script = format!("exec {program} {arguments}");
        let output = std::process::Command::new("bash")
            .current_dir(&folder)
            .args(["-c", &script])
            .output()
            .unwrap();
        (output.status.code(), stderr(&output).contains("standard output: it is closed"))
    };
    for arguments in
        [format!("{CPU} -o -"), format!("{CPU} -o a.exr --json"), "furnace --size 2 --json".into()]
    {
        assert_eq!(code(&format!("{arguments} >&-")), (Some(3), true), "{arguments}");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "{arguments} wrote a file");
    }
    for arguments in
        [format!("{CPU} -q -o - >/dev/null"), format!("{CPU} -q -o b.exr --json >/dev/null")]
    {
        assert_eq!(code(&arguments), (Some(0), false), "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn pipes_get_the_bytes_of_files() {
    let folder = tempdir().unwrap();
    ok(&folder, &format!("{CPU} -o a.exr"));
    let file = fs::read(folder.path().join("a.exr")).unwrap();
    for name in ["-", "/dev/stdout"] {
        assert!(ok(&folder, &format!("{CPU} --format exr -o {name}")).stdout == file, "{name}");
    }
}

#[test]
fn messages_stay_short() {
    let folder = tempdir().unwrap();
    let short = |output: &std::process::Output, code: i32, said: &[&str]| {
        let text = stderr(output);
        let beginning: String = text.chars().take(1000).collect();
        assert_eq!(output.status.code(), Some(code), "{beginning}");
        assert!(text.len() < 5000, "{} bytes: {beginning}", text.len());
        for words in said {
            assert!(text.contains(words), "no '{words}' in: {text}");
        }
    };
    let long = "é".repeat(400_000);
    for line in [
        format!("output = '{long}' x"),
        format!("rougness = '{long}'"),
        format!("model = '{long}'"),
    ] {
        fs::write(folder.path().join("long.toml"), format!("[[table]]\n{line}\n")).unwrap();
        short(&run(&folder, "bake --config long.toml"), 4, &["long.toml", "more characters"]);
    }
    fs::write(
        folder.path().join("long.json"),
        format!("{{\"tool\":\"x\",\"machine\":\"{long}\"}}"),
    )
    .unwrap();
    short(&run(&folder, "chart speed --from long.json"), 4, &["more characters", "measure anew"]);
    // What a command line can hold.
    let long = "é".repeat(50_000);
    let with = |arguments: &str| splitsum(folder.path(), arguments).arg(&long).output().unwrap();
    short(&with("bake --model"), 2, &["more characters", "possible values: ggx"]);
    short(&with("bake --size 2 --frobnicate"), 2, &["--frobnicate"]);
    short(&with("bake --tolerance"), 2, &["more characters", "--tolerance"]);
    short(&with("bake --rule h56 --tolerance 1e-3 --config"), 2, &["cannot be used with"]);
}

#[test]
fn files_are_compared_in_folders_that_are_yet_to_be_made() {
    let folder = tempdir().unwrap();
    configure(&folder, "c.toml", &["out/dfg.exr", "out/../out/dfg.exr"]);
    refused(&folder, "bake --config c.toml", 4, &["a file of its own"]);
    refused(&folder, "bake --size 2 -MF out/../out/dfg.exr", 2, &["a file of its own"]);
    assert!(!folder.path().join("out").exists());
}

#[cfg(unix)]
#[test]
fn a_file_that_standard_output_goes_to_is_no_dependency_file() {
    let folder = tempdir().unwrap();
    let out = File::create(folder.path().join("z.exr")).unwrap();
    let output =
        splitsum(folder.path(), &format!("{CPU} -o - -MF z.exr")).stdout(out).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("a file of its own"), "{}", stderr(&output));
}

#[cfg(unix)]
#[test]
fn links_in_a_circle_stay_links() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::os::unix::fs::symlink(path("b.exr"), path("a.exr")).unwrap();
    std::os::unix::fs::symlink(path("a.exr"), path("b.exr")).unwrap();
    let output = run(&folder, &format!("{CPU} -o a.exr"));
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(fs::read_link(path("a.exr")).is_ok());
}
