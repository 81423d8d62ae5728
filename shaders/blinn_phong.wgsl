// Blinn-Phong: the twin of src/brdf/ndf/blinn_phong.rs.

// alpha^2 P22 at the squared scaled slope.
fn blinn_phong_slope_density(y2: f32, alpha: f32) -> f32 {
    let t = alpha * alpha * y2;
    return 0.318309886 * exponential(-(y2 + t) * log1p_ratio(t));
}

// The y beyond which less than exp(-depth) of the lobe lies; (e^u - 1)/u by its series where u is
// small.
fn blinn_phong_end(alpha: f32, depth: f32) -> f32 {
    let a2 = alpha * alpha;
    let scale = depth * (1.0 + 3.0 * a2) / (1.0 + a2);
    let u = scale * a2;
    var ratio = 1.0 + u * (0.5 + u * (0.166666667 + u * 0.0416666667));
    if u > 0.1 {
        ratio = (exponential(u) - 1.0) / u;
    }
    return sqrt(scale * ratio);
}
