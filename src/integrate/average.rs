//! The average albedo over all directions: E_avg = 2 ∫_0^1 E(μ) μ dμ, the share of diffuse light
//! that a surface reflects.

use super::{Field, Integrand};
use crate::brdf::interface::{Side, TransmissionMasking};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::integrate::bounds::WIDE_LAYER;
use crate::numeric::quadrature::gauss_legendre::gauss_legendre;
use crate::numeric::quadrature::tanh_sinh::tanh_sinh;

/// Directions of an average, for each half of it: enough for every lobe but Charlie and those that
/// jump.
const NODES: usize = 64;

/// Directions of [`average_nodes`], and about as many as an average takes elsewhere: for estimates
/// of time.
pub const DIRECTIONS: usize = 2 * NODES;

/// (n·v, weight) of the directions; the weights add up to 1.
pub fn average_nodes() -> Vec<(f64, f64)> {
    crowded_nodes(0.0, 1.0, NODES)
}

/// The same for the directions from one n·v to another, `count` for each half: Gauss-Legendre in
/// q³, the distance from either end, resolves the layer at grazing angles, the bend of Charlie's
/// fitted term at 1/2 and its root at 1.
fn crowded_nodes(from: f64, to: f64, count: usize) -> Vec<(f64, f64)> {
    let (end, length) = (libm::cbrt(0.5), to - from);
    let half = |mu: fn(f64) -> f64| {
        gauss_legendre(count).into_iter().map(move |n| {
            let q = end * n.at;
            let mu = from + length * mu(q * q * q);
            (mu, 2.0 * mu * length * 3.0 * q * q * end * n.weight)
        })
    };
    half(|cube| cube).chain(half(|cube| 1.0 - cube)).collect()
}

/// Directions for each half of a piece of a lobe's average at an α: the fewest in steps of 8 that
/// keep [`AVERAGE_ERROR`], measured against twice as many.
fn directions(lobe: Microfacet, alpha: f64) -> usize {
    let wide = alpha >= WIDE_LAYER;
    match (lobe.ndf, lobe.masking) {
        (Ndf::Charlie, _) if wide => 32,
        // The ring's layer at the horizon is thinner than √α.
        (Ndf::Charlie, _) if alpha < 1e-5 => 256,
        (Ndf::Charlie, _) => NODES,
        (_, Masking::Implicit) => 32,
        (Ndf::Ggx, _) if wide => 32,
        (Ndf::Ggx, _) => 48,
        (Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong, _) if wide => 48,
        (Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong, _) => NODES,
    }
}

/// (n·v, weight) of the directions at an α: of a lobe that jumps on either side of the jump, and of
/// an interface of dielectrics in pieces, tanh-sinh in each.
///
/// An interface's albedo bends within α of grazing incidence, where F rises to 1 as c falls below
/// √k, k = η² - 1, and from inside within α of the critical angle θ_c, and where θ_v = π/2 - θ_c or
/// π/2 - 2 θ_c, at which the critical angle of a half vector meets the horizon.
pub fn average_nodes_at(integrand: Integrand, alpha: f64) -> Vec<(f64, f64)> {
    if let Integrand::Specular(lobe, fresnel) = integrand
        && !matches!(fresnel, Fresnel::Dielectric(_))
    {
        let count = directions(lobe, alpha);
        return match lobe.break_at(alpha).filter(|_| lobe.jumps()) {
            Some(jump) => {
                [crowded_nodes(0.0, jump, count), crowded_nodes(jump, 1.0, count)].concat()
            }
            None => crowded_nodes(0.0, 1.0, count),
        };
    }
    let mut breaks = vec![0.0, alpha, WIDE * alpha, 1.0];
    match integrand {
        Integrand::Glass(interface) if interface.side() == Side::Inside => {
            let (eta, critical) = (interface.eta(), interface.critical());
            breaks.extend([eta, critical, 2.0 * eta * critical]);
            for off in [alpha, WIDE * alpha] {
                breaks.extend([critical - off, critical + off]);
            }
        }
        Integrand::Glass(interface) => breaks.push(interface.k().sqrt()),
        Integrand::Specular(_, Fresnel::Dielectric(medium)) => breaks.push(medium.k().sqrt()),
        Integrand::Specular(..) | Integrand::Diffuse(_) => (),
    }
    breaks.retain(|at| (0.0..=1.0).contains(at));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let rule = tanh_sinh(if is_smooth(integrand) { PIECE_NODES } else { 2 * PIECE_NODES });
    let nodes = breaks.windows(2).flat_map(|ends| {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        rule.iter().map(move |node| {
            let mu = from + length * node.from_start;
            (mu, 2.0 * mu * length * node.weight)
        })
    });
    nodes.collect()
}

/// Whether the directions have to vary with α: those of interfaces of dielectrics, of a jump and of
/// Charlie do.
pub fn averages_by_row(integrand: Integrand) -> bool {
    match integrand {
        Integrand::Glass(_) | Integrand::Specular(_, Fresnel::Dielectric(_)) => true,
        Integrand::Specular(lobe, _) => lobe.jumps() || lobe.ndf == Ndf::Charlie,
        Integrand::Diffuse(_) => false,
    }
}

/// Whether it is of GGX with a rational masking term: Gaussian slopes and the beta function take
/// more directions.
fn is_smooth(integrand: Integrand) -> bool {
    match integrand {
        Integrand::Glass(interface) => {
            interface.lobe().ndf == Ndf::Ggx
                && interface.transmission() != TransmissionMasking::Beta
        }
        Integrand::Specular(lobe, _) => lobe.ndf == Ndf::Ggx,
        Integrand::Diffuse(_) => true,
    }
}

/// Directions in each piece of such an average.
const PIECE_NODES: usize = 48;

/// The end of a bend of width α, in α: found by trial.
const WIDE: f64 = 12.0;

/// The largest error of the nodes' quadrature, and how well what passes an interface the one way
/// and the other agrees.
pub const AVERAGE_ERROR: f64 = 1e-12;

/// The average of each row of integrals given at the directions of [`average_nodes`].
pub fn averages(nodes: &[(f64, f64)], rows: &Field) -> Field {
    debug_assert!(rows.len().is_multiple_of(nodes.len()), "{} by {}", rows.len(), nodes.len());
    let count = rows.count();
    let mut averages = Field::zeros(count, rows.len() / nodes.len());
    let sums = averages.values_mut().chunks_exact_mut(count);
    for (sum, row) in sums.zip(rows.values().chunks_exact(count * nodes.len())) {
        add_average(nodes, row.chunks_exact(count), sum);
    }
    averages
}

/// Adds the average of a row's integrals to `sum`.
pub fn add_average<'a>(
    nodes: &[(f64, f64)],
    integrals: impl Iterator<Item = &'a [f64]>,
    sum: &mut [f64],
) {
    for (&(_, weight), integrals) in nodes.iter().zip(integrals) {
        for (sum, integral) in sum.iter_mut().zip(integrals) {
            *sum += weight * integral;
        }
    }
}
