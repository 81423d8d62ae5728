//! Trust, but verify. A table is either certified, value by value, by stages of growing precision
//! ([`ziv`], [`stages`], [`decision`], [`tally`]); or it is checked on a sample: a device's against
//! the CPU, any against the reference ([`deviation`]).

mod decider;
mod halves;
pub mod decision;
pub mod deviation;
pub mod stages;
pub mod tally;
pub mod ziv;
