//! Rough interfaces on the CPU.

use super::{LANES, Points, Work, in_domain, scatter};
use crate::brdf::interface::Interface;
use crate::integrate::Integrals;
use crate::integrate::glass::{GlassNodes, glass};
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::REFERENCE_NODES;
use crate::integrate::view_polar::{ViewPolarNodes, view_polar};
use crate::numeric::lanes::{self, F64x8, vectorised};
use std::array::from_fn;

/// A rough interface by quadrature.
pub(super) struct Glass {
    interface: Interface,
    nodes: Nodes,
}

enum Nodes {
    AboutNormal(GlassNodes),
    AboutView(ViewPolarNodes),
}

impl Glass {
    /// By a rule; one that does not serve for it gives way to the reference.
    pub fn new(interface: Interface, rule: &Rule) -> Self {
        let nodes = match rule.method {
            Method::Glass(rule) => Nodes::AboutNormal(rule.nodes(interface.side())),
            Method::DoubleExponential(rule) => Nodes::AboutView(ViewPolarNodes::of(rule)),
            Method::HalfVectors(_)
            | Method::LightDirections(_)
            | Method::Interpolant(_)
            | Method::ClosedForm => Nodes::AboutView(ViewPolarNodes::of(REFERENCE_NODES)),
        };
        Glass { interface, nodes }
    }
}

impl Work for Glass {
    fn integrate(&self, points: Points, integrals: &mut [f64]) {
        let last = integrals.len() / 2 - 1;
        for (group, integrals) in integrals.chunks_mut(LANES * 2).enumerate() {
            let points: [(f64, f64); LANES] =
                from_fn(|i| points.get((group * LANES + i).min(last)));
            debug_assert!(points.iter().all(|&(mu, alpha)| in_domain(mu, alpha)), "{points:?}");
            // Any α will do in the lanes of mirrors.
            let alphas = points.map(|(_, alpha)| if alpha == 0.0 { 1.0 } else { alpha });
            let (mu, alpha) = (F64x8(points.map(|point| point.0)), F64x8(alphas));
            scatter(&vectorised(Group { work: self, mu, alpha }), integrals);
            for (integrals, (mu, alpha)) in integrals.chunks_exact_mut(2).zip(points) {
                let exact = self.interface.exact(mu, alpha);
                for (integral, exact) in integrals.iter_mut().zip(exact) {
                    *integral = exact.map_or(*integral, |exact| exact.value);
                }
            }
        }
    }

    fn shares_rows(&self) -> bool {
        false
    }
}

/// A group of as many points as there are lanes.
struct Group<'a> {
    work: &'a Glass,
    mu: F64x8,
    alpha: F64x8,
}

impl lanes::Work for Group<'_> {
    type Output = Integrals<2, F64x8>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Group { work, mu, alpha } = self;
        let from_critical = mu - work.interface.critical();
        match &work.nodes {
            Nodes::AboutNormal(nodes) => glass(work.interface, mu, from_critical, alpha, nodes),
            Nodes::AboutView(nodes) => view_polar(work.interface, mu, from_critical, alpha, nodes),
        }
    }
}
