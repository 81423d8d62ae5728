// Charlie: the twin of src/model/charlie.rs.

// The unit of slopes.
fn charlie_width(alpha: f32) -> f32 {
    return 0.5 / sqrt(alpha);
}

// P22/(4 alpha) at the squared scaled slope.
fn charlie_slope_density(y2: f32, alpha: f32) -> f32 {
    let y = max(y2, 1e-30);
    let a4 = 4.0 * alpha;
    let scale = a4 + y;
    return 0.636619772 * (1.0 + 2.0 * alpha) * exponential(max(-2.0 / y * log1p_ratio(a4 / y), -100.0)) / scale / scale;
}

// L(x) of the fit of Lambda (Estevez and Kulla 2017).
fn charlie_fit(x: f32, alpha: f32) -> f32 {
    let s = 1.0 - alpha;
    let p = vec4<f32>(21.5473, 3.82987, 0.19823, -1.97760)
        + s * s * vec4<f32>(25.3245 - 21.5473, 3.32435 - 3.82987, 0.16801 - 0.19823, -1.27393 + 1.97760);
    var power = 0.0;
    if x > 0.0 {
        power = exponential(p.z * logarithm(x));
    }
    return p.x / (1.0 + p.y * power) + p.w * x - 4.32054 + s * s * (4.32054 - 4.85967);
}

// c (1 + 2 Lambda(c)) (Estevez and Kulla 2017).
fn charlie_smith(c: f32, alpha: f32) -> f32 {
    var l = charlie_fit(min(c, 1.0 - c), alpha);
    if c >= 0.5 {
        l = 2.0 * charlie_fit(0.5, alpha) - l;
    }
    return max(c, 1e-30) * (1.0 + 2.0 * exponential(l));
}
