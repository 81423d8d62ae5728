//! Drawings: shapes on a plane, as SVG and as pixels, and the axes of a chart.

pub mod axes;
mod font;
mod paint;
mod svg;

use crate::image::Picture;
pub use font::width_of;

/// A colour, 8 bits for R, G and B.
pub type Colour = [u8; 3];

/// Shapes in the order in which they are painted; x runs right and y down, in pixels at the size at
/// which it is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Pixels across.
    pub width: f64,
    /// Pixels down.
    pub height: f64,
    /// The shapes on it.
    pub shapes: Vec<Shape>,
}

/// Something to paint.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Straight lines from point to point.
    Path {
        /// The corners.
        points: Vec<(f64, f64)>,
        /// Colour and width of the line; a polygon without a line is filled.
        line: Option<(Colour, f64)>,
        /// The colour within.
        fill: Option<Colour>,
        /// Whether the line is dashed.
        dashed: bool,
        /// Its meaning: shown where a pointer rests.
        title: String,
    },
    /// A line of text.
    Text {
        /// Where its anchor is, on the base line.
        at: (f64, f64),
        /// The text.
        text: String,
        /// Pixels of an em.
        size: f64,
        /// Which part of it is at the anchor.
        anchor: Anchor,
        /// Its colour.
        colour: Colour,
        /// Whether it reads upwards.
        upright: bool,
    },
    /// A picture, its pixels enlarged to squares.
    Image {
        /// Its left upper corner.
        at: (f64, f64),
        /// Width and height as drawn.
        size: (f64, f64),
        /// The pixels.
        picture: Picture,
        /// The picture.
        title: String,
    },
}

/// Which part of a text lies at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// Almost black.
pub const INK: Colour = [34, 34, 34];
/// For what is less important.
pub const GREY: Colour = [120, 120, 120];
/// For grids.
pub const PALE: Colour = [226, 226, 226];

impl Drawing {
    /// An empty sheet.
    pub fn new(width: f64, height: f64) -> Self {
        Drawing { width, height, shapes: Vec::new() }
    }

    /// A line through points.
    pub fn line(&mut self, points: Vec<(f64, f64)>, colour: Colour, width: f64, dashed: bool) {
        self.shapes.push(Shape::Path {
            points,
            line: Some((colour, width)),
            fill: None,
            dashed,
            title: String::new(),
        });
    }

    /// A text.
    pub fn text(
        &mut self,
        at: (f64, f64),
        text: impl Into<String>,
        size: f64,
        anchor: Anchor,
        colour: Colour,
    ) {
        self.shapes.push(Shape::Text {
            at,
            text: text.into(),
            size,
            anchor,
            colour,
            upright: false,
        });
    }

    /// A text that reads upwards.
    pub fn upright(&mut self, at: (f64, f64), text: impl Into<String>, size: f64) {
        let (anchor, colour) = (Anchor::Middle, INK);
        self.shapes.push(Shape::Text {
            at,
            text: text.into(),
            size,
            anchor,
            colour,
            upright: true,
        });
    }

    /// A mark of a kind (any number; there are six), with what it stands for.
    pub fn mark(
        &mut self,
        at: (f64, f64),
        kind: usize,
        radius: f64,
        colour: Colour,
        title: impl Into<String>,
    ) {
        // Corners and the angle of the first, in turns: disc, square, triangle, diamond, triangle
        // upside down, hexagon.
        let (corners, first) =
            [(24, 0.0), (4, 0.125), (3, 0.75), (4, 0.0), (3, 0.25), (6, 0.0)][kind % 6];
        let points = polygon(at, radius, corners, first);
        let (line, fill, title) = (Some(([255; 3], 0.8)), Some(colour), title.into());
        self.shapes.push(Shape::Path { points, line, fill, dashed: false, title });
    }

    /// A picture whose left upper corner is `at`, drawn in that size.
    pub fn image(
        &mut self,
        at: (f64, f64),
        size: (f64, f64),
        picture: Picture,
        title: impl Into<String>,
    ) {
        self.shapes.push(Shape::Image { at, size, picture, title: title.into() });
    }

    /// A ring around a place.
    pub fn ring(&mut self, at: (f64, f64), radius: f64, colour: Colour) {
        let mut points = polygon(at, radius, 32, 0.0);
        points.push(points[0]);
        self.line(points, colour, 1.2, false);
    }

    /// The drawing as SVG.
    pub fn to_svg(&self) -> crate::error::Result<String> {
        svg::write(self)
    }

    /// The drawing in pixels, `scale` of them for each of its own.
    pub fn to_picture(&self, scale: f64) -> crate::error::Result<Picture> {
        paint::paint(self, scale)
    }

    /// The boxes that its texts fill: left, top, right, bottom.
    pub fn text_boxes(&self) -> Vec<(String, [f64; 4])> {
        let text_box = |shape: &Shape| {
            let Shape::Text { at: (x, y), text, size, anchor, upright, .. } = shape else {
                return None;
            };
            let length = width_of(text, *size);
            let before = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5 * length,
                Anchor::End => length,
            };
            let (above, below) = (0.75 * size, 0.2 * size);
            let flat = [x - before, y - above, x - before + length, y + below];
            let stood = [x - above, y - length + before, x + below, y + before];
            Some((text.clone(), if *upright { stood } else { flat }))
        };
        self.shapes.iter().filter_map(text_box).collect()
    }
}

/// The corners of a regular polygon around a place, the first at `first` of a turn.
fn polygon(at: (f64, f64), radius: f64, corners: usize, first: f64) -> Vec<(f64, f64)> {
    let corner = |i: usize| {
        let angle = std::f64::consts::TAU * (first + i as f64 / corners as f64);
        (at.0 + radius * libm::cos(angle), at.1 + radius * libm::sin(angle))
    };
    (0..corners).map(corner).collect()
}
