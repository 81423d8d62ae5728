//! Microfacet models: a distribution of normals, a masking term, Fresnel. Closed forms with their citations, no tables.
//!
//! A specular lobe is f(l, v) = F D G / (4 n·l n·v). The integrals need it split otherwise: the distribution as a density
//! of slopes y = tan(θ_h)/α, which stays smooth as α → 0, and n·l V = G / (4 n·v), which is finite at n·v = 0.

pub mod fresnel;
pub mod ggx;
pub mod masking;

/// The distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ndf {
    /// Trowbridge and Reitz 1975; Walter et al. 2007, equation 33.
    Ggx,
}

/// The masking and shadowing term G.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Masking {
    /// Smith, heights correlated (Heitz 2014, equation 99).
    HeightCorrelated,
    /// Smith, G1(l) G1(v) (Heitz 2014, equation 98).
    Separable,
    /// Schlick's approximation with k = α/2 (Karis 2013).
    SchlickSmith,
}

/// A distribution of normals with its masking term: everything of a specular lobe but Fresnel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Microfacet {
    /// The distribution of normals.
    pub ndf: Ndf,
    /// The masking term.
    pub masking: Masking,
}

impl Ndf {
    /// All of them.
    pub const ALL: [Ndf; 1] = [Ndf::Ggx];

    /// P = α² P22: the density of the scaled slope y = tan(θ_h)/α, given y²; 2π ∫ y P dy = 1 over y > 0.
    pub fn slope_density(self, y2: f64) -> f64 {
        match self {
            Ndf::Ggx => ggx::ggx_slope_density(y2),
        }
    }

    /// c (1 + 2Λ(c)) for the cosine `c`: what Smith masking needs, finite at c = 0.
    pub fn smith(self, c: f64, alpha: f64) -> f64 {
        match self {
            Ndf::Ggx => ggx::ggx_smith(c, alpha),
        }
    }
}

impl Masking {
    /// All of them.
    pub const ALL: [Masking; 3] = [Masking::HeightCorrelated, Masking::Separable, Masking::SchlickSmith];
}

impl Microfacet {
    /// n·l V(l, v) = G(l, v) / (4 n·v) for n·l = `x` and n·v = `mu`.
    pub fn cosine_visibility(self, x: f64, mu: f64, alpha: f64) -> f64 {
        match self.masking {
            Masking::HeightCorrelated => {
                masking::height_correlated(x, mu, self.ndf.smith(x, alpha), self.ndf.smith(mu, alpha))
            }
            Masking::Separable => masking::separable(x, mu, self.ndf.smith(x, alpha), self.ndf.smith(mu, alpha)),
            Masking::SchlickSmith => masking::schlick_smith(x, mu, alpha),
        }
    }
}
