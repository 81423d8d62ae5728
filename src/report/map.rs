//! Pictures of numbers over (n·v, roughness): a panel for each, in a colour scale that runs both ways from white.

/// A picture in 8-bit R, G, B, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Three bytes for each pixel.
    pub rgb: Vec<u8>,
}

/// Pixels between panels.
const GAP: usize = 6;

impl Picture {
    /// All of one colour.
    pub fn new(width: usize, height: usize, colour: [u8; 3]) -> Self {
        Picture { width, height, rgb: colour.repeat(width * height) }
    }

    /// Sets a pixel.
    pub fn set(&mut self, x: usize, y: usize, colour: [u8; 3]) {
        let i = 3 * (y * self.width + x);
        self.rgb[i..i + 3].copy_from_slice(&colour);
    }
}

/// Panels of `size` × `size` values each, `columns` to a row; a value is a deviation in units of the scale's end.
pub fn panels(values: &[Vec<f64>], size: usize, columns: usize) -> Picture {
    let rows = values.len().div_ceil(columns);
    let length = |n: usize| n * (size + GAP) + GAP;
    let mut picture = Picture::new(length(columns), length(rows), [64, 64, 64]);
    for (panel, values) in values.iter().enumerate() {
        let (left, top) = (GAP + panel % columns * (size + GAP), GAP + panel / columns * (size + GAP));
        for (i, &value) in values.iter().enumerate() {
            picture.set(left + i % size, top + i / size, diverging(value));
        }
    }
    picture
}

/// Blue at -1, white at 0, orange at 1: told apart by every kind of colour vision.
fn diverging(value: f64) -> [u8; 3] {
    let (end, share) = if value < 0.0 { ([33.0, 102.0, 172.0], -value) } else { ([230.0, 97.0, 1.0], value) };
    let share = share.clamp(0.0, 1.0);
    end.map(|end: f64| (255.0 + (end - 255.0) * share).round() as u8)
}
