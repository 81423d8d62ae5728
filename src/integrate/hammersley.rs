//! The estimator that engines bake with: half vectors by the density D n·h of GGX at Hammersley's
//! points (Karis 2013). It repeats their own numbers; bakes use quadrature.

use crate::brdf::Microfacet;
use crate::brdf::fresnel::Basis;
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use std::fmt;
use std::str::FromStr;

/// The estimator with its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hammersley {
    /// The number of points.
    pub count: u32,
    /// The azimuth of the first point.
    pub frame: Frame,
}

/// How the azimuth φ = 2πi/N of a point turns a half vector from the plane of v and n.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// By φ: its part in the plane is sin θ cos φ, as in Filament's cmgen.
    Cos,
    /// By φ - π/2: sin θ sin φ, as by the tangents of Unreal and LearnOpenGL, and in three.js.
    Sin,
}

choice!(Frame, "frame", {
    Cos = "cos", "sin(theta) cos(phi) in the plane of v and n (cmgen)";
    Sin = "sin", "sin(theta) sin(phi) there (Unreal, LearnOpenGL, three.js)";
});

/// The most points: 2^20 take about 10 ms for a texel.
const LARGEST: u32 = 1 << 20;

/// The words of an estimator.
const WORDS: &str = "hammersley,n=N,frame=cos or sin, with N from 1 to 1048576, or of glass \
                     wrong-side";

/// A point: the part of φ that enters, and the share of D n·h below its θ.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    turn: f64,
    share: f64,
}

impl Hammersley {
    /// The points (i/N, the binary digits of i mirrored) (Wong, Luk and Heng 1997).
    pub fn points(self) -> Vec<Point> {
        let point = |i: u32| {
            let phi = std::f64::consts::TAU * f64::from(i) / f64::from(self.count);
            let turn = match self.frame {
                Frame::Cos => libm::cos(phi),
                Frame::Sin => libm::sin(phi),
            };
            // Mirrored about the binary point: divided by 2^32.
            Point { turn, share: f64::from(i.reverse_bits()) / 4_294_967_296.0 }
        };
        (0..self.count).map(point).collect()
    }
}

/// The integrals at (n·v, α): the mean of n·l V 4 v·h/n·h times each weight. tan² θ_h = α² u/(1-u)
/// (Walter et al. 2007, equation 35).
pub fn estimate<const N: usize, B: Basis<N>>(
    lobe: Microfacet,
    basis: B,
    (mu, alpha): (f64, f64),
    points: &[Point],
) -> [f64; N] {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let mut sums = [0.0; N];
    for point in points {
        let slope2 = alpha * alpha * point.share / (1.0 - point.share);
        let nh = 1.0 / (1.0 + slope2).sqrt();
        let vh = sv * slope2.sqrt() * nh * point.turn + mu * nh;
        let nl = 2.0 * vh * nh - mu;
        if nl > 0.0 && vh > 0.0 {
            let weight = lobe.cosine_visibility(nl, mu, alpha) * 4.0 * vh / nh;
            let weights = basis.weights(vh.min(1.0));
            sums.iter_mut().zip(weights).for_each(|(sum, part)| *sum += weight * part);
        }
    }
    sums.map(|sum| sum / points.len() as f64)
}

impl FromStr for Hammersley {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = || {
            let cure = "as in hammersley,n=1024,frame=cos";
            Error::bad_input("estimator", WORDS, format!("'{text}'"), cure)
        };
        let mut words = text.split(',').map(str::trim);
        let (Some("hammersley"), Some(n), Some(frame), None) =
            (words.next(), words.next(), words.next(), words.next())
        else {
            return Err(wrong());
        };
        let count = n.strip_prefix("n=").and_then(|n| n.parse().ok());
        let frame = frame.strip_prefix("frame=").and_then(|frame| Frame::named(frame).ok());
        match (count, frame) {
            (Some(count @ 1..=LARGEST), Some(frame)) => Ok(Hammersley { count, frame }),
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for Hammersley {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "hammersley,n={},frame={}", self.count, self.frame)
    }
}
