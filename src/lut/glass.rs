//! What a rough interface of two dielectrics reflects and transmits, seen from either side: glass.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces",
//! 2007. R + T is what one scattering on the surface keeps; renderers scale both by its inverse
//! (Turquin 2019; Cycles), or add a lobe for the rest (Kulla and Conty 2017).

use super::packing::{Content, Packing, Source};
use super::{Lut, MOST_CHANNELS, first, lobe_flags};
use crate::brdf::interface::{Interface, Side, TransmissionMasking};
use crate::choice::choice;
use crate::error::Result;
use crate::numeric::ball::Ball;
use crate::table::Channel;

/// A rough interface, and the numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    interface: Interface,
    channels: GlassChannels,
}

/// The numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlassChannels {
    /// R and T.
    Rt,
    /// R alone.
    Reflect,
    /// T alone.
    Transmit,
    /// R + T.
    Total,
}

choice!(GlassChannels, "channels", {
    Rt = "rt", "R and T, what is reflected and what is transmitted";
    Reflect = "reflect", "R alone";
    Transmit = "transmit", "T alone";
    Total = "total", "R + T, what one scattering keeps";
});

impl Glass {
    /// The table of an interface.
    pub fn new(interface: Interface, channels: GlassChannels) -> Self {
        Glass { interface, channels }
    }

    /// The interface.
    pub fn interface(&self) -> Interface {
        self.interface
    }

    /// The numbers.
    pub fn channels(&self) -> GlassChannels {
        self.channels
    }

    /// The same with another index of refraction.
    pub(super) fn at_ior(&self, ior: f64) -> Result<Self> {
        Ok(Glass { interface: self.interface.at_ior(ior)?, ..*self })
    }

    /// Both sides of an interface in a texel: the channels from outside, then those from inside.
    pub fn both_sides(outside: Interface, channels: GlassChannels) -> Result<Packing> {
        let [outside, inside] = [Side::Outside, Side::Inside]
            .map(|side| Glass { interface: outside.from(side), channels });
        let luts = vec![Lut::Glass(outside), Lut::Glass(inside)];
        let count = outside.list().len();
        let place = |i: usize| Content::of(Source::Of { part: i / count, channel: i % count });
        let contents = (0..2 * count).map(place).collect();
        Packing::new(luts, contents, format!("--lut glass {}", outside.flags("both")))
    }

    /// The channels in order.
    pub(super) fn list(&self) -> Vec<Channel> {
        let reflected = Channel::new("R", "reflected share of the light of a white furnace");
        let transmitted = Channel::new("T", "transmitted share of it");
        match self.channels {
            GlassChannels::Rt => vec![reflected, transmitted],
            GlassChannels::Reflect => vec![reflected],
            GlassChannels::Transmit => vec![transmitted],
            GlassChannels::Total => {
                vec![Channel::new("R+T", "reflected and transmitted share of a white furnace")]
            }
        }
    }

    /// The choices but for the index of refraction as flags.
    pub(super) fn flags(&self, side: &str) -> String {
        let mut flags = format!(
            "{} --channels {} --side {side}",
            lobe_flags(self.interface.lobe()),
            self.channels
        );
        let transmission = self.interface.transmission();
        if transmission != TransmissionMasking::default() {
            flags += &format!(" --transmission-masking {transmission}");
        }
        flags
    }

    /// Their values, and zeros for the channels that there are not.
    #[inline(always)]
    pub(super) fn values(&self, integrals: &[Ball]) -> [Ball; MOST_CHANNELS] {
        match self.channels {
            GlassChannels::Rt => first(integrals),
            GlassChannels::Reflect => first(&[integrals[0]]),
            GlassChannels::Transmit => first(&[integrals[1]]),
            GlassChannels::Total => first(&[integrals[0] + integrals[1]]),
        }
    }
}
