//! `splitsum preview --plan`: its pixels are what the reference rule and the plan's own numbers
//! give, and a plan that is damaged gives no picture.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, stderr};
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::image::Picture;
use splitsum::numeric::lanes::{F32x16, Vector};
use splitsum::planner::cost::Weights;
use splitsum::planner::domain::{Domain, Piece};
use splitsum::planner::file::{ChannelText, PieceText, PlanFile};
use splitsum::planner::search::{Task, search};
use splitsum::planner::tolerance::Tolerance;
use splitsum::planner::truth::Truth;
use splitsum::preview::planned::{Column, MOST_COLUMNS, columns, ends, render};
use std::fs;
use tempfile::tempdir;

const TOLERANCE: f64 = 0.01;

/// Pixels of a sphere.
const CELL: usize = 32;

/// A plan for a range of roughness and of F0, and for a constant.
fn plan() -> PlanFile {
    let truth = Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap());
    let piece = |roughness, f0| Piece { materials: vec!["oak".into()], roughness, f0 };
    let task = Task {
        domain: Domain {
            least_nov: 1e-3,
            pieces: vec![piece([0.3, 0.8], [0.04, 0.9]), piece([0.5, 0.5], [0.04, 0.04])],
        },
        tolerance: Tolerance::Absolute(TOLERANCE),
        weights: Weights::default(),
        sampler: None,
    };
    PlanFile::new(&task, &truth, &search(&task, &truth), String::new()).unwrap()
}

/// Of the four samples of a pixel the n·v, with the sphere's edge at 1/1.06 of its cell; none where
/// one of them lies beyond.
fn novs((i, j): (usize, usize)) -> Option<[f64; 4]> {
    let place = |at: usize, half: usize| {
        let share = (at as f64 + 0.25 + 0.5 * half as f64) / CELL as f64;
        (2.0 * share - 1.0) * 1.06
    };
    let squared =
        [0, 1, 2, 3].map(|s| place(i, s % 2).powi(2) + place(j, s / 2).powi(2)).map(|r2| 1.0 - r2);
    squared.iter().all(|square| *square > 0.0).then(|| squared.map(f64::sqrt))
}

/// The byte of sRGB, not rounded.
fn encoded(light: f64) -> f64 {
    let light = light.min(1.0);
    let curved =
        if light <= 0.0031308 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    255.0 * curved
}

fn byte(picture: &Picture, (i, j): (usize, usize)) -> f64 {
    let at = 3 * (j * picture.width + i);
    let pixel = &picture.rgb[at..at + 3];
    assert!(pixel.iter().all(|part| *part == pixel[0]), "{i} {j} is no grey: {pixel:?}");
    f64::from(pixel[0])
}

/// Means of a pixel: the lookup in f32, the integral by the reference rule, their difference.
fn expected(column: &Column, novs: [f64; 4], f0: f64) -> [f64; 3] {
    let roughness = column.roughness;
    let truths = Truth::by_reference(column.approximation.lobe, &novs.map(|nov| (nov, roughness)));
    let mut means = [0.0; 3];
    for (nov, truth) in novs.into_iter().zip(truths) {
        let lane = |value: f64| F32x16::gather(|_| value);
        let own = column.approximation.albedo(lane(nov), lane(roughness), lane(f0)).lane(0);
        let exact = truth.at(f0);
        for (mean, light) in means.iter_mut().zip([own, exact, 100.0 * (own - exact).abs()]) {
            *mean += 0.25 * light.min(1.0);
        }
    }
    means
}

#[test]
fn pixels_are_those_of_the_lookup_and_of_the_reference_rule() {
    let columns = columns(&plan()).unwrap();
    assert_eq!(ends(&columns), 2);
    // A range has four spheres where there are few pieces, and a constant one.
    let roughnesses: Vec<f64> = columns.iter().map(|column| column.roughness).collect();
    assert!(roughnesses.is_sorted() && roughnesses.len() == 5, "{roughnesses:?}");
    assert_eq!((roughnesses[0], roughnesses[4]), (0.3, 0.8));
    let (picture, largest) = render(&columns, CELL, &|_| ()).unwrap();
    assert_eq!((picture.width, picture.height), (5 * CELL, 6 * CELL));
    for (c, (column, largest)) in columns.iter().zip(largest).enumerate() {
        let mut seen = [0.0f64; 2];
        for (end, seen) in seen.iter_mut().enumerate() {
            let mut differences = Vec::new();
            for at in [3, 7, 10, 13, 15] {
                let Some(novs) = novs((at, 12)) else { continue };
                let means = expected(column, novs, column.f0[end]);
                for (row, mean) in means.into_iter().enumerate() {
                    let byte = byte(&picture, (c * CELL + at, (3 * end + row) * CELL + 12));
                    // A byte is rounded, by half a step; what else differs is below a hundredth of
                    // one: the rule of the picture errs by 1.5e-6, a hundredfold by half a step
                    // where sRGB is steepest.
                    let allowed = if row == 2 { 1.01 } else { 0.51 };
                    let exact = encoded(mean);
                    assert!(
                        (byte - exact).abs() <= allowed,
                        "{c} {end} {row} {at}: {byte} {exact}"
                    );
                    if row == 2 {
                        differences.push(byte);
                    }
                }
                *seen = seen.max(means[2] / 100.0);
            }
            // An error of a fit changes its sign between the middle and the edge.
            assert!(differences.iter().any(|byte| *byte != differences[0]), "{differences:?}");
            assert!(differences.iter().all(|byte| *byte <= encoded(100.0 * TOLERANCE)));
        }
        // What is printed is the largest of all pixels, and within the plan's promise.
        assert!(seen[0].max(seen[1]) <= largest && largest <= TOLERANCE, "{c}: {seen:?} {largest}");
    }
    // Around the spheres there is the furnace, and around differences next to nothing.
    assert_eq!(
        [byte(&picture, (0, 0)), byte(&picture, (0, 2 * CELL))],
        [255.0, encoded(0.02).round()]
    );
}

#[test]
fn many_roughnesses_are_shown_evenly() {
    let mut plan = plan();
    let piece = |i: usize| {
        let roughness = 0.3 + 0.005 * i as f64;
        PieceText { roughness: [roughness; 2], f0: [0.04, 0.04], materials: Vec::new() }
    };
    plan.question.pieces = (0..100).rev().map(piece).collect();
    let columns = columns(&plan).unwrap();
    assert_eq!((columns.len(), ends(&columns)), (MOST_COLUMNS, 1));
    let places: Vec<f64> =
        columns.iter().map(|column| ((column.roughness - 0.3) / 0.005).round()).collect();
    assert_eq!((places[0], places[MOST_COLUMNS - 1]), (0.0, 99.0));
    // 99 steps between 8 columns are 14 or 15 each.
    assert!(
        places.windows(2).all(|pair| (14.0..=15.0).contains(&(pair[1] - pair[0]))),
        "{places:?}"
    );
}

#[test]
fn a_plan_that_is_wrong_gives_no_picture() {
    let folder = tempdir().unwrap();
    let good = plan();
    let write = |name: &str, plan: &PlanFile| {
        fs::write(folder.path().join(name), toml::to_string(plan).unwrap()).unwrap();
    };
    write("good.toml", &good);
    let said = stderr(&ok(&folder, "preview --plan good.toml --size 16 -o good.png"));
    assert!(fs::read(folder.path().join("good.png")).unwrap().starts_with(b"\x89PNG"));
    for words in ["column    1: roughness 0.3, F0 0.04..0.9", "oak", "tolerance 0.01", "the CPU"] {
        assert!(said.contains(words), "no '{words}' in {said}");
    }
    fs::remove_file(folder.path().join("good.png")).unwrap();
    let mut damaged = good.clone();
    match &mut damaged.choice[0].channels[0] {
        ChannelText::Codes { codes, .. } => codes[0] ^= 1,
        ChannelText::Floats { floats } | ChannelText::Halves { halves: floats } => floats[0] += 1.0,
    }
    write("damaged.toml", &damaged);
    let mut wider = good.clone();
    wider.question.pieces[0].roughness[1] = 0.95;
    write("wider.toml", &wider);
    let mut outside = good.clone();
    outside.question.pieces[0].roughness[1] = 1.5;
    write("outside.toml", &outside);
    let mut everywhere = good.clone();
    everywhere.choice[0].roughness = [-1.0, 2.0];
    write("everywhere.toml", &everywhere);
    fs::write(folder.path().join("text.toml"), "[question]\nmodel = 3\n").unwrap();
    fs::copy(folder.path().join("good.toml"), folder.path().join("plan.png")).unwrap();
    let before = fs::read_dir(folder.path()).unwrap().count();
    for (arguments, code, words) in [
        ("--plan damaged.toml", 7, "are not those that were written"),
        ("--plan wider.toml", 7, "nothing in the choice is for roughness 0.3 to 0.95"),
        ("--plan outside.toml", 4, "ranges within [0, 1]"),
        ("--plan everywhere.toml", 4, "roughness in [0, 1]"),
        ("--plan text.toml", 4, "a plan of splitsum in TOML"),
        ("--plan missing.toml", 3, "missing.toml"),
        ("--plan good.toml -o a.exr", 4, ".png"),
        ("--plan plan.png -o plan.png", 2, "which is the plan"),
        ("--plan good.toml --scene furnace", 2, "cannot be used with"),
        ("--plan good.toml --backend cpu", 2, "cannot be used with"),
        ("--plan good.toml --device x", 2, "cannot be used with"),
    ] {
        let output = run(&folder, &format!("preview {arguments}"));
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {text}");
        assert!(text.contains(words), "{arguments}: no '{words}' in {text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before);
}
