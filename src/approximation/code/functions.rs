//! The functions of one approximation: the names, types and calls that they share.

use super::dialect::Dialect;
use super::function::Function;
use super::packing::Packing;
use crate::approximation::{Approximation, Channels, Shape};
use crate::choice::Choice;
use crate::lookup::Language;

/// Writes the functions of an approximation in a language.
pub struct Functions<'a> {
    pub dialect: &'static Dialect,
    pub approximation: &'a Approximation,
    pub packing: Packing<'a>,
    pub prefix: &'a str,
    /// What ends its names where there are several.
    pub suffix: String,
}

impl Functions<'_> {
    /// A name of this approximation.
    pub fn name(&self, name: &str) -> String {
        format!("{}_{name}{}", self.prefix, self.suffix)
    }

    /// A type of two floats.
    pub fn pair(&self) -> String {
        match self.dialect.language {
            Language::C => format!("{}_float2", self.prefix),
            Language::Rust => "[f32; 2]".into(),
            _ => self.dialect.syntax.float2.into(),
        }
    }

    /// The type of all channels.
    pub fn channels_kind(&self) -> String {
        match self.packing.channels() {
            1 => self.dialect.syntax.float.into(),
            _ => self.pair(),
        }
    }

    /// The channels that a function computes at a time: all, or each of several by itself.
    pub fn passes(&self) -> Vec<Option<usize>> {
        match (self.dialect.is_host(), self.packing.channels()) {
            (true, 2) => vec![Some(0), Some(1)],
            _ => vec![None],
        }
    }

    /// The type of a number in a pass.
    pub fn kind(&self) -> String {
        if self.dialect.is_host() { self.dialect.syntax.float.into() } else { self.channels_kind() }
    }

    /// The channel of a pass as the last argument or parameter.
    pub fn in_pass<T>(&self, channel: T) -> Option<T> {
        (self.passes().len() > 1).then_some(channel)
    }

    /// Names of channels, as in the word for them.
    pub fn channel_names(&self) -> Vec<&'static str> {
        self.approximation.channels.word().split('-').collect()
    }

    /// A call of a function of the numbers.
    pub fn call(&self, name: &str, arguments: &[&str], pass: Option<usize>) -> String {
        let mut arguments: Vec<String> = arguments.iter().map(|&word| word.to_owned()).collect();
        arguments.extend(pass.map(|channel| self.dialect.whole_number(channel)));
        format!("{}({})", self.name(name), arguments.join(", "))
    }

    /// The same in the function `row`, whose channel is a parameter.
    pub fn call_number(&self, index: &str) -> String {
        let arguments: Vec<&str> = [index].into_iter().chain(self.in_pass("c")).collect();
        self.call("number", &arguments, None)
    }

    /// A function that takes `parameters` and the channel.
    pub fn internal(
        &self,
        about: &str,
        name: &str,
        first: &[(&str, &str)],
        lines: Vec<String>,
    ) -> String {
        let channel = self.in_pass(("c", self.dialect.index));
        let parameters: Vec<(&str, &str)> = first.iter().copied().chain(channel).collect();
        let (kind, name) = (self.kind(), self.name(name));
        let function = Function {
            about,
            public: false,
            kind: &kind,
            name: &name,
            parameters: &parameters,
            lines,
        };
        function.text(self.dialect)
    }

    /// The index `k` plus a number.
    pub fn plus(&self, k: &str, more: usize) -> String {
        match (k, more) {
            ("", more) => self.dialect.whole_number(more),
            (k, 0) => k.to_owned(),
            (k, more) => format!("{k} + {}", self.dialect.whole_number(more)),
        }
    }

    pub fn is_spline(&self) -> bool {
        matches!(self.approximation.shape, Shape::Spline { .. })
    }

    /// Whether lookups take the roughness.
    pub fn takes_roughness(&self) -> bool {
        !matches!(self.approximation.shape, Shape::Polynomial { .. })
    }

    /// n·v and, where it is none, roughness.
    pub fn place_parameters(&self) -> Vec<(&'static str, &'static str)> {
        let float = self.dialect.syntax.float;
        let roughness = self.takes_roughness().then_some(("roughness", float));
        [("nov", float)].into_iter().chain(roughness).collect()
    }

    /// Whether lookups of the albedo take F0.
    pub fn takes_f0(&self) -> bool {
        self.approximation.channels != Channels::Albedo
    }
}
