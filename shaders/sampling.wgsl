// Estimators over points of the unit square: the twin of src/compare/sampling.rs and its files.
// It needs slope_width, slope_density, cosine_visibility and half_vectors's Sum; half vectors by
// their distribution are GGX's.

// A point: (cos 2 pi u, sin^2 2 pi u) and (v, 1 - v). Three of the nodes, the third holding its
// weight.
struct Point {
    cosine: f32,
    sine2: f32,
    v: f32,
    rest: f32,
}

struct View {
    mu: f32,
    sv: f32,
    alpha: f32,
    // mu (1 + 2 Lambda(mu)) of GGX.
    visible: f32,
    // v where the microsurface of GGX is a hemisphere: in the plane, and along the normal.
    stretched: vec2<f32>,
}

struct Sample {
    nl: f32,
    vh: f32,
    weight: f32,
}

// The view at n.v = mu.
fn seen_from(mu: f32, alpha: f32) -> View {
    let sv = sqrt((1.0 - mu) * (1.0 + mu));
    let visible = ggx_projected_area(mu, alpha);
    return View(mu, sv, alpha, visible, vec2<f32>(alpha * sv / visible, mu / visible));
}

// The direction that the half vector (x in the plane, z along the normal) reflects; its weight is
// n.l V yet.
fn reflected(view: View, x: f32, z: f32) -> Sample {
    let vh = view.sv * x + view.mu * z;
    let nl = 2.0 * vh * z - view.mu;
    return Sample(nl, vh, cosine_visibility(max(nl, 0.0), view.mu, view.alpha));
}

// The same where the half vector is given in the space in which the microsurface is a hemisphere,
// in whatever length.
fn reflect_stretched(view: View, x: f32, y2: f32, z: f32, factor: f32) -> Sample {
    let shrink = 1.0 / sqrt(view.alpha * view.alpha * (x * x + y2) + z * z);
    let sample = reflected(view, view.alpha * x * shrink, z * shrink);
    return Sample(sample.nl, sample.vh, sample.weight * factor);
}

// By D n.h of GGX (Walter et al. 2007, equation 35).
fn half_vector_sample(view: View, point: Point) -> Sample {
    let t = view.alpha * view.alpha * point.v / point.rest;
    let z = 1.0 / sqrt(1.0 + t);
    let sample = reflected(view, sqrt(t) * z * point.cosine, z);
    return Sample(sample.nl, sample.vh, sample.weight * sample.vh * (4.0 / z));
}

// f n.l / (F pdf) over n.l V: 4 n.v / G1(v).
fn visible_factor(view: View) -> f32 {
    return 2.0 * (view.mu + view.visible);
}

// By what v sees (Heitz 2018).
fn visible_sample(view: View, point: Point) -> Sample {
    let t1_squared = point.v * point.sine2;
    let s = 0.5 * (1.0 + view.stretched.y);
    let t2 = (1.0 - s) * sqrt(1.0 - t1_squared) + s * (sqrt(point.v) * point.cosine);
    let t3 = sqrt(max(1.0 - t1_squared - t2 * t2, 0.0));
    let x = view.stretched.x * t3 - view.stretched.y * t2;
    let z = max(view.stretched.x * t2 + view.stretched.y * t3, 0.0);
    return reflect_stretched(view, x, t1_squared, z, visible_factor(view));
}

// A sample from the cap of heights above -bound.
fn cap_sample(view: View, point: Point, bound: f32, factor: f32) -> Sample {
    let below = (1.0 + bound) * point.v;
    let sine2 = below * ((1.0 + bound) * point.rest + (1.0 - bound));
    let y2 = sine2 * point.sine2;
    let x = sqrt(sine2) * point.cosine + view.stretched.x;
    return reflect_stretched(view, x, y2, max(1.0 - below + view.stretched.y, 0.0), factor);
}

// By spherical caps (Dupuy and Benyoub 2023).
fn spherical_cap_sample(view: View, point: Point) -> Sample {
    return cap_sample(view, point, view.stretched.y, visible_factor(view));
}

// k of the bounded cap (Eto and Tokuyoshi 2023, equation 5).
fn bound(view: View) -> f32 {
    let ratio = view.alpha * view.mu / (1.0 + view.sv);
    return (1.0 - view.alpha) * (1.0 + view.alpha) / (1.0 + ratio * ratio);
}

// By the bounded cap (Eto and Tokuyoshi 2023).
fn bounded_visible_sample(view: View, point: Point) -> Sample {
    let k = bound(view);
    return cap_sample(view, point, k * view.stretched.y, 2.0 * (k * view.mu + view.visible));
}

// D at the squared slope t.
fn distribution(t: f32, alpha: f32) -> f32 {
    let width = slope_width(alpha);
    let inverse_width2 = 1.0 / (width * width);
    return slope_density(t * inverse_width2, alpha) * inverse_width2 * ((1.0 + t) * (1.0 + t));
}

// The sample at n.l = z, sin(theta_l) = sine.
fn direct(view: View, point: Point, z: f32, sine: f32, inverse_pdf: f32) -> Sample {
    let x = view.sv + sine * point.cosine;
    let horizontal2 = x * x + sine * sine * point.sine2;
    let vertical = view.mu + z;
    let t = horizontal2 / vertical / vertical;
    let visible = cosine_visibility(z, view.mu, view.alpha);
    let vh = 0.5 * sqrt(horizontal2 + vertical * vertical);
    return Sample(z, vh, distribution(t, view.alpha) * visible * inverse_pdf);
}

// pdf = 1/(2 pi).
fn uniform_sample(view: View, point: Point) -> Sample {
    return direct(view, point, point.rest, sqrt(point.v * (1.0 + point.rest)), 6.28318531);
}

// pdf = n.l/pi.
fn cosine_sample(view: View, point: Point) -> Sample {
    let z = sqrt(point.rest);
    return direct(view, point, z, sqrt(point.v), 3.14159265 / z);
}

// (A, B) as the mean over as many points as the rule counts.
fn estimate(mu: f32, alpha: f32, rule: Rule) -> Weights {
    let view = seen_from(mu, alpha);
    var sum = Sum(Weights(0.0), Weights(0.0));
    for (var i = 0u; i < rule.radial; i++) {
        let turn = nodes[3u * i];
        let height = nodes[3u * i + 1u];
        let sample = draw(view, Point(turn.x, turn.y, height.x, height.y));
        let value = select(0.0, sample.weight * nodes[3u * i + 2u].x, sample.nl > 0.0);
        add(&sum, i, value * fresnel_weights(sample.vh));
    }
    return sum.total + sum.block;
}
