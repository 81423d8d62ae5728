//! Plans for shaders that stay as they are: a texture, of integrals or fitted, and its sampler.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::Random;
use program::{ok, run, stderr};
use splitsum::approximation::{Shape, Storage, Texels};
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::integrate::rules::D10240;
use splitsum::numeric::half::value;
use splitsum::planner::candidate::Candidate;
use splitsum::planner::file::{PlanFile, Rejected};
use splitsum::planner::truth::Truth;
use tempfile::tempdir;

/// A half of a file.
fn half(bytes: &[u8]) -> f64 {
    value(u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// What a sampler gives at a place of a texture of two channels: texel centres, clamped, where its
/// weights are off by half a step of 8 bits.
fn sampled(texels: &[[f64; 2]], [columns, rows]: [usize; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    let near = |p: f64, count: usize| {
        let place = (p * count as f64 - 0.5 + 1.0 / 512.0).clamp(0.0, count as f64 - 1.0);
        let first = (place.floor() as usize).min(count - 2);
        (first, place - first as f64)
    };
    let ((i, s), (j, t)) = (near(u, columns), near(v, rows));
    let row = |j: usize, c: usize| {
        texels[j * columns + i][c] * (1.0 - s) + texels[j * columns + i + 1][c] * s
    };
    [0, 1].map(|c| row(j, c) * (1.0 - t) + row(j + 1, c) * t)
}

#[test]
fn a_texture_is_right_for_a_shader_that_stays_as_it_is() {
    let folder = tempdir().unwrap();
    let plan =
        "plan --roughness 0.4..1 --f0 0.02..0.2 --tolerance 0.006 --texture ab --storage f16";
    ok(&folder, &format!("{plan} -o a.toml --table a.npy"));
    ok(&folder, "plan --check a.toml");
    let text = std::fs::read_to_string(folder.path().join("a.toml")).unwrap();
    let file: PlanFile = toml::from_str(&text).unwrap();
    let [approximation] = &*file.approximations().unwrap() else { panic!("one texture") };
    let Shape::Texture { x, y, .. } = approximation.shape else { panic!("a texture") };
    let size = [x.size(), y.size()];
    // The file has the texels themselves: halves, A before B.
    let bytes = std::fs::read(folder.path().join("a.npy")).unwrap();
    let data = &bytes[bytes.len() - 4 * size[0] * size[1]..];
    let texels: Vec<[f64; 2]> =
        data.chunks_exact(4).map(|texel| [half(&texel[..2]), half(&texel[2..])]).collect();
    let mut random = Random(3);
    let places: Vec<(f64, f64)> = (0..4000)
        .map(|_| (1e-3 + 0.999 * random.next().powi(3), 0.4 + 0.6 * random.next()))
        .collect();
    let points: Vec<(f64, f64)> = places.iter().map(|&(nov, r)| (nov, r * r)).collect();
    let truths = bake_points(approximation.lobe, &points, &D10240).scale_bias();
    for (&(nov, r), truth) in places.iter().zip(truths) {
        let [a, b] = sampled(&texels, size, [nov, r]);
        for f0 in [0.02, 0.2] {
            let error = (f0 * a + b - truth.at_f0(f0)).abs();
            assert!(error <= 0.006, "{error} at n.v = {nov}, roughness {r}");
        }
    }
    // A place where a smaller texture of integrals is right is no witness.
    let exact = file.rejected.iter().position(|entry| entry.witness.is_some()).unwrap();
    let mut wrong = file.clone();
    wrong.rejected[exact].witness = Some([0.7, 0.6, 0.02]);
    std::fs::write(folder.path().join("b.toml"), toml::to_string(&wrong).unwrap()).unwrap();
    let output = run(&folder, "plan --check b.toml");
    assert_eq!(output.status.code(), Some(7), "{}", stderr(&output));
    assert!(stderr(&output).contains("is no witness"), "{}", stderr(&output));
}

#[test]
fn a_texture_of_integrals_has_the_integrals() {
    let folder = tempdir().unwrap();
    let axes = "--x nov,sqrt,edges --y roughness,edges";
    ok(
        &folder,
        &format!("plan --roughness 0.3..1 --tolerance 0.004 --texture be {axes} -o a.toml"),
    );
    let text = std::fs::read_to_string(folder.path().join("a.toml")).unwrap();
    let file: PlanFile = toml::from_str(&text).unwrap();
    let named =
        |entry: &&Rejected| entry.witness.is_some() && entry.candidate.contains("storage=f16");
    let entry = file.rejected.iter().find(named).unwrap();
    let candidate = Candidate::named(&entry.candidate).unwrap();
    let (task, _) = file.task().unwrap();
    let (region, _) = task.domain.whole().unwrap();
    let truth = Truth::new(Microfacet::new(Ndf::Ggx, None).unwrap());
    let exact = candidate.exact(&truth, region).unwrap();
    let Shape::Texture { x, y, .. } = exact.shape else { unreachable!("a texture") };
    let size = format!("{}x{}", x.size(), y.size());
    let storage = "--precision f16 -o b.npy";
    ok(&folder, &format!("bake --channels be --size {size} {axes} {storage}"));
    let bytes = std::fs::read(folder.path().join("b.npy")).unwrap();
    let data = &bytes[bytes.len() - 4 * x.size() * y.size()..];
    for (index, texel) in data.chunks_exact(4).enumerate() {
        for (channel, bytes) in texel.chunks_exact(2).enumerate() {
            let baked = half(bytes);
            let own = exact.numbers[channel].get(index);
            // The interpolant is 3e-8 off, so that a half may be its neighbour: 2^-11 of it.
            let step = 2.0_f64.powi(-11) * baked.abs() + 6e-8;
            assert!((own - baked).abs() <= step, "{index}, {channel}: {own} and {baked}");
        }
    }
}

#[test]
fn a_check_holds_a_plan_to_its_question() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let axes = "--texture be --x nov,sqrt,edges --y roughness,edges --storage f16";
    for roughness in ["0.5", "0.3..1"] {
        ok(&folder, &format!("plan --roughness {roughness} --tolerance 0.004 {axes} -o a.toml"));
        ok(&folder, "plan --check a.toml");
    }
    let good: PlanFile = toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let refused = |change: &dyn Fn(&mut PlanFile), code: i32, words: &str| {
        let mut plan = good.clone();
        change(&mut plan);
        std::fs::write(&path, toml::to_string(&plan).unwrap()).unwrap();
        let output = run(&folder, "plan --check a.toml");
        assert_eq!(output.status.code(), Some(code), "{}", stderr(&output));
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    };
    let exact = good.rejected.iter().position(|entry| entry.witness.is_some()).unwrap();
    for place in [[f64::NAN, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 1.5]] {
        refused(&|plan| plan.rejected[exact].witness = Some(place), 7, "outside of its region");
    }
    refused(&|plan| plan.choice[0].bound = None, 7, "the bound of the error is missing");
    let integrals = |plan: &mut PlanFile| {
        plan.nodes = Texels::Exact;
        let choice = &mut plan.choice[0];
        choice.candidate = choice.candidate.replace("texels=fitted", "texels=exact");
    };
    refused(&integrals, 7, "is not the integral");
    refused(&|plan| plan.nodes = Texels::Exact, 7, "what was asked for");
    let other = |plan: &mut PlanFile| {
        plan.question.sampler.as_mut().unwrap().axes[0] = "nov".into();
    };
    refused(&other, 7, "what was asked for");
    let floats = |plan: &mut PlanFile| {
        plan.question.sampler.as_mut().unwrap().storage = Some(Storage::F32);
    };
    refused(&floats, 4, "f16, unorm16 or unorm8");
    let empty = |plan: &mut PlanFile| {
        plan.rejected[exact].candidate =
            "energy-rest surface size=0x5 x=sqrt y=sqrt storage=f32".into();
    };
    refused(&empty, 4, "the words of a candidate");
}
