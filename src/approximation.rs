//! Approximations of the integrals E(F0) of a lobe over a region of (n·v, roughness, F0): shapes
//! with few numbers, evaluated as a shader does. A table of integrals is right at its nodes; an
//! approximation is judged by what a lookup gives anywhere in its region.

pub mod channels;
pub mod code;
pub mod cost;
pub mod numbers;
pub mod place;
pub mod shape;
pub mod table;
pub mod texture;

pub use channels::Channels;
pub use numbers::{Numbers, Storage};
pub use place::{Across, Along};
pub use shape::Shape;
pub use texture::{Sampler, Texels};

use crate::brdf::Microfacet;
use crate::numeric::lanes::Vector;

/// The n·v and the roughnesses that a lookup is right for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// n·v lies between this and 1.
    pub least_nov: f64,
    /// Perceptual roughness lies between these; they are equal for a constant.
    pub roughness: [f64; 2],
}

impl Region {
    /// The region of a roughness, or of a range of them, where n·v from `least_nov` on is looked
    /// up. A range that begins at a smaller α than that has its layer at n·v ~ α partly below it,
    /// at another place for each roughness: it takes every n·v instead.
    pub fn new(least_nov: f64, roughness: [f64; 2]) -> Self {
        let [low, high] = roughness;
        let is_cut = low < high && low * low < least_nov;
        Region { least_nov: if is_cut { 0.0 } else { least_nov }, roughness }
    }
}

/// An approximation: its shape and its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Approximation {
    /// The lobe whose integrals it follows.
    pub lobe: Microfacet,
    /// Where it does so.
    pub region: Region,
    /// What its numbers stand for.
    pub channels: Channels,
    /// The functions that its numbers are factors of.
    pub shape: Shape,
    /// Those factors, for each channel.
    pub numbers: Vec<Numbers>,
}

impl Approximation {
    /// The channels at these (n·v, perceptual roughness), in the arithmetic of a shader.
    pub fn at<V: Vector>(&self, nov: V, roughness: V) -> [V; 2] {
        self.beside(nov, roughness, [0.0; 2])
    }

    /// The channels where the coordinates of the shape are so far from those of a place.
    fn beside<V: Vector>(&self, nov: V, roughness: V, shift: [f64; 2]) -> [V; 2] {
        let [x, y] = self.shape.coordinates(&self.region, nov, roughness);
        let coordinates = match shift {
            [0.0, 0.0] => [x, y],
            _ => [x + shift[0], y + shift[1]],
        };
        let mut channels = [V::from(0.0); 2];
        for (channel, numbers) in channels.iter_mut().zip(&self.numbers) {
            *channel = self.shape.sum(numbers, coordinates);
        }
        channels
    }

    /// The albedo E(F0) at these places.
    pub fn albedo<V: Vector>(&self, nov: V, roughness: V, f0: V) -> V {
        self.albedo_beside(nov, roughness, f0, [0.0; 2])
    }

    /// The same where a sampler is so far off: see [`Shape::filter`].
    pub fn albedo_beside<V: Vector>(&self, nov: V, roughness: V, f0: V, shift: [f64; 2]) -> V {
        let weights = self.channels.weights(nov, f0);
        let channels = self.beside(nov, roughness, shift);
        weights[0] * channels[0] + weights[1] * channels[1]
    }

    /// BLAKE3 of its numbers: of each channel the offset, the scale and the codes, or the floats,
    /// little-endian.
    pub fn blake3(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for numbers in &self.numbers {
            match numbers {
                Numbers::Floats(floats) | Numbers::Halves(floats) => {
                    for float in floats {
                        hasher.update(&float.to_le_bytes());
                    }
                }
                Numbers::Codes { offset, scale, codes, .. } => {
                    hasher.update(&offset.to_le_bytes()).update(&scale.to_le_bytes());
                    for code in codes {
                        hasher.update(&code.to_le_bytes());
                    }
                }
            }
        }
        hasher.finalize().to_string()
    }

    /// Bytes of its numbers.
    pub fn bytes(&self) -> usize {
        self.numbers.iter().map(Numbers::bytes).sum()
    }
}
