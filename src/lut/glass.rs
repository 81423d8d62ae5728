//! What a rough interface of two dielectrics reflects and transmits, seen from either side: glass.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces",
//! 2007. E = R + T is what one scattering on the surface keeps.
//!
//! *Multiple scattering.* Renderers scale both by 1/E (Turquin 2019; Cycles), which is not
//! reciprocal, or add a lobe for the rest (Kulla and Conty 2017). With i for the side of v and o
//! for the other, of what is lost q is reflected:
//!
//! f_r = q (1-E_i(v))(1-E_i(l)) / (π (1-E_i,avg)),
//! f_t = (1-q) (1-E_i(v))(1-E_o(l)) / (π (1-E_o,avg)).
//!
//! Reciprocity is f_t/η_o² = f_t'/η_i², f_t' being that of the other side. With 1-q = x (1-F_avg),
//! and 1-F_avg standing as η_o² to η_i² on the two sides, it asks that x/(1-E_o,avg) be the same on
//! both; so x = (1-E_o,avg) / ((1-E_i,avg) + (1-E_o,avg)), and the x of both add up to 1.

use super::packing::{Content, Packing, Source};
use super::{Lut, MOST_CHANNELS, first, lobe_flags};
use crate::brdf::interface::{Interface, Side, TransmissionMasking};
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::table::Channel;

/// A rough interface, and the numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    interface: Interface,
    channels: GlassChannels,
    /// 1 - F_avg
    passed: Ball,
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
    /// R and T over all directions, which vary with roughness alone.
    Average,
    /// R + T and its average, from which the lobe of multiple scattering is made.
    KullaConty,
    /// The reflected share of that lobe, which varies with roughness alone.
    LostShare,
    /// (1-E)/E, E = R + T.
    Turquin,
}

choice!(GlassChannels, "channels", {
    Rt = "rt", "R and T, what is reflected and what is transmitted";
    Reflect = "reflect", "R alone";
    Transmit = "transmit", "T alone";
    Total = "total", "R + T, what one scattering keeps";
    Average = "average", "R, T over all directions";
    KullaConty = "kulla-conty", "R+T, (R+T)_avg";
    LostShare = "lost-share", "q, the reflected share of what one scattering loses";
    Turquin = "turquin", "(1-E)/E, E = R + T";
});

impl Glass {
    /// The table of an interface.
    pub fn new(interface: Interface, channels: GlassChannels) -> Self {
        let passed = Ball::exact(1.0) - interface.average_reflectance();
        Glass { interface, channels, passed }
    }

    /// The interface.
    pub fn interface(&self) -> Interface {
        self.interface
    }

    /// The numbers.
    pub fn channels(&self) -> GlassChannels {
        self.channels
    }

    /// The interfaces whose R and T are averaged: its own side's, and for q the other's too.
    pub(super) fn averaged(&self) -> Vec<Interface> {
        let own = self.interface;
        match self.channels {
            GlassChannels::Average | GlassChannels::KullaConty => vec![own],
            GlassChannels::LostShare => vec![own, own.from(own.side().other())],
            GlassChannels::Rt
            | GlassChannels::Reflect
            | GlassChannels::Transmit
            | GlassChannels::Total
            | GlassChannels::Turquin => Vec::new(),
        }
    }

    /// The same with another relative index of refraction η: below 1 it is that of the medium seen
    /// from inside, 1/n.
    pub(super) fn at_index(&self, eta: f64) -> Result<Self> {
        let interface = if eta >= 1.0 {
            self.interface.at_ior(eta)?
        } else if self.interface.side() == Side::Outside {
            self.interface.at_ior(1.0 / eta)?.from(Side::Inside)
        } else {
            let (expected, got) = ("outside, where indices below 1 are seen from inside", "inside");
            return Err(Error::bad_input("side", expected, got, "leave it out"));
        };
        Ok(Glass::new(interface, self.channels))
    }

    /// Both sides of an interface in a texel: the channels from outside, then those from inside.
    pub fn both_sides(outside: Interface, channels: GlassChannels) -> Result<Packing> {
        let [outside, inside] =
            [Side::Outside, Side::Inside].map(|side| Glass::new(outside.from(side), channels));
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
        let kept = || Channel::new("R+T", "reflected and transmitted share of a white furnace");
        match self.channels {
            GlassChannels::Rt => vec![reflected, transmitted],
            GlassChannels::Reflect => vec![reflected],
            GlassChannels::Transmit => vec![transmitted],
            GlassChannels::Total => vec![kept()],
            GlassChannels::Average => vec![
                Channel::new("R_avg", "average of R: 2 * integral of R mu dmu"),
                Channel::new("T_avg", "average of T"),
            ],
            GlassChannels::KullaConty => {
                vec![kept(), Channel::new("(R+T)_avg", "average of R + T")]
            }
            GlassChannels::LostShare => vec![Channel::new(
                "q",
                "reflected share of f_ms: q (1-E(l))(1-E(v)) / (pi (1-E_avg)) is reflected, with \
                 E = R+T, and (1-q) (1-E'(l))(1-E(v)) / (pi (1-E'_avg)) transmitted, E' being the \
                 other side's",
            )],
            GlassChannels::Turquin => {
                vec![Channel::new("(1-E)/E", "both lobes times 1 + (1-E)/E keep their energy")]
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
    pub(super) fn values(&self, integrals: &[Ball], averages: &[Ball]) -> [Ball; MOST_CHANNELS] {
        let kept = |of: &[Ball]| of[0] + of[1];
        let one = Ball::exact(1.0);
        match self.channels {
            GlassChannels::Rt => first(integrals),
            GlassChannels::Reflect => first(&[integrals[0]]),
            GlassChannels::Transmit => first(&[integrals[1]]),
            GlassChannels::Total => first(&[kept(integrals)]),
            GlassChannels::Average => first(averages),
            GlassChannels::KullaConty => first(&[kept(integrals), kept(averages)]),
            GlassChannels::LostShare => {
                let (own, other) = averages.split_at(2);
                let (own, other) = (one - kept(own), one - kept(other));
                first(&[one - other / (own + other) * self.passed])
            }
            GlassChannels::Turquin => first(&[(one - kept(integrals)) / kept(integrals)]),
        }
    }
}
