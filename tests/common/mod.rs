//! What several test binaries need: lobes, reference figures, points of the domain.
#![allow(dead_code, reason = "each test binary uses a part of this")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use libtest_mimic::{Failed, Trial};
use splitsum::backend::cpu;
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::certify::decision::Task;
use splitsum::certify::stages::Stages;
use splitsum::certify::ziv::{DeviceTable, certify_band};
use splitsum::choice::Choice;
use splitsum::integrate::rule::Rule;
use splitsum::integrate::rules::REFERENCE;
use splitsum::integrate::{Field, ScaleBias};
use splitsum::lut::{Dfg, DfgChannels, Lut, Part};
use splitsum::numeric::half;
use splitsum::numeric::quadrature::tanh_sinh::tanh_sinh;
use splitsum::table::claim::{Certificate, Stage};
use std::path::{Path, PathBuf};
use std::process::Command;

pub fn ggx(masking: Masking) -> Microfacet {
    Microfacet { ndf: Ndf::Ggx, masking }
}

/// The lobe of a row that begins with its model and its masking.
pub fn lobe_of(row: &[&str]) -> Microfacet {
    Microfacet { ndf: Ndf::named(row[0]).unwrap(), masking: Masking::named(row[1]).unwrap() }
}

/// The rows of a file of figures, without comments and the line of names.
pub fn figures(text: &str) -> Vec<Vec<&str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').collect()).collect()
}

pub fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Numbers in [0, 1), the same in every run: Knuth's linear congruential generator, its upper 53
/// bits.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// `count` points (n·v, α), a third of them spread evenly, the others crowded towards the edges
/// down to 1e-8, then the edges themselves: n·v in {0, 1e-6, …, 1} by perceptual roughness in
/// {1e-3, …, 1}.
pub fn domain(count: usize) -> Vec<(f64, f64)> {
    let mut random = Random(20261122);
    let mut points: Vec<(f64, f64)> = (0..count)
        .map(|i| {
            let (u, r) = (random.next(), random.next());
            let mu = match i % 3 {
                0 => u,
                1 => 10f64.powf(-8.0 * u),
                _ => 1.0 - 10f64.powf(-8.0 * u),
            };
            let r = if i % 2 == 0 { r.max(1e-3) } else { 10f64.powf(-4.0 * r) };
            (mu, r * r)
        })
        .collect();
    for mu in [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.9, 0.99, 1.0 - 1e-6, 1.0] {
        for r in [1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8, 0.99, 1.0] {
            points.push((mu, r * r));
        }
    }
    points
}

/// A rule at single points.
pub struct Integrator(pub Rule);

impl Integrator {
    /// (A, B) of a lobe.
    pub fn integrate(&self, lobe: Microfacet, mu: f64, alpha: f64) -> ScaleBias {
        cpu::bake_points(lobe, &[(mu, alpha)], &self.0).scale_bias()[0]
    }
}

/// The table of A and B.
pub fn ab(lobe: Microfacet) -> Lut {
    Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All).unwrap())
}

/// The same as the only part of a packing.
pub fn part(lobe: Microfacet) -> Part {
    ab(lobe).into()
}

/// A table of these A and B as backends give it.
pub fn field(values: &[ScaleBias]) -> Field {
    Field::of(2, values.iter().flat_map(|value| value.array()).collect())
}

/// Adds `factor` times a part.
pub fn add(sum: &mut ScaleBias, factor: f64, part: ScaleBias) {
    *sum = ScaleBias { a: sum.a + factor * part.a, b: sum.b + factor * part.b };
}

/// How far two sets of values are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest absolute difference.
    pub max: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
}

impl Difference {
    /// Of two sequences of the same length; NaN anywhere makes it NaN.
    pub fn between(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let (mut max, mut squares, mut count) = (0.0f64, 0.0, 0);
        for (a, b) in pairs {
            let d = (a - b).abs();
            max = if d <= max { max } else { d };
            squares += d * d;
            count += 1;
        }
        Difference { max, rms: (squares / f64::from(count.max(1))).sqrt() }
    }
}

/// A certified table with its certificate.
#[derive(Debug)]
pub struct Certified {
    pub values: Vec<f64>,
    pub certificate: Certificate,
    pub stages: Vec<Stage>,
}

/// Certifies a table.
pub fn certify(task: &Task, device: Option<DeviceTable>) -> splitsum::Result<Certified> {
    certify_by(task, &Stages::of(task), device)
}

/// The same through these stages.
pub fn certify_by(
    task: &Task,
    stages: &Stages,
    device: Option<DeviceTable>,
) -> splitsum::Result<Certified> {
    let (values, tally) = certify_band(task, stages, device, &|_| ())?;
    let certificate = tally.certificate(task, stages, String::new())?;
    Ok(Certified { values, certificate, stages: tally.stages })
}

/// The bounds of a rule's errors in A and B at (n·v, α).
pub fn errors_at(rule: &Rule, lobe: Microfacet, point: (f64, f64), value: ScaleBias) -> ScaleBias {
    let errors = rule.errors(lobe).at(point, &value.array());
    ScaleBias { a: errors[0], b: errors[1] }
}

/// A and B averaged over all directions, by the reference on double exponential nodes in pieces
/// that meet at these n·v.
pub fn average_in_pieces(lobe: Microfacet, alpha: f64, middles: &[f64]) -> ScaleBias {
    let mut ends = [&[0.0, 1.0], middles].concat();
    ends.sort_by(f64::total_cmp);
    let mut directions = Vec::new();
    let mut weights = Vec::new();
    for piece in ends.windows(2) {
        let (start, length) = (piece[0], piece[1] - piece[0]);
        for node in tanh_sinh(72) {
            let mu = start + length * node.from_start;
            directions.push((mu, alpha));
            weights.push(2.0 * length * node.weight * mu);
        }
    }
    let integrals = cpu::bake_points(lobe, &directions, &REFERENCE).scale_bias();
    let mut sum = ScaleBias::default();
    integrals.iter().zip(&weights).for_each(|(&part, &weight)| add(&mut sum, weight, part));
    sum
}

/// The variable that makes a failure of a missing device or layer.
pub const VULKAN: &str = "SPLITSUM_REQUIRE_VULKAN";
/// The variable that makes a failure of a missing reader, compiler or browser.
pub const READERS: &str = "SPLITSUM_REQUIRE_READERS";

/// A test that cannot run here: ignored, or failed where this variable requires it.
pub fn missing(variable: &'static str, name: String, reason: String) -> Trial {
    if std::env::var_os(variable).is_some() {
        return Trial::test(name, move || Err(format!("{variable} is set, but {reason}").into()));
    }
    Trial::test(format!("{name} ({reason})"), || Ok(())).with_ignored_flag(true)
}

/// A test by a tool that a variable names, as a program or a folder.
pub fn with_named(
    variable: &str,
    name: &str,
    test: impl FnOnce(PathBuf) -> Result<(), Failed> + Send + 'static,
) -> Trial {
    match std::env::var_os(variable) {
        Some(tool) => Trial::test(name, move || test(tool.into())),
        None => missing(READERS, name.into(), format!("{variable} is not set")),
    }
}

/// A test by a program that is asked for its version first.
pub fn with_program(
    program: &'static str,
    name: &str,
    test: impl FnOnce() -> Result<(), Failed> + Send + 'static,
) -> Trial {
    match Command::new(program).arg("--version").output() {
        Ok(_) => Trial::test(name, test),
        Err(_) => missing(READERS, name.into(), format!("{program} is not installed")),
    }
}

/// A test by Node.js or a browser with the modules of tests/web.
pub fn with_modules(
    name: &str,
    test: impl FnOnce() -> Result<(), Failed> + Send + 'static,
) -> Trial {
    if Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web/node_modules").is_dir() {
        return Trial::test(name, test);
    }
    let reason = "tests/web/node_modules is missing: run npm ci there".to_owned();
    missing(READERS, name.into(), reason)
}

/// What a command prints; an error with what it says where it fails.
pub fn printed(command: &mut Command) -> Result<Vec<u8>, Failed> {
    let output = command.output()?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(format!("{command:?}: {said}{}", String::from_utf8_lossy(&output.stdout)).into())
}

/// The points of the domain at which a lobe has an albedo.
pub fn domain_of(lobe: Microfacet, count: usize) -> Vec<(f64, f64)> {
    domain(count).into_iter().filter(|&(mu, _)| mu > 0.0 || !lobe.diverges_at_grazing()).collect()
}

/// Components and numbers of an array.
pub fn read_npy(bytes: &[u8]) -> (usize, Vec<f64>) {
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8_lossy(&bytes[10..10 + length]).into_owned();
    let data = &bytes[10 + length..];
    let shape = header.split("'shape': (").nth(1).and_then(|rest| rest.split(')').next());
    let components = shape.and_then(|shape| shape.rsplit(", ").next()).unwrap();
    let values = match header.split('\'').nth(3).unwrap() {
        "<f2" => chunks(data, |bytes| half::value(u16::from_le_bytes(bytes))),
        "<f4" => chunks(data, |bytes| f64::from(f32::from_le_bytes(bytes))),
        "<u2" => chunks(data, |bytes| f64::from(u16::from_le_bytes(bytes))),
        "|u1" => chunks(data, |[byte]: [u8; 1]| f64::from(byte)),
        other => unreachable!("{other}"),
    };
    (components.parse().unwrap(), values)
}

fn chunks<const N: usize>(data: &[u8], value: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    data.as_chunks::<N>().0.iter().map(|&bytes| value(bytes)).collect()
}
