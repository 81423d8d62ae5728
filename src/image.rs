//! Pictures of numbers over two axes: panels in a scale of colours.

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

/// A panel of `width` × `height` for each list of values, `columns` panels to a row, in the colours
/// of a scale.
pub fn panels(
    values: &[Vec<f64>],
    (width, height): (usize, usize),
    columns: usize,
    scale: fn(f64) -> [u8; 3],
) -> Picture {
    let rows = values.len().div_ceil(columns);
    let length = |n: usize, size: usize| n * (size + GAP) + GAP;
    let mut picture = Picture::new(length(columns, width), length(rows, height), [64, 64, 64]);
    for (panel, values) in values.iter().enumerate() {
        let (left, top) =
            (GAP + panel % columns * (width + GAP), GAP + panel / columns * (height + GAP));
        for (i, &value) in values.iter().enumerate() {
            picture.set(left + i % width, top + i / width, scale(value));
        }
    }
    picture
}

/// Blue at -1, white at 0, orange at 1: told apart by every kind of colour vision.
pub fn diverging(value: f64) -> [u8; 3] {
    let (end, share) =
        if value < 0.0 { ([33.0, 102.0, 172.0], -value) } else { ([230.0, 97.0, 1.0], value) };
    mix([255.0; 3], end, share.clamp(0.0, 1.0))
}

/// From dark violet at 0 over green to yellow at 1, ever lighter (five colours of Smith and van der
/// Walt's viridis).
pub fn sequential(value: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [253.0, 231.0, 37.0],
    ];
    let place = value.clamp(0.0, 1.0) * 4.0;
    let stop = (place as usize).min(3);
    mix(STOPS[stop], STOPS[stop + 1], place - stop as f64)
}

/// A colour between two, this share of the way to the second.
pub fn mix(from: [f64; 3], to: [f64; 3], share: f64) -> [u8; 3] {
    std::array::from_fn(|i| (from[i] + (to[i] - from[i]) * share).round() as u8)
}
