//! The third axis of a table: each slice is a table over two axes for one value of a further
//! parameter, or for one of several models. Files store slices as layers.

use super::axis::{Axis, AxisSpec, Parameter};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::units::{F0, Ior, short};
use std::fmt;

/// The largest number of slices.
pub const LARGEST_COUNT: usize = 64;

/// The slices of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    of: Of,
    /// The axis whose nodes the values are; none where they were listed.
    axis: Option<Axis>,
}

/// What differs from slice to slice.
#[derive(Clone, Debug, PartialEq)]
enum Of {
    /// A parameter with these values.
    Parameter(Parameter, Vec<f64>),
    /// A model with these words.
    Models(&'static str, Vec<String>),
}

/// What a slice has that others have not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum SliceValue<'a> {
    /// The value of a parameter.
    Number(f64),
    /// The word of a model.
    Word(&'a str),
}

/// What slices are to a graphics API.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlicesAs {
    /// Layers of an array.
    #[default]
    Layers,
    /// A texture of three dimensions.
    Depth,
}

choice!(SlicesAs, "slices-as", {
    Layers = "layers", "layers of an array texture";
    Depth = "depth", "a texture of three dimensions, filtered between slices";
});

impl Slices {
    /// Slices at the nodes of an axis of F0 or of the index of refraction.
    pub fn along(axis: &Axis) -> Result<Self> {
        let parameter = axis.spec().parameter;
        if ![Parameter::F0, Parameter::Ior].contains(&parameter) {
            let got = parameter.to_string();
            let cure = "lay n.v and roughness along x and y";
            return Err(Error::bad_input("axis z", "f0 or ior", got, cure));
        }
        let values = axis.values();
        check(&parameter.to_string(), &values.iter().map(|&v| short(v)).collect::<Vec<_>>())?;
        Ok(Slices { of: Of::Parameter(parameter, values), axis: Some(*axis) })
    }

    /// Slices at these F0, at least two: a table for one has no slices.
    pub fn at_f0s(values: &[F0]) -> Result<Self> {
        Slices::at(Parameter::F0, values.iter().map(|f0| f0.get()).collect())
    }

    /// Slices at these indices of refraction, at least two.
    pub fn at_iors(values: &[Ior]) -> Result<Self> {
        Slices::at(Parameter::Ior, values.iter().map(|ior| ior.get()).collect())
    }

    fn at(parameter: Parameter, values: Vec<f64>) -> Result<Self> {
        check_several(&format!("values of {parameter}"), values.len())?;
        check(parameter.word(), &values.iter().map(|&v| short(v)).collect::<Vec<_>>())?;
        Ok(Slices { of: Of::Parameter(parameter, values), axis: None })
    }

    /// Slices of these models, at least two, by their words; `what`: the flag that names them.
    pub fn of_models(what: &'static str, words: Vec<String>) -> Result<Self> {
        check_several("models", words.len())?;
        check(what, &words)?;
        Ok(Slices { of: Of::Models(what, words), axis: None })
    }

    /// The word of what differs from slice to slice: a parameter, or the flag of models.
    pub fn word(&self) -> &'static str {
        match &self.of {
            Of::Parameter(parameter, _) => parameter.word(),
            Of::Models(what, _) => what,
        }
    }

    /// The parameter that differs from slice to slice with its values; none of models.
    pub fn parameter(&self) -> Option<(Parameter, &[f64])> {
        match &self.of {
            Of::Parameter(parameter, values) => Some((*parameter, values)),
            Of::Models(..) => None,
        }
    }

    /// What a slice has that others have not.
    pub fn value(&self, slice: usize) -> SliceValue<'_> {
        match &self.of {
            Of::Parameter(_, values) => SliceValue::Number(values[slice]),
            Of::Models(_, words) => SliceValue::Word(&words[slice]),
        }
    }

    /// The number of slices.
    pub fn count(&self) -> usize {
        match &self.of {
            Of::Parameter(_, values) => values.len(),
            Of::Models(_, words) => words.len(),
        }
    }

    /// The axis whose nodes the values are; none where they were listed.
    pub fn axis(&self) -> Option<&Axis> {
        self.axis.as_ref()
    }

    /// The words of that axis.
    pub fn spec(&self) -> Option<AxisSpec> {
        self.axis.map(|axis| axis.spec())
    }

    /// The name of a slice, such as `F0 = 0.04` or `dielectric:1.5`.
    pub fn label(&self, slice: usize) -> String {
        match self.value(slice) {
            SliceValue::Number(value) => {
                format!("{} = {}", self.word().to_uppercase(), short(value))
            }
            SliceValue::Word(word) => word.to_owned(),
        }
    }

    /// The values with commas between, as a flag has them.
    pub fn list(&self) -> String {
        (0..self.count()).map(|slice| self.value(slice).to_string()).collect::<Vec<_>>().join(",")
    }
}

impl fmt::Display for SliceValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SliceValue::Number(value) => f.write_str(&short(*value)),
            SliceValue::Word(word) => f.write_str(word),
        }
    }
}

/// Refuses fewer than two.
fn check_several(what: &str, count: usize) -> Result<()> {
    if count >= 2 {
        return Ok(());
    }
    let cure = "give more, or a table without slices";
    Err(Error::bad_input("slices", format!("at least 2 {what}"), count.to_string(), cure))
}

/// Refuses too many slices, and those that are the same.
fn check(what: &str, values: &[String]) -> Result<()> {
    if !(1..=LARGEST_COUNT).contains(&values.len()) {
        let expected = format!("1 to {LARGEST_COUNT} slices");
        let got = values.len().to_string();
        return Err(Error::bad_input("slices", expected, got, "give a number in that range"));
    }
    if (1..values.len()).any(|i| values[..i].contains(&values[i])) {
        let expected = "different values";
        let cure = "give each value once, or other nodes";
        return Err(Error::bad_input(what, expected, listed(values), cure));
    }
    Ok(())
}

/// Values with commas between, at most nine of them.
fn listed(values: &[String]) -> String {
    let shown = values.iter().take(9).cloned().collect::<Vec<_>>().join(",");
    if values.len() > 9 { format!("{shown},… ({} in all)", values.len()) } else { shown }
}
