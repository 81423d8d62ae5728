//! The average albedo over all directions: E_avg = 2 ∫_0^1 E(μ) μ dμ, what a surface reflects of diffuse light.

use super::{Integrand, ScaleBias};
use crate::model::{Microfacet, Ndf};
use crate::quadrature::gauss_legendre::gauss_legendre;

/// Directions of an average, for each half of it.
const NODES: usize = 64;

/// (n·v, weight) of the directions; the weights add up to 1.
///
/// Gauss-Legendre in q, μ = q³ up to 1/2 and 1 - q³ beyond, resolves the layer at grazing angles, the bend of Charlie's fitted
/// term at 1/2 and its root at 1: 1e-12 are left of every average but Walter's, whose term jumps elsewhere (1e-6).
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

/// What the nodes' quadrature may err.
pub fn average_error(integrand: Integrand) -> f64 {
    match integrand {
        Integrand::Specular(Microfacet { ndf: Ndf::BeckmannWalter, .. }) => 1e-6,
        _ => 1e-12,
    }
}

/// The average of each row of integrals given at the directions of [`average_nodes`].
pub fn averages(nodes: &[(f64, f64)], rows: &[ScaleBias]) -> Vec<ScaleBias> {
    let average = |row: &[ScaleBias]| {
        let mut sum = ScaleBias::default();
        nodes.iter().zip(row).for_each(|(&(_, weight), &integral)| sum.add(weight, integral));
        sum
    };
    rows.chunks(nodes.len()).map(average).collect()
}
