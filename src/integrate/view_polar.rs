//! The integrals of a rough interface over half vectors in polar coordinates about v, by double
//! exponential quadrature in both variables: the reference of glass. It shares no variable, no
//! split of the domain and no rule with the one about the normal.
//!
//! With θ the angle of h from v, ψ its azimuth from the plane of n, c = cos θ and s = sin θ: h·n =
//! μc + sv s cos ψ, dω_h = s dθ dψ, and D being the density of half vectors
//!
//! E = ∫ 4 c s w(c) dθ ∫ D (G₂/(4μ)) dψ, w = F for reflection and 1 - F for transmission:
//!
//! F stands outside of the inner integral, and the critical angle is one end of a piece.
//!
//! Where: θ = θ_v + δ, p = tan(δ/2) = (width/2) sinh r about the facet that is the surface's own.
//! Every cosine that vanishes somewhere is written by the distance in p from where it does:
//! sin(θ_j - θ) = 2q/(1+q²) with q = (p_j - p)/(1 + p_j p).
//!
//! In ψ, tan(ψ/2) = k sinh r on a full circle, and sin(ψ/2) = k sinh r on a part of one, k being
//! the scale of D's peak.
//!
//! *Reflection.* n·l = x = μ cos 2θ + sv sin 2θ cos ψ > 0: all ψ below θ_1 = (π/2 - θ_v)/2, up to
//! ψ_m below θ_2 = (π/2 + θ_v)/2.
//!
//! *Transmission.* x = -n·l = (μ + (g - c) h·n)/η. From the thinner side it is never negative, and
//! h·n > 0 cuts the circle beyond θ = π/2 - θ_v. From the denser side θ ends at the critical angle,
//! and where tan θ > μη/(1 - η sv) the condition x > 0 cuts away what lies near n.

mod places;

use self::places::{Landmarks, Place};
use super::Integrals;
use super::double_exponential::DoubleExponentialRule;
use crate::brdf::fresnel::reflectance_from;
use crate::brdf::interface::{Interface, Side};
use crate::brdf::{Microfacet, Ndf};
use crate::integrate::half_vectors::TAIL_DEPTH;
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::tanh_sinh::{DeNode, half_line, tanh_sinh};
use crate::numeric::special::{exponential, hyperbolic_sine};

/// The nodes of a rule.
#[derive(Clone, Debug)]
pub struct ViewPolarNodes {
    outer: Vec<DeNode>,
    /// Of a full circle.
    circle: Vec<(f64, f64)>,
    /// Of a part of one.
    arc: Vec<DeNode>,
}

impl ViewPolarNodes {
    /// The nodes of a rule.
    pub fn of(rule: DoubleExponentialRule) -> Self {
        ViewPolarNodes {
            outer: tanh_sinh(rule.outer),
            circle: half_line(rule.inner, 4.085),
            arc: tanh_sinh(rule.inner),
        }
    }
}

/// R and T at n·v = `mu` in [0, 1] and `alpha` in (0, 1]; `from_critical` is μ less the cosine of
/// the critical angle, which both round.
#[inline(always)]
pub fn view_polar<R: Real>(
    interface: Interface,
    mu: R,
    from_critical: R,
    alpha: R,
    nodes: &ViewPolarNodes,
) -> Integrals<2, R> {
    let view = View::new(interface, mu, from_critical, alpha);
    let reflected = view.over(Exit::Reflected, nodes);
    let transmitted = view.over(Exit::Transmitted, nodes);
    Integrals([reflected, transmitted])
}

/// What becomes of the light.
#[derive(Clone, Copy, PartialEq)]
enum Exit {
    Reflected,
    Transmitted,
}

struct View<R> {
    interface: Interface,
    lobe: Microfacet,
    mu: R,
    sv: R,
    alpha: R,
    area_v: R,
    /// The unit of slopes.
    width: R,
    /// The places in p of what the formulas name.
    at: Landmarks<R>,
    /// |p| where the lobe ends.
    end: R,
}

impl<R: Real> View<R> {
    #[inline(always)]
    fn new(interface: Interface, mu: R, from_critical: R, alpha: R) -> Self {
        let lobe = interface.lobe();
        let one = R::from(1.0);
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        let width = lobe.ndf.width(alpha);
        let end = match lobe.ndf {
            Ndf::Ggx => one,
            _ => {
                let slope = width * lobe.ndf.slope_end(alpha, TAIL_DEPTH);
                (slope / ((slope * slope + 1.0).sqrt() + 1.0)).min(one)
            }
        };
        let at = Landmarks::new(interface, mu, from_critical, sv);
        let area_v = lobe.masking_projected_area(mu, alpha);
        View { interface, lobe, mu, sv, alpha, area_v, width, at, end }
    }

    /// One of the two integrals.
    #[inline(always)]
    fn over(&self, exit: Exit, nodes: &ViewPolarNodes) -> R {
        let at = self.at;
        let zero = R::from(0.0);
        let (breaks, last) = match (exit, self.interface.side()) {
            (Exit::Reflected, _) => ([zero, at.critical, at.full], at.cut),
            (Exit::Transmitted, Side::Outside) => ([zero, at.critical, at.upright], at.grazing),
            (Exit::Transmitted, Side::Inside) => {
                ([zero, at.horizon, at.upright], at.critical.min(at.grazing))
            }
        };
        let (start, end) = (at.first.max(-self.end), last.min(self.end));
        let [a, b, c] = breaks.map(|place| place.max(start).min(end));
        let (low, high) = (a.min(b), a.max(b));
        let ends = [start, low.min(c), low.max(high.min(c)), high.max(c), end];
        let mut sum = zero;
        for ends in ends.windows(2) {
            sum = sum + self.piece(exit, ends[0], ends[1], nodes);
        }
        sum
    }

    /// The integral from p = `start` to `end`; nothing where they are the same.
    #[inline(always)]
    fn piece(&self, exit: Exit, start: R, end: R, nodes: &ViewPolarNodes) -> R {
        let (zero, unit) = (R::from(0.0), self.width * 0.5);
        if !(end - start).any(|length| length > 0.0) {
            return zero;
        }
        let asinh = |p: R| p.zip(unit, |p, unit| libm::asinh(p / unit));
        let (r0, r1) = (asinh(start), asinh(end));
        let length = r1 - r0;
        let mut sum = zero;
        for node in &nodes.outer {
            let (from_start, to_end) = (length * node.from_start, length * node.to_end);
            let r = from_start.select_below(to_end, r0 + from_start, r1 - to_end);
            let gap = |d: R, middle: R| {
                unit * 2.0 * middle.zip(d, |m, d| libm::cosh(m) * libm::sinh(0.5 * d))
            };
            let p = unit * r.zip(r, |r, _| libm::sinh(r));
            let place = Place {
                p,
                start,
                end,
                from_start: gap(from_start, r0 + from_start * 0.5),
                to_end: gap(to_end, r1 - to_end * 0.5),
            };
            let value = match exit {
                Exit::Reflected => self.reflected(place, nodes),
                Exit::Transmitted => self.transmitted(place, nodes),
            };
            // dθ = 2 dp/(1 + p²)
            let dtheta =
                length * node.weight * unit * r.zip(r, |r, _| libm::cosh(r)) * 2.0 / (p * p + 1.0);
            sum = sum + zero.select_below(dtheta, dtheta * value, zero);
        }
        zero.select_below(length, sum, zero)
    }

    /// g² = k + c² at c = cos θ and s = sin θ.
    #[inline(always)]
    fn root2(&self, place: Place<R>, c: R, s: R) -> R {
        match self.interface.side() {
            Side::Outside => R::from(self.interface.k()) + c * c,
            Side::Inside => {
                // cos θ - cos θ_c = 2 sin(d/2) sin(θ + d/2), d = θ_c - θ.
                let q = place.half_tangent_to(self.at.critical);
                let difference = q * 2.0 * (s + c * q) / (q * q + 1.0);
                difference * (c + self.interface.critical())
            }
        }
    }

    #[inline(always)]
    fn reflected(&self, place: Place<R>, nodes: &ViewPolarNodes) -> R {
        let (s, c) = (-place.sine_to(self.at.first), place.sine_to(self.at.grazing));
        let g2 = self.root2(place, c, s);
        let f = reflectance_from(c, g2, s * s, R::from(self.interface.k()));
        let swing = self.sv * s * c * 4.0;
        let (low, high) = place.to_horizon(self.at, swing);
        let inner = self.azimuth(
            place.p,
            s,
            nodes,
            R::from(0.0),
            (low, high),
            #[inline(always)]
            |across, to_end| {
                let x = low.select_below(R::from(0.0), swing * to_end, low + swing * across);
                let x = x.max(R::from(0.0)).min(R::from(1.0));
                self.lobe.cosine_visibility_at(x, self.mu, self.area_v, self.alpha)
            },
        );
        c * s * f * 4.0 * inner
    }

    #[inline(always)]
    fn transmitted(&self, place: Place<R>, nodes: &ViewPolarNodes) -> R {
        let View { interface, mu, sv, .. } = *self;
        let (zero, tiny) = (R::from(0.0), R::from(f64::MIN_POSITIVE));
        let (eta, k) = (R::from(interface.eta()), R::from(interface.k()));
        let (s, c) = (-place.sine_to(self.at.first), place.sine_to(self.at.grazing));
        let g = self.root2(place, c, s).max(zero).sqrt();
        let (t, p) = ((g + c).max(tiny), (eta * eta * c + g).max(tiny));
        let passed = c * g * 2.0 * ((t * t).recip() + eta * eta / (p * p));
        // h·n = upright + 2 sv s cos²(ψ/2), from cos(θ - θ_v) down.
        let upright = place.sine_to(self.at.upright);
        let top = (place.p * place.p).complement() / (place.p * place.p + 1.0);
        let turn = k / t;
        let first = match interface.side() {
            Side::Outside => zero,
            // h·n where x = 0.
            Side::Inside => {
                let least = mu * t / (-k).max(tiny);
                ((top - least) / (least - upright).max(tiny)).max(zero)
            }
        };
        let swing = sv * s * 2.0;
        let inner = self.azimuth(
            place.p,
            s,
            nodes,
            first,
            (upright, top),
            #[inline(always)]
            |across, to_end| {
                let nh = upright.select_below(zero, swing * to_end, upright + swing * across);
                let x = ((mu + turn * nh) / eta).max(zero).min(R::from(1.0));
                interface.transmitted_visibility(x, mu, self.area_v, self.alpha)
            },
        );
        c * s * passed * 4.0 * inner
    }

    /// D of a half vector with this sin²(θ_h/2).
    #[inline(always)]
    fn density(&self, half: R) -> R {
        let w2 = self.width * self.width;
        let ch = (half * 2.0).complement().max(R::from(1e-35));
        let ch2 = ch * ch;
        let t = half * half.complement() * 4.0 / (ch2 * w2);
        self.lobe.ndf.slope_density(t, self.alpha) / (w2 * (ch2 * ch2))
    }

    /// ∫ D (G₂/(4μ)) dψ over the circle where tan²(ψ/2) is beyond `first`, and where low is
    /// negative below high/-low. `visible`: G₂/(4μ) at cos²(ψ/2), with the distance of sin²(ψ/2)
    /// from that end.
    #[inline(always)]
    fn azimuth(
        &self,
        p: R,
        s: R,
        nodes: &ViewPolarNodes,
        first: R,
        (low, high): (R, R),
        visible: impl Fn(R, R) -> R,
    ) -> R {
        let (zero, one, tiny) = (R::from(0.0), R::from(1.0), R::from(f64::MIN_POSITIVE));
        let w2 = self.width * self.width;
        let plane = p * p / (p * p + 1.0);
        let across = s * self.sv;
        // The tail of GGX is as wide as it is far from the peak.
        let (peak, tail) = match self.lobe.ndf {
            Ndf::Ggx => (w2 * 0.25 + plane, one),
            // sin²(ψ/2) where the lobe ends.
            _ => (w2 * 0.25, (w2 * (TAIL_DEPTH / 4.0) / across.max(tiny)).min(one)),
        };
        let k2 = peak / (peak + across);
        let k = k2.sqrt();
        let cut = (-low).max(first).max(tail.complement());
        let whole = cut.select_below(tiny, one, zero);
        let mut sum = zero;
        if whole.any(|whole| whole > 0.0) {
            for &(z, weight) in &nodes.circle {
                let z2 = k2 * (z * z);
                let cosine2 = (z2 + 1.0).recip();
                let density = self.density(plane + across * (z2 * cosine2));
                sum = sum + density * visible(cosine2, cosine2) * (cosine2 * weight);
            }
            sum = sum * k;
        }
        if whole.any(|whole| whole == 0.0) {
            // cos²(ψ/2) at the last azimuth.
            let last = zero.select_below(low, zero, low / (low - high)).max(zero).min(one);
            let to2 = last.complement().min(tail);
            let (from, to) = ((first / (first + 1.0)).max(zero).sqrt(), to2.sqrt());
            let beyond = last.complement() - to2;
            let asinh = |y: R| y.zip(k, |y, k| libm::asinh(y / k));
            let (r0, r1) = (asinh(from), asinh(to));
            let length = r1 - r0;
            let mut part = zero;
            for node in &nodes.arc {
                let (from_start, to_end) = (length * node.from_start, length * node.to_end);
                let r = from_start.select_below(to_end, r0 + from_start, r1 - to_end);
                let (e, half) = (exponential(r), hyperbolic_sine(to_end * 0.5));
                let (sinh, cosh) = ((e - e.recip()) * 0.5, (e + e.recip()) * 0.5);
                // sinh r1 - sinh r, without cancellation.
                let gap = half * 2.0 * (half * sinh + (half * half + 1.0).sqrt() * cosh);
                let y = k * sinh;
                let rest = beyond + k * gap * (y + to);
                let cosine2 = (last + rest).max(tiny);
                let dy = length * node.weight * k * cosh;
                let density = self.density(plane + across * (y * y));
                part = part + density * visible(cosine2, rest) * dy / cosine2.sqrt();
            }
            part = zero.select_below(length, part, zero);
            sum = zero.select_below(whole, sum, part);
        }
        // Either side of the plane, and dψ = 2 d(tan)/(1 + tan²) = 2 d(sin)/cos.
        sum * 4.0
    }
}
