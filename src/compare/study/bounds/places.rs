//! Places of the domain, crowded at every edge and corner and where rules change, and steps from
//! one to the next.

use crate::integrate::Integrand;
use crate::integrate::bounds::{BLINN_PHONG_LIMIT, CHARLIE_LIMIT, GRAZING, WIDE_LAYER};
use crate::integrate::rule::Method;
use crate::integrate::rules::RULES;
use crate::units::{LARGEST_ALPHA, SMALLEST_ALPHA, SMALLEST_COSINE};

/// A point of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// n·v
    pub mu: f64,
    /// α
    pub alpha: f64,
}

/// Draws places.
pub struct Places {
    random: Random,
    /// n·v = 0, or the smallest above it where the lobe has no albedo there.
    least_mu: f64,
    /// The largest α of a texel.
    most_alpha: f64,
    /// The cosine of the critical angle of glass seen from inside, else 0.
    critical: f64,
    /// [`limits`]
    limits: Vec<f64>,
}

/// 1 - p at the upper end of a coordinate, apart from p = 1 itself: the last number below 1.
const GAP: f64 = 1.2e-16;

/// p at the coordinate c: -1 is `least` and 1 the last number below 1, both ends crowded by the
/// logarithm; beyond them lie the edges `edge` and 1.
fn value(c: f64, least: f64, edge: f64) -> f64 {
    match c {
        ..=-1.0 => edge,
        1.0.. => 1.0,
        ..0.0 => (0.5 * libm::pow(2.0 * least, -c)).max(least),
        _ => 1.0 - 0.5 * libm::pow(2.0 * GAP, c),
    }
}

/// The inverse of [`value`]; -1.02 and 1.02 on the edges.
fn coordinate(p: f64, least: f64) -> f64 {
    match p {
        _ if p < least => -1.02,
        1.0.. => 1.02,
        ..0.5 => -libm::log(2.0 * p) / libm::log(2.0 * least),
        _ => libm::log(2.0 * (1.0 - p)) / libm::log(2.0 * GAP),
    }
}

/// The coordinate beyond which α exceeds 1, as on an unclamped axis, and that stretch's length.
const BEYOND_ONE: (f64, f64) = (1.02, 0.1);

/// α at a coordinate.
fn alpha_at(c: f64) -> f64 {
    let beyond = (c - BEYOND_ONE.0) / BEYOND_ONE.1;
    if beyond > 0.0 {
        return (1.0 + beyond * (LARGEST_ALPHA - 1.0)).min(LARGEST_ALPHA);
    }
    value(c, SMALLEST_ALPHA, SMALLEST_ALPHA)
}

/// The inverse of [`alpha_at`].
fn alpha_coordinate(alpha: f64) -> f64 {
    if alpha > 1.0 {
        return BEYOND_ONE.0 + (alpha - 1.0) / (LARGEST_ALPHA - 1.0) * BEYOND_ONE.1;
    }
    coordinate(alpha, SMALLEST_ALPHA)
}

impl Place {
    fn coordinates(self) -> [f64; 2] {
        [coordinate(self.mu, SMALLEST_COSINE), alpha_coordinate(self.alpha)]
    }

    /// Whether another place is within a distance along both coordinates.
    pub fn near(self, other: Place, distance: f64) -> bool {
        let ([x, y], [u, v]) = (self.coordinates(), other.coordinates());
        (x - u).abs() < distance && (y - v).abs() < distance
    }
}

impl Places {
    /// The places of an integrand's domain.
    pub fn new(of: Integrand, seed: u64) -> Self {
        let (diverges, most_alpha, critical) = match of {
            Integrand::Specular(lobe, _) => {
                (lobe.diverges_at_grazing(), lobe.ndf.most_alpha(), 0.0)
            }
            Integrand::Glass(interface) => {
                (false, interface.lobe().ndf.most_alpha(), interface.critical())
            }
            Integrand::Diffuse(_) => (false, 1.0, 0.0),
        };
        let least_mu = if diverges { SMALLEST_COSINE } else { 0.0 };
        Places { random: Random(seed), least_mu, most_alpha, critical, limits: limits() }
    }

    fn at(&self, x: f64, y: f64) -> Place {
        Place {
            mu: value(x, SMALLEST_COSINE, self.least_mu),
            alpha: alpha_at(y).min(self.most_alpha),
        }
    }

    fn within(&self, mu: f64, alpha: f64) -> Place {
        let mu = if mu < SMALLEST_COSINE { self.least_mu } else { mu.min(1.0) };
        Place { mu, alpha: alpha.clamp(SMALLEST_ALPHA, self.most_alpha) }
    }

    /// The i-th start: crowded at all edges, spread like a table's texels, or where the integrals
    /// have a layer or rules a limit.
    pub fn start(&mut self, i: usize) -> Place {
        // A fortieth of the coordinates lies beyond either end: on the edge itself.
        let (x, y) = (self.random.between(-1.05, 1.05), self.random.between(-1.05, 1.05));
        let (u, r) = (self.random.next(), self.random.next());
        let (crowded, few) = (self.at(x, y), libm::exp10(self.random.between(-3.0, 3.0)));
        match i % 8 {
            // The critical angle, and twice its cosine, where it meets the horizon.
            1..3 if self.critical > 0.0 => {
                let at = if i % 8 == 1 { self.critical } else { 2.0 * self.critical };
                let off = libm::exp10(self.random.between(-15.0, -0.3)).copysign(u - 0.5);
                self.within((at * (1.0 + off)).max(0.0), crowded.alpha)
            }
            0..3 => crowded,
            3 => self.within(u, self.most_alpha * r * r),
            // From the n·v on where bounds are narrower.
            4 if u < 0.5 => self.within(GRAZING * few.max(few.recip()), self.most_alpha * r * r),
            4 => self.within(crowded.mu, self.most_alpha * r * r),
            // n·v ~ α, where shadows begin; n·v ~ √α, where Charlie's ring touches the horizon; sin
            // θ_v ~ α, where a lobe stands around the normal.
            5 if u < 0.5 => self.within(crowded.alpha * few, crowded.alpha),
            5 => self.within(crowded.alpha.sqrt() * few, crowded.alpha),
            6 => self.within(1.0 - (crowded.alpha * few) * (crowded.alpha * few), crowded.alpha),
            _ => {
                let limits = &self.limits;
                let limit = limits[(r * limits.len() as f64) as usize % limits.len()];
                let off = libm::exp10(self.random.between(-12.0, -1.0));
                self.within(crowded.mu, limit * (1.0 + off.copysign(u - 0.5)))
            }
        }
    }

    /// A step from a place: of any length from 1e-6 to 0.3 of the coordinates, along either or
    /// both.
    pub fn near(&mut self, place: Place) -> Place {
        let [x, y] = place.coordinates();
        let length = libm::exp10(self.random.between(-6.0, -0.5));
        let (dx, dy) = (self.random.between(-length, length), self.random.between(-length, length));
        match (3.0 * self.random.next()) as usize {
            0 => Place { mu: self.at(x + dx, y).mu, ..place },
            1 => Place { alpha: self.at(x, y + dy).alpha, ..place },
            _ => self.at(x + dx, y + dy),
        }
    }

    /// A whole number of [from, to).
    pub fn pick(&mut self, from: usize, to: usize) -> usize {
        (from + (self.random.next() * (to - from) as f64) as usize).min(to - 1)
    }
}

/// Numbers in [0, 1): Knuth's linear congruential generator, its upper 53 bits.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// The α at which bounds change, and those at the ends of the pieces of interpolants.
fn limits() -> Vec<f64> {
    let mut limits = vec![CHARLIE_LIMIT, WIDE_LAYER, BLINN_PHONG_LIMIT];
    for rule in RULES {
        if let Method::Interpolant(rule) = rule.method {
            let ends = rule.pieces.iter().map(|piece| piece.end);
            limits.extend(ends.chain([rule.start]).map(|roughness| roughness * roughness));
        }
    }
    limits
}
