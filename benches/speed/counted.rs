//! Arithmetic that counts itself: the formulas are generic over what they compute with.

use splitsum::numeric::lanes::Real;
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// An f64 of which every + - × ÷ √ and special function counts as one operation; comparisons and
/// signs are free.
#[derive(Clone, Copy)]
pub struct Counted(f64);

fn count<T>(value: T) -> T {
    OPERATIONS.with(|operations| operations.set(operations.get() + 1));
    value
}

/// How many operations `work` takes.
pub fn operations<T>(work: impl FnOnce() -> T) -> u64 {
    let before = OPERATIONS.get();
    work();
    OPERATIONS.get() - before
}

impl From<f64> for Counted {
    fn from(value: f64) -> Self {
        Counted(value)
    }
}

impl Real for Counted {
    fn sqrt(self) -> Self {
        count(Counted(self.0.sqrt()))
    }

    fn nearest_whole(self) -> Self {
        count(Counted(self.0.nearest_whole()))
    }

    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        count(Counted(f(self.0, other.0)))
    }

    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        if self.0 < limit.0 { yes } else { no }
    }

    fn any(self, test: impl Fn(f64) -> bool) -> bool {
        test(self.0)
    }
}

impl Neg for Counted {
    type Output = Self;

    fn neg(self) -> Self {
        Counted(-self.0)
    }
}

macro_rules! counted {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Counted {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                count(Counted(self.0 $operator other.0))
            }
        }

        impl $trait<f64> for Counted {
            type Output = Self;

            fn $method(self, other: f64) -> Self {
                count(Counted(self.0 $operator other))
            }
        }
    };
}

counted!(Add, add, +);
counted!(Sub, sub, -);
counted!(Mul, mul, *);
counted!(Div, div, /);
