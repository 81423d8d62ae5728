//! Dependency files as make and ninja read them: built once, all is up to date; after a change of
//! the configuration it is not. A tool that is not installed is reported as ignored, with the
//! reason; where SPLITSUM_REQUIRE_MAKE is set (in .ci/run, which installs both), that is a failure
//! instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use libtest_mimic::{Arguments, Failed, Trial};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};
use tempfile::{TempDir, tempdir};

/// A name for an output or a configuration, and which of the two it is for.
struct Case {
    name: String,
    target: bool,
}

fn main() {
    let trials = vec![
        of_tool("make", "reads every name", || all(make_reads)),
        of_tool("make", "reads several outputs", make_reads_several),
        of_tool("ninja", "reads every name that it can read", || all(ninja_reads)),
        Trial::test(
            "names that make cannot read are refused before any work",
            unreadable_names_are_refused,
        ),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn of_tool(tool: &'static str, what: &str, test: fn() -> Result<(), Failed>) -> Trial {
    let name = format!("{tool} {what}");
    let installed = cfg!(unix) && Command::new(tool).arg("--version").output().is_ok();
    match (installed, std::env::var_os("SPLITSUM_REQUIRE_MAKE")) {
        (true, _) => Trial::test(name, test),
        (false, None) => Trial::test(format!("{name} ({tool} is not installed)"), || Ok(()))
            .with_ignored_flag(true),
        (false, Some(_)) => Trial::test(name, move || {
            Err(format!("SPLITSUM_REQUIRE_MAKE is set, but there is no {tool}").into())
        }),
    }
}

fn all(test: fn(&Case) -> Result<(), String>) -> Result<(), Failed> {
    let cases = cases();
    assert!(cases.len() > 300, "{} cases", cases.len());
    let wrong: Vec<String> = cases.iter().filter_map(|case| test(case).err()).collect();
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

/// Each special character in every place, behind backslashes, and names of many of them.
fn cases() -> Vec<Case> {
    let mut names: Vec<String> = Vec::new();
    for c in " #:$%|;\t=&*?[]\\~(){}!^@<>'\",+`-é".chars() {
        let forms = [
            format!("a{c}b"),
            format!("{c}b"),
            format!("a{c}"),
            format!("a\\{c}b"),
            format!("a\\\\{c}{c}b"),
        ];
        names.extend(forms);
    }
    let alphabet: Vec<char> = "ab\\\\\\ #:$%|;\t=&*[".chars().collect();
    let mut state = 20261125_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    for _ in 0..120 {
        let length = 1 + random(7);
        names.push((0..length).map(|_| alphabet[random(alphabet.len())]).collect());
    }
    let words = ["define", "undefine", "override", "export", "private", "include", ".hidden"];
    names.extend(["a folder/of tables/a:b#c"].into_iter().chain(words).map(String::from));
    let cases = names
        .into_iter()
        .flat_map(|name| [true, false].map(|target| Case { name: name.clone(), target }));
    cases.filter(Case::is_readable).collect()
}

impl Case {
    /// Whether make can read the name at all, as the README has it, and be asked for it.
    fn is_readable(&self) -> bool {
        let has = |characters: &[char]| self.name.contains(characters);
        let refused = self.name.starts_with('~')
            || self.name.ends_with(')') && self.name.contains('(')
            || self.target && has(&['%']) && has(&['*', '?', '['])
            || !self.target && self.name.ends_with([' ', '\t']);
        // Make takes an argument with an = for a variable, so that only its first target, which has
        // no %, can be asked for.
        let cannot_be_asked_for = self.target && has(&['=']) && has(&['%']);
        !refused && !cannot_be_asked_for
    }

    /// As the README has it.
    fn is_readable_by_ninja(&self) -> bool {
        let Case { name, target } = self;
        let unknown = name
            .contains(['"', '&', '\'', '*', ';', '<', '>', '?', '[', '^', '`', '|', '\t'])
            || *target && name.contains(['%', '=']);
        let backslashes = ["\\#", "\\:", "\\$", "\\="].iter().any(|pair| name.contains(pair))
            || name.ends_with('\\');
        !unknown && !backslashes && (*target || !name.ends_with(':'))
    }

    fn output(&self) -> &str {
        if self.target { &self.name } else { "out" }
    }

    fn configuration(&self) -> &str {
        if self.target { "conf" } else { &self.name }
    }

    /// A folder with the configuration.
    fn folder(&self) -> TempDir {
        // In memory, where there is such a folder: each test waits for the disk several times.
        let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempdir()).unwrap();
        for name in [self.output(), self.configuration()] {
            fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        }
        // Outputs are relative to the configuration.
        let depth = self.configuration().matches('/').count();
        let output =
            serde_json::to_string(&format!("{}{}", "../".repeat(depth), self.output())).unwrap();
        let text = format!("[[table]]\noutput = {output}\nformat = 'exr'\nsize = 1\n");
        fs::write(folder.path().join(self.configuration()), text).unwrap();
        folder
    }

    /// Runs the command where rules find what they need; what they run is noted in the file `runs`.
    fn command(&self, folder: &Path, program: &str) -> Command {
        let mut command = Command::new(program);
        let bake = format!("{} bake --backend cpu --threads 1 -q", env!("CARGO_BIN_EXE_splitsum"));
        command
            .current_dir(folder)
            .env("BAKE", bake)
            .env("CONF", self.configuration())
            .env("MT", self.output());
        command
    }

    /// What is wrong unless the command succeeds with so many runs so far.
    fn expect(&self, when: &str, runs: u64, folder: &Path, output: &Output) -> Result<(), String> {
        let noted = fs::metadata(folder.join("runs")).map_or(0, |metadata| metadata.len());
        if output.status.success() && noted == runs {
            return Ok(());
        }
        let place = if self.target { "output" } else { "configuration" };
        let rule = fs::read_to_string(folder.join("deps")).unwrap_or_default();
        Err(format!(
            "{place} {:?}, {when}: {noted} runs for {runs}: {rule:?}, {output:?}",
            self.name
        ))
    }
}

fn set_age(path: &Path, seconds: u64) {
    File::options()
        .write(true)
        .open(path)
        .unwrap()
        .set_modified(SystemTime::now() - Duration::from_secs(seconds))
        .unwrap();
}

/// The target is named as a path from where make runs, as a build would do; -MT keeps `../` out of
/// it.
const RECIPE: &str = "printf 1 >>runs; $$BAKE --config=\"$$CONF\" -MF deps --mt=\"$$MT\"";

fn make_reads(case: &Case) -> Result<(), String> {
    let folder = case.folder();
    let path = folder.path();
    fs::write(path.join("rules"), format!("%:\n\t@{RECIPE}\n")).unwrap();
    let goal = (!case.output().contains('=')).then(|| case.output());
    let make = || {
        let arguments = ["-srR", "-f", "deps", "-f", "rules", "--"].into_iter().chain(goal);
        case.command(path, "make").args(arguments).output().unwrap()
    };
    let bake = RECIPE.replace("$$", "$").replace("printf 1 >>runs; ", "");
    let baked = case.command(path, "sh").args(["-c", &bake]).output().unwrap();
    case.expect("baked", 0, path, &baked)?;
    set_age(&path.join(case.output()), 100);
    set_age(&path.join(case.configuration()), 200);
    case.expect("built once", 0, path, &make())?;
    set_age(&path.join(case.configuration()), 50);
    case.expect("changed", 1, path, &make())?;
    case.expect("built again", 1, path, &make())
}

fn make_reads_several() -> Result<(), Failed> {
    let folder = tempdir()?;
    let at = |name: &str| folder.path().join(name);
    let outputs = ["a b", "c:d", "e%f", "g&", "h;i", "j*k", "l\\"];
    let table = |name: &&str| format!("[[table]]\noutput = '{name}'\nformat = 'exr'\nsize = 1\n");
    fs::write(at("luts.toml"), outputs.iter().map(table).collect::<String>())?;
    fs::write(at("rules"), "%:\n\t@printf 1 >>runs\n")?;
    let mut bake = Command::new(env!("CARGO_BIN_EXE_splitsum"));
    let bake = bake.current_dir(&folder).args([
        "bake",
        "--backend",
        "cpu",
        "-q",
        "--config",
        "luts.toml",
        "-MF",
        "deps",
    ]);
    assert!(bake.status()?.success());
    for (age, runs) in [(200, 0), (50, 1)] {
        set_age(&at("luts.toml"), age);
        for output in outputs {
            set_age(&at(output), 100);
            let _ = fs::remove_file(at("runs"));
            let arguments = ["-srR", "-f", "deps", "-f", "rules", output];
            let made = Command::new("make").current_dir(&folder).args(arguments).output()?;
            let noted = fs::metadata(at("runs")).map_or(0, |metadata| metadata.len());
            assert_eq!((made.status.code(), noted), (Some(0), runs), "{output}: {made:?}");
        }
    }
    Ok(())
}

fn ninja_reads(case: &Case) -> Result<(), String> {
    if !case.is_readable_by_ninja() {
        return Ok(());
    }
    let folder = case.folder();
    let path = folder.path();
    let output = case.output().replace('$', "$$");
    let output = if output.starts_with(' ') { format!("${output}") } else { output };
    let rules = format!(
        "t = {output}\nrule bake\n  depfile = deps\n  command = {RECIPE}\nbuild $t: bake\n"
    );
    fs::write(path.join("build.ninja"), rules).unwrap();
    let ninja = || case.command(path, "ninja").output().unwrap();
    set_age(&path.join(case.configuration()), 200);
    case.expect("new", 1, path, &ninja())?;
    case.expect("built once", 1, path, &ninja())?;
    let later = SystemTime::now() + Duration::from_secs(5);
    File::options()
        .write(true)
        .open(path.join(case.configuration()))
        .unwrap()
        .set_modified(later)
        .unwrap();
    case.expect("changed", 2, path, &ninja())
}

fn unreadable_names_are_refused() -> Result<(), Failed> {
    let folder = tempdir()?;
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        let flags = ["bake", "--backend", "cpu", "-q", "-MF", "deps"];
        let output = command.current_dir(&folder).args(flags).args(arguments).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        assert!(text.contains(words), "no '{words}' in: {text}");
    };
    let output = ["--size", "1", "--format", "exr", "-o"];
    for (name, words) in [
        ("a\nb", "line break"),
        ("a\rb", "line break"),
        ("~root", "home"),
        ("~", "home"),
        ("a(b)", "archive"),
        ("a%b*", "no % beside"),
        (".PHONY", "capitals after a dot"),
    ] {
        refused(&[&output[..], &[name]].concat(), 2, words);
    }
    for (name, words) in [("", "expected a name"), ("a\nb", "line break")] {
        refused(&[&output[..], &["a.exr", "-MT", name]].concat(), 2, words);
    }
    assert_eq!(fs::read_dir(&folder)?.count(), 0, "something was written");
    fs::write(folder.path().join("conf"), "[[table]]\noutput = \"a\\nb\"\nformat = 'exr'\n")?;
    refused(&["--config", "conf"], 4, "conf, table 1: expected no line break");
    fs::write(folder.path().join("conf "), "[[table]]\noutput = 'a.exr'\n")?;
    refused(&["--config", "conf "], 2, "no blank at the end");
    assert_eq!(fs::read_dir(&folder)?.count(), 2, "something was written");
    Ok(())
}
