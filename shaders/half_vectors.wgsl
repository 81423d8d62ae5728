// The integral over half vectors: the twin of src/integrate/half_vectors.rs. It needs slope_width,
// slope_end, slope_density and cosine_visibility of the lobe, fresnel_weights and their type
// Weights, and the rule's nodes.

// Numbers of nodes: see HalfVectorRule.
struct Rule {
    radial: u32,
    azimuth: u32,
    radial_horizon: u32,
    azimuth_horizon: u32,
}

struct Ring {
    m: f32,
    s: f32,
    secant2: f32,
    half_secant: f32,
}

// The half vectors of one slope tan(theta_h) = tau: n.l = m + s cos(phi).
fn ring(mu: f32, sv: f32, tau: f32) -> Ring {
    let secant2 = 1.0 + tau * tau;
    let m = mu * ((1.0 - tau) * (1.0 + tau)) / secant2;
    return Ring(m, 2.0 * sv * tau / secant2, secant2, 0.5 * sqrt(secant2));
}

// 2 (x + mu) (n.l V) times each weight of the Fresnel model.
fn integrand(x: f32, mu: f32, alpha: f32, half_secant: f32) -> Weights {
    let g = 2.0 * (x + mu) * cosine_visibility(x, mu, alpha);
    return g * fresnel_weights((x + mu) * half_secant);
}

// The azimuth integral where the whole circle lies above the horizon; `first` is its first node.
fn full_circle(mu: f32, alpha: f32, r: Ring, first: u32, count: u32) -> Weights {
    var sum = Weights(0.0);
    for (var j = 0u; j < count; j++) {
        let node = nodes[first + j];
        sum += node.y * integrand(max(r.m + r.s * node.x, 0.0), mu, alpha, r.half_secant);
    }
    return sum;
}

// The same where the horizon cuts it: tan(phi/4) = tm u.
fn cut_circle(mu: f32, alpha: f32, r: Ring, first: u32, count: u32) -> Weights {
    let cos_m = clamp(-r.m / r.s, -1.0, 1.0);
    let half = sqrt(0.5 * (1.0 + cos_m));
    let tm = sqrt(0.5 * (1.0 - cos_m)) / (1.0 + half);
    let tm2 = tm * tm;
    let scale = 4.0 * r.s * tm2 / (1.0 + tm2);
    var sum = Weights(0.0);
    for (var j = 0u; j < count; j++) {
        let node = nodes[first + j];
        let u2 = node.x * node.x;
        let q = 1.0 / (1.0 + tm2 * u2);
        let c = (1.0 - tm2 * u2) * q;
        let x = scale * (1.0 - u2) * q * (c + half);
        sum += node.y * (8.0 * tm * q) * integrand(x, mu, alpha, r.half_secant);
    }
    return sum;
}

// The integrals at n.v = mu in [0, 1] and alpha in (0, 1].
fn half_vectors(mu: f32, alpha: f32, rule: Rule) -> Weights {
    let sv = sqrt((1.0 - mu) * (1.0 + mu));
    let t1 = mu / (1.0 + sv);
    let width = slope_width(alpha);
    let end = slope_end(alpha);
    let y1 = min(t1 / width, end);
    var y2 = end;
    if t1 * width * end > 1.0 {
        y2 = 1.0 / (t1 * width);
    }
    let azimuth = rule.radial;
    let radial_horizon = azimuth + rule.azimuth;
    let azimuth_horizon = radial_horizon + rule.radial_horizon;
    var sum = Sum(Weights(0.0), Weights(0.0));
    if mu > 0.0 {
        let below = slope_interval(0.0, y1);
        for (var i = 0u; i < rule.radial; i++) {
            let slope = slope_at(nodes[i].x, below);
            let r = ring(mu, sv, width * slope.y);
            let part = full_circle(mu, alpha, r, azimuth, rule.azimuth);
            add(&sum, i, radial_weight(alpha, nodes[i].y * slope.dy, slope.y) * r.secant2 * part);
        }
    }
    if sv > 0.0 {
        let beyond = slope_interval(y1, y2);
        for (var i = 0u; i < rule.radial_horizon; i++) {
            let node = nodes[radial_horizon + i];
            let slope = slope_at(node.x, beyond);
            let r = ring(mu, sv, width * slope.y);
            let part = cut_circle(mu, alpha, r, azimuth_horizon, rule.azimuth_horizon);
            add(&sum, i, radial_weight(alpha, node.y * slope.dy, slope.y) * r.secant2 * part);
        }
    }
    return sum.total + sum.block;
}
