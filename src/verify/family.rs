//! Tables beside the split sums of Schlick's Fresnel: exact Fresnel, glass, what a lobe leaves and
//! loses. Most have a number of their own, an index of refraction or F0, which is fitted.

pub mod contest;
pub mod number;
pub mod seek;

use super::candidates::NUMBERS;
use super::sample::Quantity;
use super::search::Hypothesis;
use super::truth::{ROUGH, Truth};
use crate::brdf::fresnel::{Dielectric, SchlickPower, metal, metal_names};
use crate::brdf::interface::{Interface, Side, TransmissionMasking};
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::Result;
use crate::lut::{Dfg, DfgChannels, Energy, EnergyChannels, Glass, GlassChannels, Lut};
use crate::units::F0;

/// Indices from which a fit begins.
const INDICES: [f64; 13] = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.85, 2.0, 2.2, 2.5, 3.0, 4.0];

/// F0s from which a fit begins: those of metals leave so little that a step of 0.1 is much.
const REFLECTANCES: [f64; 12] =
    [0.02, 0.04, 0.08, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.94];

/// Exponents of Schlick's approximation from which a fit begins.
const EXPONENTS: [f64; 3] = [3.5, 4.5, 6.0];

/// A table of each family with so many channels, by lobes that nearly all tables have.
pub fn families(channels: usize) -> Result<Vec<Truth>> {
    let lobe = Microfacet::new(Ndf::Ggx, Some(Masking::HeightCorrelated))?;
    let mut luts = Vec::new();
    for ior in INDICES {
        if channels == 1 {
            luts.push(dfg(lobe, Fresnel::Dielectric(Dielectric::new(ior)?))?);
        }
        for &side in Side::ALL {
            let interface = Interface::new(lobe, ior, side, TransmissionMasking::default())?;
            // From outside R is that of exact Fresnel.
            let own = match side {
                Side::Outside => GlassChannels::Transmit,
                Side::Inside => GlassChannels::Rt,
            };
            let of_one = [own, GlassChannels::Total, GlassChannels::Turquin];
            let of_more = [GlassChannels::Rt, GlassChannels::KullaConty];
            let lists = if channels == 1 { &of_one[..] } else { &of_more[..] };
            luts.extend(lists.iter().map(|&list| Lut::Glass(Glass::new(interface, list))));
        }
    }
    if channels == 1 {
        // Of other metals the layout is told by these in red and blue, which are far apart.
        for [red, _, blue] in ["gold", "iron", "aluminium"].into_iter().filter_map(metal) {
            luts.push(dfg(lobe, Fresnel::Conductor(red))?);
            luts.push(dfg(lobe, Fresnel::Conductor(blue))?);
        }
    }
    for exponent in EXPONENTS {
        let fresnel = Fresnel::SchlickPower(SchlickPower::new(exponent)?);
        for masking in [Masking::HeightCorrelated, Masking::SchlickSmith] {
            let lobe = Microfacet::new(Ndf::Ggx, Some(masking))?;
            luts.push(dfg(lobe, fresnel)?);
        }
    }
    for f0 in REFLECTANCES {
        luts.push(Lut::Energy(Energy::new(lobe, F0::new(f0)?, EnergyChannels::Split)?));
    }
    for ior in INDICES {
        luts.push(Lut::Energy(Energy::of_interface(lobe, ior)?));
    }
    let alone = if channels == 1 { EnergyChannels::Turquin } else { EnergyChannels::KullaConty };
    // These have no number, and depend the more on the lobe.
    let (correlated, ggx) = (Masking::HeightCorrelated, Ndf::Ggx);
    let of_ggx = [correlated, Masking::Separable, Masking::SchlickSmith].map(|of| (ggx, of));
    for (ndf, masking) in of_ggx.into_iter().chain([(Ndf::Beckmann, correlated)]) {
        let lobe = Microfacet::new(ndf, Some(masking))?;
        luts.push(Lut::Energy(Energy::new(lobe, F0::new(0.0)?, alone)?));
    }
    Ok(luts.into_iter().map(|lut| Truth { lut, tolerance: ROUGH }).collect())
}

/// A table whose rows alone differ: averages over all directions.
pub fn averages() -> Result<Vec<Truth>> {
    let lobe = Microfacet::new(Ndf::Ggx, Some(Masking::HeightCorrelated))?;
    let energy = Energy::new(lobe, F0::new(0.0)?, EnergyChannels::Average)?;
    let mut luts = vec![Lut::Energy(energy)];
    for ior in INDICES {
        for &side in Side::ALL {
            let interface = Interface::new(lobe, ior, side, TransmissionMasking::default())?;
            luts.push(Lut::Glass(Glass::new(interface, GlassChannels::Average)));
        }
    }
    Ok(luts.into_iter().map(|lut| Truth { lut, tolerance: ROUGH }).collect())
}

fn dfg(lobe: Microfacet, fresnel: Fresnel) -> Result<Lut> {
    let channels = match fresnel {
        Fresnel::SchlickPower(_) => DfgChannels::Every,
        _ => DfgChannels::All,
    };
    Ok(Lut::Dfg(Dfg::new(lobe, fresnel, channels)?))
}

/// The numbers of a texel that a channel may be.
pub fn numbers(lut: &Lut) -> Vec<Quantity> {
    let count = lut.channels().len();
    let channels = || (0..count).map(Quantity::Channel);
    let both = || channels().chain((0..count).map(Quantity::Complement)).collect();
    match lut {
        Lut::Dfg(dfg) if dfg.fresnel().count() > 1 => NUMBERS.to_vec(),
        Lut::Dfg(_) | Lut::Diffuse(_) => channels().collect(),
        Lut::Energy(energy) => match energy.channels() {
            // What an interface leaves is 1 less what it reflects, which is a table of its own.
            EnergyChannels::Split if energy.ior().is_some() => channels().collect(),
            EnergyChannels::Turquin => channels().collect(),
            EnergyChannels::Split | EnergyChannels::Average | EnergyChannels::KullaConty => both(),
        },
        Lut::Glass(glass) => match glass.channels() {
            GlassChannels::Total | GlassChannels::KullaConty => both(),
            _ => channels().collect(),
        },
    }
}

/// The same hypothesis by integrals as exact as errors are.
pub fn fine(hypothesis: Hypothesis) -> Hypothesis {
    let truth = Truth { tolerance: super::errors::TOLERANCE, ..hypothesis.truth };
    Hypothesis { truth, ..hypothesis }
}

/// The distance beyond which a table is none that is known. Of split sums that are known the
/// farthest lay at 0.013, of two of sheen by other lobes the nearest at 0.07, of an LTC fit at 0.1;
/// one channel alone is as near as 0.02 to that of other families. Where a number is fitted, or a
/// metal chosen, much is alike. `rounding`: what the steps of a file are off by on the average, in
/// each channel.
pub fn farthest(nearest: &Hypothesis, rounding: &[f64]) -> f64 {
    let of = |&(channel, _): &(usize, Quantity)| rounding.get(channel).copied().unwrap_or(0.0);
    let packing = &nearest.packing;
    let rounding = packing.iter().map(of).sum::<f64>() / packing.len().max(1) as f64;
    match (is_split_sum(nearest.truth), nearest.packing.len()) {
        (true, 1) => 0.01 + rounding,
        (true, _) => 0.03,
        (false, _) => 0.002 + rounding,
    }
}

/// Whether it is a split sum of Schlick's Fresnel.
pub fn is_split_sum(truth: Truth) -> bool {
    truth.lut.fresnel() == Some(Fresnel::Schlick)
}

/// The distributions of other families than split sums.
const DISTRIBUTIONS: [Ndf; 2] = [Ndf::Ggx, Ndf::Beckmann];

/// The same table for every lobe of these that has one.
pub fn relatives(truth: Truth) -> Vec<Truth> {
    let lobes = DISTRIBUTIONS.iter().flat_map(|&ndf| {
        let maskings = ndf.definition().maskings.iter();
        maskings.filter_map(move |&masking| Microfacet::new(ndf, Some(masking)).ok())
    });
    lobes
        .filter_map(|lobe| of_lobe(truth.lut, lobe).ok())
        .map(|lut| Truth { lut, ..truth })
        .collect()
}

fn of_lobe(lut: Lut, lobe: Microfacet) -> Result<Lut> {
    Ok(match lut {
        Lut::Dfg(table) => dfg(lobe, table.fresnel())?,
        Lut::Energy(energy) => Lut::Energy(match energy.ior() {
            Some(ior) => Energy::of_interface(lobe, ior)?,
            None => {
                let f0 = F0::new(energy.f0().unwrap_or(0.0))?;
                Energy::new(lobe, f0, energy.channels())?
            }
        }),
        Lut::Glass(glass) => {
            let own = glass.interface();
            let interface = Interface::new(lobe, own.ior(), own.side(), own.transmission())?;
            Lut::Glass(Glass::new(interface, glass.channels()))
        }
        Lut::Diffuse(_) => lut,
    })
}

/// The metals whose reflectances are sought, each in red, green and blue; none for a table of
/// another Fresnel.
pub fn metals(truth: Truth) -> Vec<Truth> {
    let (Lut::Dfg(table), Some(Fresnel::Conductor(_))) = (truth.lut, truth.lut.fresnel()) else {
        return Vec::new();
    };
    let of = |metal| dfg(table.lobe(), Fresnel::Conductor(metal)).ok();
    let names = metal_names();
    let conductors = names.split(", ").filter_map(metal).flatten();
    conductors.filter_map(of).map(|lut| Truth { lut, ..truth }).collect()
}

/// What families have in common whose tables differ by their lobe and their own number alone.
pub fn kind(lut: &Lut) -> String {
    match lut {
        Lut::Dfg(dfg) => match dfg.fresnel() {
            Fresnel::Schlick => "split sum".into(),
            Fresnel::SchlickPower(_) => "split sum of another exponent".into(),
            Fresnel::Conductor(_) => "conductor".into(),
            _ => "dielectric".into(),
        },
        Lut::Energy(energy) => {
            let of = if energy.ior().is_some() { " of an interface" } else { "" };
            format!("energy {}{of}", energy.channels())
        }
        Lut::Glass(glass) => {
            format!("glass {} {}", glass.channels(), glass.interface().side())
        }
        Lut::Diffuse(diffuse) => diffuse.to_string(),
    }
}
