//! Coordinates in which both the truth and lookups are smooth: u along n·v and t across roughness,
//! from 0 to 1.
//!
//! The interpolant of the truth is a polynomial in s and t. With v = tanh(A/16) and A =
//! asinh(n·v/α) it has s⁴ = v/v(n·v = 1), and t is the place of √r. Here s = s0 + (1 - s0) u^k with
//! s0 at the least n·v. A lookup takes roots of n·v less its own least: k = 2 there, so that they
//! are smooth in u. Both differences are written without their zero:
//! sinh A - sinh A0 = 2 sinh(4 ln ρ) cosh((A + A0)/2) with ρ = (1 + w)/(1 - w) and w =
//! (v - v0)/(1 - v v0).

use super::interval::{Interval, Jet};
use crate::approximation::{Across, Along, Region, Shape};
use crate::integrate::interpolant::SMOOTHEST;
use crate::table::axis::{Axis, Mapping, Parameter};

/// Which variable changes along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along n·v.
    Nov,
    /// Across roughness.
    Roughness,
}

/// A rectangle in u and t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Along n·v.
    pub u: [f64; 2],
    /// Across roughness.
    pub t: [f64; 2],
}

impl Cell {
    /// Its halves along these directions.
    pub fn halves(&self, divided: [bool; 2]) -> Vec<Cell> {
        let parts = |[low, high]: [f64; 2], divided: bool| {
            let middle = 0.5 * (low + high);
            if divided { vec![[low, middle], [middle, high]] } else { vec![[low, high]] }
        };
        let across = parts(self.t, divided[1]);
        let along = parts(self.u, divided[0]);
        along.iter().flat_map(|&u| across.iter().map(move |&t| Cell { u, t })).collect()
    }
}

/// The coordinates of a region for a shape.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates<'a> {
    region: &'a Region,
    shape: &'a Shape,
}

/// What lookups take, along a line through a cell.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// s of the interpolant.
    pub s: Jet,
    /// t of the interpolant.
    pub t: Jet,
    /// n·v
    pub nov: Jet,
    /// The coordinate of the shape along n·v.
    pub along: Jet,
    /// That across roughness; 0 of a polynomial.
    pub across: Jet,
}

/// √r at t.
fn root_of<T>(t: T) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<f64, Output = T>,
{
    let start = SMOOTHEST.sqrt();
    t * (1.0 - start) + start
}

/// tanh(asinh(y)/16) of y ≥ 0
fn compressed(y: Jet) -> Jet {
    let e = (y + (y.square() + 1.0).sqrt()).sqrt().sqrt().sqrt();
    (e + 1.0).recip() * -2.0 + 1.0
}

/// x + 1/x
fn with_inverse(x: Jet) -> Jet {
    x + x.recip()
}

impl<'a> Coordinates<'a> {
    /// Of a shape in a region.
    pub fn new(region: &'a Region, shape: &'a Shape) -> Self {
        Coordinates { region, shape }
    }

    /// Whether s = s0 + (1 - s0) u²: where a shape counts n·v from the region's least.
    fn is_squared(&self) -> bool {
        matches!(self.shape, Shape::Spline { .. }) && self.region.least_nov > 0.0
    }

    /// Perceptual roughness at t.
    pub fn roughness(&self, t: f64) -> f64 {
        let [low, high] = self.region.roughness;
        let root = root_of(t);
        // Not a rounding below what the interpolant covers.
        (root * root).clamp(low.max(SMOOTHEST), high)
    }

    /// t of a perceptual roughness.
    pub fn t(roughness: f64) -> f64 {
        let start = SMOOTHEST.sqrt();
        ((roughness.sqrt() - start) / (1.0 - start)).clamp(0.0, 1.0)
    }

    /// The places of a roughness.
    pub fn row(&self, roughness: f64) -> Row {
        let least = self.region.least_nov;
        let alpha = roughness * roughness;
        let place = |nov: f64| {
            let e = libm::exp(libm::asinh(nov / alpha) / 8.0);
            (e - 1.0) / (e + 1.0)
        };
        let end = place(1.0);
        let first = if least > 0.0 { libm::pow(place(least) / end, 0.25) } else { 0.0 };
        Row { least, alpha, end, first, is_squared: self.is_squared() }
    }

    /// What lookups take along lines in this direction through a cell.
    pub fn place(&self, cell: &Cell, direction: Direction) -> Place {
        let jet = |own: Direction, [low, high]: [f64; 2]| {
            let range = Interval { low, high };
            if own == direction { Jet::variable(range) } else { Jet::fixed(range) }
        };
        let (u, t) = (jet(Direction::Nov, cell.u), jet(Direction::Roughness, cell.t));
        let Region { least_nov: least, roughness: [low, high] } = *self.region;
        let root = match low == high {
            true => Jet::from(low.sqrt()),
            false => root_of(t),
        };
        let alpha = root.square().square();
        let steepness = alpha.recip();
        let end = compressed(steepness);
        let zero = Jet::from(0.0);
        let (v0, s0) = match least {
            0.0 => (zero, zero),
            _ => {
                let v0 = compressed(steepness * least);
                (v0, (v0 * end.recip()).power(0.25))
            }
        };
        let width = s0 * -1.0 + 1.0;
        // 1 less the rest, so that no range of it passes 1.
        let rest = (if self.is_squared() { u.square() } else { u }) * -1.0 + 1.0;
        let s = (width * rest) * -1.0 + 1.0;
        let v = end * s.square().square();
        let e = |v: Jet| (v * -1.0 + 1.0).recip() * 2.0 + -1.0;
        let (ev, e0) = (e(v), e(v0));
        // Half of sinh(p ln x) over (x - 1)/(x + 1) = w, p = 8 and 4.
        let slope = |w: Jet| (w.square() * -1.0 + 1.0).recip() * 2.0;
        let sinh4 = |x: Jet, w: Jet| slope(w) * with_inverse(x) * with_inverse(x.square());
        let sinh8 = |x: Jet, w: Jet| sinh4(x, w) * with_inverse(x.square().square());
        let nov = (alpha * v * sinh8(ev, v)).within(least, 1.0);
        let counted = if self.is_squared() {
            let apart = (v * v0) * -1.0 + 1.0;
            // w/u²
            let rise = end * width * (s + s0) * (s.square() + s0.square()) * apart.recip();
            let w = u.square() * rise;
            let rho = e(w);
            let cosh = with_inverse((ev * e0).square().square()) * 0.5;
            let rest = rise * sinh4(rho, w) * cosh * (2.0 / (1.0 - least));
            Factored { root: Some(u), rest }
        } else if least == 0.0 {
            // s = u, and n·v/α = u⁴ times this.
            Factored { root: Some(u.square()), rest: end * sinh8(ev, v) }
        } else {
            Factored { root: None, rest: v * sinh8(ev, v) }
        };
        let (x, across) = match *self.shape {
            Shape::Polynomial { x } => (x, zero),
            Shape::Surface { x, y, .. } => (x, power(y, root)),
            Shape::Spline { x, y, .. } => (x, across(y, self.region, root)),
            Shape::Texture { x, y, .. } => {
                let p = match x.spec().mapping {
                    // Those of an index of refraction are no axis of an approximation.
                    Mapping::Linear | Mapping::SqrtF0 | Mapping::Piecewise => {
                        counted.whole() * alpha
                    }
                    Mapping::Sqrt => counted.sqrt() * root.square(),
                    Mapping::Square => nov.square(),
                    Mapping::SqrtComplement => (nov * -1.0 + 1.0).sqrt(),
                };
                let parameter = match y.spec().parameter {
                    Parameter::Alpha => alpha,
                    _ => root.square(),
                };
                let q = match y.spec().mapping {
                    Mapping::Linear | Mapping::SqrtF0 | Mapping::Piecewise => parameter,
                    Mapping::Sqrt => parameter.sqrt(),
                    Mapping::Square => parameter.square(),
                    Mapping::SqrtComplement => (parameter * -1.0 + 1.0).sqrt(),
                };
                let (along, across) = (texel(&x, p), texel(&y, q));
                return Place { s, t, nov, along, across };
            }
        };
        let along = along(x, counted, alpha).within(0.0, 1.0);
        let along = match self.shape {
            Shape::Polynomial { .. } => along * 2.0 + -1.0,
            _ => along,
        };
        Place { s, t, nov, along, across }
    }
}

/// The places of a roughness.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    least: f64,
    alpha: f64,
    /// v at n·v = 1.
    end: f64,
    /// s at the least n·v.
    first: f64,
    is_squared: bool,
}

impl Row {
    /// s at u.
    pub fn s(&self, u: f64) -> f64 {
        self.first + (1.0 - self.first) * if self.is_squared { u * u } else { u }
    }

    /// n·v at u.
    pub fn nov(&self, u: f64) -> f64 {
        let s = self.s(u);
        let v = self.end * (s * s) * (s * s);
        // Its logarithm is 16 atanh(v).
        let e = ((1.0 + v) / (1.0 - v)).powi(8);
        match u {
            0.0 => self.least,
            1.0 => 1.0,
            _ => (0.5 * self.alpha * (e - 1.0 / e)).clamp(self.least, 1.0),
        }
    }
}

/// root² · rest, with a root that may be 0.
struct Factored {
    root: Option<Jet>,
    rest: Jet,
}

impl Factored {
    fn whole(&self) -> Jet {
        self.root.map_or(self.rest, |root| root.square() * self.rest)
    }

    fn sqrt(&self) -> Jet {
        let rest = self.rest.sqrt();
        self.root.map_or(rest, |root| root * rest)
    }
}

/// [`Along::at`], of n·v over α.
fn along(x: Along, slope: Factored, alpha: Jet) -> Jet {
    match x {
        Along::Nov => slope.whole() * alpha,
        Along::Sqrt => slope.sqrt() * alpha.sqrt(),
        Along::Cbrt => (slope.whole() * alpha).power(1.0 / 3.0),
        Along::Log => (slope.whole() * alpha).log(),
        Along::Layer(k) => {
            let widened = alpha * k + 1.0;
            let inverse = (slope.whole() + k).recip();
            // y/(y + k) in two ways: the first is smooth at 0, the second has y but once.
            let first = Factored { rest: slope.rest * inverse * widened, ..slope }.sqrt();
            let second = ((inverse * -k + 1.0) * widened).sqrt();
            first.and(second)
        }
    }
}

/// The place among the texels of an axis, from 0 to 1 and clamped there, of a mapped parameter.
fn texel(axis: &Axis, mapped: Jet) -> Jet {
    let last = (axis.size() - 1) as f64;
    let (scale, shift) = axis.texels();
    (mapped * (scale / last) + shift / last).clamped(0.0, 1.0)
}

/// [`Across::at`] of a spline, where `root` is √r.
fn across(y: Across, region: &Region, root: Jet) -> Jet {
    let [low, high] = region.roughness.map(|end| y.of::<f64>(end));
    (power(y, root) + -low) * (1.0 / (high - low))
}

/// [`Across::of`]
fn power(y: Across, root: Jet) -> Jet {
    match y {
        Across::Linear => root.square(),
        Across::Sqrt => root,
        Across::Power(p) => root.power(2.0 * p),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::approximation::Texels;

    /// Value and derivatives of f at x by differences of fourth order.
    fn differences(x: f64, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let h = 1e-3;
        let at = |k: i32| f(x + h * f64::from(k));
        let first = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * h);
        let second = (16.0 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30.0 * at(0)) / (12.0 * h * h);
        [at(0), first, second]
    }

    /// The coordinates of lookups themselves, and their derivatives by differences, lie in the
    /// ranges of small cells around them.
    #[test]
    fn ranges_hold_what_lookups_take() {
        let layer = Along::Layer(3.0);
        let spline = |x, y| Shape::Spline { x, y, size: [7, 9], degree: 3 };
        let surface = |x, y| Shape::Surface { x, y, columns: 4 };
        let texture = |x: &str, y: &str| {
            let axis = |words: &str| Axis::new(words.parse().unwrap(), 16).unwrap();
            Shape::Texture { x: axis(x), y: axis(y), texels: Texels::Exact }
        };
        let shapes = [
            (spline(layer, Across::Sqrt), 1e-3),
            (spline(layer, Across::Linear), 0.0),
            (spline(Along::Sqrt, Across::Power(0.35)), 1e-3),
            (spline(Along::Nov, Across::Linear), 1e-3),
            (surface(Along::Cbrt, Across::Linear), 1e-3),
            (surface(layer, Across::Sqrt), 0.0),
            (surface(Along::Log, Across::Sqrt), 1e-3),
            (Shape::Polynomial { x: Along::Log }, 1e-3),
            (texture("nov,sqrt,edges", "alpha,sqrt,edges,flip"), 1e-3),
            (texture("nov,edges", "roughness,edges"), 0.0),
        ];
        let places = [[0.03, 0.25], [0.1, 0.9], [0.5, 0.4], [0.8, 0.6], [0.97, 0.3]];
        for ((shape, least_nov), [u, t]) in
            shapes.iter().flat_map(|shape| places.map(|place| (*shape, place)))
        {
            let region = Region { least_nov, roughness: [0.045, 1.0] };
            let coordinates = Coordinates::new(&region, &shape);
            let cell = Cell { u: [u - 3e-3, u + 3e-3], t: [t - 3e-3, t + 3e-3] };
            let at = |u: f64, t: f64| {
                let roughness = coordinates.roughness(t);
                let nov = coordinates.row(roughness).nov(u);
                let [along, across] = shape.coordinates(&region, nov, roughness);
                [nov, along, across]
            };
            for direction in [Direction::Nov, Direction::Roughness] {
                let place = coordinates.place(&cell, direction);
                for (k, jet) in [place.nov, place.along, place.across].into_iter().enumerate() {
                    let own = match direction {
                        Direction::Nov => differences(u, |u| at(u, t)[k]),
                        Direction::Roughness => differences(t, |t| at(u, t)[k]),
                    };
                    for (value, range) in own.into_iter().zip([jet.value, jet.first, jet.second]) {
                        // The differences are right to about 1e-8 of the largest derivative, which
                        // a wide layer has: 1e3.
                        let slack = 1e-6 * (1.0 + jet.second.size());
                        let is_inside = range.low - slack <= value && value <= range.high + slack;
                        assert!(
                            is_inside,
                            "{shape:?} {u} {t} {direction:?} {k}: {value} {range:?}"
                        );
                        assert!(range.size() < 1e4, "{range:?}");
                    }
                }
            }
        }
    }
}
