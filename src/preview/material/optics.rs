//! What spheres of a material need at each roughness: integrals over n·v by a table and by a rule,
//! and the moments of their light.

use super::{Material, Way};
use crate::backend::cpu;
use crate::backend::cpu::Baker;
use crate::brdf::fresnel::{Basis, Dielectric, metal};
use crate::brdf::interface::{Interface, Side, TransmissionMasking};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::average::average_nodes;
use crate::numeric::quadrature::gauss_legendre::{Node, gauss_legendre};
use crate::preview::curve::{Curve, NODES, Samples, points};
use crate::preview::moments::{MOMENT_NODES, Moments, View};
use crate::preview::shade::LAMBERT;
use crate::preview::{Column, axes, means, rule_of_picture};
use crate::table::grid::Grid;
use crate::units::alpha_of;
use std::f64::consts::FRAC_PI_2;

/// The index of refraction of the glass and of the coat.
pub const IOR: f64 = 1.5;

/// The lobe.
pub const LOBE: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

/// N integrals by a table and by a rule, over n·v.
pub struct Read<const N: usize> {
    pub table: Curve<N>,
    pub integral: Curve<N>,
}

/// A lobe's albedo and the moments of its light.
pub struct Lobe {
    pub albedo: Read<1>,
    pub moments: Curve<6>,
}

/// What a sphere needs of its material.
pub enum Optics {
    /// R and T; the moments of both; of refracted light the means of P1 and P2 about -n.
    Glass { albedos: Read<2>, moments: [Curve<6>; 2], means: (f64, f64) },
    /// The interface; S_avg by the table and exactly; the means of P1 and P2 of light that passes
    /// it, by both.
    Coat { interface: Lobe, averages: [f64; 2], passed: [(f64, f64); 2] },
    /// Red, green and blue.
    Metal(Vec<Lobe>),
}

/// Of each column.
pub fn optics(material: Material, columns: &[Column]) -> Result<Vec<Optics>> {
    match material {
        Material::Glass => glass(columns),
        Material::Coat => coats(columns),
        Material::Metal => metals(columns),
    }
}

impl<const N: usize> Read<N> {
    /// The integrals at n·v.
    pub fn at(&self, way: Way, mu: f64) -> [f64; N] {
        match way {
            Way::Table => self.table.at(mu),
            Way::Integral => self.integral.at(mu),
        }
    }
}

fn glass(columns: &[Column]) -> Result<Vec<Optics>> {
    let interface = Interface::new(LOBE, IOR, Side::Outside, TransmissionMasking::Correlated)?;
    let medium = interface.medium();
    let optics = |(column, albedos): (&Column, Read<2>)| {
        let alpha = column.alpha;
        let reflected =
            moments(|mu| View::new(mu, alpha).reflected(LOBE, |c| medium.weights(c)[0]));
        let transmitted = moments(|mu| View::new(mu, alpha).transmitted(interface));
        let means = refracted_means(alpha);
        Ok(Optics::Glass { albedos, moments: [reflected?, transmitted?], means })
    };
    columns.iter().zip(read(Integrand::Glass(interface), columns)?).map(optics).collect()
}

fn coats(columns: &[Column]) -> Result<Vec<Optics>> {
    let medium = Dielectric::new(IOR)?;
    let of = Integrand::Specular(LOBE, Fresnel::Dielectric(medium));
    let baker = Baker::new(of, &rule_of_picture(of, NODES));
    let (_, y) = axes()?;
    let rows = baker.averages(&y.values().iter().map(|&r| alpha_of(r)).collect::<Vec<_>>());
    let optics = |(column, interface): (&Column, Lobe)| {
        let (i, next, share) = y.neighbours(column.roughness);
        let (low, high) = (rows.values()[i], rows.values()[next]);
        let exact = baker.averages(&[column.alpha]).values()[0];
        let kernel = |(mu, weight): (f64, f64)| {
            let [s] = interface.albedo.integral.at(mu);
            (weight * (1.0 - s), mu)
        };
        let passed = [LAMBERT, means(average_nodes().into_iter().map(kernel))];
        let averages = [low + share * (high - low), exact];
        Optics::Coat { interface, averages, passed }
    };
    let lobes = lobes(Fresnel::Dielectric(medium), |c| medium.weights(c)[0], columns)?;
    Ok(columns.iter().zip(lobes).map(optics).collect())
}

fn metals(columns: &[Column]) -> Result<Vec<Optics>> {
    let channels = metal("gold").ok_or_else(|| Error::Internal("there is no gold".into()))?;
    let [red, green, blue] = channels.map(|conductor| {
        lobes(Fresnel::Conductor(conductor), move |c| conductor.weights(c)[0], columns)
    });
    let all = red?.into_iter().zip(green?).zip(blue?);
    Ok(all.map(|((red, green), blue)| Optics::Metal(vec![red, green, blue])).collect())
}

/// A lobe with this Fresnel model, whose F is given too, for each column.
fn lobes(
    fresnel: Fresnel,
    reflectance: impl Fn(f64) -> f64 + Sync,
    columns: &[Column],
) -> Result<Vec<Lobe>> {
    let lobe = |(column, albedo): (&Column, Read<1>)| {
        let moments = moments(|mu| View::new(mu, column.alpha).reflected(LOBE, &reflectance))?;
        Ok(Lobe { albedo, moments })
    };
    columns.iter().zip(read(Integrand::Specular(LOBE, fresnel), columns)?).map(lobe).collect()
}

fn moments(at: impl Fn(f64) -> Moments + Send + Sync) -> Result<Curve<6>> {
    Curve::of(MOMENT_NODES, at)
}

/// The integrals at each column's roughness, by a table of them and by a rule.
fn read<const N: usize>(of: Integrand, columns: &[Column]) -> Result<Vec<Read<N>>> {
    let (x, y) = axes()?;
    let rule = rule_of_picture(of, NODES);
    let values = points(&cpu::bake(of, &Grid::new(&x, &y)?, &rule, &|_| ()));
    let table = Samples { x, y, values };
    let read = |column: &Column| {
        let integral = Curve::of_integral(of, column.alpha, &rule)?;
        Ok(Read { table: Curve::of_table(&table, column.roughness), integral })
    };
    columns.iter().map(read).collect()
}

/// The means of P1 and P2 of refracted light about -n, for half vectors by D n·h with v = n and
/// light weighted by |n·l|: the kernel of [`Column`] for light that passes.
fn refracted_means(alpha: f64) -> (f64, f64) {
    let kernel = |node: Node| {
        let theta = node.at * FRAC_PI_2;
        let (c, y) = (theta.cos(), theta.tan() / LOBE.ndf.width(alpha));
        // x = -n·l with l = (-v + (c - g) h)/η, g² = η² - 1 + c².
        let x = (1.0 + ((IOR * IOR - 1.0 + c * c).sqrt() - c) * c) / IOR;
        (node.weight * y * LOBE.ndf.slope_density(y * y, alpha) / (c * c) * x, x)
    };
    means(gauss_legendre(256).into_iter().map(kernel))
}
