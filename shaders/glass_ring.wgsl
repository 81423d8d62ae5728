// Cosines on a ring of half vectors that vanish on it: the twin of src/integrate/glass/ring.rs.

// Nothing on a ring is as narrow.
const SMALLEST_SWING = 1e-30;

// The half vectors of one slope: c = middle + swing cos(phi); versine is 1 - cos(theta_h).
struct Ring {
    secant: f32,
    middle: f32,
    swing: f32,
    versine: f32,
}

// A place on a ring: 1/(1+t^2), C = cos(phi/2) and t^2, with t = tan(phi/4).
struct Azimuth {
    share: f32,
    cos_half: f32,
    t2: f32,
}

// A cosine that vanishes at C^2 = square: scale (C^2 - square). C and t^2 there, and
// 2 scale/(1 + t^2).
struct Zero {
    scale: f32,
    square: f32,
    cos_half: f32,
    t2: f32,
    slope: f32,
}

fn zero_at(scale: f32, square: f32) -> Zero {
    let cos_half = sqrt(clamp(square, 0.0, 1.0));
    let t2 = (1.0 - cos_half) / (cos_half + 1.0);
    return Zero(scale, square, cos_half, t2, scale * 2.0 / (t2 + 1.0));
}

fn azimuth_at(t2: f32) -> Azimuth {
    let share = 1.0 / (t2 + 1.0);
    return Azimuth(share, (1.0 - t2) * share, t2);
}

// The cosine at an azimuth whose t^2 is `rest` below that of the zero.
fn cosine_at(zero: Zero, azimuth: Azimuth, rest: f32) -> f32 {
    let between = zero.slope * (rest * azimuth.share) * (azimuth.cos_half + zero.cos_half);
    let all_around = zero.scale * (azimuth.cos_half * azimuth.cos_half - zero.square);
    return select(all_around, between, zero.square > 0.0);
}
