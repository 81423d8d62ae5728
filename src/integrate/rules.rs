//! All rules, and what each promises.

use super::bounds::{Bounds, NONE, ShareOfB};
use super::h_space::HSpaceRule;
use super::l_space::LSpaceRule;
use super::reference::ReferenceRule;
use super::rule::{Method, Rule};
use super::surrogate::SurrogateRule;
use crate::quadrature::slope_map::Power;

/// For diffuse lobes, exact to rounding.
pub const CLOSED_FORM: Rule = Rule { name: "closed-form", method: Method::ClosedForm, bounds: Bounds::NONE };

/// The cheapest over half vectors.
pub const H56: Rule = h("h56", [8, 3, 8, 4], Power::Two, [1e-3, 2.5e-3, 3e-3, 2e-2], [6e-2, 6e-2]);
/// Over half vectors.
pub const H130: Rule = h("h130", [12, 5, 14, 5], Power::Four, [1e-4, 1e-4, 5e-4, 1e-3], [2e-2, 2e-2]);
/// Over half vectors.
pub const H288: Rule = h("h288", [16, 8, 20, 8], Power::Four, [1e-5, 1e-5, 1.5e-4, 4e-5], [3e-3, 3e-3]);
/// Over half vectors.
pub const H640: Rule = h("h640", [32, 10, 32, 10], Power::Four, [1.5e-6, 1e-6, 6e-5, 3e-6], [5e-5, 6e-4]);
/// Over half vectors.
pub const H1536: Rule = h("h1536", [48, 16, 48, 16], Power::Four, [1e-7, 1e-7, 1.2e-5, 1.5e-7], [4e-6, 2e-4]);
/// The finest over half vectors.
pub const H6144: Rule = h("h6144", [96, 32, 96, 32], Power::Four, [3e-9, 5e-10, 2e-6, 1e-9], [3e-6, 3e-5]);

/// Double exponential, the cheapest.
pub const D6144: Rule = d("d6144", [64, 48], [5e-7, NONE], [ShareOfB::of(1e-6, 1e-12), ShareOfB::of(1.5e-6, 1e-12)]);
/// Double exponential: the last stage of certification before the reference.
pub const D10240: Rule = d("d10240", [80, 64], [6e-9, NONE], [ShareOfB::of(4e-8, 1e-12), ShareOfB::of(7e-8, 1e-12)]);
/// The rule that tables are measured against.
pub const REFERENCE: Rule = d("reference", [160, 150], [1e-13, 2e-6], [ShareOfB::of(3e-12, 3e-24); 2]);
/// The rule that tables by [`REFERENCE`] itself are measured against.
pub(super) const FINER_REFERENCE: Rule = d("reference", [240, 220], [1e-13, 2e-6], [ShareOfB::of(3e-12, 3e-24); 2]);

/// Over directions of light, the cheapest.
pub const L288: Rule = l("l288", L288_NODES, 3e-5, ShareOfB::NONE);
/// Over directions of light; what [`S640`] takes.
pub const L512: Rule = l("l512", L512_NODES, 1e-5, ShareOfB::NONE);
/// Over directions of light, the finest; what [`S2304`] takes.
pub const L4608: Rule = l("l4608", L4608_NODES, 5e-9, ShareOfB::of(8e-8, 1e-12));

/// Interpolated, the cheaper.
pub const S640: Rule = s("s640", [32, 20], Power::Two, L512_NODES, 1e-5, ShareOfB::NONE);
/// Interpolated, the finer: the first stage of certification.
pub const S2304: Rule = s("s2304", [64, 36], Power::Four, L4608_NODES, 3e-8, ShareOfB::of(8e-8, 3e-11));

/// All of them.
pub const RULES: [Rule; 15] =
    [CLOSED_FORM, H56, H130, H288, H640, H1536, H6144, D6144, D10240, REFERENCE, L288, L512, L4608, S640, S2304];

const L288_NODES: LSpaceRule = LSpaceRule { slope: 24, azimuth: 12, power: Power::Two };
const L512_NODES: LSpaceRule = LSpaceRule { slope: 32, azimuth: 16, power: Power::Two };
const L4608_NODES: LSpaceRule = LSpaceRule { slope: 96, azimuth: 48, power: Power::Four };

/// A rule over half vectors; `bounds` are of GGX, Beckmann, Beckmann with Walter's term and Blinn-Phong, `charlie`
/// without and with its fitted Λ. Above its limit Charlie errs as little with it as without.
const fn h(name: &'static str, nodes: [usize; 4], power: Power, bounds: [f64; 4], charlie: [f64; 2]) -> Rule {
    let [radial, azimuth, radial_horizon, azimuth_horizon] = nodes;
    let rule = HSpaceRule { radial, azimuth, radial_horizon, azimuth_horizon, power };
    let [ggx, beckmann, beckmann_walter, blinn_phong] = bounds;
    let [charlie, charlie_fitted] = charlie;
    let (charlie_above_limit, none) = (charlie, Bounds::NONE);
    let bounds =
        Bounds { ggx, beckmann, beckmann_walter, blinn_phong, charlie, charlie_fitted, charlie_above_limit, ..none };
    Rule { name, method: Method::HSpace(rule), bounds }
}

/// A double exponential rule: as sharp for one lobe as for any other, but for Charlie below its limit and Charlie's B
/// above it, whose bounds stand second.
const fn d(name: &'static str, nodes: [usize; 2], bounds: [f64; 2], of_b: [ShareOfB; 2]) -> Rule {
    let rule = ReferenceRule { outer: nodes[0], inner: nodes[1] };
    let ([bound, charlie], [of_b, of_b_of_charlie]) = (bounds, of_b);
    let bounds = Bounds { charlie, charlie_fitted: charlie, of_b_of_charlie, ..Bounds::same(bound, of_b) };
    Rule { name, method: Method::Reference(rule), bounds }
}

const fn l(name: &'static str, rule: LSpaceRule, bound: f64, of_b: ShareOfB) -> Rule {
    Rule { name, method: Method::LSpace(rule), bounds: Bounds::ggx_alone(bound, of_b) }
}

const fn s(
    name: &'static str,
    nodes: [usize; 2],
    power: Power,
    source: LSpaceRule,
    bound: f64,
    of_b: ShareOfB,
) -> Rule {
    let rule = SurrogateRule { directions: nodes[0], roughnesses: nodes[1], power, source };
    Rule { name, method: Method::Surrogate(rule), bounds: Bounds::ggx_alone(bound, of_b) }
}
