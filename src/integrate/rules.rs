//! All rules: names and numbers of nodes. Their bounds stand in [`super::bounds`], one column for
//! each.

use super::bent_rings::BentRingRule;
use super::bounds::{Bound, Columns, NONE, all};
use super::double_exponential::DoubleExponentialRule;
use super::glass::{Counts, GlassRule};
use super::half_vectors::HalfVectorRule;
use super::interpolant::InterpolantRule;
use super::interpolant::nodes::{
    S640_NODES, S896_NODES, S960_NODES, S1008_NODES, S1120_NODES, S1248_NODES, S1344_NODES,
    S1360_NODES, S1440_NODES, S1616_NODES, S1792_NODES, S2080_NODES, S2304_NODES, S2560_NODES,
};
use super::light_directions::LightDirectionRule;
use super::light_planes::LightPlaneRule;
use super::rings::RingRule;
use super::rule::{Method, Rule};
use crate::numeric::quadrature::slope_map::Power;

/// For diffuse lobes, exact to rounding.
pub const CLOSED_FORM: Rule = rule("closed-form", Method::ClosedForm, |_| NONE);

/// The cheapest over half vectors.
pub const H56: Rule =
    rule("h56", Method::HalfVectors(nodes([8, 3, 8, 4], Power::Two)), |bounds| bounds.h56);
/// Over half vectors.
pub const H130: Rule =
    rule("h130", Method::HalfVectors(nodes([12, 5, 14, 5], Power::Four)), |bounds| bounds.h130);
/// Over half vectors.
pub const H288: Rule = rule("h288", Method::HalfVectors(H288_NODES), |bounds| bounds.h288);
/// Over half vectors.
pub const H640: Rule = rule("h640", Method::HalfVectors(H640_NODES), |bounds| bounds.h640);
/// Over half vectors.
pub const H1536: Rule =
    rule("h1536", Method::HalfVectors(nodes([48, 16, 48, 16], Power::Four)), |bounds| bounds.h1536);
/// The finest over half vectors for any lobe.
pub const H6144: Rule =
    rule("h6144", Method::HalfVectors(nodes([96, 32, 96, 32], Power::Four)), |bounds| bounds.h6144);

/// Over half vectors that crowd where the lobe is cut, for Blinn-Phong where it is a low power.
pub const H1152: Rule =
    rule("h1152", Method::HalfVectors(crowded_nodes([32, 12, 48, 16])), |bounds| bounds.h1152);

/// Double exponential, the cheapest.
pub const D6144: Rule = double_exponential("d6144", [64, 48], |bounds| bounds.d6144);
/// Double exponential: the last stage of certification before the reference where no rule of a
/// lobe's own is finer.
pub const D10240: Rule = double_exponential("d10240", [80, 64], |bounds| bounds.d10240);
/// The rule that tables are measured against.
pub const REFERENCE: Rule =
    rule("reference", Method::DoubleExponential(REFERENCE_NODES), |bounds| bounds.reference);
/// The nodes of [`REFERENCE`].
pub const REFERENCE_NODES: DoubleExponentialRule = DoubleExponentialRule { outer: 160, inner: 150 };
/// The rule that tables by [`REFERENCE`] itself are measured against.
pub(super) const FINER_REFERENCE: Rule =
    double_exponential("reference", [240, 220], |bounds| bounds.reference);
/// The reference of glass with fewer nodes.
pub(super) const COARSE_REFERENCE: Rule =
    double_exponential("coarse reference", [96, 90], |_| all(COARSE_ERROR));
/// By how much it errs at the most; 1.8e-8 was seen, with Beckmann's distribution from inside.
pub const COARSE_ERROR: f64 = 5e-8;

/// Glass, the cheapest.
pub const G112: Rule = glass_rule(
    "g112",
    GlassRule {
        outside: [Counts::few([7, 4, 1]), Counts::few([7, 4, 1])],
        inside: [Counts::few([7, 4, 3]), Counts::few([7, 4, 1])],
    },
    |bounds| bounds.g112,
);
/// Glass.
pub const G560: Rule = glass_rule(
    "g560",
    GlassRule {
        outside: [Counts::crowded([20, 8, 1], Power::Two), Counts::crowded([20, 6, 1], Power::Two)],
        inside: [Counts::crowded([14, 9, 7], Power::Two), Counts::crowded([14, 7, 1], Power::Two)],
    },
    |bounds| bounds.g560,
);
/// Glass.
pub const G904: Rule = glass_rule(
    "g904",
    GlassRule {
        outside: [
            Counts::crowded([27, 10, 1], Power::Two),
            Counts::crowded([26, 7, 1], Power::Two),
        ],
        inside: [
            Counts::crowded([18, 12, 10], Power::Two),
            Counts::crowded([18, 11, 1], Power::Two),
        ],
    },
    |bounds| bounds.g904,
);
/// Glass, the finest for devices.
pub const G2240: Rule = glass_rule(
    "g2240",
    GlassRule {
        outside: [
            Counts::crowded([40, 16, 1], Power::Two),
            Counts::crowded([40, 12, 1], Power::Two),
        ],
        inside: [
            Counts::crowded([26, 18, 15], Power::Two),
            Counts::crowded([26, 15, 1], Power::Two),
        ],
    },
    |bounds| bounds.g2240,
);
/// Glass: the last stage of certification before the reference.
pub const G4536: Rule = glass_rule(
    "g4536",
    GlassRule {
        outside: [
            Counts::crowded([54, 26, 1], Power::Four),
            Counts::crowded([54, 16, 1], Power::Four),
        ],
        inside: [
            Counts::crowded([46, 32, 28], Power::Four),
            Counts::crowded([46, 24, 1], Power::Four),
        ],
    },
    |bounds| bounds.g4536,
);

/// Over directions of light, the cheapest.
pub const L288: Rule = rule("l288", Method::LightDirections(L288_NODES), |bounds| bounds.l288);
/// Over directions of light; [`S640`] takes its integrals.
pub const L512: Rule = rule("l512", Method::LightDirections(L512_NODES), |bounds| bounds.l512);
/// Over directions of light; [`S1120`], [`S1440`] and [`S896`] take its integrals.
pub const L2048: Rule = rule("l2048", Method::LightDirections(L2048_NODES), |bounds| bounds.l2048);
/// Over directions of light, the finest; [`S2304`] takes its integrals, and those of certification
/// outside of their domain.
pub const L4608: Rule = rule("l4608", Method::LightDirections(L4608_NODES), |bounds| bounds.l4608);

/// Over planes of light directions, the cheaper; [`S1008`] takes its integrals.
pub const P480: Rule = rule("p480", Method::LightPlanes(P480_NODES), |bounds| bounds.p480);
/// Over planes of light directions, the finer.
pub const P1024: Rule = rule("p1024", Method::LightPlanes(P1024_NODES), |bounds| bounds.p1024);

/// About a ring, the cheapest.
pub const R456: Rule = ring("r456", ring_nodes([24, 16, 12, 6]), |bounds| bounds.r456);
/// About a ring; [`S1792`] takes its integrals.
pub const R976: Rule = ring("r976", R976_NODES, |bounds| bounds.r976);
/// About a ring.
pub const R1776: Rule = ring("r1776", ring_nodes([48, 32, 20, 12]), |bounds| bounds.r1776);
/// About a ring, the finest.
pub const R6080: Rule = ring("r6080", ring_nodes([88, 64, 28, 16]), |bounds| bounds.r6080);

/// About a ring with a bend; [`S1616`] takes its integrals.
pub const B2544: Rule = bent_ring("b2544", B2544_NODES, |bounds| bounds.b2544);
/// About a ring with a bend, the finest.
pub const B5920: Rule = bent_ring(
    "b5920",
    BentRingRule { first: [56, 42], middle: [32, 20, 32], last: [20, 12] },
    |bounds| bounds.b5920,
);

/// Interpolated, the cheapest for GGX.
pub const S640: Rule = interpolant("s640", S640_NODES, |bounds| bounds.s640);
/// Interpolated, for GGX with a term of each direction for itself: its first stage of certification
/// for few texels.
pub const S960: Rule = interpolant("s960", S960_NODES, |bounds| bounds.s960);
/// Interpolated, for GGX with such a term: its first stage of certification for many texels.
pub const S1120: Rule = interpolant("s1120", S1120_NODES, |bounds| bounds.s1120);
/// Interpolated, for GGX with a term that couples them: its first stage of certification for few
/// texels.
pub const S1344: Rule = interpolant("s1344", S1344_NODES, |bounds| bounds.s1344);
/// Interpolated, for GGX with such a term: its first stage of certification for many texels.
pub const S1440: Rule = interpolant("s1440", S1440_NODES, |bounds| bounds.s1440);
/// Interpolated, the finest for GGX.
pub const S2304: Rule = interpolant("s2304", S2304_NODES, |bounds| bounds.s2304);
/// Interpolated in pieces, for Beckmann: the first stage of certification.
pub const S2080: Rule = interpolant("s2080", S2080_NODES, |bounds| bounds.s2080);
/// Interpolated in pieces, for Blinn-Phong: the first stage of certification.
pub const S2560: Rule = interpolant("s2560", S2560_NODES, |bounds| bounds.s2560);
/// Interpolated in pieces, for Charlie with Neubelt's term: the first stage of certification.
pub const S1792: Rule = interpolant("s1792", S1792_NODES, |bounds| bounds.s1792);
/// Interpolated in pieces, for Charlie with its fitted term: the first stage of certification.
pub const S1616: Rule = interpolant("s1616", S1616_NODES, |bounds| bounds.s1616);
/// Interpolated, for GGX with the implicit term: the first stage of certification.
pub const S896: Rule = interpolant("s896", S896_NODES, |bounds| bounds.s896);
/// Interpolated in pieces, for Beckmann with it: the first stage of certification.
pub const S1008: Rule = interpolant("s1008", S1008_NODES, |bounds| bounds.s1008);
/// Interpolated in pieces, for Blinn-Phong with it: the first stage of certification.
pub const S1248: Rule = interpolant("s1248", S1248_NODES, |bounds| bounds.s1248);
/// Interpolated in pieces, for Charlie with it: the first stage of certification.
pub const S1360: Rule = interpolant("s1360", S1360_NODES, |bounds| bounds.s1360);

/// How many times as fine as a rule another has to be to be worth asking after it.
pub const FINER_BY: f64 = 1.5;

/// What decides the values that a first rule leaves undecided, in this order: of those that apply,
/// rules that are finer on some rows than all before.
pub const FINER: [Rule; 12] =
    [G904, G4536, L2048, L4608, P1024, H1152, R1776, R6080, B5920, D10240, REFERENCE, CLOSED_FORM];

/// Every rule.
pub const RULES: [Rule; 42] = [
    CLOSED_FORM,
    H56,
    H130,
    H288,
    H640,
    H1536,
    H6144,
    H1152,
    D6144,
    D10240,
    REFERENCE,
    L288,
    L512,
    L2048,
    L4608,
    P480,
    P1024,
    R456,
    R976,
    R1776,
    R6080,
    B2544,
    B5920,
    S640,
    S960,
    S1120,
    S1344,
    S1440,
    S2304,
    S2080,
    S2560,
    S1792,
    S1616,
    S896,
    S1008,
    S1248,
    S1360,
    G112,
    G560,
    G904,
    G2240,
    G4536,
];

/// The nodes of [`H288`].
pub const H288_NODES: HalfVectorRule = nodes([16, 8, 20, 8], Power::Four);
/// The nodes of [`H640`].
pub const H640_NODES: HalfVectorRule = nodes([32, 10, 32, 10], Power::Four);
const L288_NODES: LightDirectionRule =
    LightDirectionRule { slope: 24, azimuth: 12, power: Power::Two };
/// The nodes of [`L512`].
pub const L512_NODES: LightDirectionRule =
    LightDirectionRule { slope: 32, azimuth: 16, power: Power::Two };
/// The nodes of [`L2048`].
pub const L2048_NODES: LightDirectionRule =
    LightDirectionRule { slope: 64, azimuth: 32, power: Power::Four };
/// The nodes of [`L4608`].
pub const L4608_NODES: LightDirectionRule =
    LightDirectionRule { slope: 96, azimuth: 48, power: Power::Four };

/// The nodes of [`P480`].
pub const P480_NODES: LightPlaneRule = LightPlaneRule { slope: 40, azimuth: 12 };
const P1024_NODES: LightPlaneRule = LightPlaneRule { slope: 64, azimuth: 16 };

/// The nodes of [`R976`].
pub const R976_NODES: RingRule = ring_nodes([36, 24, 14, 8]);
/// The nodes of [`B2544`].
pub const B2544_NODES: BentRingRule =
    BentRingRule { first: [36, 24], middle: [24, 16, 16], last: [16, 9] };

type Column = fn(&Columns) -> Bound;

const fn rule(name: &'static str, method: Method, column: Column) -> Rule {
    Rule { name, method, column, promised: None }
}

const fn glass_rule(name: &'static str, nodes: GlassRule, column: Column) -> Rule {
    rule(name, Method::Glass(nodes), column)
}

const fn nodes(counts: [usize; 4], power: Power) -> HalfVectorRule {
    let [radial, azimuth, radial_horizon, azimuth_horizon] = counts;
    HalfVectorRule { radial, azimuth, radial_horizon, azimuth_horizon, power, crowded: false }
}

/// The same of slopes that crowd at both ends of the cut circle.
pub(super) const fn crowded_nodes(counts: [usize; 4]) -> HalfVectorRule {
    HalfVectorRule { crowded: true, ..nodes(counts, Power::Two) }
}

const fn ring(name: &'static str, nodes: RingRule, column: Column) -> Rule {
    rule(name, Method::Rings(nodes), column)
}

/// Radial nodes and azimuths where the horizon cuts the circle, then where it does not.
const fn ring_nodes(counts: [usize; 4]) -> RingRule {
    let [radial, azimuth, radial_full, azimuth_full] = counts;
    RingRule { radial, azimuth, radial_full, azimuth_full }
}

const fn bent_ring(name: &'static str, nodes: BentRingRule, column: Column) -> Rule {
    rule(name, Method::BentRings(nodes), column)
}

const fn double_exponential(
    name: &'static str,
    [outer, inner]: [usize; 2],
    column: Column,
) -> Rule {
    rule(name, Method::DoubleExponential(DoubleExponentialRule { outer, inner }), column)
}

const fn interpolant(name: &'static str, nodes: InterpolantRule, column: Column) -> Rule {
    rule(name, Method::Interpolant(nodes), column)
}
