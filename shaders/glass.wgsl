// The integrals of a rough interface: the twin of src/integrate/glass.rs. It needs slope_width,
// slope_end, slope_density and projected_area of the lobe; reflected_visibility and
// transmitted_visibility, given both projected areas; and of the interface ETA, K = ETA^2 - 1,
// CRITICAL, the cosine of the critical angle, and INSIDE, whether it is seen from the denser side.

// R and T.
alias Weights = vec2<f32>;

// Numbers of nodes for reflection and transmission, and the interface's ETA, K and CRITICAL.
struct Rule {
    reflected_slopes: u32,
    reflected_azimuths: u32,
    total_azimuths: u32,
    transmitted_slopes: u32,
    transmitted_azimuths: u32,
    eta: f32,
    k: f32,
    critical: f32,
}

// How near beyond the last azimuth, as a share of the interval in C^2, the root of 1 - F counts as
// at it.
const NEAR = 0.3;

// The slope of a half vector on the horizon, scaled or not.
const FAR = 1e18;

// What is the same for all half vectors; `from_critical` is mu - CRITICAL.
struct View {
    mu: f32,
    sv: f32,
    from_critical: f32,
    alpha: f32,
    area_v: f32,
}

fn view_of(mu: f32, from_critical: f32, alpha: f32) -> View {
    let sv = sqrt((1.0 - mu) * (1.0 + mu));
    return View(mu, sv, from_critical, alpha, projected_area(mu, alpha));
}

// tan of an angle with this sine and cosine, at most FAR.
fn tangent(sine: f32, cosine: f32) -> f32 {
    return select(FAR, min(sine / max(cosine, SMALLEST_SWING), FAR), cosine > 0.0);
}

// tan |theta_v - theta_c| and tan(theta_v + theta_c).
fn touches(view: View) -> vec2<f32> {
    let sum = view.sv * CRITICAL + view.mu * ETA;
    let sine = abs(view.from_critical) * (view.mu + CRITICAL) / sum;
    return vec2(tangent(sine, view.mu * CRITICAL + view.sv * ETA),
        tangent(sum, view.mu * CRITICAL - view.sv * ETA));
}

// The ends of pieces from `first` to `last` with these breaks between, in ascending order.
fn sorted(first: f32, breaks: vec4<f32>, last: f32) -> array<f32, 6> {
    let b = clamp(breaks, vec4(first), vec4(max(first, last)));
    let low = min(b.xz, b.yw);
    let high = max(b.xz, b.yw);
    let middle = vec2(max(low.x, low.y), min(high.x, high.y));
    return array<f32, 6>(first, min(low.x, low.y), min(middle.x, middle.y),
        max(middle.x, middle.y), max(high.x, high.y), max(first, last));
}

// The slopes tan(theta_h) between pieces of reflection.
fn reflected_breaks(view: View) -> array<f32, 6> {
    let full = view.mu / (view.sv + 1.0);
    let end = tangent(view.sv + 1.0, view.mu);
    if !INSIDE {
        return array<f32, 6>(0.0, full, full, full, full, end);
    }
    let twice = CRITICAL * 2.0;
    let meeting = tangent(sqrt(max((twice - view.mu) * (twice + view.mu), 0.0)), view.mu);
    return sorted(0.0, vec4(full, touches(view), meeting), end);
}

// The same of transmission.
fn transmitted_breaks(view: View) -> array<f32, 6> {
    if !INSIDE {
        let upright = tangent(view.mu, view.sv);
        return array<f32, 6>(0.0, upright, upright, upright, upright, FAR);
    }
    let touch = touches(view);
    let below = -(view.from_critical * (view.mu + CRITICAL)) / (view.sv + ETA);
    let horizon = tangent(max(below, 0.0), view.mu);
    let lack = (CRITICAL - view.mu) * (CRITICAL + view.mu);
    let meeting = tangent(sqrt(max(lack, 0.0)), view.mu);
    let first = select(0.0, touch.x, view.from_critical < 0.0);
    return sorted(first, vec4(touch.x, horizon, meeting, meeting), touch.y);
}

// F at c with g^2 = K + c^2.
fn reflectance(c: f32, g2: f32) -> f32 {
    return reflectance_from(c, g2, max(1.0 - c, 0.0) * (c + 1.0), K);
}

// 1 - F, with no product of two numbers that may be tiny.
fn transmittance(c: f32, g: f32) -> f32 {
    let s = 1.0 / max(c + g, SMALLEST_ROOT);
    let p = 1.0 / max((K + 1.0) * c + g, SMALLEST_ROOT);
    return 2.0 * ((c * s) * (g * s) + (K + 1.0) * ((c * p) * (g * p)));
}

// c G2 / (4 mu) of reflection towards n.l = x.
fn seen(view: View, ring: Ring, x: f32) -> f32 {
    let l = clamp(x, 0.0, 1.0);
    let visible = reflected_visibility(l, view.mu, projected_area(l, view.alpha), view.area_v);
    return (l + view.mu) * ring.secant * 0.5 * visible;
}

// c (1 - F) G2 / (4 mu) of transmission.
fn passed(view: View, ring: Ring, c: f32, g2: f32) -> f32 {
    let g = sqrt(max(g2, 0.0));
    let sum = max(c + g, SMALLEST_ROOT);
    let x = clamp((view.mu + K / (sum * ring.secant)) / ETA, 0.0, 1.0);
    let visible = transmitted_visibility(x, view.mu, projected_area(x, view.alpha), view.area_v);
    return c * transmittance(c, g) * visible;
}

// Where c is that of the critical angle.
fn critical_zero(view: View, ring: Ring) -> Zero {
    let below = view.mu * ring.versine - view.from_critical;
    return zero_at(ring.swing * 2.0, (below / ring.swing + 1.0) * 0.5);
}

// The integral over azimuths of c F G2 / (4 mu); `first` is the first node.
fn reflected_ring(view: View, ring: Ring, first: u32, rule: Rule) -> f32 {
    let light = ring.swing * 2.0 / ring.secant;
    let below = (view.mu - ring.middle * 2.0 / ring.secant) / light;
    let horizon = zero_at(light * 2.0, (below + 1.0) * 0.5);
    let count = rule.reflected_azimuths;
    if !INSIDE {
        var sum = 0.0;
        for (var j = 0u; j < count; j++) {
            let node = nodes[first + j];
            let azimuth = azimuth_at(horizon.t2 * (node.x * node.x));
            let x = cosine_at(horizon, azimuth, horizon.t2 * (1.0 - node.x * node.x));
            let c = (max(x, 0.0) + view.mu) * ring.secant * 0.5;
            sum += azimuth.share * node.y * seen(view, ring, x) * reflectance(c, K + c * c);
        }
        return sum * sqrt(horizon.t2) * 8.0;
    }
    let cone = critical_zero(view, ring);
    let t2 = min(cone.t2, horizon.t2);
    // The cone cuts the ring inside of the horizon: with a root at the end.
    let cut = cone.square > 0.0 && cone.square > horizon.square;
    let partly = first + select(0u, count, cut);
    var part = 0.0;
    if t2 > 0.0 {
        for (var j = 0u; j < count; j++) {
            let node = nodes[partly + j];
            let azimuth = azimuth_at(t2 * (node.x * node.x));
            let rest = t2 * (1.0 - node.x * node.x);
            let above = cosine_at(cone, azimuth, (cone.t2 - t2) + rest);
            let x = cosine_at(horizon, azimuth, (horizon.t2 - t2) + rest);
            let f = reflectance(above + CRITICAL, above * (above + 2.0 * CRITICAL));
            part += azimuth.share * node.y * (seen(view, ring, x) * f);
        }
    }
    let whole = reflected_whole(view, ring, t2, horizon, first + 2u * count, rule);
    return part * sqrt(t2) * 8.0 + whole;
}

// The same from t^2 = `t2` to the horizon, where light is reflected whole.
fn reflected_whole(view: View, ring: Ring, t2: f32, horizon: Zero, first: u32, rule: Rule) -> f32 {
    let length2 = horizon.t2 - t2;
    if length2 <= 0.0 {
        return 0.0;
    }
    let begin = sqrt(t2);
    let length = length2 / max(begin + sqrt(horizon.t2), SMALLEST_SWING);
    // The whole interval is symmetric about its start.
    let nodes_at = first + select(0u, rule.total_azimuths, t2 > 0.0);
    var sum = 0.0;
    for (var j = 0u; j < rule.total_azimuths; j++) {
        let node = nodes[nodes_at + j];
        let t = begin + length * node.x;
        let azimuth = azimuth_at(t * t);
        let x = cosine_at(horizon, azimuth, horizon.t2 - azimuth.t2);
        sum += azimuth.share * node.y * seen(view, ring, x);
    }
    return sum * length * 8.0;
}

// The integral over azimuths of c (1 - F) G2 / (4 mu).
fn transmitted_ring(view: View, ring: Ring, first: u32, rule: Rule) -> f32 {
    let count = rule.transmitted_azimuths;
    var limit = zero_at(ring.swing * 2.0, (1.0 - ring.middle / ring.swing) * 0.5);
    var lift = 0.0;
    var list = first;
    if INSIDE {
        let cone = critical_zero(view, ring);
        // x > 0 where c > (kappa^2 + CRITICAL^2)/(2 kappa), this far above CRITICAL.
        let kappa = view.mu * ring.secant;
        let lack = max(CRITICAL - kappa, 0.0);
        lift = lack * lack / (max(kappa, SMALLEST_SWING) * 2.0);
        limit = zero_at(cone.scale, cone.square + lift / cone.scale);
        let near = cone.scale * (1.0 - limit.square) * NEAR;
        list += select(0u, count, limit.square > 0.0 && lift < near);
    }
    if limit.t2 <= 0.0 {
        return 0.0;
    }
    var sum = 0.0;
    for (var j = 0u; j < count; j++) {
        let node = nodes[list + j];
        let azimuth = azimuth_at(limit.t2 * (node.x * node.x));
        let above = cosine_at(limit, azimuth, limit.t2 * (1.0 - node.x * node.x)) + lift;
        // From the thinner side CRITICAL is 0, and c itself is `above`.
        let c = max(above, 0.0) + CRITICAL;
        let g2 = select(K + c * c, above * (c + CRITICAL), INSIDE);
        sum += azimuth.share * node.y * passed(view, ring, c, g2);
    }
    return sum * sqrt(limit.t2) * 8.0;
}

// The ring of half vectors at a scaled slope.
fn ring_at(view: View, tau: f32) -> Ring {
    let secant = sqrt(tau * tau + 1.0);
    let swing = max(view.sv * (tau / secant), SMALLEST_SWING);
    return Ring(secant, view.mu / secant, swing, tau / secant * (tau / (secant + 1.0)));
}

// R and T at n.v = `mu`, given mu - CRITICAL, and alpha above 0.
fn glass(mu: f32, from_critical: f32, alpha: f32, rule: Rule) -> Weights {
    let view = view_of(mu, from_critical, alpha);
    let width = slope_width(alpha);
    let end = slope_end(alpha);
    let transmitted = rule.reflected_slopes + 2u * (rule.reflected_azimuths + rule.total_azimuths);
    var reflected_at = reflected_breaks(view);
    var transmitted_at = transmitted_breaks(view);
    var sum = Sum(Weights(0.0), Weights(0.0));
    var terms = 0u;
    for (var piece = 0u; piece < 5u; piece++) {
        let reflects = slope_interval(min(reflected_at[piece] / width, end),
            min(reflected_at[piece + 1u] / width, end));
        if reflects.width > 0.0 {
            for (var i = 0u; i < rule.reflected_slopes; i++) {
                let slope = slope_at(nodes[i].x, reflects);
                let ring = ring_at(view, width * slope.y);
                let weight = radial_weight(alpha, nodes[i].y * slope.dy, slope.y) * ring.secant;
                let part = reflected_ring(view, ring, rule.reflected_slopes, rule);
                add(&sum, terms, Weights(weight * part, 0.0));
                terms += 1u;
            }
        }
        let passes = slope_interval(min(transmitted_at[piece] / width, end),
            min(transmitted_at[piece + 1u] / width, end));
        if passes.width > 0.0 {
            for (var i = 0u; i < rule.transmitted_slopes; i++) {
                let node = nodes[transmitted + i];
                let slope = slope_at(node.x, passes);
                let ring = ring_at(view, width * slope.y);
                let weight = radial_weight(alpha, node.y * slope.dy, slope.y) * ring.secant;
                let first = transmitted + rule.transmitted_slopes;
                let part = transmitted_ring(view, ring, first, rule);
                add(&sum, terms, Weights(0.0, weight * part));
                terms += 1u;
            }
        }
    }
    return (sum.total + sum.block) * 4.0;
}
