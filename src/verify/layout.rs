//! Hypotheses of axes: which of them is n·v, its mapping, its nodes, its direction.

use crate::table::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
use crate::units::alpha_of;

/// Where nodes are sought: texel centres, both ends, i/N, a texel and a half late, a texel late,
/// half a texel early.
pub const NODES: [Nodes; 6] = [
    Nodes::Offset(0.5),
    Nodes::Edges,
    Nodes::Offset(0.0),
    Nodes::Offset(1.0),
    Nodes::Offset(1.5),
    Nodes::Offset(-0.5),
];

/// The first of them that nearly all tables have.
pub const COMMON_NODES: usize = 2;

const COSINES: [(Parameter, Mapping); 3] = [
    (Parameter::Nov, Mapping::Linear),
    (Parameter::Nov, Mapping::Sqrt),
    (Parameter::Nov, Mapping::SqrtComplement),
];

const ROUGHNESSES: [(Parameter, Mapping); 4] = [
    (Parameter::Roughness, Mapping::Linear),
    (Parameter::Alpha, Mapping::Linear),
    (Parameter::Roughness, Mapping::Sqrt),
    (Parameter::Alpha, Mapping::Square),
];

/// The axes of a table, one of which is n·v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Along a row.
    pub x: AxisSpec,
    /// From row to row.
    pub y: AxisSpec,
}

impl Layout {
    /// Whether n·v runs along y.
    pub fn is_transposed(&self) -> bool {
        self.y.parameter == Parameter::Nov
    }

    /// The axis of n·v.
    pub fn nov(&self) -> AxisSpec {
        if self.is_transposed() { self.y } else { self.x }
    }

    /// The axis of roughness.
    pub fn roughness(&self) -> AxisSpec {
        if self.is_transposed() { self.x } else { self.y }
    }

    /// The same axes with these nodes of n·v and of roughness.
    pub fn with_nodes(&self, [nov, roughness]: [Nodes; 2]) -> Self {
        let of = |spec: AxisSpec, nodes| AxisSpec { nodes, ..spec };
        let (nov, roughness) = (of(self.nov(), nov), of(self.roughness(), roughness));
        Layout::of(nov, roughness, self.is_transposed())
    }

    /// The axes of n·v and of roughness in their places.
    pub fn of(nov: AxisSpec, roughness: AxisSpec, transposed: bool) -> Self {
        match transposed {
            true => Layout { x: roughness, y: nov },
            false => Layout { x: nov, y: roughness },
        }
    }
}

/// All hypotheses of an axis of n·v with these nodes.
pub fn cosines(nodes: &[Nodes]) -> Vec<AxisSpec> {
    all(&COSINES, nodes)
}

/// All hypotheses of an axis of roughness with these nodes.
pub fn roughnesses(nodes: &[Nodes]) -> Vec<AxisSpec> {
    all(&ROUGHNESSES, nodes)
}

fn all(kinds: &[(Parameter, Mapping)], nodes: &[Nodes]) -> Vec<AxisSpec> {
    let mut specs = Vec::new();
    for &(parameter, mapping) in kinds {
        for &nodes in nodes {
            for flip in [false, true] {
                specs.push(AxisSpec { mapping, nodes, flip, ..AxisSpec::of(parameter) });
            }
        }
    }
    specs
}

/// n·v, or α, at these texels of an axis of so many.
pub fn places(spec: AxisSpec, size: usize, texels: &[usize]) -> Vec<f64> {
    let Ok(axis) = Axis::new(spec, size) else { return vec![0.0; texels.len()] };
    let place = |&texel: &usize| place(spec.parameter, axis.value(texel));
    texels.iter().map(place).collect()
}

/// n·v, or α, where an axis has this value.
pub fn place(parameter: Parameter, value: f64) -> f64 {
    if parameter == Parameter::Roughness { alpha_of(value) } else { value }
}
