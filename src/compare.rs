//! Methods compared: the field's estimators and fits, formulas of textbooks, what each costs and
//! where each fails, as figures and as charts. No bake uses anything of it.

pub mod analytic_fit;
pub mod chart;
pub mod device;
pub mod draw;
pub mod point_set;
pub mod rows;
pub mod sampling;
pub mod study;
pub mod technique;
pub mod textbook;
