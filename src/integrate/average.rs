//! The average albedo over all directions: E_avg = 2 ∫_0^1 E(μ) μ dμ, the share of diffuse light
//! that a surface reflects.

use super::{Field, Integrand};
use crate::brdf::{Microfacet, Ndf};
use crate::numeric::quadrature::gauss_legendre::gauss_legendre;

/// Directions of an average, for each half of it.
const NODES: usize = 64;

/// (n·v, weight) of the directions; the weights add up to 1.
///
/// Gauss-Legendre in q, μ = q³ up to 1/2 and 1 - q³ beyond, resolves the layer at grazing angles,
/// the bend of Charlie's fitted term at 1/2 and its root at 1.
pub fn average_nodes() -> Vec<(f64, f64)> {
    let end = libm::cbrt(0.5);
    let half = |mu: fn(f64) -> f64| {
        gauss_legendre(NODES).into_iter().map(move |n| {
            let q = end * n.at;
            let mu = mu(q * q * q);
            (mu, 2.0 * mu * 3.0 * q * q * end * n.weight)
        })
    };
    half(|cube| cube).chain(half(|cube| 1.0 - cube)).collect()
}

/// The largest error of the nodes' quadrature: 1e-12, but for Walter's term, which jumps between
/// two nodes.
pub fn average_error(integrand: Integrand) -> f64 {
    match integrand {
        Integrand::Specular(Microfacet { ndf: Ndf::BeckmannWalter, .. }, _) => 1e-6,
        _ => 1e-12,
    }
}

/// The average of each row of integrals given at the directions of [`average_nodes`].
pub fn averages(nodes: &[(f64, f64)], rows: &Field) -> Field {
    debug_assert!(rows.len().is_multiple_of(nodes.len()), "{} by {}", rows.len(), nodes.len());
    let count = rows.count();
    let mut averages = Field::zeros(count, rows.len() / nodes.len());
    let sums = averages.values_mut().chunks_exact_mut(count);
    for (sum, row) in sums.zip(rows.values().chunks_exact(count * nodes.len())) {
        for (&(_, weight), integrals) in nodes.iter().zip(row.chunks_exact(count)) {
            for (sum, integral) in sum.iter_mut().zip(integrals) {
                *sum += weight * integral;
            }
        }
    }
    averages
}
