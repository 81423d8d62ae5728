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

// e^L(0) of the fit of Lambda (Estevez and Kulla 2017).
fn charlie_scale(alpha: f32) -> f32 {
    let s = 1.0 - alpha;
    return 24154952.75 * exponential(0.22676 + 3.23807 * (s * s));
}

// L(x) - L(0).
fn charlie_fit(x: f32, alpha: f32) -> f32 {
    let s = 1.0 - alpha;
    let p = vec4<f32>(21.5473, 3.82987, 0.19823, -1.97760) + (s * s) * vec4<f32>(3.7772, -0.50552, -0.03022, 0.70367);
    var power = 0.0;
    if x > 0.0 {
        power = exponential(p.z * logarithm(x));
    }
    let b_power = p.y * power;
    return p.w * x - p.x * b_power / (1.0 + b_power);
}

// c (1 + 2 Lambda(c)).
fn charlie_smith(c: f32, alpha: f32) -> f32 {
    var fall = charlie_fit(min(c, 1.0 - c), alpha);
    if c >= 0.5 {
        fall = 2.0 * charlie_fit(0.5, alpha) - fall;
    }
    return max(c, 1e-30) * (1.0 + 2.0 * charlie_scale(alpha) * exponential(fall));
}
