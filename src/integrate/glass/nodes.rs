//! Numbers of nodes of the rules for glass, and the nodes.

use crate::brdf::interface::Side;
use crate::numeric::quadrature::gauss_legendre::{
    Node, crowded_at_both_ends, crowded_at_end, gauss_legendre, half_gauss,
};
use crate::numeric::quadrature::slope_map::Power;

/// Numbers of nodes for one of the two integrals from one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Slopes for each piece.
    pub slopes: usize,
    /// Azimuths where light is partly reflected.
    pub azimuths: usize,
    /// Azimuths where it is reflected whole.
    pub total: usize,
    /// The slope map.
    pub power: Power,
    /// Whether slopes crowd at both ends of a piece, where derivatives do not exist.
    pub crowded: bool,
}

/// Numbers of nodes for reflection and transmission, from outside and from inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlassRule {
    /// Reflection and transmission from the thinner side.
    pub outside: [Counts; 2],
    /// The same from the denser side.
    pub inside: [Counts; 2],
}

/// The nodes for one of the two integrals.
#[derive(Clone, Debug)]
pub struct ExitNodes {
    /// Slopes of a piece.
    pub slopes: Vec<Node>,
    /// Azimuths of an interval that is symmetric about its start.
    pub even: Vec<Node>,
    /// Of one with a root at its end.
    pub root: Vec<Node>,
    /// Of light that is reflected whole, symmetric about the start.
    pub total_even: Vec<Node>,
    /// Of it where the start lies beyond 0.
    pub total: Vec<Node>,
    /// The slope map.
    pub power: Power,
}

/// The nodes for both.
#[derive(Clone, Debug)]
pub struct GlassNodes {
    /// Of R.
    pub reflected: ExitNodes,
    /// Of T.
    pub transmitted: ExitNodes,
}

impl Counts {
    /// A rule of few nodes.
    pub const fn few([slopes, azimuths, total]: [usize; 3]) -> Self {
        Counts { slopes, azimuths, total, power: Power::Two, crowded: false }
    }

    /// A rule whose slopes crowd.
    pub const fn crowded([slopes, azimuths, total]: [usize; 3], power: Power) -> Self {
        Counts { slopes, azimuths, total, power, crowded: true }
    }

    fn nodes(self) -> ExitNodes {
        let slopes = gauss_legendre(self.slopes);
        ExitNodes {
            slopes: if self.crowded { crowded_at_both_ends(slopes) } else { slopes },
            even: half_gauss(self.azimuths),
            root: crowded_at_end(gauss_legendre(self.azimuths)),
            total_even: half_gauss(self.total),
            total: gauss_legendre(self.total),
            power: self.power,
        }
    }
}

impl GlassRule {
    /// Evaluations of the integrands for a texel seen from outside, where the pieces are two each.
    pub const fn evaluations(&self) -> usize {
        let [reflected, transmitted] = self.outside;
        2 * (reflected.slopes * reflected.azimuths + transmitted.slopes * transmitted.azimuths)
    }

    /// The numbers of nodes of a side in the order of the shader's `Rule`.
    pub fn counts(&self, side: Side) -> [usize; 5] {
        let [reflected, transmitted] = self.of(side);
        let Counts { slopes, azimuths, total, .. } = reflected;
        [slopes, azimuths, total, transmitted.slopes, transmitted.azimuths]
    }

    /// The slope map of a side, the same for both integrals.
    pub fn power(&self, side: Side) -> Power {
        self.of(side)[0].power
    }

    /// Whether f32 adds no more than to any other lobe: with the other map the squares of slopes
    /// leave its range, and a rule of few nodes hangs on the rounding by which they are chosen near
    /// the critical angle.
    pub fn fits_f32(&self) -> bool {
        let fits = |counts: &Counts| counts.power == Power::Two && counts.crowded;
        self.outside.iter().chain(&self.inside).all(fits)
    }

    fn of(&self, side: Side) -> [Counts; 2] {
        match side {
            Side::Outside => self.outside,
            Side::Inside => self.inside,
        }
    }

    /// The nodes for a side.
    pub fn nodes(&self, side: Side) -> GlassNodes {
        let [reflected, transmitted] = self.of(side);
        GlassNodes { reflected: reflected.nodes(), transmitted: transmitted.nodes() }
    }
}

impl GlassNodes {
    /// The lists of nodes in the order of the shader's.
    pub fn lists(&self) -> [&[Node]; 8] {
        let GlassNodes { reflected, transmitted } = self;
        [
            &reflected.slopes,
            &reflected.even,
            &reflected.root,
            &reflected.total_even,
            &reflected.total,
            &transmitted.slopes,
            &transmitted.even,
            &transmitted.root,
        ]
    }
}
