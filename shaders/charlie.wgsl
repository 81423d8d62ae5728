// Charlie: the twin of src/brdf/ndf/charlie.rs.

// The unit of slopes.
fn charlie_width(alpha: f32) -> f32 {
    return 0.5 / sqrt(alpha);
}

// P22/(4 alpha) at the squared scaled slope.
fn charlie_slope_density(y2: f32, alpha: f32) -> f32 {
    let y = max(y2, 1e-30);
    let a4 = 4.0 * alpha;
    let scale = a4 + y;
    let power = exponential(max(-2.0 / y * log1p_ratio(a4 / y), -100.0));
    return 0.636619772 * (1.0 + 2.0 * alpha) * power / scale / scale;
}

// e^L(x), L(x) = a/(1 + b x^p) + d x + e (Estevez and Kulla 2017), within 7e-7 of itself: L reaches
// 20, so that its parts are kept in heads of 12 bits, whose products are exact, and in what is left
// of them.
fn charlie_lambda(x: f32, alpha: f32) -> f32 {
    let s = 1.0 - alpha;
    let s2 = s * s;
    // b x^p: b times a power of 2, exactly, and a smaller rest.
    var high = 0.0;
    var low = 0.0;
    if x > 0.0 {
        // p = 203/1024 and a rest.
        let parts = power_parts(x, 0.1982421875, -1.21875e-5 - 0.03022 * s2);
        high = (3.82987 - 0.50552 * s2) * parts.x;
        low = high * parts.y;
    }
    let sum = 1.0 + high + low;
    let sum_head = bitcast<f32>(bitcast<u32>(sum) & 0xfffff000u);
    let sum_rest = ((1.0 - sum_head) + high) + low;
    // a/sum, a = 21.5 and a rest.
    let a_rest = 0.0473 + 3.7772 * s2;
    let head = bitcast<f32>(bitcast<u32>((21.5 + a_rest) / sum) & 0xfffff000u);
    let rest = ((21.5 - head * sum_head) + (a_rest - head * sum_rest)) / sum;
    let slope = (0.70367 * s2 - 1.97760) * x - (0.32054 + 0.53913 * s2);
    return exponential(head - 4.0) * exponential(rest + slope);
}

// c (1 + 2 Lambda(c)).
fn charlie_projected_area(c: f32, alpha: f32) -> f32 {
    var lambda = charlie_lambda(min(c, 1.0 - c), alpha);
    if c >= 0.5 {
        let middle = charlie_lambda(0.5, alpha);
        lambda = middle * middle / lambda;
    }
    return max(c, 1e-30) * (1.0 + 2.0 * lambda);
}
