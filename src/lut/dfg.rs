//! The preintegrated specular lobe of the split sum, E(F0) = F0 A + B, often called DFG or "the BRDF LUT".
//!
//! Karis, "Real Shading in Unreal Engine 4", 2013; the multiple-scattering packing (B, E) is that of Lagarde and
//! Golubev, "The road toward unified rendering with Unity's high definition rendering pipeline", 2018, and of Filament.

use crate::ball::Ball;
use crate::integrate::ScaleBias;
use crate::model::Microfacet;
use crate::table::Channel;

/// Which lobe, and which numbers of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dfg {
    /// The lobe.
    pub lobe: Microfacet,
    /// The numbers.
    pub channels: DfgChannels,
}

/// Which numbers a texel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DfgChannels {
    /// (A, B): E(F0) = F0 A + B.
    Ab,
    /// (B, E): E(F0) = F0 (E - B) + B, and E for energy compensation.
    Be,
    /// E alone: the directional albedo at F = 1.
    E,
}

const A: Channel = Channel { name: "A", meaning: "scale: E(F0) = F0*A + B" };
const B: Channel = Channel { name: "B", meaning: "bias: E(F0) = F0*A + B" };
const E: Channel = Channel { name: "E", meaning: "directional albedo at F = 1: E = A + B" };

impl DfgChannels {
    /// The channels in order.
    pub fn list(self) -> &'static [Channel] {
        match self {
            DfgChannels::Ab => &[A, B],
            DfgChannels::Be => &[B, E],
            DfgChannels::E => &[E],
        }
    }

    /// Their values, and zeros for the channels that there are not.
    pub fn values(self, integral: ScaleBias<Ball>) -> [Ball; 3] {
        match self {
            DfgChannels::Ab => [integral.a, integral.b, Ball::default()],
            DfgChannels::Be => [integral.b, integral.e(), Ball::default()],
            DfgChannels::E => [integral.e(), Ball::default(), Ball::default()],
        }
    }
}
