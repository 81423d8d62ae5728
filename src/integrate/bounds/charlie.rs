//! The largest error of each rule for Charlie.

use super::{CHARLIE_LIMIT, CHARLIE_UNKNOWN, Columns, NONE, SMOOTH, WIDE_LAYER, all, sharp};
use crate::brdf::Masking;

/// The bounds with a masking term at an α, where n·v may be `grazing`.
pub const fn charlie_columns(masking: Masking, grazing: bool, alpha: f64) -> &'static Columns {
    let level = if alpha >= WIDE_LAYER {
        0
    } else if alpha >= CHARLIE_LIMIT {
        1
    } else if alpha >= CHARLIE_UNKNOWN {
        2
    } else {
        3
    };
    match masking {
        Masking::HeightCorrelated => &FITTED[level],
        Masking::Implicit => &IMPLICIT[level],
        _ if grazing => &NEUBELT_GRAZING[level],
        _ => &NEUBELT[level],
    }
}

/// From [`WIDE_LAYER`] on, from [`CHARLIE_LIMIT`] on, from [`CHARLIE_UNKNOWN`] on, and below.
type Levels = [Columns; 4];

/// With Neubelt's term, whose layer at the horizon is as thin as n·v.
const NEUBELT_GRAZING: Levels = [WIDE, BELOW_WIDE_LAYER, BELOW_LIMIT, UNKNOWN_BELOW];

/// Beyond [`super::GRAZING`].
const NEUBELT: Levels =
    [neubelt(WIDE), neubelt(BELOW_WIDE_LAYER), neubelt(BELOW_LIMIT), UNKNOWN_BELOW];

/// With the implicit term, which has no layer.
const IMPLICIT: Levels =
    [implicit(WIDE), implicit(BELOW_WIDE_LAYER), implicit(BELOW_LIMIT), UNKNOWN_BELOW];

/// With the fitted term. At small α its Λ is so large that only the far tail of the ring is seen,
/// which falls faster than the rules over half vectors follow (below roughness 1e-6).
const FITTED: Levels = [
    WIDE,
    BELOW_WIDE_LAYER,
    BELOW_LIMIT,
    Columns { h640: all(6e-4), h1536: all(2e-4), h6144: all(3e-5), ..UNKNOWN_BELOW },
];

const fn neubelt(base: Columns) -> Columns {
    Columns {
        r976: sharp(1e-9, 2e-7, 7e-11),
        r1776: sharp(1.3e-11, 1e-9, 1e-12),
        r6080: sharp(2e-13, 5e-12, 5e-15),
        s1792: sharp(1.4e-9, 5e-7, 3.4e-10),
        ..base
    }
}

const fn implicit(base: Columns) -> Columns {
    Columns {
        r976: sharp(1e-10, 1e-6, 1.5e-11),
        r1776: sharp(2e-13, 5e-12, 5e-15),
        r6080: sharp(2e-13, 5e-12, 5e-15),
        ..base
    }
}

const WIDE: Columns = Columns { s1616: sharp(6e-8, 5e-7, 1.5e-9), ..BELOW_WIDE_LAYER };

const BELOW_WIDE_LAYER: Columns =
    Columns { d6144: sharp(5e-7, 1.5e-6, 1e-12), d10240: sharp(6e-9, 7e-8, 1e-12), ..BELOW_LIMIT };

const BELOW_LIMIT: Columns = Columns {
    h56: all(6e-2),
    h130: all(2e-2),
    h288: all(3e-3),
    h640: all(5e-5),
    h1536: all(4e-6),
    h6144: all(3e-6),
    d6144: NONE,
    d10240: NONE,
    r456: sharp(5e-7, 4e-6, 4e-9),
    r976: sharp(1.5e-8, 2e-7, 7e-11),
    r1776: sharp(1.7e-9, 1e-8, 1e-10),
    r6080: sharp(1.4e-11, 1e-9, 1e-13),
    b2544: sharp(6e-8, 5e-7, 1.2e-9),
    b5920: sharp(2.5e-8, 2e-7, 2e-10),
    s1792: sharp(1.6e-8, 5e-7, 3.4e-10),
    s1616: sharp(3e-7, 1.2e-6, 4e-9),
    s1360: sharp(8e-10, 1e-6, 2.4e-10),
    ..SMOOTH
};

const UNKNOWN_BELOW: Columns = Columns {
    r456: NONE,
    r976: NONE,
    r1776: NONE,
    r6080: NONE,
    b2544: NONE,
    b5920: NONE,
    s1792: NONE,
    s1616: NONE,
    s1360: NONE,
    reference: all(2e-6),
    ..BELOW_LIMIT
};
