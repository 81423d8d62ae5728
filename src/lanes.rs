//! Eight numbers side by side: the formulas are written once, for one f64 or for eight texels in a CPU's vector registers.
//!
//! Every operation acts on each lane alone and rounds as IEEE 754 says, so that a lane holds the same bits as the f64 would.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes side by side: the widest vectors of today's CPUs.
pub const WIDTH: usize = 8;

/// What the formulas compute with: f64, or [`Lanes`] of them.
pub trait Real:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + Neg<Output = Self>
{
    /// √x
    fn sqrt(self) -> Self;

    /// f(x, y) in every lane; for what has no vector instruction.
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self;

    /// `yes` in the lanes where this is below `limit`, else `no`.
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self;

    /// 1 - x
    #[inline(always)]
    fn complement(self) -> Self {
        Self::from(1.0) - self
    }

    /// 1/x
    #[inline(always)]
    fn recip(self) -> Self {
        Self::from(1.0) / self
    }

    /// The smaller of the two.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.select_below(other, self, other)
    }

    /// The larger of the two.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.select_below(other, other, self)
    }

    /// |x|
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.most(-self)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        f(self, other)
    }

    #[inline(always)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        if self < limit { yes } else { no }
    }
}

/// Eight f64, aligned for the vector registers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; WIDTH]);

impl Real for Lanes {
    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes(from_fn(|i| self.0[i].sqrt()))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Lanes(from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Lanes(from_fn(|i| if self.0[i] < limit.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

impl From<f64> for Lanes {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Lanes([value; WIDTH])
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes(self.0.map(|x| -x))
    }
}

macro_rules! lane_by_lane {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Lanes(from_fn(|i| self.0[i] $operator other.0[i]))
            }
        }

        impl $trait<f64> for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Lanes(from_fn(|i| self.0[i] $operator other))
            }
        }
    };
}

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

/// Runs `work` compiled for the best vector instructions that the CPU has. What it calls has to be inlined into it.
#[inline(always)]
pub fn vectorised<W: pulp::NullaryFnOnce>(work: W) -> W::Output {
    pulp::Arch::new().dispatch(work)
}
