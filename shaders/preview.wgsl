// Spheres under a punctual light, in a white furnace and under a sky: the twin of src/preview.rs,
// which explains it. It needs table_u and table_v, the texture coordinates of the table
// (src/table/axis.rs).

struct Job {
    // Pixels along the edge of a sphere's cell, and spheres in a row.
    cell: u32,
    columns: u32,
    scene: u32,
    // Texels along the edge of the table.
    table: u32,
    rule: Rule,
}

// For each column alpha, roughness, and the means of P1 and P2 over the prefiltering kernel.
@group(0) @binding(1) var<storage, read> columns: array<vec4<f32>>;
// (A, B) over n.v and roughness.
@group(0) @binding(2) var<storage, read> table: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read_write> pixels: array<vec4<f32>>;

var<immediate> job: Job;

const BASE = vec3<f32>(0.5, 0.08, 0.06);
const GOLD = vec3<f32>(1.0, 0.78, 0.34);
const DIELECTRIC = 0.04;
const LIGHT = vec3<f32>(0.48, 0.6, 0.64);
const LIGHT_COLOUR = 1.6;
// The sky as a polynomial of the height y of a direction: zeroth, first and second Legendre
// coefficient.
const SKY0 = vec3<f32>(0.55, 0.6, 0.7);
const SKY1 = vec3<f32>(0.3, 0.42, 0.6);
const SKY2 = vec3<f32>(-0.22, -0.12, 0.0);

// pi D V: what a lobe contributes to L = (c_diff + pi D V F) c_light n.l.
fn pi_d_v(x: f32, mu: f32, nh: f32, alpha: f32) -> f32 {
    let c2 = nh * nh;
    let width = slope_width(alpha);
    let y2 = (1.0 - nh) * (1.0 + nh) / (c2 * width * width);
    let d = slope_density(y2, alpha) / (width * width * c2 * c2);
    return 3.14159265 * d * cosine_visibility(x, mu, alpha) / x;
}

// The table as a renderer reads it: bilinear between texels, clamped at the border.
fn lookup(mu: f32, roughness: f32) -> vec2<f32> {
    let last = f32(job.table) - 1.0;
    let u = clamp(f32(job.table) * table_u(mu) - 0.5, 0.0, last);
    let v = clamp(f32(job.table) * table_v(roughness) - 0.5, 0.0, last);
    let i = u32(u);
    let j = u32(v);
    let i1 = min(i + 1u, job.table - 1u);
    let j1 = min(j + 1u, job.table - 1u);
    let low = mix(table[j * job.table + i], table[j * job.table + i1], u - f32(i));
    let high = mix(table[j1 * job.table + i], table[j1 * job.table + i1], u - f32(i));
    return mix(low, high, v - f32(j));
}

// The sky in the direction of height y, its first and second coefficients scaled by a kernel's
// means.
fn sky(y: f32, p1: f32, p2: f32) -> vec3<f32> {
    return SKY0 + SKY1 * (p1 * y) + SKY2 * (p2 * (1.5 * y * y - 0.5));
}

fn punctual(n: vec3<f32>, column: vec4<f32>) -> vec3<f32> {
    let x = dot(n, LIGHT);
    if x <= 0.0 {
        return vec3<f32>(0.0);
    }
    let h = normalize(LIGHT + vec3<f32>(0.0, 0.0, 1.0));
    let f = DIELECTRIC + (1.0 - DIELECTRIC) * schlick_weight(h.z);
    let specular = f * pi_d_v(x, max(n.z, 1e-4), clamp(dot(n, h), 1e-4, 1.0), column.x);
    return (BASE + specular) * (LIGHT_COLOUR * x);
}

fn furnace(n: vec3<f32>, column: vec4<f32>, part: u32) -> vec3<f32> {
    let mu = max(n.z, 0.0);
    let looked_up = lookup(mu, column.y);
    let integral = half_vectors(mu, column.x, job.rule);
    let a = GOLD * looked_up.x + looked_up.y;
    let b = GOLD * integral.x + integral.y;
    if part == 0u {
        return a;
    }
    if part == 1u {
        return b;
    }
    return 100.0 * abs(a - b);
}

fn daylight(n: vec3<f32>, column: vec4<f32>) -> vec3<f32> {
    let mu = max(n.z, 0.0);
    let ab = lookup(mu, column.y);
    let e = DIELECTRIC * ab.x + ab.y;
    // The reflected direction of v = (0, 0, 1) has the height 2 n.v n.y.
    let specular = e * sky(2.0 * mu * n.y, column.z, column.w);
    return specular + (1.0 - e) * BASE * sky(n.y, 0.666666667, 0.25);
}

// The colour of a scene at a place of the unit square around a sphere; y runs down.
fn shade(px: f32, py: f32, column: vec4<f32>, scene: u32) -> vec3<f32> {
    let x = (2.0 * px - 1.0) * 1.06;
    let y = (1.0 - 2.0 * py) * 1.06;
    let r2 = x * x + y * y;
    if r2 >= 1.0 {
        if scene == 0u || scene == 3u {
            return vec3<f32>(0.02);
        }
        if scene == 4u {
            return sky(clamp(y, -1.0, 1.0), 1.0, 1.0);
        }
        return vec3<f32>(1.0);
    }
    let n = vec3<f32>(x, y, sqrt(1.0 - r2));
    if scene == 0u {
        return punctual(n, column);
    }
    if scene == 4u {
        return daylight(n, column);
    }
    return furnace(n, column, scene - 1u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = job.cell * job.columns;
    if id.x >= width * job.cell {
        return;
    }
    let i = id.x % width;
    let column = columns[i / job.cell];
    var sum = vec3<f32>(0.0);
    // Four samples a pixel.
    for (var s = 0u; s < 4u; s++) {
        let px = (f32(i % job.cell) + 0.25 + 0.5 * f32(s % 2u)) / f32(job.cell);
        let py = (f32(id.x / width) + 0.25 + 0.5 * f32(s / 2u)) / f32(job.cell);
        sum += 0.25 * min(shade(px, py, column, job.scene), vec3<f32>(1.0));
    }
    pixels[id.x] = vec4<f32>(sum, 1.0);
}
