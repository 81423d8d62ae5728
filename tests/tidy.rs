//! The architecture's invariants, as src/lib.rs and the README state them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::integrate::Integrand;
use splitsum::integrate::rule::Method;
use std::fs;
use std::path::{Path, PathBuf};

/// All files below a folder of the repository, by path from its root.
fn files(folder: &str) -> Vec<(String, String)> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let others = ["node_modules", "foreign/target", "fuzz/target", "hostile/corpus"];
            let foreign = others.iter().any(|other| path.ends_with(other));
            match path.is_dir() {
                _ if foreign => (),
                true => walk(&path, found),
                false => found.push(path),
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    walk(&root.join(folder), &mut found);
    found.sort();
    let name = |path: &Path| path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
    found.iter().filter_map(|path| Some((name(path), fs::read_to_string(path).ok()?))).collect()
}

fn file(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// The modules of the crate in the order in which src/lib.rs declares them.
fn modules() -> Vec<String> {
    let lib = file("src/lib.rs");
    lib.lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';').map(str::to_owned))
        .collect()
}

/// The top-level module that a file of src belongs to; none for lib.rs and main.rs.
fn module_of(path: &str) -> Option<&str> {
    let name = path.strip_prefix("src/")?.split('/').next()?.trim_end_matches(".rs");
    (name != "lib" && name != "main").then_some(name)
}

/// The top-level modules that a text names after `crate::`.
fn uses(text: &str) -> Vec<&str> {
    let name =
        |rest: &'_ str| rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    text.split("crate::").skip(1).map(|rest| &rest[..name(rest)]).collect()
}

#[test]
fn a_module_uses_only_modules_above_it() {
    let modules = modules();
    let place = |name: &str| modules.iter().position(|module| module == name);
    assert!(modules.len() > 10);
    for (path, text) in files("src") {
        let Some(own) = module_of(&path)
            .map(|name| place(name).unwrap_or_else(|| panic!("{path} is in no module")))
        else {
            continue;
        };
        for used in uses(&text) {
            // What is no module is an item of lib.rs itself, which only the command line stands
            // above.
            let above = place(used).map_or(modules[own] == "cli", |used| used <= own);
            assert!(above, "{path} uses crate::{used}, which does not stand above it");
        }
    }
}

#[test]
fn the_map_in_lib_rs_lists_the_modules_in_order() {
    let lib = file("src/lib.rs");
    let listed = lib.lines().filter_map(|line| line.strip_prefix("//! - ")?.split(':').next());
    let listed: Vec<_> = listed
        .map(|name| name.trim_matches(['[', ']', '`']).trim_start_matches("mod@").to_owned())
        .collect();
    assert_eq!(listed, modules());
}

#[test]
fn models_know_no_tables_backends_no_files_and_encoders_only_tables() {
    let allowed: [(&str, &[&str]); 3] = [
        ("brdf", &["brdf", "choice", "error", "numeric", "units"]),
        ("numeric", &["numeric"]),
        ("format", &["format", "choice", "error", "lookup", "table"]),
    ];
    let modules = modules();
    for (module, allowed) in allowed {
        assert!(modules.iter().any(|known| known == module), "no module {module}");
        for (path, text) in files("src").iter().filter(|(path, _)| module_of(path) == Some(module))
        {
            for used in uses(text) {
                assert!(allowed.contains(&used), "{path} uses crate::{used}");
            }
        }
    }
}

#[test]
fn only_the_command_line_touches_the_disk_or_prints() {
    for (path, text) in files("src").iter().filter(|(path, _)| module_of(path) != Some("cli")) {
        for word in [
            "std::fs",
            "File::",
            "println!",
            "eprint",
            "stdout()",
            "stderr()",
            "std::env",
            "std::process::exit",
        ] {
            let found = text
                .lines()
                .any(|line| line.contains(word) && !line.trim_start().starts_with("//"));
            let program = path == "src/main.rs" && word == "std::env";
            assert!(!found || program, "{path} has {word}");
        }
    }
}

#[test]
fn unsafe_stands_in_the_vulkan_host_alone() {
    for (path, text) in files("src") {
        let host = path.starts_with("src/backend/vulkan");
        assert!(
            host || !text.contains("unsafe {") && !text.contains("unsafe_code"),
            "{path} has unsafe code"
        );
        // Each block says why it may.
        let lines: Vec<_> = text.lines().collect();
        for (i, line) in lines.iter().enumerate().filter(|(_, line)| line.contains("unsafe {")) {
            let said = lines[i.saturating_sub(4)..i].iter().any(|line| line.contains("// SAFETY:"));
            assert!(said, "{path}:{} is unsafe without a reason: {line}", i + 1);
        }
    }
}

/// The names of the functions that a text defines.
fn functions(text: &str) -> Vec<&str> {
    let name = |line: &'_ str| line.find(|c: char| !c.is_alphanumeric() && c != '_');
    let definitions = text.lines().map(|line| line.trim_start().trim_start_matches("pub "));
    definitions
        .filter_map(|line| line.strip_prefix("fn "))
        .filter_map(|rest| Some(&rest[..name(rest)?]))
        .collect()
}

#[test]
fn every_wgsl_function_has_a_rust_twin_and_a_test() {
    let rust: Vec<(String, String)> = files("src");
    let rust: Vec<&str> = rust.iter().flat_map(|(_, text)| functions(text)).collect();
    let tests: String = ["twins", "model_twins", "sampling_twins", "stability", "glass_twins"]
        .map(|name| file(&format!("tests/vulkan/{name}.rs")))
        .concat();
    let mut count = 0;
    for (path, text) in files("shaders") {
        for function in functions(&text).into_iter().filter(|&name| name != "main") {
            assert!(rust.contains(&function), "{path}: {function} has no Rust twin");
            // The functions of a preview are tested by its pictures.
            let tested = path.ends_with("preview.wgsl") || tests.contains(&format!("{function}("));
            assert!(tested, "{path}: {function} is not tested alone");
            count += 1;
        }
    }
    assert!(count > 15, "only {count} functions found");
}

#[test]
fn every_shader_is_for_the_poorest_driver() {
    // What a study of drivers is about may ask for what they do badly.
    for (path, text) in
        files("shaders").into_iter().filter(|(path, _)| path != "shaders/textbook.wgsl")
    {
        for word in [
            "enable ",
            "f16",
            "f64",
            "subgroup",
            "workgroup>",
            "sin(",
            "cos(",
            "pow(",
            "exp(",
            "log(",
            "fma(",
        ] {
            let found = text
                .lines()
                .any(|line| line.contains(word) && !line.trim_start().starts_with("//"));
            assert!(!found, "{path} has {word}");
        }
    }
}

#[test]
fn files_begin_with_what_they_are_and_stay_short() {
    for (path, text) in
        files("src").into_iter().chain(files("tests")).filter(|(path, _)| path.ends_with(".rs"))
    {
        assert!(text.starts_with("//! "), "{path} does not begin with what it is");
        assert!(text.lines().count() <= 400, "{path} has grown to {} lines", text.lines().count());
    }
    for (path, text) in files("shaders") {
        assert!(text.starts_with("// "), "{path} does not begin with what it is");
    }
}

#[test]
fn the_readme_has_the_exit_codes() {
    let readme = file("README.md");
    for (code, meaning) in splitsum::error::ExitCode::MEANINGS {
        let row = format!("| {} | {meaning} |", code as u8);
        assert!(readme.contains(&row), "no exit code {code:?} in the README");
    }
}

#[test]
fn the_page_of_accuracy_has_the_rules_and_their_bounds() {
    let page = file("docs/accuracy.md");
    for rule in splitsum::integrate::rules::RULES {
        let evaluations = match rule.method {
            Method::Interpolant(interpolant) => format!("{} integrals", interpolant.len()),
            _ => rule.evaluations(1).to_string(),
        };
        let bound = |ndf: Ndf| {
            let lobe = Microfacet { ndf, masking: ndf.default_masking() };
            let holds = rule.applies_to(lobe) && rule.bound(lobe).is_finite();
            if holds { format!("{:e}", rule.bound(lobe)) } else { "-".to_owned() }
        };
        let bounds = Ndf::ALL.iter().map(|&ndf| bound(ndf)).collect::<Vec<_>>().join(" | ");
        let row = format!("| `{}` | {evaluations} | {bounds} |", rule.name);
        assert!(page.contains(&row), "no row '{row}' in docs/accuracy.md");
    }
    let interface = |ndf, ior, transmission| {
        let lobe = Microfacet { ndf, masking: Masking::HeightCorrelated };
        Integrand::Glass(Interface::new(lobe, ior, Side::Inside, transmission).unwrap())
    };
    let (correlated, beta) = (TransmissionMasking::Correlated, TransmissionMasking::Beta);
    let kinds =
        [(Ndf::Ggx, 1.5, correlated), (Ndf::Beckmann, 1.5, correlated), (Ndf::Ggx, 1.5, beta)];
    for rule in splitsum::integrate::rules::RULES {
        let bound = |(ndf, ior, transmission)| rule.bound(interface(ndf, ior, transmission));
        let bounds = kinds.map(bound);
        if bounds.iter().all(|bound| bound.is_finite()) {
            let [ggx, beckmann, beta] = bounds;
            let row = format!("| `{}` | {ggx:e} | {beckmann:e} | {beta:e} |", rule.name);
            assert!(page.contains(&row), "no row '{row}' in docs/accuracy.md");
        }
    }
}

#[test]
fn lines_have_at_most_a_hundred_columns() {
    for (path, text) in
        ["src", "tests", "benches", "examples", "shaders"].into_iter().flat_map(files)
    {
        let code = path.ends_with(".rs") || path.ends_with(".wgsl");
        for (i, line) in text.lines().enumerate().filter(|_| code) {
            let columns = line.chars().count();
            assert!(columns <= 100, "{path}:{} has {columns} columns", i + 1);
        }
    }
}
