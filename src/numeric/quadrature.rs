//! Quadrature on an interval: Gauss-Legendre rules, the slope map that prepares integrands for
//! them, and double exponential (tanh-sinh) rules.

pub mod gauss_legendre;
pub mod slope_map;
pub mod tanh_sinh;
