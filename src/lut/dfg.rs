//! The preintegrated specular lobe of the split sum, often called DFG or "the BRDF LUT": the
//! integrals of the weights of its Fresnel model, E(F0) = F0 A + B for Schlick's.
//!
//! Karis, "Real Shading in Unreal Engine 4", 2013; the multiple-scattering packing (B, E) is that
//! of Lagarde and Golubev, "The road toward unified rendering with Unity's high definition
//! rendering pipeline", 2018, and of Filament.

use super::{MOST_CHANNELS, first};
use crate::brdf::fresnel::Integral;
use crate::brdf::{Fresnel, Microfacet};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::table::Channel;

/// A lobe, its Fresnel model, and the numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dfg {
    lobe: Microfacet,
    fresnel: Fresnel,
    channels: DfgChannels,
}

/// The numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DfgChannels {
    /// The integrals of all weights: (A, B) for Schlick's.
    All,
    /// (B, E): E(F0) = F0 (E - B) + B, and E for energy compensation.
    Be,
    /// E alone: the directional albedo at F = 1.
    E,
    /// The integrals of all weights, and E: what lists of terms are picked from.
    Every,
}

/// The channel that holds an integral.
fn channel_of(&Integral { name, meaning, .. }: &Integral) -> Channel {
    Channel::new(name, meaning)
}

const E: (&str, &str) = ("E", "directional albedo at F = 1: E = A + B");

impl Dfg {
    /// Refuses a masking term that has no meaning for the distribution, and channels that the
    /// Fresnel model has not.
    pub fn new(lobe: Microfacet, fresnel: Fresnel, channels: DfgChannels) -> Result<Self> {
        if channels == DfgChannels::Every {
            check_interface(lobe, fresnel)?;
            // E is the sum of the first two, and a texel has room for no more.
            if (2..MOST_CHANNELS).contains(&fresnel.count()) {
                return Ok(Dfg { lobe, fresnel, channels });
            }
            let (expected, cure) = ("a Fresnel model of 2 or 3 weights", "leave out the terms");
            return Err(Error::bad_input("channels", expected, fresnel.to_string(), cure));
        }
        Dfg::with_channels(lobe, fresnel, channels.word(fresnel))
    }

    /// The channels with this word: the letters of the integrals, as in `ab`, or `be` or `e`.
    pub fn with_channels(lobe: Microfacet, fresnel: Fresnel, word: &str) -> Result<Self> {
        check_interface(lobe, fresnel)?;
        let served = || DfgChannels::served_by(fresnel);
        if let Some(channels) = served().find(|channels| channels.word(fresnel) == word) {
            return Ok(Dfg { lobe, fresnel, channels });
        }
        let known: Vec<&str> = served().map(|channels| channels.word(fresnel)).collect();
        let (what, got) = (format!("channels of {fresnel}"), format!("'{word}'"));
        let cure = "name one of these, or another Fresnel model";
        Err(Error::bad_input(what, known.join(", "), got, cure))
    }

    /// The lobe.
    pub fn lobe(&self) -> Microfacet {
        self.lobe
    }

    /// Its Fresnel model.
    pub fn fresnel(&self) -> Fresnel {
        self.fresnel
    }

    /// The word of the channels.
    pub fn word(&self) -> &'static str {
        self.channels.word(self.fresnel)
    }

    /// The same channels with another Fresnel model; an error where it has not the same.
    pub(super) fn with_fresnel(&self, fresnel: Fresnel) -> Result<Self> {
        let with = Dfg::new(self.lobe, fresnel, self.channels)?;
        if with.word() == self.word() {
            return Ok(with);
        }
        let expected = format!("models with the channels of {}", self.fresnel);
        let cure = "bake tables of their own";
        Err(Error::bad_input("fresnel", expected, fresnel.to_string(), cure))
    }

    /// The channels in order.
    pub(super) fn list(&self) -> Vec<Channel> {
        let integrals = self.fresnel.definition().integrals.iter();
        let mut integrals: Vec<Channel> = integrals.map(channel_of).collect();
        let e = Channel::new(E.0, E.1);
        match self.channels {
            DfgChannels::All => integrals,
            DfgChannels::Be => vec![integrals.swap_remove(1), e],
            DfgChannels::E => vec![e],
            DfgChannels::Every => {
                integrals.push(e);
                integrals
            }
        }
    }

    /// Whether they are the integrals themselves.
    pub(super) fn is_integrals(&self) -> bool {
        self.channels == DfgChannels::All
    }

    /// Their values, and zeros for the channels that there are not.
    #[inline(always)]
    pub(super) fn values(&self, integrals: &[Ball]) -> [Ball; MOST_CHANNELS] {
        match self.channels {
            DfgChannels::All => first(integrals),
            DfgChannels::Be => first(&[integrals[1], integrals[0] + integrals[1]]),
            DfgChannels::E => first(&[integrals[0] + integrals[1]]),
            DfgChannels::Every => {
                let mut values = first(integrals);
                values[integrals.len()] = integrals[0] + integrals[1];
                values
            }
        }
    }
}

/// Refuses a masking term that has no meaning for the distribution, and the exact equations of an
/// interface for sheen, which has none.
fn check_interface(lobe: Microfacet, fresnel: Fresnel) -> Result<()> {
    lobe.check()?;
    if lobe.takes(fresnel) {
        return Ok(());
    }
    let got = format!("{fresnel} with {}", lobe.ndf);
    let cure = "choose another model, or schlick";
    Err(Error::bad_input("fresnel", "one of Schlick's for sheen", got, cure))
}

impl DfgChannels {
    /// The channels that suffice for a Fresnel model, or leave out what it does not change: a
    /// packing of two numbers has no place for a third integral.
    pub(crate) fn served_by(fresnel: Fresnel) -> impl Iterator<Item = DfgChannels> {
        let serves = move |channels: &DfgChannels| match channels {
            DfgChannels::All => true,
            DfgChannels::Be => fresnel.count() == 2,
            DfgChannels::E => fresnel.count() >= 2,
            DfgChannels::Every => false,
        };
        [DfgChannels::All, DfgChannels::Be, DfgChannels::E].into_iter().filter(serves)
    }

    /// Their word.
    pub(crate) fn word(self, fresnel: Fresnel) -> &'static str {
        match self {
            DfgChannels::All => fresnel.definition().channels,
            DfgChannels::Be => "be",
            DfgChannels::E => "e",
            DfgChannels::Every => "every",
        }
    }

    /// They in a line, for `--help`.
    #[cfg(feature = "cli")]
    pub(crate) fn about(self, fresnel: Fresnel) -> &'static str {
        match self {
            DfgChannels::All => fresnel.definition().albedo,
            DfgChannels::Be => "B and E = A + B, the multiple-scattering packing",
            DfgChannels::E => "E = A + B alone",
            DfgChannels::Every => "all integrals and E",
        }
    }
}
