// A texel's integrals, whatever its alpha: the twin of src/integrate.rs and src/backend/cpu.rs.
// It needs quadrature: the integrals of a lobe at alpha above 0.

// The limit alpha -> 0 at fixed n.v: a perfect mirror, times the limit of the albedo.
fn mirror(mu: f32) -> Weights {
    return smooth_limit(mu) * fresnel_weights(mu);
}

// The integrals at n.v = view.x and alpha, both in [0, 1].
fn integrate(view: vec2<f32>, alpha: f32, rule: Rule) -> Weights {
    if alpha == 0.0 {
        return mirror(view.x);
    }
    return quadrature(view.x, alpha, rule);
}
