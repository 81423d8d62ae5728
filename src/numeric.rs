//! Numbers: arithmetic in vector registers and with error bounds, correctly rounded halves, special
//! functions, quadrature.

pub mod ball;
pub mod climb;
pub mod half;
pub mod lanes;
pub mod quadrature;
pub mod special;
