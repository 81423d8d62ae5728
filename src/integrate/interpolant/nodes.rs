//! The nodes of the interpolants. But for s640, s960, s1344 and s2304, maps and pieces are those
//! that reach 1e-7 in E and 2e-9 in the rests with the fewest nodes, of ten to forty maps that were
//! tried for each distribution; those of uncoupled and implicit terms are sharper yet, where the
//! few nodes more cost less than the values that they decide.

use super::{Beyond, InterpolantRule, Layer, Map, Piece, SMOOTHEST, Source};
use crate::brdf::Masking::{self, HeightCorrelated, HeightCorrelatedApprox};
use crate::brdf::Ndf;
use crate::integrate::half_vectors::HalfVectorRule;
use crate::integrate::light_directions::LightDirectionRule;
use crate::integrate::light_planes::LightPlaneRule;
use crate::integrate::rules::{
    B2544_NODES, L512_NODES, L2048_NODES, L4608_NODES, P480_NODES, R976_NODES, crowded_nodes,
};
use crate::numeric::quadrature::slope_map::Power;

const fn map([compression, power]: [u32; 2], layer: Layer) -> Map {
    Map { compression, power, layer, cut: f64::INFINITY }
}

const fn piece(end: f64, [directions, roughnesses]: [usize; 2], map: Map, source: Source) -> Piece {
    Piece { end, directions, roughnesses, apart: true, map, source }
}

/// A piece whose polynomials go on over a break.
const fn across(piece: Piece) -> Piece {
    Piece { apart: false, ..piece }
}

/// For these distributions and masking terms, of E beyond its limit.
const fn of(
    distributions: &'static [Ndf],
    maskings: &'static [Masking],
    below: Source,
    pieces: &'static [Piece],
) -> InterpolantRule {
    let (start, beyond) = (SMOOTHEST, Beyond::Limit);
    InterpolantRule { start, below, pieces, distributions, maskings, beyond }
}

/// For GGX, of E itself, which polynomials do not follow with the implicit term, where it falls
/// with μ².
const fn whole(below: Source, pieces: &'static [Piece]) -> InterpolantRule {
    InterpolantRule { beyond: Beyond::Nothing, ..of(&[Ndf::Ggx], SMITH, below, pieces) }
}

/// Smith's terms and those that stand for them.
const SMITH: &[Masking] =
    &[HeightCorrelated, HeightCorrelatedApprox, Masking::Separable, Masking::SchlickSmith];
/// Of those, which couple both directions.
const COUPLED: &[Masking] = &[HeightCorrelated, HeightCorrelatedApprox];
/// Which do not.
const UNCOUPLED: &[Masking] = &[Masking::Separable, Masking::SchlickSmith];
const IMPLICIT: &[Masking] = &[Masking::Implicit];

const L512: Source = Source::LightDirections(L512_NODES);
const L1152: Source =
    Source::LightDirections(LightDirectionRule { slope: 48, azimuth: 24, power: Power::Two });
const L2048: Source = Source::LightDirections(L2048_NODES);
const L4608: Source = Source::LightDirections(L4608_NODES);
const P480: Source = Source::LightPlanes(P480_NODES);
const P768: Source = Source::LightPlanes(LightPlaneRule { slope: 48, azimuth: 16 });
const H2304: Source = Source::HalfVectors(HalfVectorRule {
    radial: 64,
    azimuth: 12,
    radial_horizon: 64,
    azimuth_horizon: 24,
    power: Power::Four,
    crowded: false,
});
const H800: Source = Source::HalfVectors(crowded_nodes([24, 10, 40, 14]));
const R976: Source = Source::Rings(R976_NODES);
const B2544: Source = Source::BentRings(B2544_NODES);

/// tanh(asinh(μ/α)/8)^½
const FEW: Map = map([3, 1], Layer::Alpha(1.0));
/// tanh(asinh(μ/4α)/8)^¼
const SOME: Map = map([3, 2], Layer::Alpha(4.0));
/// tanh(asinh(μ/2α)/8)^¼
const CLOSE: Map = map([3, 2], Layer::Alpha(2.0));
/// tanh(asinh(μ/2α)/8)^½
const ALONE: Map = map([3, 1], Layer::Alpha(2.0));
/// tanh(asinh(μ/α)/16)^¼
const MANY: Map = map([4, 2], Layer::Alpha(1.0));
/// tanh(asinh(μ/2α)/4): a Gaussian leaves no term μ ln μ to resolve but where the lobe is wide.
const GAUSSIAN: Map = map([2, 0], Layer::Alpha(2.0));
/// tanh(asinh(μ/2α)/8): with the implicit term nothing is left that is not smooth.
const SMOOTH: Map = map([3, 0], Layer::Alpha(2.0));
/// tanh(asinh(μ/4α)/8)
const SMOOTH_GAUSSIAN: Map = map([3, 0], Layer::Alpha(4.0));
/// tanh(asinh(μ/8α)/8)^½, for Blinn-Phong where it is a low power.
const WIDE: Map = map([3, 1], Layer::Alpha(8.0));
/// tanh(asinh(μ/8√α)/8)^¼
const BENT_RING: Map = map([3, 2], Layer::RootAlpha(8.0));
/// The same up to μ = 16√α, where an albedo is 1e-14 of what it is at μ = 0.
const NARROW_BENT_RING: Map = Map { cut: 2.0, ..BENT_RING };
/// tanh(asinh(μ/16√α)/8)^¼
const RING: Map = map([3, 2], Layer::RootAlpha(16.0));
/// The same up to μ = 16√α.
const NARROW_RING: Map = Map { cut: 1.0, ..RING };
/// tanh(asinh(μ/2√α)/8)
const SMOOTH_RING: Map = map([3, 0], Layer::RootAlpha(2.0));
/// tanh(asinh(μ/16√α)/8)^½ up to μ = 16√α
const NARROW_SMOOTH_RING: Map = Map { cut: 1.0, ..map([3, 1], Layer::RootAlpha(16.0)) };
/// The roughness up to which 16√α is less than 1.
const NARROW: f64 = 0.0625;

/// The nodes of `s640`.
pub const S640_NODES: InterpolantRule = whole(L512, &[across(piece(1.0, [32, 20], FEW, L512))]);
/// The nodes of `s960`.
pub const S960_NODES: InterpolantRule =
    of(&[Ndf::Ggx], UNCOUPLED, L4608, &[piece(1.0, [40, 24], ALONE, L1152)]);
/// The nodes of `s1344`.
pub const S1344_NODES: InterpolantRule =
    of(&[Ndf::Ggx], COUPLED, L4608, &[piece(1.0, [48, 28], CLOSE, L1152)]);
/// The nodes of `s1440`.
pub const S1440_NODES: InterpolantRule =
    of(&[Ndf::Ggx], COUPLED, L4608, &[piece(1.0, [48, 30], SOME, L2048)]);
/// The nodes of `s1120`.
pub const S1120_NODES: InterpolantRule =
    of(&[Ndf::Ggx], UNCOUPLED, L4608, &[piece(1.0, [40, 28], ALONE, L2048)]);
/// The nodes of `s2304`.
pub const S2304_NODES: InterpolantRule = whole(L4608, &[across(piece(1.0, [64, 36], MANY, L4608))]);

/// The nodes of `s2080`.
pub const S2080_NODES: InterpolantRule = of(
    &[Ndf::Beckmann, Ndf::BeckmannWalter],
    SMITH,
    P768,
    &[
        piece(0.06, [48, 10], GAUSSIAN, P768),
        piece(0.3, [48, 16], GAUSSIAN, P768),
        piece(1.0, [32, 26], GAUSSIAN, P768),
    ],
);

/// The nodes of `s2560`.
pub const S2560_NODES: InterpolantRule = of(
    &[Ndf::BlinnPhong],
    SMITH,
    P768,
    &[
        piece(0.06, [48, 10], GAUSSIAN, P768),
        piece(0.3, [48, 16], GAUSSIAN, P768),
        piece(0.75, [32, 20], GAUSSIAN, P768),
        piece(1.0, [48, 14], SOME, H2304),
    ],
);

/// The nodes of `s1792`.
pub const S1792_NODES: InterpolantRule = of(
    &[Ndf::Charlie],
    &[Masking::Neubelt],
    R976,
    &[
        piece(NARROW, [48, 12], NARROW_RING, R976),
        piece(0.3, [48, 16], RING, R976),
        piece(1.0, [32, 14], RING, R976),
    ],
);

/// The nodes of `s1616`. On smooth rows next to nothing is seen from above the bend.
pub const S1616_NODES: InterpolantRule = InterpolantRule {
    // Below, the factor of the integrals, 1/√α, is that of the error too where n·v is large.
    start: 0.01,
    ..of(
        &[Ndf::Charlie],
        &[HeightCorrelated],
        B2544,
        &[
            across(piece(0.05, [64, 12], NARROW_BENT_RING, R976)),
            piece(0.3, [32, 16], BENT_RING, B2544),
            piece(1.0, [24, 14], BENT_RING, B2544),
        ],
    )
};

/// The nodes of `s896`.
pub const S896_NODES: InterpolantRule =
    of(&[Ndf::Ggx], IMPLICIT, L4608, &[piece(1.0, [32, 28], SMOOTH, L2048)]);

/// The nodes of `s1008`.
pub const S1008_NODES: InterpolantRule = of(
    &[Ndf::Beckmann],
    IMPLICIT,
    P480,
    &[
        piece(0.15, [24, 12], SMOOTH_GAUSSIAN, P480),
        piece(0.5, [24, 14], SMOOTH_GAUSSIAN, P480),
        piece(1.0, [24, 16], SMOOTH_GAUSSIAN, P480),
    ],
);

/// The nodes of `s1248`.
pub const S1248_NODES: InterpolantRule = of(
    &[Ndf::BlinnPhong],
    IMPLICIT,
    P480,
    &[
        piece(0.15, [24, 12], SMOOTH_GAUSSIAN, P480),
        piece(0.5, [24, 14], SMOOTH_GAUSSIAN, P480),
        piece(0.7, [24, 12], SMOOTH_GAUSSIAN, P480),
        piece(1.0, [24, 14], WIDE, H800),
    ],
);

/// The nodes of `s1360`.
pub const S1360_NODES: InterpolantRule = of(
    &[Ndf::Charlie],
    IMPLICIT,
    R976,
    &[
        piece(NARROW, [32, 12], NARROW_SMOOTH_RING, R976),
        piece(0.3, [40, 16], SMOOTH_RING, R976),
        piece(1.0, [24, 14], SMOOTH_RING, R976),
    ],
);
