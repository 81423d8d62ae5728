// A texel's integral, whatever its alpha: the twin of src/integrate.rs and src/integrate/rule.rs.
// It needs quadrature: (A, B) of a lobe at alpha above 0.

// The limit alpha -> 0 at fixed n.v: a perfect mirror, times `limit`.
fn mirror(mu: f32, limit: f32) -> vec2<f32> {
    let b = schlick_weight(mu);
    return limit * vec2<f32>(1.0 - b, b);
}

// (A, B) at n.v = mu and alpha, both in [0, 1].
fn integrate(mu: f32, alpha: f32, rule: Rule) -> vec2<f32> {
    if alpha == 0.0 {
        return mirror(mu, smooth_limit(mu));
    }
    return quadrature(mu, alpha, rule);
}
