//! Quadrature on an interval: Gauss-Legendre rules, the slope map that prepares integrands for them, double exponential; and point
//! sets of the square.

pub mod double_exponential;
pub mod gauss_legendre;
pub mod point_set;
pub mod slope_map;
