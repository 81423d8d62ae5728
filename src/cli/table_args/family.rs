//! The family of a table and its model, by name.

use super::TableArgs;
use crate::brdf::interface::{Interface, Side};
use crate::brdf::{Diffuse, Fresnel, Microfacet, Ndf};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::lut::{
    Dfg, DfgChannels, Energy, EnergyChannels, Glass, GlassChannels, Lut, Packing, terms,
};
use crate::units::{F0, Ior};

/// A family of tables by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    Dfg,
    Sheen,
    Energy,
    Glass,
    Diffuse,
}

/// The sides of glass in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    Outside,
    Inside,
    Both,
}

choice!(Sides, "side", {
    Outside = "outside", "seen from air";
    Inside = "inside", "seen from the medium, with total reflection";
    Both = "both", "the channels from outside, then those from inside";
});

choice!(Family, "lut", {
    Dfg = "dfg", "the split sum, E(F0) = F0*A + B (Karis 2013)";
    Sheen = "sheen", "the same with charlie and E alone";
    Energy = "energy", "the energy that a specular lobe leaves and loses (Kulla and Conty 2017; \
                        Turquin 2019)";
    Glass = "glass", "what a rough interface reflects and transmits (Walter et al. 2007)";
    Diffuse = "diffuse", "the albedo of a white diffuse lobe";
});

impl TableArgs {
    /// The table; `f0`, `ior` and `fresnel`: those of a table for one.
    pub(super) fn family(&self, f0: F0, ior: Ior, fresnel: Fresnel) -> Result<Packing> {
        match self.lut.unwrap_or(Family::Dfg) {
            Family::Dfg => self.dfg((Ndf::Ggx, fresnel), None),
            Family::Sheen => self.dfg((Ndf::Charlie, fresnel), Some("e")),
            Family::Energy => {
                check_no_fresnel(fresnel)?;
                let channels = self.channels.as_deref().unwrap_or(EnergyChannels::Split.word());
                let (channels, lobe) = (EnergyChannels::named(channels)?, self.lobe(Ndf::Ggx)?);
                let energy = match (&self.ior, channels) {
                    (Some(_), EnergyChannels::Split) => Energy::of_interface(lobe, ior.get()),
                    _ => Energy::new(lobe, f0, channels),
                };
                energy.map(|energy| Lut::Energy(energy).into())
            }
            Family::Glass => {
                check_no_fresnel(fresnel)?;
                self.glass(ior)
            }
            Family::Diffuse => {
                check_no_fresnel(fresnel)?;
                self.diffuse().map(|diffuse| Lut::Diffuse(diffuse).into())
            }
        }
    }

    /// The integrals of a specular lobe; without other channels all of them.
    fn dfg(&self, (ndf, fresnel): (Ndf, Fresnel), channels: Option<&str>) -> Result<Packing> {
        let lobe = self.lobe(ndf)?;
        let Some(words) = self.channels.as_deref().or(channels) else {
            return Dfg::new(lobe, fresnel, DfgChannels::All).map(|dfg| Lut::Dfg(dfg).into());
        };
        match Dfg::with_channels(lobe, fresnel, words) {
            Ok(dfg) => Ok(Lut::Dfg(dfg).into()),
            Err(_) => terms::packing(lobe, fresnel, words),
        }
    }

    fn glass(&self, ior: Ior) -> Result<Packing> {
        let channels =
            self.channels.as_deref().map_or(Ok(GlassChannels::Rt), GlassChannels::named)?;
        let transmission = self.transmission_masking.unwrap_or_default();
        let outside = Interface::new(self.lobe(Ndf::Ggx)?, ior.get(), Side::Outside, transmission)?;
        let of = |side| Ok(Lut::Glass(Glass::new(outside.from(side), channels)).into());
        match self.side.unwrap_or(Sides::Outside) {
            Sides::Outside => of(Side::Outside),
            Sides::Inside => of(Side::Inside),
            Sides::Both => Glass::both_sides(outside, channels),
        }
    }

    fn diffuse(&self) -> Result<Diffuse> {
        if self.masking.is_some() || self.channels.is_some() {
            let (expected, got) = ("a model alone for diffuse", "masking or channels");
            return Err(Error::bad_input("lut", expected, got, "leave them out"));
        }
        self.model.as_deref().map_or(Ok(Diffuse::Burley), Diffuse::named)
    }

    /// The lobe of the model, or by default of this distribution.
    fn lobe(&self, default: Ndf) -> Result<Microfacet> {
        let ndf = self.model.as_deref().map_or(Ok(default), Ndf::named)?;
        Microfacet::new(ndf, self.masking)
    }
}

fn check_no_fresnel(fresnel: Fresnel) -> Result<()> {
    if fresnel == Fresnel::Schlick {
        return Ok(());
    }
    let expected = "schlick for energy, glass and diffuse";
    Err(Error::bad_input("fresnel", expected, fresnel.to_string(), "leave it out"))
}
