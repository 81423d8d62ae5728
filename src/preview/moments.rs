//! The light of GGX under a sky by brute force: moments of the light direction l over a lobe, by
//! Gauss quadrature over half vectors.
//!
//! With E = ∫ f |n·l| dl at n·v = μ, and t the direction across n in the plane of v, the sky
//! L(l) = s0 + s1 P1(y) + s2 P2(y) of the height y of l needs ∫ f |n·l| of 1, l·n, l·t, (l·n)²,
//! (l·n)(l·t) and (l·t)² alone: no kernel, no split. Those with one l·t are odd in sin θ_v, which
//! divides them, so that all are smooth at n·v = 1.
//!
//! With dω_h = sin θ_h dθ_h dφ, f |n·l| dl = 4 (v·h) w (G₂/(4μ)) D dω_h, w = F or 1 - F, and for
//! GGX, with 1 + tan² θ_h/α² = eᵗ, D cos θ_h dω_h = e⁻ᵗ dt dφ/(2π): the density is gone.

use crate::brdf::Microfacet;
use crate::brdf::fresnel::Basis;
use crate::brdf::interface::Interface;
use crate::numeric::quadrature::gauss_legendre::{Node, gauss_legendre};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

/// ∫ f |n·l| of 1, l·n, (l·t)/sin θ_v, (l·n)², (l·n)(l·t)/sin θ_v, (l·t)².
pub type Moments = [f64; 6];

/// Nodes of a curve of moments over √(n·v): between them it errs by less than 2e-5.
pub const MOMENT_NODES: usize = 1025;

/// The nodes in a piece of slopes, and in azimuth.
static NODES: LazyLock<Vec<Node>> = LazyLock::new(|| gauss_legendre(48));

/// e⁻ᵗ there is what is left out of D: far less than a picture shows.
const LAST: f64 = 28.0;

/// The largest n·v: sin θ_v is 1.4e-5 there, and the moments are those of n·v = 1 within 1e-10.
const UPRIGHT: f64 = 1.0 - 1e-10;

/// A half vector: its cosine and its sine times cos φ, and v·h.
struct Half {
    cosine: f64,
    along: f64,
    vh: f64,
}

/// The light of a half vector: 4 (v·h) w G₂/(4μ), l·n and l·t.
type Light = (f64, f64, f64);

/// A view of GGX.
#[derive(Clone, Debug)]
pub struct View {
    mu: f64,
    sine: f64,
    alpha: f64,
}

impl View {
    /// At n·v = `mu` from 0 to 1 and `alpha` above 0.
    pub fn new(mu: f64, alpha: f64) -> Self {
        let mu = mu.min(UPRIGHT);
        let sine = ((1.0 - mu) * (1.0 + mu)).sqrt();
        View { mu, sine, alpha }
    }

    /// Of light that GGX with the lobe's masking reflects; `reflectance` is F at v·h.
    pub fn reflected(&self, lobe: Microfacet, reflectance: impl Fn(f64) -> f64) -> Moments {
        let &View { mu, sine, alpha } = self;
        let view = mu.acos();
        // The ring of half vectors touches the horizon of l, and leaves it.
        let ends = [0.0, 0.5 * (FRAC_PI_2 - view), 0.5 * (FRAC_PI_2 + view)];
        // n·l = 2 (v·h) n·h - μ > 0
        let least = |cosine: f64| 0.5 * mu / cosine;
        self.over_half_vectors(&ends, least, |half| {
            let Half { cosine, along, vh } = *half;
            let x = 2.0 * vh * cosine - mu;
            let visible = lobe.cosine_visibility(x.clamp(0.0, 1.0), mu, alpha);
            (4.0 * vh * reflectance(vh) * visible, x, 2.0 * vh * along - sine)
        })
    }

    /// Of light that passes an interface from the thinner side.
    pub fn transmitted(&self, interface: Interface) -> Moments {
        let &View { mu, sine, alpha } = self;
        let (eta, k) = (interface.eta(), interface.k());
        let area_v = interface.lobe().masking_projected_area(mu, alpha);
        let ends = [0.0, FRAC_PI_2 - mu.acos(), FRAC_PI_2];
        self.over_half_vectors(
            &ends,
            |_| 0.0,
            |half| {
                let Half { cosine, along, vh } = *half;
                // l = (-v + (c - g) h)/η, g² = η² - 1 + c².
                let turn = vh - (k + vh * vh).sqrt();
                let (ln, lt) = ((turn * cosine - mu) / eta, (turn * along - sine) / eta);
                let visible = interface.transmitted_visibility((-ln).min(1.0), mu, area_v, alpha);
                let [reflected] = interface.medium().weights(vh);
                (4.0 * vh * (1.0 - reflected) * visible, ln, lt)
            },
        )
    }

    /// Over the θ_h between these ends and the azimuths where v·h is above the least that a ring
    /// of this cosine has light for.
    fn over_half_vectors(
        &self,
        ends: &[f64],
        least: impl Fn(f64) -> f64,
        light: impl Fn(&Half) -> Light,
    ) -> Moments {
        let mut moments = [0.0; 6];
        for pair in ends.windows(2) {
            // In √t, which is the slope where that is small.
            let [first, last] = [pair[0], pair[1]].map(|theta| self.depth(theta).sqrt());
            if first >= last {
                continue;
            }
            for node in &*NODES {
                let root = first + (last - first) * node.at;
                let depth = root * root;
                let tangent = self.alpha * depth.exp_m1().sqrt();
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let (middle, swing) = (self.mu * cosine, self.sine * tangent * cosine);
                // v·h = middle + swing cos φ
                let end =
                    ((least(cosine) - middle) / swing.max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
                let azimuth = end.acos();
                // Both sides of the plane of v, over 2π.
                let ring = 2.0 * root * (last - first) * node.weight * (-depth).exp() / cosine / PI;
                for node in &*NODES {
                    let along = (azimuth * node.at).cos();
                    let vh = (middle + swing * along).clamp(0.0, 1.0);
                    let half = Half { cosine, along: tangent * cosine * along, vh };
                    let (weight, ln, lt) = light(&half);
                    let weight = ring * azimuth * node.weight * weight;
                    let odd = lt / self.sine;
                    let powers = [1.0, ln, odd, ln * ln, ln * odd, lt * lt];
                    moments.iter_mut().zip(powers).for_each(|(sum, power)| *sum += weight * power);
                }
            }
        }
        moments
    }

    /// t at an angle of the half vector.
    fn depth(&self, theta: f64) -> f64 {
        let slope = theta.tan().max(0.0) / self.alpha;
        if theta < FRAC_PI_2 { (slope * slope).ln_1p().min(LAST) } else { LAST }
    }
}
