// What every sum over slopes takes. It needs slope_density and Weights.

// The weight of a radial node without the factor 1/cos^2 theta_h.
fn radial_weight(alpha: f32, weight: f32, y: f32) -> f32 {
    return weight * (y * slope_density(y * y, alpha));
}

// A sum in two levels: terms gather in blocks of 8, so that rounding grows with n/8 instead of n.
// Halves the error of a bake.
struct Sum {
    total: Weights,
    block: Weights,
}

fn add(sum: ptr<function, Sum>, i: u32, term: Weights) {
    (*sum).block += term;
    if i % 8u == 7u {
        (*sum).total += (*sum).block;
        (*sum).block = Weights(0.0);
    }
}
