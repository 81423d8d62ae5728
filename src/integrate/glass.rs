//! The integrals of a rough interface over half vectors in polar coordinates about n, for CPU and
//! device: as in [`super::half_vectors`], with transmission, and with pieces that meet where a ring
//! of half vectors touches the critical angle or where refracted light meets the horizon.
//!
//! With τ = tan θ_h = width · y, ch = cos θ_h, and φ the azimuth of h from the plane of v, c = v·h
//! = ch (μ + sv τ cos φ), and
//!
//! E = ∫ y P(y) dy ∫ 4 (c/ch) w(c) (G₂/(4μ)) dφ, w = F for reflection and 1 - F for transmission.
//!
//! *Rings.* With C = cos(φ/2), every cosine on a ring is a + 2b C², and vanishes where C² = C_j²:
//! n·l of reflection at C_m², c less the cosine of the critical angle at C_c², and c less the least
//! that still transmits at C_l². In t = tan(φ/4), C - C_j = 2 (t_j² - t²)/((1+t²)(1+t_j²)), which
//! does not cancel where t_j is an end of the interval. 1 - F falls like the root of that distance
//! from the critical angle: t = t_j (1 - (1-v)²) makes it smooth.
//!
//! Closures over nodes are `inline(always)`: whatever the compiler leaves as a function of its
//! own has none of the instructions that [`crate::numeric::lanes::vectorised`] chose.
//!
//! *Pieces* meet at the slopes tan θ_h where
//!
//! - θ_h = (π/2 - θ_v)/2: reflected light touches the horizon; it ends at (π/2 + θ_v)/2;
//! - θ_h = |θ_v - θ_c| and θ_v + θ_c: the ring touches the critical angle θ_c;
//! - cos θ_h = μ/(2 cos θ_c): the horizon meets the critical angle, for reflection;
//! - cos θ_h = μ/cos θ_c, and tan θ_h = (sv - η)/μ: the same for transmission;
//! - θ_h = π/2 - θ_v: the ring reaches c = 0, for transmission from the thinner side.

mod nodes;
pub mod ring;

pub use self::nodes::{Counts, GlassNodes, GlassRule};

use self::nodes::ExitNodes;
use self::ring::{Ring, SMALLEST_SWING, Zero, beyond, cosine_at, either, interval, zero_at};
use super::Integrals;
use super::half_vectors::{TAIL_DEPTH, radial_weight};
use crate::brdf::fresnel::{SMALLEST_ROOT, reflectance_from};
use crate::brdf::interface::{Interface, Side};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::slope_map::{slope_at, slope_interval};

/// R and T at n·v = `mu` in [0, 1] and `alpha` in (0, 1]; `from_critical` is μ less the cosine of
/// the critical angle.
#[inline(always)]
pub fn glass<R: Real>(
    interface: Interface,
    mu: R,
    from_critical: R,
    alpha: R,
    nodes: &GlassNodes,
) -> Integrals<2, R> {
    let view = view_of(interface, mu, from_critical, alpha);
    let reflected = view.pieces(
        view.reflected_breaks(),
        &nodes.reflected,
        #[inline(always)]
        |view, ring, nodes| view.reflected_ring(ring, nodes),
    );
    let transmitted = view.pieces(
        view.transmitted_breaks(),
        &nodes.transmitted,
        #[inline(always)]
        |view, ring, nodes| view.transmitted_ring(ring, nodes),
    );
    Integrals([reflected, transmitted])
}

/// The quantities that are the same for all half vectors.
#[derive(Clone, Copy)]
pub struct View<R> {
    interface: Interface,
    mu: R,
    sv: R,
    from_critical: R,
    alpha: R,
    area_v: R,
    /// η² - 1
    k: R,
    eta: R,
    /// The cosine of the critical angle.
    critical: R,
}

/// How near beyond the last azimuth, as a share of the interval in C², the root of 1 - F counts as
/// at it: found by trial, and of little account from 0.03 to 3.
const NEAR: f64 = 0.3;

/// The slope of a half vector on the horizon, scaled or not.
const FAR: f64 = 1e18;

/// tan of an angle with this sine and cosine, at most `FAR`, which stands for all beyond.
#[inline(always)]
pub fn tangent<R: Real>(sine: R, cosine: R) -> R {
    let (zero, far) = (R::from(0.0), R::from(FAR));
    let tangent = (sine / cosine.max(R::from(SMALLEST_SWING))).min(far);
    zero.select_below(cosine, tangent, far)
}

/// The view at n·v = `mu`: see [`glass`].
#[inline(always)]
pub fn view_of<R: Real>(interface: Interface, mu: R, from_critical: R, alpha: R) -> View<R> {
    View {
        interface,
        mu,
        sv: (mu.complement() * (mu + 1.0)).sqrt(),
        from_critical,
        alpha,
        area_v: interface.lobe().masking_projected_area(mu, alpha),
        k: R::from(interface.k()),
        eta: R::from(interface.eta()),
        critical: R::from(interface.critical()),
    }
}

impl<R: Real> View<R> {
    /// tan |θ_v - θ_c| and tan(θ_v + θ_c).
    #[inline(always)]
    pub fn touches(&self) -> [R; 2] {
        let View { mu, sv, from_critical, eta, critical, .. } = *self;
        let sum = sv * critical + mu * eta;
        // sin(θ_v - θ_c), from the difference of the squared cosines.
        let sine = from_critical * (mu + critical) / sum;
        [tangent(sine.abs(), mu * critical + sv * eta), tangent(sum, mu * critical - sv * eta)]
    }

    /// The slopes tan θ_h between pieces of reflection, the first and the last included.
    #[inline(always)]
    pub fn reflected_breaks(&self) -> [R; 6] {
        let View { mu, sv, critical, .. } = *self;
        let (zero, full) = (R::from(0.0), mu / (sv + 1.0));
        let end = tangent(sv + 1.0, mu);
        match self.interface.side() {
            Side::Outside => [zero, full, full, full, full, end],
            Side::Inside => {
                let [near, far] = self.touches();
                let twice = critical * 2.0;
                let meeting = ((twice - mu) * (twice + mu)).max(zero).sqrt() / mu.max(zero);
                sorted(zero, [full, near, far, meeting], end)
            }
        }
    }

    /// The same of transmission.
    #[inline(always)]
    pub fn transmitted_breaks(&self) -> [R; 6] {
        let View { mu, sv, from_critical, eta, critical, .. } = *self;
        let (zero, far) = (R::from(0.0), R::from(FAR));
        match self.interface.side() {
            Side::Outside => {
                let upright = tangent(mu, sv);
                [zero, upright, upright, upright, upright, far]
            }
            Side::Inside => {
                let [near, last] = self.touches();
                // sv - η, from the difference of the squared cosines.
                let below = -(from_critical * (mu + critical)) / (sv + eta);
                let horizon = tangent(below.max(zero), mu);
                let meeting = tangent(((critical - mu) * (critical + mu)).max(zero).sqrt(), mu);
                // Beyond the critical angle nothing is transmitted up to |θ_v - θ_c|.
                let start = from_critical.select_below(zero, near, zero);
                sorted(start, [near, horizon, meeting, meeting], last)
            }
        }
    }

    /// The integral over slopes: that over the azimuths of every ring.
    #[inline(always)]
    fn pieces(
        &self,
        breaks: [R; 6],
        nodes: &ExitNodes,
        azimuths: impl Fn(&Self, Ring<R>, &ExitNodes) -> R,
    ) -> R {
        let lobe = self.interface.lobe();
        let width = lobe.ndf.width(self.alpha);
        let end = lobe.ndf.slope_end(self.alpha, TAIL_DEPTH);
        let zero = R::from(0.0);
        let mut sum = zero;
        for ends in breaks.windows(2) {
            let [first, last] = [ends[0], ends[1]].map(|tau| (tau / width).min(end));
            let length = last - first;
            if !length.any(|length| length > 0.0) {
                continue;
            }
            let interval = slope_interval(first, last, nodes.power);
            let mut part = zero;
            for node in &nodes.slopes {
                let slope = slope_at(node.at, interval, nodes.power);
                let ring = self.ring_at(width * slope.y);
                let weight = radial_weight(lobe, self.alpha, slope.dy * node.weight, slope.y);
                part = part + weight * (ring.secant * azimuths(self, ring, nodes));
            }
            sum = sum + zero.select_below(length, part, zero);
        }
        sum * 4.0
    }

    /// The ring of half vectors with this slope.
    #[inline(always)]
    pub fn ring_at(&self, tau: R) -> Ring<R> {
        let secant = (tau * tau + 1.0).sqrt();
        let sine = tau / secant;
        Ring {
            secant,
            middle: self.mu / secant,
            swing: (self.sv * sine).max(R::from(SMALLEST_SWING)),
            versine: sine * (tau / (secant + 1.0)),
        }
    }

    /// Where c is that of the critical angle.
    #[inline(always)]
    pub fn critical_zero(&self, ring: Ring<R>) -> Zero<R> {
        let below = self.mu * ring.versine - self.from_critical;
        zero_at(ring.swing * 2.0, (below / ring.swing + 1.0) * 0.5)
    }

    /// c G₂/(4μ) of reflection towards n·l = `x`.
    #[inline(always)]
    pub fn seen(&self, ring: Ring<R>, x: R) -> R {
        let View { interface, mu, area_v, alpha, .. } = *self;
        let x = x.max(R::from(0.0)).min(R::from(1.0));
        let visible = interface.lobe().cosine_visibility_at(x, mu, area_v, alpha);
        (x + mu) * ring.secant * 0.5 * visible
    }

    /// c (1 - F) G₂/(4μ) of transmission at c with g² = k + c².
    #[inline(always)]
    pub fn passed(&self, ring: Ring<R>, c: R, g2: R) -> R {
        let View { interface, mu, area_v, alpha, k, eta, .. } = *self;
        let g = g2.max(R::from(0.0)).sqrt();
        let sum = (c + g).max(R::from(SMALLEST_ROOT));
        let x = (mu + k / (sum * ring.secant)) / eta;
        let least = if interface.counts_wrong_side() { -x } else { R::from(0.0) };
        let x = x.max(least).min(R::from(1.0));
        c * self.transmittance(c, g) * interface.transmitted_visibility(x, mu, area_v, alpha)
    }

    /// ∫ c F (G₂/(4μ)) dφ
    #[inline(always)]
    pub fn reflected_ring(&self, ring: Ring<R>, nodes: &ExitNodes) -> R {
        let View { mu, k, critical, .. } = *self;
        let (zero, one) = (R::from(0.0), R::from(1.0));
        // n·l = 2c/secant - μ
        let light = ring.swing * 2.0 / ring.secant;
        let below = (mu - ring.middle * 2.0 / ring.secant) / light;
        let horizon = zero_at(light * 2.0, (below + 1.0) * 0.5);
        match self.interface.side() {
            Side::Outside => interval(
                horizon.t2,
                &nodes.even,
                #[inline(always)]
                |azimuth, rest| {
                    let x = cosine_at(horizon, azimuth, rest);
                    let c = (x.max(zero) + mu) * ring.secant * 0.5;
                    self.seen(ring, x) * self.reflectance(c, k + c * c)
                },
            ),
            Side::Inside => {
                let cone = self.critical_zero(ring);
                let t2 = cone.t2.min(horizon.t2);
                // The cone cuts the ring inside of the horizon.
                let root = zero.select_below(cone.square, one, zero)
                    * horizon.square.select_below(cone.square, one, zero);
                let part = either(
                    root,
                    t2,
                    &nodes.root,
                    &nodes.even,
                    #[inline(always)]
                    |azimuth, rest| {
                        let above = cosine_at(cone, azimuth, (cone.t2 - t2) + rest);
                        let c = above + critical;
                        let f = self.reflectance(c, above * (c + critical));
                        self.seen(ring, cosine_at(horizon, azimuth, (horizon.t2 - t2) + rest)) * f
                    },
                );
                part + self.reflected_whole(ring, t2, horizon, nodes)
            }
        }
    }

    /// The same from t² = `t2` to the horizon, where light is reflected whole.
    #[inline(always)]
    pub fn reflected_whole(&self, ring: Ring<R>, t2: R, horizon: Zero<R>, nodes: &ExitNodes) -> R {
        beyond(
            t2,
            horizon.t2,
            nodes,
            #[inline(always)]
            |azimuth| self.seen(ring, cosine_at(horizon, azimuth, horizon.t2 - azimuth.t2)),
        )
    }

    /// ∫ c (1 - F) (G₂/(4μ)) dφ
    #[inline(always)]
    pub fn transmitted_ring(&self, ring: Ring<R>, nodes: &ExitNodes) -> R {
        let View { mu, k, critical, .. } = *self;
        let (zero, one) = (R::from(0.0), R::from(1.0));
        match self.interface.side() {
            Side::Outside => {
                let grazing = zero_at(ring.swing * 2.0, (one - ring.middle / ring.swing) * 0.5);
                interval(
                    grazing.t2,
                    &nodes.even,
                    #[inline(always)]
                    |azimuth, rest| {
                        let c = cosine_at(grazing, azimuth, rest).max(zero);
                        self.passed(ring, c, k + c * c)
                    },
                )
            }
            Side::Inside => {
                let cone = self.critical_zero(ring);
                // x > 0 where c > (κ² + cos²θ_c)/(2κ), κ = μ/cos θ_h, which lies this far above
                // cos θ_c where κ is below it.
                let kappa = mu * ring.secant;
                // Whoever counts what leaves on the wrong side has no horizon.
                let limited = !self.interface.counts_wrong_side();
                let lack = if limited { (critical - kappa).max(zero) } else { zero };
                let lift = lack * lack / (kappa.max(R::from(SMALLEST_SWING)) * 2.0);
                let limit = zero_at(cone.scale, cone.square + lift / cone.scale);
                let near = cone.scale * limit.square.complement() * NEAR;
                let root =
                    zero.select_below(limit.square, one, zero) * near.select_below(lift, zero, one);
                either(
                    root,
                    limit.t2,
                    &nodes.root,
                    &nodes.even,
                    #[inline(always)]
                    |azimuth, rest| {
                        let above = cosine_at(limit, azimuth, rest) + lift;
                        let c = above + critical;
                        self.passed(ring, c, above * (c + critical))
                    },
                )
            }
        }
    }

    /// F at c with g² = k + c².
    #[inline(always)]
    pub fn reflectance(&self, c: R, g2: R) -> R {
        // On the last ring c may round beyond 1.
        let s2 = c.complement().max(R::from(0.0)) * (c + 1.0);
        reflectance_from(c, g2, s2, self.k)
    }

    /// 1 - F
    #[inline(always)]
    pub fn transmittance(&self, c: R, g: R) -> R {
        let eta2 = self.k + 1.0;
        let floor = R::from(SMALLEST_ROOT);
        let (s, p) = ((c + g).max(floor), (eta2 * c + g).max(floor));
        let product = s * p;
        c * g * 2.0 * (p * p + eta2 * s * s) / (product * product)
    }
}

/// The ends of pieces from `start` to `end` with these breaks between, in ascending order.
#[inline(always)]
pub fn sorted<R: Real>(start: R, breaks: [R; 4], end: R) -> [R; 6] {
    let [a, b, c, d] = breaks.map(|at| at.max(start).min(end));
    let (a, b) = (a.min(b), a.max(b));
    let (c, d) = (c.min(d), c.max(d));
    let (first, low) = (a.min(c), a.max(c));
    let (high, last) = (b.min(d), b.max(d));
    [start, first, low.min(high), low.max(high), last, end.max(start)]
}
