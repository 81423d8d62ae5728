//! What follows from the channels: A and B of E(F0) = F0 A + B, and E(F0) itself.

use super::function::Function;
use super::functions::Functions;
use crate::approximation::Channels;
use crate::choice::Choice;

/// What a function of the results is, its name, and its lines.
pub const SCALE_BIAS: (&str, &str) = ("(A, B) of E(F0) = F0 A + B.", "scale_bias");
pub const ALBEDO: (&str, &str) = ("E(F0).", "albedo");

/// Whether E(F0) has F, and with it (1 - n.v)^5.
pub fn has_fresnel(channels: Channels) -> bool {
    matches!(channels, Channels::EnergyRest | Channels::Ratio)
}

impl Functions<'_> {
    /// The functions of the channels and of what follows from them.
    pub fn results(&self, public: bool) -> Vec<String> {
        let about = format!("{}.", self.approximation.channels.about());
        match self.approximation.channels {
            Channels::Albedo => vec![self.channels(&about, ALBEDO.1, public)],
            Channels::Ratio => vec![self.channels(&about, "ratio", false), self.albedo(public)],
            Channels::ScaleBias => {
                vec![self.channels(SCALE_BIAS.0, SCALE_BIAS.1, public), self.albedo(public)]
            }
            Channels::EnergyRest | Channels::BiasEnergy => vec![
                self.channels(&about, "channels", false),
                self.scale_bias(public),
                self.albedo(public),
            ],
        }
    }

    /// The line that looks the channels up with the function `name`.
    fn look_up(&self, name: &str) -> String {
        let arguments: Vec<&str> =
            self.place_parameters().into_iter().map(|(name, _)| name).collect();
        let call = format!("{}({})", self.name(name), arguments.join(", "));
        let local = if self.packing.channels() == 1 { name } else { "channels" };
        self.dialect.local(&self.channels_kind(), local, &call)
    }

    /// (1 - n.v)^5
    fn grazing(&self) -> String {
        format!("{}_grazing(nov)", self.prefix)
    }

    fn scale_bias(&self, public: bool) -> String {
        let (dialect, kind) = (self.dialect, self.pair());
        let [x, y] = [0, 1].map(|index| dialect.of_pair("channels", index));
        let mut lines = vec![self.look_up("channels")];
        lines.extend(if self.approximation.channels == Channels::EnergyRest {
            let bias = format!("{y} + {} * {x}", self.grazing());
            let mut lines = vec![dialect.local(dialect.syntax.float, "bias", &bias)];
            lines.extend(dialect.return_pair(&kind, [&format!("{x} - bias"), "bias"]));
            lines
        } else {
            dialect.return_pair(&kind, [&format!("{y} - {x}"), &x])
        });
        let (name, parameters) = (self.name(SCALE_BIAS.1), self.place_parameters());
        let about = SCALE_BIAS.0;
        Function { about, public, kind: &kind, name: &name, parameters: &parameters, lines }
            .text(dialect)
    }

    fn albedo(&self, public: bool) -> String {
        let (dialect, float) = (self.dialect, self.dialect.syntax.float);
        let [x, y] = [0, 1].map(|index| dialect.of_pair("channels", index));
        let complement = format!("({} - f0)", dialect.number(1.0));
        let (name, albedo) = match self.approximation.channels {
            Channels::ScaleBias => (SCALE_BIAS.1, format!("f0 * {x} + {y}")),
            Channels::BiasEnergy => ("channels", format!("{complement} * {x} + f0 * {y}")),
            Channels::EnergyRest => ("channels", format!("fresnel * {x} + {complement} * {y}")),
            Channels::Ratio | Channels::Albedo => ("ratio", "fresnel * ratio".into()),
        };
        let mut lines = vec![self.look_up(name)];
        if has_fresnel(self.approximation.channels) {
            let fresnel = format!("f0 + {complement} * {}", self.grazing());
            lines.push(dialect.local(float, "fresnel", &fresnel));
        }
        lines.push(format!("return {albedo};"));
        let mut parameters = self.place_parameters();
        parameters.push(("f0", float));
        let ((about, _), name) = (ALBEDO, self.name(ALBEDO.1));
        Function { about, public, kind: float, name: &name, parameters: &parameters, lines }
            .text(dialect)
    }
}
