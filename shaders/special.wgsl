// Special functions: the twin of src/numeric/special.rs. Correct to a few ulps with + - * / alone.

// e^r - 1 for |r| <= ln(2)/2: the Taylor series to r^7 (the next term is 5e-9).
fn expm1_reduced(r: f32) -> f32 {
    return r * (1.0 + r * (0.5 + r * (0.166666667 + r * (0.0416666667
        + r * (0.00833333333 + r * (0.00138888889 + r * 0.000198412698))))));
}

// 2^k for a whole number k from -126 to 127.
fn power_of_two(k: f32) -> f32 {
    return bitcast<f32>(u32(i32(k) + 127) << 23u);
}

// exp(x) for x <= 88: 2^k e^r, |r| <= ln(2)/2; 0 below the normal numbers.
fn exponential(x: f32) -> f32 {
    if x < -87.0 {
        return 0.0;
    }
    let k = floor(x * 1.44269504 + 0.5);
    // ln 2 in two parts, the first of which times k is exact.
    let scale = power_of_two(k);
    return scale + scale * expm1_reduced((x - k * 0.693359375) + k * 2.12194440e-4);
}

// atanh(s)/s for |s| <= 1/3 by its square; the next term of the series is 1e-9.
fn atanh_ratio(s2: f32) -> f32 {
    return 1.0 + s2 * (0.333333333 + s2 * (0.2 + s2 * (0.142857143 + s2 * (0.111111111
        + s2 * (0.0909090909 + s2 * (0.0769230769 + s2 * 0.0666666667))))));
}

// k and ln m of normal x = 2^k m > 0, 1 <= m < 2: ln m = 2 atanh((m-1)/(m+1)).
fn logarithm_parts(x: f32) -> vec2<f32> {
    let bits = bitcast<u32>(x);
    let m = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    let s = (m - 1.0) / (m + 1.0);
    return vec2<f32>(f32(i32(bits >> 23u) - 127), 2.0 * s * atanh_ratio(s * s));
}

// ln x for normal x > 0.
fn logarithm(x: f32) -> f32 {
    let parts = logarithm_parts(x);
    return parts.x * 0.69314718 + parts.y;
}

// ln(1+u)/u for u >= 0, 1 at u = 0.
fn log1p_ratio(u: f32) -> f32 {
    if u >= 1.0 {
        return logarithm(1.0 + u) / u;
    }
    let s = u / (2.0 + u);
    return 2.0 / (2.0 + u) * atanh_ratio(s * s);
}

// i1erfc(a) = exp(-a^2)/sqrt(pi) - a erfc(a) for a >= 0: exp(-a^2) times a Chebyshev fit in (a -
// 2.5)/(a + 2.5), within 1e-8 on [0, 6.5]; beyond, the value is below 1e-20.
fn ierfc(a: f32) -> f32 {
    if a > 6.5 {
        return 0.0;
    }
    let t = (a - 2.5) / (a + 2.5);
    let fit = 0.0371736772 + t * (-0.124690063 + t * (0.175368384 + t * (-0.141328856
        + t * (0.0714551881
        + t * (-0.0183963254 + t * (-0.00186886371 + t * (0.00263420981 + t * (8.36901236e-5
        + t * -0.000196480847))))))));
    return exponential(-a * a) * fit;
}

// x^(head + rest) for normal x > 0 as 2^k and e^r - 1: nearly twice the digits of one number.
// `head` has few enough bits that its products with the exponents of x are exact.
fn power_parts(x: f32, head: f32, rest: f32) -> vec2<f32> {
    let parts = logarithm_parts(x);
    let high = head * parts.x;
    let low = rest * parts.x + (head + rest) * (1.44269504 * parts.y);
    let k = floor(high + low + 0.5);
    return vec2<f32>(power_of_two(k), expm1_reduced(((high - k) + low) * 0.69314718));
}
