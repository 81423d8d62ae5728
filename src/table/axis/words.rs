//! The words of an axis, as in `nov,sqrt,edges,flip`.

use super::{AxisSpec, Mapping, Nodes, Parameter, default_max};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::units::short;
use std::fmt;
use std::str::FromStr;

/// The words of an axis, for `--help` and errors.
pub const AXIS_WORDS: &str = "PARAMETER[,MAPPING][,NODES][,flip][,unclamped][,min=X][,max=X] with \
                              PARAMETER nov, critical, roughness, alpha, exponent or (along z) f0 \
                              or ior; MAPPING linear, sqrt (t = sqrt(p)), square (t = p^2), \
                              sqrt-complement (t = sqrt(1-p)) or of ior sqrt-f0 or piecewise; \
                              NODES centres, edges or offset=X with X in [-2, 2]; min=X with X in \
                              [0, 1]; max=X above 0, from min up; of ior min and max from 1 up";

impl FromStr for AxisSpec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = |got: &str| {
            Error::bad_input("axis", AXIS_WORDS, format!("'{got}' in '{text}'"), "use those words")
        };
        let mut words = text.split(',').map(str::trim);
        let parameter = words.next().unwrap_or_default();
        let mut spec = AxisSpec::of(Parameter::named(parameter).map_err(|_| wrong(parameter))?);
        // Their ranges are checked where an axis is made.
        let number = |text: &str| text.parse::<f64>().map_err(|_| wrong(text));
        let mut given = Vec::new();
        for word in words {
            let kind = match word.split_once('=') {
                Some((key, _)) if key != "offset" => key,
                None if word == "flip" || word == "unclamped" => word,
                Some(_) | None if Mapping::named(word).is_err() => "nodes",
                _ => "mapping",
            };
            if given.contains(&kind) {
                return Err(wrong(word));
            }
            given.push(kind);
            match word.split_once('=') {
                None => match word {
                    "centres" => spec.nodes = Nodes::Offset(0.5),
                    "edges" => spec.nodes = Nodes::Edges,
                    "flip" => spec.flip = true,
                    "unclamped" => spec.clamp = false,
                    _ => spec.mapping = Mapping::named(word).map_err(|_| wrong(word))?,
                },
                Some(("offset", x)) => spec.nodes = Nodes::Offset(number(x)?),
                Some(("min", x)) => spec.min = number(x)?,
                Some(("max", x)) => spec.max = number(x)?,
                Some(_) => return Err(wrong(word)),
            }
        }
        if !given.contains(&"max") {
            spec.max = default_max(spec.parameter, spec.mapping);
        }
        Ok(spec)
    }
}

impl fmt::Display for AxisSpec {
    /// The words that [`AxisSpec::from_str`] reads back to the same axis.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.parameter, self.mapping)?;
        match self.nodes {
            Nodes::Edges => write!(f, ",edges")?,
            Nodes::Offset(0.5) => write!(f, ",centres")?,
            Nodes::Offset(offset) => write!(f, ",offset={}", short(offset))?,
        }
        if self.flip {
            write!(f, ",flip")?;
        }
        if !self.clamp {
            write!(f, ",unclamped")?;
        }
        // What is no min or max is shown too, since an error quotes it.
        if self.min != AxisSpec::of(self.parameter).min {
            write!(f, ",min={}", short(self.min))?;
        }
        if self.max != default_max(self.parameter, self.mapping) {
            write!(f, ",max={}", short(self.max))?;
        }
        Ok(())
    }
}
