//! The third axis of a table: each slice is a table over two axes for one value of a further
//! parameter. Files store slices as layers.

use super::axis::{Axis, AxisSpec, Parameter};
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::units::{F0, short};

/// The largest number of slices.
pub const LARGEST_COUNT: usize = 64;

/// The slices of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    parameter: Parameter,
    values: Vec<f64>,
    /// The axis whose nodes the values are; none where they were listed.
    axis: Option<Axis>,
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
    /// Slices at the nodes of an axis of F0.
    pub fn along(axis: &Axis) -> Result<Self> {
        let spec = axis.spec();
        if spec.parameter != Parameter::F0 {
            let got = spec.parameter.to_string();
            return Err(Error::bad_input(
                "axis z",
                "f0",
                got,
                "lay n.v and roughness along x and y",
            ));
        }
        Slices::new(spec.parameter, axis.values(), Some(*axis))
    }

    /// Slices at these F0, at least two: a table for one has no slices.
    pub fn at_f0s(values: &[F0]) -> Result<Self> {
        if values.len() < 2 {
            let (expected, got) = ("at least 2 values of F0", values.len().to_string());
            let cure = "give more, or a table without slices";
            return Err(Error::bad_input("slices", expected, got, cure));
        }
        Slices::new(Parameter::F0, values.iter().map(|f0| f0.get()).collect(), None)
    }

    fn new(parameter: Parameter, values: Vec<f64>, axis: Option<Axis>) -> Result<Self> {
        if !(1..=LARGEST_COUNT).contains(&values.len()) {
            let expected = format!("1 to {LARGEST_COUNT} slices");
            let got = values.len().to_string();
            return Err(Error::bad_input("slices", expected, got, "give a number in that range"));
        }
        if (1..values.len()).any(|i| values[..i].contains(&values[i])) {
            let expected = "different values";
            let cure = "give each value once, or other nodes";
            return Err(Error::bad_input(parameter.to_string(), expected, listed(&values), cure));
        }
        Ok(Slices { parameter, values, axis })
    }

    /// The parameter that differs from slice to slice.
    pub fn parameter(&self) -> Parameter {
        self.parameter
    }

    /// Its value in each slice.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The number of slices.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// The axis whose nodes the values are; none where they were listed.
    pub fn axis(&self) -> Option<&Axis> {
        self.axis.as_ref()
    }

    /// The words of that axis.
    pub fn spec(&self) -> Option<AxisSpec> {
        self.axis.map(|axis| axis.spec())
    }

    /// The name of a slice, such as `F0 = 0.04`.
    pub fn label(&self, slice: usize) -> String {
        format!("{} = {}", self.parameter.to_string().to_uppercase(), short(self.values[slice]))
    }
}

/// Numbers with commas between, at most nine of them.
fn listed(values: &[f64]) -> String {
    let shown = values.iter().take(9).map(|&value| short(value)).collect::<Vec<_>>().join(",");
    if values.len() > 9 { format!("{shown},… ({} in all)", values.len()) } else { shown }
}
