//! The largest error of each rule for rough interfaces.

use super::{Columns, NONE, SMOOTH, all, sharp};
use crate::brdf::Ndf;
use crate::brdf::interface::{Interface, Side, TransmissionMasking};

/// The bounds for a rough interface.
pub fn glass_columns(interface: Interface) -> &'static Columns {
    match (interface.transmission(), interface.lobe().ndf, interface.side()) {
        (TransmissionMasking::Beta, _, _) => &GLASS_BETA,
        (_, Ndf::Beckmann, _) => &GLASS_BECKMANN,
        (_, _, Side::Outside) => &GLASS,
        (_, _, Side::Inside) => &GLASS_INSIDE,
    }
}

const GLASS: Columns = Columns {
    g112: all(2e-3),
    g560: all(1e-5),
    g904: all(1.5e-6),
    g2240: all(1.2e-7),
    g4536: all(5e-9),
    reference: all(1e-12),
    ..WITHOUT_GLASS
};

/// Far below the critical angle T spans ten decades.
const GLASS_INSIDE: Columns =
    Columns { g904: sharp(1.5e-6, 6e-4, 2e-11), g4536: sharp(5e-9, 1e-4, 1e-12), ..GLASS };

/// Gaussian tails end within a piece, which few nodes do not follow.
const GLASS_BECKMANN: Columns = Columns {
    g112: all(8e-3),
    g560: all(5e-4),
    g904: all(1e-4),
    g2240: all(1e-6),
    g4536: all(1e-7),
    reference: all(1e-12),
    ..WITHOUT_GLASS
};

/// The beta function falls like a power of n·l that is no whole number, which no rule resolves:
/// worst where n·v = 0, α = 1 and n is about 10.
const GLASS_BETA: Columns = Columns {
    g112: all(6e-2),
    g560: all(4e-3),
    g904: all(5e-4),
    g2240: all(4e-5),
    g4536: all(8e-6),
    reference: all(3e-12),
    ..WITHOUT_GLASS
};

/// What a layer adds for a rough interface. Where the index is near 1, F falls from 1 within the
/// root of n² - 1 of grazing incidence; where it is large, within 1/n. Rules err most where that is
/// as wide as the spacing of their nodes: `g560` at n = 1.002, `g904` at 1.0013 and 30, `g2240` at
/// 1.0002.
pub fn glass_layer(interface: Interface) -> Option<&'static Columns> {
    match interface.ior() {
        ..1.002 | 12.0.. => Some(&GLASS_LAYER),
        ..1.05 | 2.75.. => Some(&GLASS_WIDE_LAYER),
        _ => None,
    }
}

const GLASS_LAYER: Columns = Columns {
    g112: all(1e-3),
    g560: all(1.5e-4),
    g904: all(8e-5),
    g2240: all(1e-5),
    g4536: all(3e-6),
    reference: all(1e-12),
    ..WITHOUT_GLASS
};

const GLASS_WIDE_LAYER: Columns = Columns {
    g112: all(1e-3),
    g560: all(1.5e-4),
    g904: all(8e-5),
    g2240: all(5e-7),
    g4536: all(2e-8),
    reference: all(1e-12),
    ..WITHOUT_GLASS
};

const WITHOUT_GLASS: Columns = Columns { d6144: NONE, d10240: NONE, ..SMOOTH };
