//! The outlines and widths of letters: DejaVu Sans, which comes with the program, so that every
//! machine draws the same.
//!
//! DejaVuSans.ttf holds the Latin and Greek letters, the signs and the superscripts of version
//! 2.37, a tenth of the font (pyftsubset of fonttools, without hints and layout); its licence
//! stands in its table of names.

use crate::error::{Error, Result};
use tiny_skia::PathBuilder;
use ttf_parser::{Face, OutlineBuilder};

/// The family as SVG names it; where it is missing, Verdana has nearly the same widths.
pub const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

const FONT: &[u8] = include_bytes!("DejaVuSans.ttf");

pub fn face() -> Result<Face<'static>> {
    Face::parse(FONT, 0).map_err(|error| Error::Internal(format!("the font: {error}")))
}

/// The length of a text of this size; 0 if the font could not be read.
pub fn width_of(text: &str, size: f64) -> f64 {
    face().map_or(0.0, |face| text.chars().map(|c| advance(&face, c, size)).sum())
}

fn advance(face: &Face, letter: char, size: f64) -> f64 {
    let glyph = face.glyph_index(letter).unwrap_or_default();
    f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) * size / f64::from(face.units_per_em())
}

/// The outline of a text that begins at (0, 0), y running down.
pub fn outline(text: &str, size: f64) -> Result<PathBuilder> {
    let face = face()?;
    let scale = size / f64::from(face.units_per_em());
    let mut pen = Pen { path: PathBuilder::new(), x: 0.0, scale };
    for letter in text.chars() {
        face.outline_glyph(face.glyph_index(letter).unwrap_or_default(), &mut pen);
        pen.x += advance(&face, letter, size);
    }
    Ok(pen.path)
}

struct Pen {
    path: PathBuilder,
    x: f64,
    scale: f64,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        ((self.x + f64::from(x) * self.scale) as f32, (-f64::from(y) * self.scale) as f32)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) =
            (self.place(x1, y1), self.place(x2, y2), self.place(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
