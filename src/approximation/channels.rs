//! What the channels of an approximation stand for, and how E(F0) follows from them.

use crate::brdf::fresnel::schlick_weight;
use crate::choice::choice;
use crate::numeric::lanes::Number;

/// The channels. F is Schlick's at n·v, F0 + (1 - F0)(1 - n·v)⁵.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// The albedo at F0 itself, for one F0.
    Albedo,
    /// W of E(F0) = F W, for one F0: W changes less than the albedo.
    Ratio,
    /// E and R of E(F0) = F E + (1 - F0) R: E is the albedo at F0 = 1, and R what B has beyond
    /// (1 - n·v)⁵ E. Both are smooth in a coordinate that follows the lobe's layer at grazing
    /// angles.
    EnergyRest,
    /// A and B of E(F0) = F0 A + B (Karis 2013).
    ScaleBias,
    /// B and E of E(F0) = (1 - F0) B + F0 E: the order of Filament's table.
    BiasEnergy,
}

choice!(Channels, "channels", {
    Albedo = "albedo", "E(F0) of one F0";
    Ratio = "ratio", "W of E(F0) = F W, of one F0";
    EnergyRest = "energy-rest", "E and R of E(F0) = F E + (1 - F0) R";
    ScaleBias = "scale-bias", "A and B of E(F0) = F0 A + B";
    BiasEnergy = "bias-energy", "B and E of E(F0) = (1 - F0) B + F0 E";
});

impl Channels {
    /// The number of channels.
    pub fn count(self) -> usize {
        match self {
            Channels::Albedo | Channels::Ratio => 1,
            Channels::EnergyRest | Channels::ScaleBias | Channels::BiasEnergy => 2,
        }
    }

    /// The factor of each channel in E(F0).
    pub fn weights<R: Number>(self, nov: R, f0: R) -> [R; 2] {
        let complement = R::from(1.0) - f0;
        let fresnel = || f0 + complement * schlick_weight(nov);
        match self {
            Channels::Albedo => [R::from(1.0), R::from(0.0)],
            Channels::Ratio => [fresnel(), R::from(0.0)],
            Channels::EnergyRest => [fresnel(), complement],
            Channels::ScaleBias => [f0, R::from(1.0)],
            Channels::BiasEnergy => [complement, f0],
        }
    }
}
