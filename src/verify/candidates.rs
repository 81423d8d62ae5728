//! The tables of ours that a foreign one may be.

use super::sample::Quantity;
use super::truth::Truth;
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::Result;
use crate::lut::{Dfg, DfgChannels, Lut};

/// The error of integrals that will do: hypotheses that matter differ by more, and most points err
/// by far less than the bound.
pub const TOLERANCE: f64 = 1e-3;

/// The split sum of a lobe by Schlick's Fresnel: A, B, E.
fn split_sum(lobe: Microfacet) -> Result<Truth> {
    let dfg = Dfg::new(lobe, Fresnel::Schlick, DfgChannels::Every)?;
    Ok(Truth { lut: Lut::Dfg(dfg), tolerance: TOLERANCE })
}

/// Its numbers: A, B, E and 1 - E.
pub const NUMBERS: [Quantity; 4] =
    [Quantity::Channel(0), Quantity::Channel(1), Quantity::Channel(2), Quantity::Complement(2)];

/// Lobes by which the layout of nearly every table is told: all of GGX differ less than layouts do.
pub fn likely() -> Result<Vec<Truth>> {
    let lobe = |masking| split_sum(Microfacet::new(Ndf::Ggx, Some(masking))?);
    Ok(vec![lobe(Masking::HeightCorrelated)?, lobe(Masking::SchlickSmith)?])
}

/// Lobes for the layouts of the rest.
pub fn unlikely() -> Result<Vec<Truth>> {
    let lobe = |ndf, masking| split_sum(Microfacet::new(ndf, Some(masking))?);
    Ok(vec![
        lobe(Ndf::Ggx, Masking::Implicit)?,
        lobe(Ndf::BeckmannWalter, Masking::HeightCorrelated)?,
        lobe(Ndf::BlinnPhong, Masking::Implicit)?,
    ])
}

/// The lobe for the layouts of tables of sheen.
pub fn sheen() -> Result<Vec<Truth>> {
    Ok(vec![split_sum(Microfacet::new(Ndf::Charlie, Some(Masking::Neubelt))?)?])
}

/// Every lobe; those of sheen, which cost most, on request.
pub fn split_sums(with_sheen: bool) -> Result<Vec<Truth>> {
    let wanted = |ndf: &&Ndf| with_sheen || **ndf != Ndf::Charlie;
    let lobes = Ndf::ALL.iter().filter(wanted).flat_map(|&ndf| {
        let maskings = ndf.definition().maskings.iter();
        maskings.map(move |&masking| Microfacet::new(ndf, Some(masking)))
    });
    lobes.map(|lobe| split_sum(lobe?)).collect()
}
