//! Numbers side by side: each formula is written once, for one f64, for eight of them in a CPU's
//! vector registers, or for sixteen f32.
//!
//! Every operation acts on each lane alone and rounds as IEEE 754 says, so that a lane holds the
//! same bits as the scalar would.

use std::array::from_fn;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes of an [`F64x8`]: those of AVX-512, the widest registers of today's CPUs.
const F64_LANES: usize = 8;

/// 1.5 2^52. Added to a number below 2^51, it leaves the nearest whole number in the low bits of
/// the sum: up there the numbers of an f64 lie 1 apart.
pub const ROUND_F64: f64 = 6_755_399_441_055_744.0;

/// 1.5 2^23: the same for an f32 below 2^22.
const ROUND_F32: f32 = 12_582_912.0;

/// A number that can be added and multiplied: every [`Real`], and numbers that carry their error.
pub trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl<R: Copy + From<f64> + Add<Output = R> + Sub<Output = R> + Mul<Output = R>> Number for R {}

/// The arithmetic of the formulas: f64, [`F64x8`] of them, or f32 in [`F32x16`].
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

    /// f(x, y) in every lane, computed in f64: for functions without a vector instruction.
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self;

    /// f(x, y), called: a long formula is compiled once, not into every loop that needs it, and
    /// its vector instructions are better for it.
    #[inline(always)]
    fn call<F: Function>(self, other: Self) -> Self {
        F::at(self, other)
    }

    /// `yes` in the lanes where this is below `limit`, else `no`.
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self;

    /// Whether a lane passes a test.
    fn any(self, test: impl Fn(f64) -> bool) -> bool;

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
    fn min(self, other: Self) -> Self {
        self.select_below(other, self, other)
    }

    /// The larger of the two.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select_below(other, other, self)
    }

    /// |x|
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(-self)
    }
}

/// A function of two numbers for [`Real::call`].
pub trait Function {
    /// f(x, y)
    fn at<R: Real>(x: R, y: R) -> R;
}

/// Lanes that a loop over texels fills and empties.
pub trait Vector: Real {
    /// The number of lanes.
    const LANES: usize;

    /// `f(i)` in lane i.
    fn gather(f: impl Fn(usize) -> f64) -> Self;

    /// The number in lane i.
    fn lane(self, i: usize) -> f64;
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn nearest_whole(self) -> Self {
        (self + ROUND_F64) - ROUND_F64
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        f(self, other)
    }

    #[inline(always)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        if self < limit { yes } else { no }
    }

    #[inline(always)]
    fn any(self, test: impl Fn(f64) -> bool) -> bool {
        test(self)
    }
}

macro_rules! lanes {
    ($(#[$about:meta])* $name:ident, $scalar:ty, $width:expr, $round:expr) => {
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
                $name(from_fn(|i| (self.0[i] + $round) - $round))
            }

            #[inline(always)]
            fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
                $name(from_fn(|i| f(self.0[i].into(), other.0[i].into()) as $scalar))
            }

            #[inline(never)]
            fn call<F: Function>(self, other: Self) -> Self {
                vectorised(Call::<F, Self> { x: self, y: other, function: PhantomData })
            }

            #[inline(always)]
            fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
                $name(from_fn(|i| if self.0[i] < limit.0[i] { yes.0[i] } else { no.0[i] }))
            }

            #[inline(always)]
            fn any(self, test: impl Fn(f64) -> bool) -> bool {
                self.0.iter().any(|&lane| test(lane.into()))
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
    /// Eight f64.
    F64x8,
    f64,
    F64_LANES,
    ROUND_F64
);
lanes!(
    /// Sixteen f32: for the study of what single precision costs and saves.
    F32x16,
    f32,
    2 * F64_LANES,
    ROUND_F32
);
lanes!(
    /// One f32.
    F32x1,
    f32,
    1,
    ROUND_F32
);

/// The work of [`Real::call`].
struct Call<F, R> {
    x: R,
    y: R,
    function: PhantomData<F>,
}

impl<F: Function, R: Real> Work for Call<F, R> {
    type Output = R;

    #[inline(always)]
    fn call(self) -> R {
        F::at(self.x, self.y)
    }
}

/// Work that [`vectorised`] runs.
#[cfg(feature = "simd")]
pub use pulp::NullaryFnOnce as Work;

/// Work that [`vectorised`] runs.
#[cfg(not(feature = "simd"))]
pub trait Work {
    /// Its result.
    type Output;

    /// Does it.
    fn call(self) -> Self::Output;
}

/// Runs `work` compiled for the best vector instructions of the CPU; without the feature `simd`,
/// for those that every CPU of its kind has.
///
/// Whatever `work` calls has to be inlined into it: a function that is not is compiled without
/// those instructions, and several times as slow. That is what `#[inline(always)]` on the formulas
/// is for; `cargo bench` shows one that lacks it.
#[inline(always)]
pub fn vectorised<W: Work>(work: W) -> W::Output {
    #[cfg(feature = "simd")]
    return pulp::Arch::new().dispatch(work);
    #[cfg(not(feature = "simd"))]
    return work.call();
}
