//! Numbers side by side: the formulas are written once, for one f64, for eight texels in a CPU's vector registers, or
//! for sixteen in f32.
//!
//! Every operation acts on each lane alone and rounds as IEEE 754 says, so that a lane holds the same bits as the
//! scalar would.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes side by side: the widest vectors of today's CPUs.
pub const WIDTH: usize = 8;

/// Added to a number below 2^51, it leaves its nearest whole number in the low bits.
pub const SHIFT: f64 = 6_755_399_441_055_744.0;

/// The same for an f32 below 2^22.
const SHIFT_OF_SINGLES: f32 = 12_582_912.0;

/// What can be added and multiplied: every [`Real`], and numbers that carry their error.
pub trait Number: Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<R: Copy + From<f64> + Add<Output = R> + Sub<Output = R> + Mul<Output = R>> Number for R {}

/// What the formulas compute with: f64, [`Lanes`] of them, or f32 in [`Singles`].
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

    /// The nearest whole number, for |x| below 2^21.
    fn nearest_whole(self) -> Self;

    /// f(x, y) in every lane, computed in f64; for what has no vector instruction.
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

/// Lanes that a loop over texels fills and empties.
pub trait Vector: Real {
    /// How many.
    const LANES: usize;

    /// `f(i)` in lane i.
    fn gather(f: impl Fn(usize) -> f64) -> Self;

    /// What is in lane i.
    fn lane(self, i: usize) -> f64;
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn nearest_whole(self) -> Self {
        (self + SHIFT) - SHIFT
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

macro_rules! lanes {
    ($(#[$about:meta])* $name:ident, $scalar:ty, $width:expr, $shift:expr) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(align(64))]
        pub struct $name(pub [$scalar; $width]);

        impl Real for $name {
            #[inline(always)]
            fn sqrt(self) -> Self {
                $name(from_fn(|i| self.0[i].sqrt()))
            }

            #[inline(always)]
            fn nearest_whole(self) -> Self {
                $name(from_fn(|i| (self.0[i] + $shift) - $shift))
            }

            #[inline(always)]
            fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
                $name(from_fn(|i| f(self.0[i].into(), other.0[i].into()) as $scalar))
            }

            #[inline(always)]
            fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
                $name(from_fn(|i| if self.0[i] < limit.0[i] { yes.0[i] } else { no.0[i] }))
            }
        }

        impl Vector for $name {
            const LANES: usize = $width;

            #[inline(always)]
            fn gather(f: impl Fn(usize) -> f64) -> Self {
                $name(from_fn(|i| f(i) as $scalar))
            }

            #[inline(always)]
            fn lane(self, i: usize) -> f64 {
                self.0[i].into()
            }
        }

        impl From<f64> for $name {
            #[inline(always)]
            fn from(value: f64) -> Self {
                $name([value as $scalar; $width])
            }
        }

        impl Neg for $name {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                $name(from_fn(|i| -self.0[i]))
            }
        }

        lanes!($name, $scalar, Add, add, +);
        lanes!($name, $scalar, Sub, sub, -);
        lanes!($name, $scalar, Mul, mul, *);
        lanes!($name, $scalar, Div, div, /);
    };
    ($name:ident, $scalar:ty, $trait:ident, $method:ident, $operator:tt) => {
        impl $trait for $name {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $name(from_fn(|i| self.0[i] $operator other.0[i]))
            }
        }

        impl $trait<f64> for $name {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                $name(from_fn(|i| self.0[i] $operator other as $scalar))
            }
        }
    };
}

lanes!(
    /// Eight f64, aligned for the vector registers.
    Lanes,
    f64,
    WIDTH,
    SHIFT
);
lanes!(
    /// Sixteen f32: what the formulas are worth in single precision, and how fast they are there.
    Singles,
    f32,
    2 * WIDTH,
    SHIFT_OF_SINGLES
);
lanes!(
    /// One f32.
    Single,
    f32,
    1,
    SHIFT_OF_SINGLES
);

/// Runs `work` compiled for the best vector instructions that the CPU has. What it calls has to be inlined into it.
#[inline(always)]
pub fn vectorised<W: pulp::NullaryFnOnce>(work: W) -> W::Output {
    pulp::Arch::new().dispatch(work)
}
