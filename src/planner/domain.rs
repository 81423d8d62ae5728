//! The domain of a scene: the roughnesses and the F0 that its lobes have.

use crate::approximation::Region;
use crate::scene::{Layer, Lobe, Scene, Span};

/// Lobes of one roughness or of one range of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The materials.
    pub materials: Vec<String>,
    /// Perceptual roughness from the smoothest to the roughest.
    pub roughness: [f64; 2],
    /// F0 over F90, from the least to the largest: E(F0) with F90 is F90 times that at this ratio,
    /// and errors are no larger.
    pub f0: [f64; 2],
}

/// Pieces that reports look at one by one.
const MOST_PIECES: usize = 64;

/// All pieces, and the least n·v at which they are looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// The least n·v.
    pub least_nov: f64,
    /// The pieces, each roughness once.
    pub pieces: Vec<Piece>,
}

/// F0 over F90.
fn ratio(f0: Span, f90: Span) -> [f64; 2] {
    let over = |f0: f64, f90: f64| if f90 > 0.0 { (f0 / f90).min(1.0) } else { 1.0 };
    [over(f0.low, f90.high), over(f0.high, f90.low)]
}

impl Domain {
    /// The domain of the lobes of some scenes in these layers; constants of one roughness are one
    /// piece.
    pub fn of(scenes: &[Scene], layers: &[Layer], least_nov: f64) -> Self {
        let mut pieces: Vec<Piece> = Vec::new();
        let lobes = scenes.iter().flat_map(|scene| &scene.lobes);
        for lobe in lobes.filter(|lobe| layers.contains(&lobe.layer)) {
            let Lobe { material, roughness, f0, f90, .. } = lobe;
            let (roughness, f0) = ([roughness.low, roughness.high], ratio(*f0, *f90));
            match pieces.iter_mut().find(|piece| piece.roughness == roughness) {
                Some(piece) => {
                    piece.f0 = [piece.f0[0].min(f0[0]), piece.f0[1].max(f0[1])];
                    if !piece.materials.contains(material) {
                        piece.materials.push(material.clone());
                    }
                }
                None => pieces.push(Piece { materials: vec![material.clone()], roughness, f0 }),
            }
        }
        pieces.sort_by(|a, b| a.roughness[0].total_cmp(&b.roughness[0]));
        Domain { least_nov, pieces }
    }

    /// Whether every piece has one roughness.
    pub fn is_constant(&self) -> bool {
        self.pieces.iter().all(|piece| piece.roughness[0] == piece.roughness[1])
    }

    /// The pieces, or as many of them, evenly, as there is time to look at one by one.
    pub fn some_pieces(&self) -> impl Iterator<Item = &Piece> {
        self.pieces.iter().step_by(self.pieces.len().div_ceil(MOST_PIECES).max(1))
    }

    /// The region of a piece.
    pub fn region_of(&self, piece: &Piece) -> Region {
        Region::new(self.least_nov, piece.roughness)
    }

    /// The least region that holds all pieces, and the range of F0 there; none without pieces.
    pub fn whole(&self) -> Option<(Region, [f64; 2])> {
        let hull = |range: fn(&Piece) -> [f64; 2]| {
            let ranges = || self.pieces.iter().map(range);
            let low = ranges().map(|[low, _]| low).reduce(f64::min)?;
            Some([low, ranges().map(|[_, high]| high).reduce(f64::max)?])
        };
        let roughness = hull(|piece| piece.roughness)?;
        Some((Region::new(self.least_nov, roughness), hull(|piece| piece.f0)?))
    }
}
