//! What several test binaries need: lobes, reference figures, points of the domain.
#![allow(dead_code, reason = "each test binary uses a part of this")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use libtest_mimic::Trial;
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::REFERENCE;
use splitsum::model::{Masking, Microfacet, Ndf};
use splitsum::quadrature::double_exponential::tanh_sinh;

pub fn ggx(masking: Masking) -> Microfacet {
    Microfacet { ndf: Ndf::Ggx, masking }
}

/// The lobe of a row that begins with its model and its masking.
pub fn lobe_of(row: &[&str]) -> Microfacet {
    let [ndf, masking] = [row[0], row[1]].map(serde_json::Value::from);
    Microfacet { ndf: serde_json::from_value(ndf).unwrap(), masking: serde_json::from_value(masking).unwrap() }
}

/// The rows of a file of figures, without comments and the line of names.
pub fn figures(text: &str) -> Vec<Vec<&str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').collect()).collect()
}

pub fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Numbers in [0, 1), the same in every run: Knuth's linear congruential generator, its upper 53 bits.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// `count` points (n·v, α), a third of them spread evenly, the others crowded towards the edges down to 1e-8, then the
/// edges themselves: n·v in {0, 1e-6, …, 1} by perceptual roughness in {1e-3, …, 1}.
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

/// A and B averaged over all directions, by the reference on double exponential nodes in two pieces that meet at `middle`.
pub fn average_in_two_pieces(lobe: Microfacet, alpha: f64, middle: f64) -> ScaleBias {
    let integrator = REFERENCE.integrator();
    let mut sum = ScaleBias::zero();
    for (start, length) in [(0.0, middle), (middle, 1.0 - middle)] {
        for node in tanh_sinh(72) {
            let mu = start + length * node.from_start;
            sum.add(2.0 * length * node.weight * mu, integrator.integrate(lobe, mu, alpha));
        }
    }
    sum
}

/// Whether a missing device, layer or tool is a failure.
fn required() -> bool {
    std::env::var_os("SPLITSUM_REQUIRE_VULKAN").is_some()
}

/// A test that cannot run here: ignored, or failed where it is required.
pub fn missing(name: String, reason: String) -> Trial {
    if required() {
        return Trial::test(name, move || Err(format!("SPLITSUM_REQUIRE_VULKAN is set, but {reason}").into()));
    }
    Trial::test(format!("{name} ({reason})"), || Ok(())).with_ignored_flag(true)
}

/// The points of the domain at which a lobe has an albedo.
pub fn domain_of(lobe: Microfacet, count: usize) -> Vec<(f64, f64)> {
    domain(count).into_iter().filter(|&(mu, _)| mu > 0.0 || !lobe.diverges_at_grazing()).collect()
}
