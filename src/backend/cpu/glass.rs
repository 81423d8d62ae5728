//! Rough interfaces on the CPU.

use super::{Points, Work, in_groups};
use crate::brdf::Ndf;
use crate::brdf::interface::{Interface, TransmissionMasking};
use crate::integrate::Integrals;
use crate::integrate::double_exponential::DoubleExponentialRule;
use crate::integrate::glass::{GlassNodes, glass};
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::REFERENCE_NODES;
use crate::integrate::view_polar::{ViewPolarNodes, view_polar};
use crate::numeric::lanes::{self, F64x8, vectorised};

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
            Method::DoubleExponential(rule) => Nodes::AboutView(about_view(interface, rule)),
            Method::HalfVectors(_)
            | Method::LightDirections(_)
            | Method::LightPlanes(_)
            | Method::Rings(_)
            | Method::BentRings(_)
            | Method::Interpolant(_)
            | Method::ClosedForm => Nodes::AboutView(about_view(interface, REFERENCE_NODES)),
        };
        Glass { interface, nodes }
    }
}

/// The nodes about v: Gaussian tails take more of them in the outer variable, and in the inner one
/// where a beta function falls on their side of the horizon.
fn about_view(interface: Interface, rule: DoubleExponentialRule) -> ViewPolarNodes {
    let DoubleExponentialRule { outer, inner } = rule;
    let (outer, inner) = match (interface.lobe().ndf, interface.transmission()) {
        (Ndf::Ggx, _) => (outer, inner),
        (_, TransmissionMasking::Beta) => (outer * 7 / 5, inner * 6 / 5),
        (_, _) => (outer * 7 / 5, inner),
    };
    ViewPolarNodes::of(DoubleExponentialRule { outer, inner })
}

impl Work for Glass {
    fn integrate(&self, points: Points, integrals: &mut [f64]) {
        let lanes = |mu, alpha| vectorised(Group { work: self, mu, alpha });
        in_groups(points, integrals, lanes, |point, integrals| {
            self.interface.put_exact(point, integrals);
        });
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
