//! Charts: what is on them, from stored measurements; and the commands that measure and draw.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, stderr};
use serde::de::DeserializeOwned;
use serde_json::Value;
use splitsum::compare::chart::speed::{Against, chart as speed_chart};
use splitsum::compare::chart::stability::chart as stability_chart;
use splitsum::compare::chart::{lookup, size};
use splitsum::compare::draw::{Drawing, Shape};
use splitsum::compare::sampling::Sampler;
use splitsum::compare::study::Machine;
use splitsum::compare::study::lookup::Reading;
use splitsum::compare::study::lookup::layer::{Net, Where};
use splitsum::compare::study::size::Cost;
use splitsum::compare::study::speed::{Speed, Who};
use splitsum::compare::study::stability::{Family, Stability};
use splitsum::compare::technique::Technique;
use splitsum::table::precision::Precision;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// Measurements of a table of 16 x 16, and maps of 7 x 5 points, with two devices.
const SPEED: &str = include_str!("figures/speed.json");
const STABILITY: &str = include_str!("figures/stability.json");

fn part<T: DeserializeOwned>(text: &str, key: &str) -> T {
    let mut whole: Value = serde_json::from_str(text).unwrap();
    serde_json::from_value(whole[key].take()).unwrap()
}

fn speed() -> (Speed, Machine) {
    (part(SPEED, "speed"), part(SPEED, "machine"))
}

/// All charts of the stored measurements, by name.
fn all() -> Vec<(&'static str, Drawing)> {
    let (speed, machine) = speed();
    let stability: Stability = part(STABILITY, "stability");
    let lobe = speed.plan.lobe;
    let readings: Vec<Reading> = part(SPEED, "lookup");
    let nets: Vec<Net> = part(SPEED, "nets");
    let costs: Vec<Cost> = part(SPEED, "size");
    let maps = |family| stability_chart(&stability, family, "Maps", &machine).unwrap();
    vec![
        ("time", speed_chart(&speed, &machine, Against::Time)),
        ("evaluations", speed_chart(&speed, &machine, Against::Evaluations)),
        ("lookup", lookup::chart(&readings, &nets, lobe, &machine)),
        ("size", size::chart(&costs, lobe, &machine)),
        ("formulas", maps(Family::Formulas)),
        ("methods", maps(Family::Methods)),
        ("storage", maps(Family::Storage)),
        ("devices", maps(Family::Devices)),
    ]
}

/// The marks of a drawing: what each stands for, and its middle.
fn marks(drawing: &Drawing) -> Vec<(String, (f64, f64))> {
    let middle = |points: &[(f64, f64)]| {
        let n = points.len() as f64;
        (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n)
    };
    let mark = |shape: &Shape| match shape {
        Shape::Path { points, title, fill: Some(_), .. } if !title.is_empty() => {
            Some((title.clone(), middle(points)))
        }
        _ => None,
    };
    drawing.shapes.iter().filter_map(mark).collect()
}

#[test]
fn every_method_has_its_mark_in_its_place() {
    let (speed, machine) = speed();
    for against in [Against::Time, Against::Evaluations] {
        let marks = marks(&speed_chart(&speed, &machine, against));
        let shown = |who: &Who, technique: Technique| match who {
            Who::Cpu(_) => true,
            Who::Device(_) => {
                let drawn = [Technique::HalfVectors, Technique::Samples(Sampler::HalfVector)];
                against == Against::Time && drawn.contains(&technique)
            }
        };
        let measured: Vec<_> =
            speed.measurements.iter().filter(|m| shown(&m.who, m.technique)).collect();
        assert_eq!(marks.len(), measured.len(), "{against:?}");
        // The marks lie as the numbers do: those of which one is cheaper lie farther to the left,
        // those of less error lower.
        let found = |m: &splitsum::compare::study::speed::Measurement| {
            let said = format!(
                "{:.1e} at {:.3} of the baseline, {:.0} evaluations",
                m.errors.largest(),
                m.ratio,
                m.evaluations
            );
            let own = |(title, _): &&(String, (f64, f64))| {
                title.starts_with(&format!("{}, {},", m.technique.name(), m.step))
                    && title.ends_with(&said)
            };
            marks.iter().find(own).unwrap_or_else(|| panic!("no mark of {m:?}")).1
        };
        let places: Vec<(f64, f64)> = measured.iter().map(|m| found(m)).collect();
        for (m, place) in measured.iter().zip(&places) {
            for (other, there) in measured.iter().zip(&places) {
                let across = |m: &splitsum::compare::study::speed::Measurement| {
                    if against == Against::Time { m.ratio } else { m.evaluations }
                };
                // Labels are rounded, so that a mark may be taken for its like.
                let (cheaper, better) = (
                    across(other) / across(m) > 1.1,
                    other.errors.largest() / m.errors.largest() > 1.3,
                );
                let axis = m.errors.largest() < 10.0;
                assert!(!cheaper || place.0 < there.0, "{m:?} {other:?}");
                assert!(!better || !axis || place.1 > there.1, "{m:?} {other:?}");
            }
        }
        // Within the axes.
        assert!(
            places.iter().all(|p| (82.0..=800.0).contains(&p.0) && (65.0..=541.0).contains(&p.1)),
            "{places:?}"
        );
        let named = |technique: Technique| measured.iter().any(|m| m.technique == technique);
        assert!(Technique::all().all(named), "a method is missing from the stored measurements");
    }
}

#[test]
fn every_table_and_net_has_its_marks() {
    let (speed, machine) = speed();
    let readings: Vec<Reading> = part(SPEED, "lookup");
    let nets: Vec<Net> = part(SPEED, "nets");
    let marks = marks(&lookup::chart(&readings, &nets, speed.plan.lobe, &machine));
    let of = |words: &str| marks.iter().filter(|(title, _)| title.contains(words)).count();
    // Each in every panel, but nets in those of their own domain: the mean is one over everything.
    for net in &nets {
        let panels = if net.domain == Where::Everywhere { 2 } else { 1 };
        assert_eq!(of(&format!("{} bytes, {}: ", net.bytes, net.candidate)), panels, "{net:?}");
    }
    assert!(nets.len() > 2);
    let tables = readings.iter().filter(|reading| reading.precision != Precision::F32).count();
    assert_eq!(of(" x "), 3 * tables);
    // Over T there are as many as over any other axes.
    assert_eq!(of(", T,edges, "), of(", nov,sqrt,edges, "));
}

#[test]
fn no_label_covers_another_or_leaves_the_sheet() {
    // Lobes have fewer methods than GGX, and machines more devices or none.
    let (whole, machine) = speed();
    let fewer = |count: usize| {
        let techniques: Vec<Technique> = Technique::all().take(count).collect();
        let mut speed = whole.clone();
        speed.measurements.retain(|m| techniques.contains(&m.technique));
        ("fewer", speed_chart(&speed, &machine, Against::Time))
    };
    let mut more = whole.clone();
    for name in ["third", "fourth", "fifth"] {
        let device = whole.measurements.iter().filter(|m| matches!(m.who, Who::Device(_))).cloned();
        more.measurements.extend(device.map(|m| splitsum::compare::study::speed::Measurement {
            who: Who::Device(name.into()),
            ..m
        }));
    }
    let others = (0..14).map(fewer).chain([("more", speed_chart(&more, &machine, Against::Time))]);
    for (name, drawing) in all().into_iter().chain(others) {
        let boxes = drawing.text_boxes();
        for (i, (text, [left, top, right, bottom])) in boxes.iter().enumerate() {
            let inside =
                *left >= 0.0 && *top >= 0.0 && *right <= drawing.width && *bottom <= drawing.height;
            assert!(inside, "{name}: '{text}' leaves the sheet: {left} {top} {right} {bottom}");
            for (other, [l, t, r, b]) in &boxes[..i] {
                let apart = left >= r || l >= right || top >= b || t >= bottom;
                assert!(apart, "{name}: '{text}' covers '{other}'");
            }
        }
    }
}

#[test]
fn maps_show_every_error_and_fault() {
    let stability: Stability = part(STABILITY, "stability");
    let pictures: usize = all()
        .iter()
        .filter(|(name, _)| ["formulas", "methods", "storage", "devices"].contains(name))
        .map(|(_, drawing)| {
            drawing.shapes.iter().filter(|shape| matches!(shape, Shape::Image { .. })).count() - 1
        })
        .sum();
    assert_eq!(pictures, stability.maps.len());
    assert!(stability.maps.iter().any(|map| !map.faults.is_empty()));
}

#[test]
fn the_same_measurements_give_the_same_bytes() {
    for ((name, drawing), (_, again)) in all().into_iter().zip(all()) {
        let svg = drawing.to_svg().unwrap();
        assert_eq!(svg, again.to_svg().unwrap(), "{name}");
        let picture = drawing.to_picture(1.0).unwrap();
        assert_eq!(picture, again.to_picture(1.0).unwrap(), "{name}");
        assert_eq!((picture.width as f64, picture.height as f64), (drawing.width, drawing.height));
        // Neither empty nor all of one colour, and every tag of the SVG closed.
        let inked = picture.rgb.chunks_exact(3).filter(|pixel| pixel != &[255; 3]).count();
        assert!(inked > 2000, "{name}: {inked} pixels");
        for tag in ["path", "text", "title", "image", "svg"] {
            let (open, close) = (
                svg.matches(&format!("<{tag}")).count(),
                svg.matches(&format!("</{tag}>")).count(),
            );
            assert_eq!(open, close, "{name}: <{tag}>");
        }
    }
}

#[test]
fn the_cheapest_step_that_keeps_an_error_is_found() {
    let (speed, _) = speed();
    for technique in Technique::all() {
        for error in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0] {
            let found = speed.cheapest(error, |t| t == technique);
            let keeps = |m: &&splitsum::compare::study::speed::Measurement| {
                m.technique == technique
                    && matches!(m.who, Who::Cpu(_))
                    && m.errors.largest() <= error
            };
            let least = speed.measurements.iter().filter(keeps).map(|m| m.ratio).reduce(f64::min);
            assert_eq!(found.map(|m| m.ratio), least, "{technique:?} {error}");
        }
    }
    let at = speed.at_error(Technique::Samples(Sampler::HalfVector), 1e-2);
    assert!(at.ours.unwrap() < 10.0 && at.error == 1e-2);
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn the_commands_measure_draw_and_draw_again() {
    let folder = tempdir().unwrap();
    let output = ok(&folder, "chart speed --quick --cpu --size 16 -q -o .");
    let text = String::from_utf8(output.stdout).unwrap();
    for words in
        ["| ours |", "| half vectors by D (Karis 2013) |", "| MaterialX's fit (rational) |", "1e-5"]
    {
        assert!(text.contains(words), "no '{words}' in: {text}");
    }
    ok(&folder, "chart stability --quick --cpu -q -o .");
    let written = names(folder.path());
    let expected = "evaluations.png evaluations.svg formulas.png formulas.svg lookup.csv \
                    lookup.png lookup.svg methods.png \
                    methods.svg nets.csv size.csv size.png size.svg speed.csv speed.json speed.md \
                    speed.png speed.svg stability.json \
                    stability.md storage.png storage.svg";
    assert_eq!(written.join(" "), expected);
    let csv = fs::read_to_string(folder.path().join("speed.csv")).unwrap();
    let saved: Value =
        serde_json::from_slice(&fs::read(folder.path().join("speed.json")).unwrap()).unwrap();
    assert_eq!(csv.lines().count(), 1 + saved["speed"]["measurements"].as_array().unwrap().len());
    // Drawn again from what was saved, all is the same.
    let again = tempdir().unwrap();
    for file in ["speed.json", "stability.json"] {
        let path = folder.path().join(file);
        let command = file.trim_end_matches(".json");
        ok(&again, &format!("chart {command} --from {} -q -o .", path.to_str().unwrap()));
    }
    for name in names(again.path()) {
        let read = |folder: &Path| fs::read(folder.join(&name)).unwrap();
        assert!(read(folder.path()) == read(again.path()), "{name} differs");
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("wrong.json"), "{\"speed\": 3}").unwrap();
    // Maps with less errors than points, and without points.
    let torn = STABILITY.replacen("\"size\":[7,5]", "\"size\":[7,6]", 1);
    fs::write(folder.path().join("torn.json"), torn).unwrap();
    fs::write(
        folder.path().join("empty.json"),
        STABILITY.replacen("\"size\":[7,5]", "\"size\":[0,5]", 1),
    )
    .unwrap();
    let cases: [(&str, i32, &str); 11] = [
        ("chart stability --from torn.json -o .", 4, "an error for each point"),
        ("chart stability --from empty.json -o .", 4, "an error for each point"),
        ("chart speed --size 8 --cpu", 2, "8 is not in 16..=512"),
        ("chart speed --model phong --cpu", 2, "possible values: ggx"),
        ("chart speed --masking neubelt --cpu", 4, "masking of ggx"),
        ("chart speed --cpu -o nowhere", 3, "create it first"),
        ("chart speed --from nothing.json -o .", 3, "cannot read nothing.json"),
        ("chart speed --from wrong.json -o .", 4, "measurements that this command has saved"),
        ("chart stability --from wrong.json -o .", 4, "measurements that this command has saved"),
        ("chart stability --cpu --device x", 2, "cannot be used with"),
        ("chart stability --device no-such-device -o .", 5, "no-such-device"),
    ];
    for (arguments, code, words) in cases {
        let output = run(&folder, arguments);
        let text = stderr(&output);
        // Without a driver there is no list of devices to name one of.
        let said = text.contains(words) || code == 5;
        assert!(
            output.status.code() == Some(code) && said,
            "{arguments}: {:?} {text}",
            output.status.code()
        );
    }
    assert_eq!(names(folder.path()), ["empty.json", "torn.json", "wrong.json"]);
}
