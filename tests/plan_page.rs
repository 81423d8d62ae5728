//! The page of a plan: one file without scripts that asks for nothing, escapes the words of a
//! scene, and is shown by a browser without a complaint. Chromium and the modules of tests/web that
//! are not there are reported as ignored; where SPLITSUM_REQUIRE_READERS is set, that is a failure
//! instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{READERS, missing, printed, with_modules};
use libtest_mimic::{Arguments, Failed, Trial};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::{TempDir, tempdir};

/// A name that ends whatever it stands in.
const HOSTILE: &str = "<script>alert(1)</script>&\"";

const ESCAPED: &str = "&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;";

/// Sections in their order.
const SECTIONS: [&str; 6] = [
    "The scene",
    "Where it errs",
    "Cost against error",
    "What the model leaves out",
    "Tables of engines",
    "Rejected candidates",
];

fn main() {
    let trials = vec![
        Trial::test("a page of constants escapes names and asks for nothing", constants),
        Trial::test("a page of ranges has maps and asks for nothing", ranges),
        in_chromium("Chromium shows a page of constants", || shown(&of_constants()?, 0)),
        in_chromium("Chromium shows a page of ranges", || shown(&of_ranges()?, 3)),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A test by Chromium and the modules of tests/web.
fn in_chromium(name: &'static str, test: fn() -> Result<(), Failed>) -> Trial {
    let chromium = std::env::var_os("CHROMIUM").map_or("/usr/bin/chromium".into(), PathBuf::from);
    if Command::new("node").arg("--version").output().is_err() {
        return missing(READERS, name.into(), "node is not installed".into());
    }
    if !chromium.is_file() {
        return missing(READERS, name.into(), format!("there is no {}", chromium.display()));
    }
    with_modules(name, test)
}

/// The page of a plan, in a folder of its own.
fn page(materials: &str, flags: &str) -> Result<(TempDir, PathBuf), Failed> {
    let folder = tempdir()?;
    fs::write(folder.path().join("a&b.json"), format!("{{\"materials\": [{materials}]}}"))?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
    let flags = flags.split_whitespace();
    printed(
        command.current_dir(&folder).args(["plan", "a&b.json", "--html", "plan.html"]).args(flags),
    )?;
    let file = folder.path().join("plan.html");
    Ok((folder, file))
}

fn of_constants() -> Result<(TempDir, PathBuf), Failed> {
    let name = serde_json::to_string(HOSTILE)?;
    let materials = format!(
        "{{\"name\": {name}, \"roughness\": 0.4, \"f0\": 0.04}}, {{\"name\": \"http://a.b/c.png\", \
         \"roughness\": 0.7, \"f0\": 0.5}}"
    );
    page(&materials, "--tolerance 0.02")
}

fn of_ranges() -> Result<(TempDir, PathBuf), Failed> {
    let name = serde_json::to_string(HOSTILE)?;
    let range = format!("{{\"name\": {name}, \"roughness\": [0.4, 0.9], \"f0\": [0.02, 0.08]}}");
    page(&range, "--tolerance 0.05")
}

/// What every page has and has not.
fn check(text: &str) {
    assert!(text.starts_with("<!doctype html>\n"), "{}", &text[..100]);
    for word in ["<meta charset=\"utf-8\">", "name=\"viewport\"", "<title>Plan for a&amp;b.json<"] {
        assert!(text.contains(word), "no {word}");
    }
    assert!(text.contains(ESCAPED), "no {ESCAPED}");
    for word in ["<script", "javascript:", "<iframe", "<link rel=\"stylesheet", "@import", "url("] {
        assert!(!text.contains(word), "{word}");
    }
    // Attributes that fetch something have it in the page itself.
    for name in ["src=", "href=", "srcset=", "data="] {
        for rest in text.split(&format!(" {name}")).skip(1) {
            assert!(rest.starts_with("\"data:"), "{name}{}", &rest[..rest.len().min(60)]);
        }
    }
    let headings: Vec<&str> =
        text.split("<h2>").skip(1).filter_map(|rest| rest.split('<').next()).collect();
    assert_eq!(headings, SECTIONS);
}

fn constants() -> Result<(), Failed> {
    let (_folder, file) = of_constants()?;
    let text = fs::read_to_string(file)?;
    check(&text);
    // A name that is an address is a text and no address.
    let text = text.replace(">http://a.b/c.png", ">").replace(" http://a.b/c.png", " ");
    assert!(!text.contains("=\"http"), "an address elsewhere");
    assert!(text.contains("one for each roughness") && text.contains("Error against n·v"));
    Ok(())
}

fn ranges() -> Result<(), Failed> {
    let (_folder, file) = of_ranges()?;
    let text = fs::read_to_string(file)?;
    check(&text);
    assert!(!text.contains("http://") && !text.contains("https://"), "an address elsewhere");
    for words in ["Map of the error at F0 = 0.02", "Map of the error at F0 = 0.08"] {
        assert_eq!(text.matches(words).count(), 1, "{words}");
    }
    assert_eq!(text.matches("data:image/png;base64,").count(), 3);
    Ok(())
}

/// Opens a page in a browser, which finds so many images in it.
fn shown((_folder, file): &(TempDir, PathBuf), images: usize) -> Result<(), Failed> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web/plan_page.mjs");
    let output = printed(Command::new("node").arg(script).arg(file))?;
    let found: Value = serde_json::from_slice(&output)?;
    assert_eq!(found["wrong"], Value::Array(Vec::new()));
    for request in found["requests"].as_array().unwrap() {
        let address = request.as_str().unwrap();
        let is_own = address.starts_with("http://127.0.0.1:") && address.ends_with("/plan.html");
        assert!(is_own || address.starts_with("data:"), "{address}");
    }
    let views = found["views"].as_array().unwrap();
    assert_eq!(views.len(), 4);
    for view in views {
        let sizes = |name: &str| -> Vec<f64> {
            let sizes = view[name].as_array().unwrap().iter();
            sizes.flat_map(|size| size.as_array().unwrap()).map(|n| n.as_f64().unwrap()).collect()
        };
        let (svgs, pictures) = (sizes("svgs"), sizes("images"));
        assert!(svgs.len() >= 2 * 4 && svgs.iter().all(|&side| side > 24.0), "{svgs:?}");
        assert_eq!(pictures.len(), 2 * images);
        assert!(pictures.iter().all(|&side| side > 0.0), "{pictures:?}");
        assert_eq!(view["scripts"], 0);
        assert!(view["overflow"].as_f64().unwrap() <= 0.0, "too wide: {view}");
        // Level AA of WCAG 2.2.
        assert!(view["contrast"].as_f64().unwrap() >= 4.5, "{view}");
    }
    Ok(())
}
