// The slope map: the twin of src/numeric/quadrature/slope_map.rs. POWER is 2 or 4.

struct SlopeInterval {
    w0: f32,
    plus0: f32,
    minus1: f32,
    width: f32,
}

struct MappedSlope {
    y: f32,
    dy: f32,
}

// 1 - w at the slope y >= 0.
fn slope_complement(y: f32) -> f32 {
    var e = sqrt(y + sqrt(1.0 + y * y));
    if POWER == 4u {
        e = sqrt(e);
    }
    return 2.0 / (1.0 + e);
}

// The interval from y0 to y1, y0 <= y1 and 0 <= y1.
fn slope_interval(y0: f32, y1: f32) -> SlopeInterval {
    let c0 = slope_complement(abs(y0));
    let c1 = slope_complement(y1);
    if y0 < 0.0 {
        return SlopeInterval(c0 - 1.0, c0, c1, 2.0 - c0 - c1);
    }
    return SlopeInterval(1.0 - c0, 2.0 - c0, c1, c0 - c1);
}

// The slope at position u in [0, 1] of an interval.
fn slope_at(u: f32, interval: SlopeInterval) -> MappedSlope {
    let w = interval.w0 + interval.width * u;
    let s = (interval.plus0 + interval.width * u) * (interval.minus1 + interval.width * (1.0 - u));
    let w2 = w * w;
    let r = 1.0 / (s * s);
    let sinh = 4.0 * w * (1.0 + w2) * r;
    let cosh = (1.0 + w2 * (6.0 + w2)) * r;
    if POWER == 2u {
        return MappedSlope(sinh, interval.width * 4.0 * cosh / s);
    }
    return MappedSlope(2.0 * sinh * cosh, interval.width * 8.0 * (1.0 + 2.0 * sinh * sinh) / s);
}
