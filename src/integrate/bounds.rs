//! The largest error of each rule for each distribution of normals.
//!
//! Every bound is measured: `splitsum chart bounds` climbs towards the largest error from thousands
//! of starts, and the largest that it finds stays below the bound over [`MARGIN`] (docs/bounds.md).
//! A new distribution needs an arm of [`columns`] and the constants that it names: [`NONE`] for
//! rules that it is not to use.

mod charlie;
mod glass;

use self::charlie::charlie_columns;
pub use self::glass::{glass_columns, glass_layer};
use crate::brdf::{Masking, Microfacet, Ndf};

/// Below this α (roughness 0.07) Charlie's ring lies so near the horizon that the double
/// exponential rules but for the reference keep nothing.
pub const CHARLIE_LIMIT: f64 = 0.0049;

/// Above this α (roughness 0.7) Blinn-Phong falls like a low power of the slope, and the rules over
/// planes of light directions are given no bound; s2560 takes one's integrals up to 0.5625.
pub const BLINN_PHONG_LIMIT: f64 = 0.49;

/// From this α (roughness 0.1) on, where the layer at grazing is wide, rules for GGX and Charlie
/// are several times as sharp as below.
pub const WIDE_LAYER: f64 = 0.01;

/// From this n·v on, the centre of the first texel of 2,048, several bounds are narrower: below it
/// the layer at the horizon of terms that couple both directions, of Neubelt's and of a smooth GGX
/// is thinner than any rule's nodes lie apart.
pub const GRAZING: f64 = 1.0 / 4096.0;

/// Below this α (roughness 1e-5) the reference keeps 2e-6 of Charlie only, and nothing is known
/// better.
pub const CHARLIE_UNKNOWN: f64 = 1e-10;

/// A bound is at least this many times the largest error that a long search finds.
pub const MARGIN: f64 = 1.5;

/// The bounds of a rule's errors: absolute, or relative where an albedo exceeds 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The largest error of any integral.
    pub all: f64,
    /// A sharper bound for the integrals whose weights vanish at normal incidence (B), which span
    /// ten decades: at most `relative` of the integral and `absolute`. Infinite where there is
    /// none.
    pub relative: f64,
    /// The other part of it.
    pub absolute: f64,
}

impl Bound {
    /// The same for errors so many times as large.
    pub fn times(self, factor: f64) -> Self {
        let Bound { all, relative, absolute } = self;
        Bound { all: factor * all, relative: factor * relative, absolute: factor * absolute }
    }

    /// The same for the sum of two errors.
    pub fn plus(self, other: Self) -> Self {
        Bound {
            all: self.all + other.all,
            relative: self.relative + other.relative,
            absolute: self.absolute + other.absolute,
        }
    }
}

/// The bound of a rule that does not serve for a lobe.
pub const NONE: Bound = all(f64::INFINITY);

/// One bound for all integrals.
pub const fn all(all: f64) -> Bound {
    Bound { all, relative: f64::INFINITY, absolute: f64::INFINITY }
}

/// A bound for all integrals, and a sharper one for those that vanish at normal incidence.
pub const fn sharp(all: f64, relative: f64, absolute: f64) -> Bound {
    Bound { all, relative, absolute }
}

/// The bounds of all rules for one lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns {
    /// Over half vectors.
    pub h56: Bound,
    /// Over half vectors.
    pub h130: Bound,
    /// Over half vectors.
    pub h288: Bound,
    /// Over half vectors.
    pub h640: Bound,
    /// Over half vectors.
    pub h1536: Bound,
    /// Over half vectors.
    pub h6144: Bound,
    /// Over half vectors that crowd.
    pub h1152: Bound,
    /// Double exponential.
    pub d6144: Bound,
    /// Double exponential.
    pub d10240: Bound,
    /// Double exponential.
    pub reference: Bound,
    /// Over directions of light.
    pub l288: Bound,
    /// Over directions of light.
    pub l512: Bound,
    /// Over directions of light.
    pub l2048: Bound,
    /// Over directions of light.
    pub l4608: Bound,
    /// Over planes of light directions.
    pub p480: Bound,
    /// Over planes of light directions.
    pub p1024: Bound,
    /// About a ring.
    pub r456: Bound,
    /// About a ring.
    pub r976: Bound,
    /// About a ring.
    pub r1776: Bound,
    /// About a ring.
    pub r6080: Bound,
    /// About a ring with a bend.
    pub b2544: Bound,
    /// About a ring with a bend.
    pub b5920: Bound,
    /// Interpolated.
    pub s640: Bound,
    /// Interpolated.
    pub s960: Bound,
    /// Interpolated.
    pub s1120: Bound,
    /// Interpolated.
    pub s1344: Bound,
    /// Interpolated.
    pub s1440: Bound,
    /// Interpolated.
    pub s2304: Bound,
    /// Interpolated.
    pub s2080: Bound,
    /// Interpolated.
    pub s2560: Bound,
    /// Interpolated.
    pub s1792: Bound,
    /// Interpolated.
    pub s1616: Bound,
    /// Interpolated.
    pub s896: Bound,
    /// Interpolated.
    pub s1008: Bound,
    /// Interpolated.
    pub s1248: Bound,
    /// Interpolated.
    pub s1360: Bound,
    /// Glass.
    pub g112: Bound,
    /// Glass.
    pub g560: Bound,
    /// Glass.
    pub g904: Bound,
    /// Glass.
    pub g2240: Bound,
    /// Glass.
    pub g4536: Bound,
}

/// The bounds for a lobe at an α where n·v is at least `mu`: for GGX and Charlie wider below
/// [`WIDE_LAYER`] and, but for uncoupled and implicit terms on rough rows, below [`GRAZING`], and
/// for Charlie wider still below [`CHARLIE_LIMIT`] and [`CHARLIE_UNKNOWN`]; for Blinn-Phong wider
/// above [`BLINN_PHONG_LIMIT`].
pub const fn columns(lobe: Microfacet, mu: f64, alpha: f64) -> &'static Columns {
    let grazing = mu < GRAZING;
    match lobe.ndf {
        Ndf::Ggx => {
            let coupled =
                matches!(lobe.masking, Masking::HeightCorrelated | Masking::HeightCorrelatedApprox);
            match alpha < WIDE_LAYER {
                true if grazing => &GGX_GRAZING_BELOW_WIDE_LAYER,
                true => &GGX_BELOW_WIDE_LAYER,
                false if grazing && coupled => &GGX_GRAZING,
                false if coupled => &GGX,
                false => &GGX_SEPARABLE,
            }
        }
        Ndf::Beckmann => &BECKMANN,
        Ndf::BeckmannWalter => &BECKMANN_WALTER,
        Ndf::BlinnPhong if alpha > BLINN_PHONG_LIMIT => &BLINN_PHONG_BEYOND_LIMIT,
        Ndf::BlinnPhong => &BLINN_PHONG,
        Ndf::Charlie => charlie_columns(lobe.masking, grazing, alpha),
    }
}

const GGX_GRAZING_BELOW_WIDE_LAYER: Columns = Columns {
    h56: all(1e-3),
    h130: all(1e-4),
    h288: all(1e-5),
    h640: all(1.5e-6),
    h1536: all(1e-7),
    h6144: all(3e-9),
    l288: all(3e-5),
    l512: all(1e-5),
    l2048: sharp(2.7e-7, 5e-7, 2.5e-12),
    l4608: sharp(5e-9, 8e-8, 1e-12),
    s640: all(1e-5),
    s960: sharp(2e-6, 2e-6, 6e-8),
    s1120: sharp(1.2e-7, 5e-7, 1e-9),
    s1344: sharp(2e-6, 2e-6, 1.6e-6),
    s1440: sharp(1.2e-7, 2e-6, 4e-9),
    s2304: sharp(3e-8, 8e-8, 3e-11),
    s896: sharp(1.2e-7, 5e-7, 1e-9),
    ..SMOOTH
};

const GGX_BELOW_WIDE_LAYER: Columns = Columns {
    l4608: sharp(8e-11, 1e-8, 1e-13),
    s960: sharp(2e-7, 6e-7, 4e-9),
    s1344: sharp(2.5e-7, 1e-6, 5e-9),
    s1440: sharp(1.2e-7, 5e-7, 1e-9),
    ..GGX_GRAZING_BELOW_WIDE_LAYER
};

/// With the height-correlated term and its approximation, which couple both directions.
const GGX_GRAZING: Columns = Columns {
    l2048: sharp(4e-8, 1e-6, 1e-10),
    l4608: sharp(3.5e-9, 8e-8, 1e-12),
    s1440: sharp(4.5e-8, 7.5e-7, 3e-10),
    s2304: sharp(4e-9, 2e-7, 1.5e-11),
    ..GGX_GRAZING_BELOW_WIDE_LAYER
};

const GGX: Columns = Columns {
    l2048: sharp(6e-10, 1.2e-8, 2e-12),
    l4608: sharp(2.5e-11, 1e-9, 1e-14),
    s1344: sharp(7e-8, 1e-6, 1.6e-9),
    s1440: sharp(1.2e-8, 2e-7, 3e-10),
    s2304: sharp(1.5e-9, 3e-8, 1.5e-11),
    ..GGX_GRAZING
};

/// With a term of each direction for itself.
const GGX_SEPARABLE: Columns = Columns {
    l2048: sharp(3e-10, 1e-8, 1e-12),
    l4608: sharp(1.8e-12, 1.5e-11, 3e-14),
    s960: sharp(8e-8, 1e-6, 2e-10),
    s1120: sharp(3e-9, 1e-7, 3e-10),
    s2304: sharp(1.6e-9, 3e-8, 1.5e-11),
    s896: sharp(1e-9, 1e-7, 3e-10),
    ..GGX_BELOW_WIDE_LAYER
};

const BECKMANN: Columns = Columns {
    h56: all(2.5e-3),
    h130: all(1e-4),
    h288: all(1e-5),
    h640: all(1e-6),
    h1536: all(1e-7),
    h6144: all(5e-10),
    p480: sharp(5e-9, 1e-7, 1e-12),
    p1024: sharp(2.5e-11, 1e-9, 1e-15),
    s2080: sharp(8e-8, 3e-7, 3e-10),
    s1008: sharp(1.2e-8, 5e-7, 6.5e-10),
    ..SMOOTH
};

/// Walter's Smith term jumps, which no rule over half vectors resolves.
const BECKMANN_WALTER: Columns = Columns {
    h56: all(3e-3),
    h130: all(5e-4),
    h288: all(1.5e-4),
    h640: all(6e-5),
    h1536: all(1.2e-5),
    h6144: all(2e-6),
    p480: sharp(5e-9, 1e-7, 1e-12),
    p1024: sharp(2.5e-11, 1e-9, 1e-15),
    s2080: sharp(8e-8, 3e-7, 3e-10),
    ..SMOOTH
};

const BLINN_PHONG: Columns = Columns {
    h56: all(2e-2),
    h130: all(1e-3),
    h288: all(4e-5),
    h640: all(3e-6),
    h1536: all(1.5e-7),
    h6144: all(1e-9),
    p480: sharp(7e-9, 1e-7, 1e-12),
    p1024: sharp(2.5e-11, 1e-9, 1e-15),
    s2560: sharp(1.6e-7, 1e-6, 3e-10),
    s1248: sharp(1.8e-8, 5e-7, 6.5e-10),
    ..SMOOTH
};

/// Where the lobe is so wide that it does not end.
const BLINN_PHONG_BEYOND_LIMIT: Columns = Columns {
    h1152: sharp(2e-13, 5e-12, 5e-15),
    p480: NONE,
    p1024: NONE,
    s1248: sharp(6e-10, 1e-8, 5e-11),
    ..BLINN_PHONG
};

/// What the layer of an index of refraction near 1 adds, where reflectance falls from 1 within
/// √(n² - 1) of grazing incidence.
pub const LAYER: Columns = Columns {
    h56: all(1e-3),
    h130: all(2e-4),
    h288: all(5e-5),
    h640: all(2e-5),
    h1536: all(4e-6),
    h6144: all(3e-7),
    d6144: all(1e-5),
    d10240: all(1e-6),
    reference: all(1e-10),
    ..SMOOTH
};

/// The double exponential rules are as sharp for one smooth lobe as for any other; the rest serve
/// for none.
const SMOOTH: Columns = Columns {
    h56: NONE,
    h130: NONE,
    h288: NONE,
    h640: NONE,
    h1536: NONE,
    h6144: NONE,
    h1152: NONE,
    d6144: sharp(5e-7, 1e-6, 1e-12),
    d10240: sharp(6e-9, 4e-8, 1e-12),
    reference: sharp(1e-13, 3e-12, 3e-24),
    l288: NONE,
    l512: NONE,
    l2048: NONE,
    l4608: NONE,
    p480: NONE,
    p1024: NONE,
    r456: NONE,
    r976: NONE,
    r1776: NONE,
    r6080: NONE,
    b2544: NONE,
    b5920: NONE,
    s640: NONE,
    s960: NONE,
    s1120: NONE,
    s1344: NONE,
    s1440: NONE,
    s2304: NONE,
    s2080: NONE,
    s2560: NONE,
    s1792: NONE,
    s1616: NONE,
    s896: NONE,
    s1008: NONE,
    s1248: NONE,
    s1360: NONE,
    g112: NONE,
    g560: NONE,
    g904: NONE,
    g2240: NONE,
    g4536: NONE,
};
