//! The families of tables: each with its integrand, its channels and its citation.

pub mod dfg;
pub mod energy;
pub mod glass;
pub mod packing;
pub mod sheet;
pub mod terms;

pub use dfg::{Dfg, DfgChannels};
pub use energy::{Energy, EnergyChannels};
pub use glass::{Glass, GlassChannels};
pub use packing::{Content, Packing, Part, Source};

use crate::brdf::{Diffuse, Fresnel, Microfacet};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::average::DIRECTIONS;
use crate::numeric::ball::Ball;
use crate::table::axis::Parameter;
use crate::table::{Channel, InterfaceText, Provenance};
use crate::units::F0;

/// The most channels of a texel.
pub const MOST_CHANNELS: usize = 4;

/// A family of tables with its choices made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lut {
    /// The integrals of a specular lobe: the split sum's scale and bias.
    Dfg(Dfg),
    /// The energy that a specular lobe leaves and loses.
    Energy(Energy),
    /// What a rough interface reflects and transmits.
    Glass(Glass),
    /// The albedo of a white diffuse lobe.
    Diffuse(Diffuse),
}

/// The channel of a diffuse lobe's table.
const ALBEDO: (&str, &str) = ("E", "directional albedo of a white surface: integral of f(l,v) n.l");

impl Lut {
    /// The name of the family.
    pub fn name(&self) -> &'static str {
        match self {
            Lut::Dfg(_) => "dfg",
            Lut::Energy(_) => "energy",
            Lut::Glass(_) => "glass",
            Lut::Diffuse(_) => "diffuse",
        }
    }

    /// The lobe that is integrated.
    pub fn integrand(&self) -> Integrand {
        match self {
            Lut::Dfg(dfg) => Integrand::Specular(dfg.lobe(), dfg.fresnel()),
            Lut::Energy(energy) => Integrand::Specular(energy.lobe(), energy.fresnel()),
            Lut::Glass(glass) => Integrand::Glass(glass.interface()),
            Lut::Diffuse(diffuse) => Integrand::Diffuse(*diffuse),
        }
    }

    /// The Fresnel model that can be chosen.
    pub fn fresnel(&self) -> Option<Fresnel> {
        match self {
            Lut::Dfg(dfg) => Some(dfg.fresnel()),
            Lut::Energy(_) | Lut::Glass(_) | Lut::Diffuse(_) => None,
        }
    }

    /// The index of refraction of a table for one: glass, and the split of energy at an interface.
    pub fn ior(&self) -> Option<f64> {
        match self {
            Lut::Glass(glass) => Some(glass.interface().ior()),
            Lut::Energy(energy) => energy.ior(),
            Lut::Dfg(_) | Lut::Diffuse(_) => None,
        }
    }

    /// The same table with another Fresnel model; an error where none can be chosen, or where the
    /// model has not its channels.
    pub fn with_fresnel(&self, fresnel: Fresnel) -> Result<Lut> {
        match self {
            Lut::Dfg(dfg) => dfg.with_fresnel(fresnel).map(Lut::Dfg),
            Lut::Energy(_) | Lut::Glass(_) | Lut::Diffuse(_) => {
                let cure = "bake dfg, or leave it out";
                Err(Error::bad_input("fresnel", "schlick", fresnel.to_string(), cure))
            }
        }
    }

    /// The F0 of a table for one: a split of energy. The others serve every F0.
    pub fn f0(&self) -> Option<f64> {
        match self {
            Lut::Energy(energy) => energy.f0(),
            Lut::Dfg(_) | Lut::Glass(_) | Lut::Diffuse(_) => None,
        }
    }

    /// The table of a slice in which `parameter` has this value; an error where no channel varies
    /// with it.
    pub fn at(&self, parameter: Parameter, value: f64) -> Result<Lut> {
        match (self, parameter) {
            (Lut::Energy(energy), Parameter::F0) if self.f0().is_some() => {
                Energy::new(energy.lobe(), F0::new(value)?, energy.channels()).map(Lut::Energy)
            }
            (Lut::Energy(energy), Parameter::Ior) if energy.channels() == EnergyChannels::Split => {
                Energy::of_interface(energy.lobe(), value).map(Lut::Energy)
            }
            (Lut::Glass(glass), Parameter::Ior) => glass.at_index(value).map(Lut::Glass),
            (Lut::Dfg(_) | Lut::Energy(_) | Lut::Glass(_) | Lut::Diffuse(_), _) => {
                let expected = "a parameter that the table varies with";
                let cure =
                    "bake the split of energy for f0 or ior, or glass for ior, or leave it out";
                Err(Error::bad_input("slices", expected, parameter.word(), cure))
            }
        }
    }

    /// The directions, about, at which a row's averages take integrals.
    pub fn averaged_directions(&self) -> usize {
        self.averaged().len() * DIRECTIONS
    }

    /// Whether a texel needs averages over all directions too.
    pub fn needs_averages(&self) -> bool {
        !self.averaged().is_empty()
    }

    /// Whether a texel's numbers depend on n·v: averages over all directions do not.
    pub fn depends_on_nov(&self) -> bool {
        match self {
            Lut::Energy(energy) => energy.channels() != EnergyChannels::Average,
            Lut::Glass(glass) => {
                !matches!(glass.channels(), GlassChannels::Average | GlassChannels::LostShare)
            }
            Lut::Dfg(_) | Lut::Diffuse(_) => true,
        }
    }

    /// Whose integrals a texel needs averaged over all directions, in the order of the averages.
    pub fn averaged(&self) -> Vec<Integrand> {
        match self {
            Lut::Energy(energy) if energy.channels() == EnergyChannels::Turquin => Vec::new(),
            Lut::Energy(_) => vec![self.integrand()],
            Lut::Glass(glass) => glass.averaged().into_iter().map(Integrand::Glass).collect(),
            Lut::Dfg(_) | Lut::Diffuse(_) => Vec::new(),
        }
    }

    /// Whether it is known that no channel exceeds 1.
    pub fn at_most_one(&self) -> bool {
        match self {
            Lut::Dfg(_) => !self.integrand().may_exceed_one(),
            Lut::Glass(glass) => glass.channels() != GlassChannels::Turquin,
            // (1-E)/E and R exceed 1, and so do some diffuse lobes.
            Lut::Energy(_) | Lut::Diffuse(_) => false,
        }
    }

    /// The channels of a texel.
    pub fn channels(&self) -> Vec<Channel> {
        match self {
            Lut::Dfg(dfg) => dfg.list(),
            Lut::Energy(energy) => {
                let named =
                    |&(name, meaning): &(&'static str, &'static str)| Channel::new(name, meaning);
                energy.list().iter().map(named).collect()
            }
            Lut::Glass(glass) => glass.list(),
            Lut::Diffuse(_) => vec![Channel::new(ALBEDO.0, ALBEDO.1)],
        }
    }

    /// The choices of the family as flags.
    pub fn flags(&self) -> String {
        match self {
            Lut::Dfg(dfg) => format!("{} --channels {}", lobe_flags(dfg.lobe()), dfg.word()),
            Lut::Energy(energy) => {
                format!("{} --channels {}", lobe_flags(energy.lobe()), energy.channels())
            }
            Lut::Glass(glass) => glass.flags(glass.interface().side().word()),
            Lut::Diffuse(diffuse) => format!("--model {diffuse}"),
        }
    }

    /// The origin of its numbers for the metadata.
    pub fn provenance(&self) -> Provenance {
        match (self, self.integrand()) {
            (_, Integrand::Specular(Microfacet { ndf, masking }, fresnel)) => Provenance {
                table: self.name(),
                equation: format!(
                    "{} = integral of f(l,v) n.l over directions l, f = F D G / (4 n.l n.v)",
                    fresnel.definition().albedo
                ),
                model: ndf.word(),
                masking: Some(masking.word()),
                interface: None,
                fresnel: Some(fresnel.formula()),
                f0: self.f0(),
                roughness: ndf.definition().roughness,
            },
            (_, Integrand::Glass(interface)) => Provenance {
                table: self.name(),
                equation:
                    "R = integral of f_r(l,v) |n.l|, T = integral of f_t(l,v) |n.l| over all \
                           directions l, f_t without the factor of radiance (Walter et al. 2007)"
                        .into(),
                model: interface.lobe().ndf.word(),
                masking: Some(interface.lobe().masking.word()),
                interface: Some(InterfaceText {
                    ior: interface.ior(),
                    side: interface.side().word(),
                    transmission_masking: interface.transmission().word(),
                    average_fresnel: interface.average_reflectance().value,
                }),
                fresnel: Some("Fresnel's equations for unpolarised light".into()),
                f0: None,
                roughness: interface.lobe().ndf.definition().roughness,
            },
            (_, Integrand::Diffuse(model)) => Provenance {
                table: self.name(),
                equation: model.source().into(),
                model: model.word(),
                masking: None,
                interface: None,
                fresnel: None,
                f0: None,
                roughness: model.roughness(),
            },
        }
    }

    /// The values of the channels of a texel at n·v = `mu`, from its integrals and the averages of
    /// its row: each with the bound of its error that follows from theirs and from the formula's
    /// own arithmetic. The first `channels().len()` entries are used.
    #[inline(always)]
    pub fn values(&self, mu: f64, integrals: &[Ball], averages: &[Ball]) -> [Ball; MOST_CHANNELS] {
        match self {
            Lut::Dfg(dfg) => dfg.values(integrals),
            Lut::Energy(energy) => energy.values(mu, integrals, averages),
            Lut::Glass(glass) => glass.values(integrals, averages),
            Lut::Diffuse(_) => first(integrals),
        }
    }
}

/// A lobe as flags.
fn lobe_flags(Microfacet { ndf, masking }: Microfacet) -> String {
    format!("--model {ndf} --masking {masking}")
}

/// The first balls of a list, and zeros.
#[inline(always)]
fn first(balls: &[Ball]) -> [Ball; MOST_CHANNELS] {
    let mut values = [Ball::default(); MOST_CHANNELS];
    values.iter_mut().zip(balls).for_each(|(value, ball)| *value = *ball);
    values
}
