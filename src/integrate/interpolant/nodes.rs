//! The nodes of the interpolants. But for s640 and s2304, maps and pieces are those that reach 1e-7
//! in E and 2e-9 in the rests (5e-10 in both for Charlie) with the fewest nodes, of some ten maps
//! that were tried for each distribution.

use super::{Beyond, InterpolantRule, Layer, Map, Piece, SMOOTHEST, Source};
use crate::brdf::Ndf;
use crate::integrate::half_vectors::HalfVectorRule;
use crate::integrate::light_directions::LightDirectionRule;
use crate::integrate::light_planes::LightPlaneRule;
use crate::integrate::rules::{L512_NODES, L4608_NODES, R1344_NODES};
use crate::numeric::quadrature::slope_map::Power;

const fn map([compression, power]: [u32; 2], layer: Layer) -> Map {
    Map { compression, power, layer }
}

const fn piece(end: f64, [directions, roughnesses]: [usize; 2], map: Map, source: Source) -> Piece {
    Piece { end, directions, roughnesses, map, source }
}

/// Of E beyond its limit.
const fn of(
    distributions: &'static [Ndf],
    below: Source,
    pieces: &'static [Piece],
) -> InterpolantRule {
    InterpolantRule { start: SMOOTHEST, below, pieces, distributions, beyond: Beyond::Limit }
}

/// Of E itself.
const fn whole(below: Source, pieces: &'static [Piece]) -> InterpolantRule {
    InterpolantRule { beyond: Beyond::Nothing, ..of(&[Ndf::Ggx], below, pieces) }
}

const L512: Source = Source::LightDirections(L512_NODES);
const L2048: Source =
    Source::LightDirections(LightDirectionRule { slope: 64, azimuth: 32, power: Power::Four });
const L4608: Source = Source::LightDirections(L4608_NODES);
const P768: Source = Source::LightPlanes(LightPlaneRule { slope: 48, azimuth: 16 });
const H2304: Source = Source::HalfVectors(HalfVectorRule {
    radial: 64,
    azimuth: 12,
    radial_horizon: 64,
    azimuth_horizon: 24,
    power: Power::Four,
});
const R1344: Source = Source::Rings(R1344_NODES);

/// tanh(asinh(μ/α)/8)^½
const FEW: Map = map([3, 1], Layer::Alpha(1.0));
/// tanh(asinh(μ/4α)/8)^¼
const SOME: Map = map([3, 2], Layer::Alpha(4.0));
/// tanh(asinh(μ/α)/16)^¼
const MANY: Map = map([4, 2], Layer::Alpha(1.0));
/// tanh(asinh(μ/2α)/4): a Gaussian leaves no term μ ln μ to resolve but where the lobe is wide.
const GAUSSIAN: Map = map([2, 0], Layer::Alpha(2.0));
/// tanh(asinh(μ/4√α)/8)^¼
const RING: Map = map([3, 2], Layer::RootAlpha(4.0));

/// The nodes of `s640`.
pub const S640_NODES: InterpolantRule = whole(L512, &[piece(1.0, [32, 20], FEW, L512)]);
/// The nodes of `s1440`.
pub const S1440_NODES: InterpolantRule =
    of(&[Ndf::Ggx], L4608, &[piece(1.0, [48, 30], SOME, L2048)]);
/// The nodes of `s2304`.
pub const S2304_NODES: InterpolantRule = whole(L4608, &[piece(1.0, [64, 36], MANY, L4608)]);

/// The nodes of `s2080`.
pub const S2080_NODES: InterpolantRule = of(
    &[Ndf::Beckmann, Ndf::BeckmannWalter],
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
    P768,
    &[
        piece(0.06, [48, 10], GAUSSIAN, P768),
        piece(0.3, [48, 16], GAUSSIAN, P768),
        piece(0.75, [32, 20], GAUSSIAN, P768),
        piece(1.0, [48, 14], SOME, H2304),
    ],
);

/// The nodes of `s2432`.
pub const S2432_NODES: InterpolantRule = InterpolantRule {
    // Below, a table has few rows and most of their values are 0.
    start: 0.03,
    ..of(
        &[Ndf::Charlie],
        R1344,
        &[
            piece(0.1, [64, 16], RING, R1344),
            piece(0.4, [48, 20], RING, R1344),
            piece(1.0, [32, 14], RING, R1344),
        ],
    )
};
