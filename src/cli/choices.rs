//! Flags with a word for each choice: the parser, the help and the completions know all of them.

use crate::brdf::fresnel::KINDS;
use crate::brdf::{Diffuse, Fresnel, Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::Result;
use crate::format::{FORMATS, Format};
use crate::integrate::rules::RULES;
use crate::lut::{DfgChannels, EnergyChannels, GlassChannels};
use crate::preset::presets;
use crate::table::precision::Precision;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::ffi::OsStr;

/// The parser of a choice.
pub fn of<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = C> {
    PossibleValuesParser::new(C::ALL.iter().map(value)).try_map(|word| C::named(&word))
}

/// The parser of a model's name: a distribution of normals or a diffuse lobe.
pub fn model() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(Ndf::ALL.iter().map(value).chain(Diffuse::ALL.iter().map(value)))
}

/// The parser of channels: a name, or a list of terms, which is checked where the lobe is known.
/// The names are those of each Fresnel model, and those of energy and glass.
pub fn channels() -> impl TypedValueParser<Value = String> {
    Text { names: names_of_channels }
}

/// The parser of Fresnel models, one or several; numbers follow the names.
pub fn fresnel() -> impl TypedValueParser<Value = String> {
    Text { names: names_of_models }
}

/// Takes any text, and knows names.
#[derive(Clone)]
struct Text {
    names: fn() -> Vec<PossibleValue>,
}

impl TypedValueParser for Text {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> std::result::Result<String, clap::Error> {
        clap::builder::StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.names)().into_iter()))
    }
}

fn names_of_models() -> Vec<PossibleValue> {
    KINDS.iter().map(|kind| PossibleValue::new(kind.usage).help(kind.about)).collect()
}

fn names_of_channels() -> Vec<PossibleValue> {
    let of_model =
        |fresnel: Fresnel| DfgChannels::served_by(fresnel).map(move |channels| (channels, fresnel));
    let pairs: Vec<(DfgChannels, Fresnel)> =
        Fresnel::samples().into_iter().flat_map(of_model).collect();
    let of_dfg = pairs.iter().map(|&(channels, fresnel)| {
        let word = channels.word(fresnel);
        let serves = pairs.iter().filter(|(channels, fresnel)| channels.word(*fresnel) == word);
        let mut models: Vec<&str> = serves.map(|(_, fresnel)| fresnel.definition().word).collect();
        models.dedup();
        let about = channels.about(fresnel);
        PossibleValue::new(word).help(format!("of dfg, {}: {about}", models.join(" or ")))
    });
    let of_energy = EnergyChannels::ALL.iter().map(|channels| {
        PossibleValue::new(channels.word()).help(format!("of energy: {}", channels.about()))
    });
    let of_glass = GlassChannels::ALL.iter().map(|channels| {
        PossibleValue::new(channels.word()).help(format!("of glass: {}", channels.about()))
    });
    distinct(of_dfg.chain(of_energy).chain(of_glass))
}

/// The parser of a rule's name.
pub fn rule() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(RULES.iter().map(|rule| PossibleValue::new(rule.name)))
}

/// The parser of a preset's name.
pub fn preset() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(
        presets().map(|preset| PossibleValue::new(preset.name).help(preset.about)),
    )
}

/// The parser of a file format.
pub fn format() -> impl TypedValueParser<Value = String> {
    let value = |format: &Format| PossibleValue::new(format.extension()).help(format.about());
    PossibleValuesParser::new(FORMATS.iter().map(value))
}

/// The parser of a storage: those that a format has.
pub fn precision() -> impl TypedValueParser<Value = Precision> {
    let known = FORMATS.iter().flat_map(|format| format.precisions()).map(value);
    PossibleValuesParser::new(distinct(known)).try_map(|word| Precision::named(&word))
}

/// Each word once, at its first place.
fn distinct(values: impl Iterator<Item = PossibleValue>) -> Vec<PossibleValue> {
    let mut distinct: Vec<PossibleValue> = Vec::new();
    for value in values {
        if distinct.iter().all(|known| known.get_name() != value.get_name()) {
            distinct.push(value);
        }
    }
    distinct
}

fn value<C: Choice>(choice: &C) -> PossibleValue {
    PossibleValue::new(choice.word()).help(choice.about())
}

/// The specular lobe of a command.
#[derive(clap::Args)]
pub struct LobeArgs {
    /// Distribution of normals of the specular lobe
    #[arg(long, value_name = "NAME", default_value = "ggx", value_parser = of::<Ndf>())]
    model: Ndf,
    /// Its masking [default: the first that 'bake --help' names for the model]
    #[arg(long, value_name = "NAME", value_parser = of::<Masking>())]
    masking: Option<Masking>,
}

impl LobeArgs {
    /// The lobe; an error where the masking has no meaning for the model.
    pub fn lobe(&self) -> Result<Microfacet> {
        Microfacet::new(self.model, self.masking)
    }
}
