//! Drawings in SVG within a page: their colours are those of its style.

use crate::html::escape;
use std::fmt::Write;

/// A drawing.
pub struct Svg {
    size: [f64; 2],
    body: String,
}

/// Where the data of a drawing are.
#[derive(Clone, Copy)]
pub struct Frame {
    /// The left edge.
    pub left: f64,
    /// The upper edge.
    pub top: f64,
    /// The width.
    pub width: f64,
    /// The height.
    pub height: f64,
}

impl Frame {
    /// The place at these shares of its width, from the left, and of its height, from below.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left + x * self.width, self.top + (1.0 - y) * self.height]
    }
}

impl Svg {
    /// Nothing yet.
    pub fn new(width: f64, height: f64) -> Self {
        Svg { size: [width, height], body: String::new() }
    }

    /// A text, in classes of the style.
    pub fn text(&mut self, [x, y]: [f64; 2], class: &str, text: &str) {
        let text = escape(text);
        self.add(&format!("<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\">{text}</text>"));
    }

    /// A rectangle with a text that is shown where a pointer rests.
    pub fn rectangle(
        &mut self,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
        class: &str,
        title: &str,
    ) {
        let title = match title {
            "" => String::new(),
            text => format!("<title>{}</title>", escape(text)),
        };
        self.add(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             class=\"{class}\">{title}</rect>"
        ));
    }

    /// A path.
    pub fn path(&mut self, class: &str, path: &str) {
        self.add(&format!("<path class=\"{class}\" d=\"{path}\"/>"));
    }

    /// A line.
    pub fn line(&mut self, class: &str, [x, y]: [f64; 2], [to_x, to_y]: [f64; 2]) {
        self.path(class, &format!("M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}"));
    }

    /// A line through points.
    pub fn lines(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        let mut path = String::new();
        for (i, [x, y]) in points.into_iter().enumerate() {
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        self.path(class, &path);
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, class: &str) {
        self.add(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" class=\"{class}\"/>"
        ));
    }

    /// A ring that is seen on any colour.
    pub fn ring(&mut self, [x, y]: [f64; 2]) {
        for (colour, width) in [("#ffffff", 4.5), ("#000000", 2.0)] {
            self.add(&format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"7\" fill=\"none\" stroke=\"{colour}\" \
                 stroke-width=\"{width}\"/>"
            ));
        }
    }

    /// A picture that fills a frame.
    pub fn image(&mut self, frame: Frame, address: &str) {
        let Frame { left, top, width, height } = frame;
        self.add(&format!(
            "<image x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" \
             preserveAspectRatio=\"none\" href=\"{address}\"/>"
        ));
    }

    /// Ticks along the lower edge of a frame, by their share of its width.
    pub fn ticks_below(&mut self, frame: Frame, ticks: &[(f64, String)], grid: bool) {
        for (share, text) in ticks {
            let [x, y] = frame.at([*share, 0.0]);
            let top = if grid { frame.top } else { y };
            self.line(if grid { "grid" } else { "frame" }, [x, y + 4.0], [x, top]);
            self.text([x, y + 17.0], "d m", text);
        }
    }

    /// Ticks along the left edge of a frame, by their share of its height.
    pub fn ticks_beside(&mut self, frame: Frame, ticks: &[(f64, String)], grid: bool) {
        for (share, text) in ticks {
            let [x, y] = frame.at([0.0, *share]);
            let right = if grid { x + frame.width } else { x };
            self.line(if grid { "grid" } else { "frame" }, [x - 4.0, y], [right, y]);
            self.text([x - 7.0, y + 4.0], "d e", text);
        }
    }

    /// The edge of a frame.
    pub fn frame(&mut self, Frame { left, top, width, height }: Frame) {
        self.rectangle([left, top], [width, height], "frame", "");
    }

    fn add(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// The element, and what it shows in words.
    pub fn finish(self, label: &str) -> String {
        let [width, height] = self.size;
        format!(
            "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
             role=\"img\" aria-label=\"{}\">\n{}</svg>\n",
            escape(label),
            self.body
        )
    }
}

/// Values for ticks, the dearest first: those that keep this distance from each other.
pub fn apart(values: &[f64], place: impl Fn(f64) -> f64, distance: f64) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for &value in values {
        let is_free = kept.iter().all(|&other| (place(other) - place(value)).abs() >= distance);
        if is_free {
            kept.push(value);
        }
    }
    kept
}
