//! Quadrature on an interval: Gauss-Legendre rules, the slope map that prepares integrands for them, double exponential.

pub mod double_exponential;
pub mod gauss_legendre;
pub mod slope_map;
