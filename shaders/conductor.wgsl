// Fresnel's equations of conductors: the twin of src/brdf/fresnel/conductor.rs.

// F at c = v.h for the index n + ik.
fn conductor_reflectance(c: f32, n: f32, k: f32) -> f32 {
    let s2 = (1.0 - c) * (1.0 + c);
    let nk2 = 4.0 * (n * k) * (n * k);
    let t = (n - k) * (n + k) - s2;
    let p = sqrt(t * t + nk2);
    let size = p + abs(t);
    var a2 = size;
    if t < 0.0 {
        a2 = nk2 / size;
    }
    let turned = 2.0 * sqrt(0.5 * a2) * c;
    let sum = p + c * c;
    let mean = c * c * p + s2 * s2;
    return (sum - turned) * mean / ((sum + turned) * (mean + turned * s2));
}
