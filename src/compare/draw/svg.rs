//! A drawing as SVG 1.1, its texts as texts and its pictures as PNG within.

use super::{Anchor, Colour, Drawing, Shape, font};
use crate::error::Result;
use crate::format::png::encode_rgb;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

/// Lengths of dashes and of the gaps between them.
pub const DASH: [f64; 2] = [5.0, 3.5];

pub fn write(drawing: &Drawing) -> Result<String> {
    let Drawing { width, height, shapes } = drawing;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{}\">\n<rect width=\"100%\" \
         height=\"100%\" fill=\"#ffffff\"/>\n",
        font::FAMILY
    );
    for shape in shapes {
        write_shape(&mut svg, shape)?;
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

fn write_shape(svg: &mut String, shape: &Shape) -> Result<()> {
    // Writing to a String cannot fail.
    let _ = match shape {
        Shape::Path { points, line, fill, dashed, title } => {
            let place = |(i, (x, y)): (usize, &(f64, f64))| {
                format!("{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' })
            };
            let path: String = points.iter().enumerate().map(place).collect();
            let close = if fill.is_some() { "Z" } else { "" };
            let fill = fill.map_or("none".into(), hex);
            let line = line.map_or(String::new(), |(colour, width)| {
                let dash = if *dashed {
                    format!(" stroke-dasharray=\"{} {}\"", DASH[0], DASH[1])
                } else {
                    String::new()
                };
                format!(" stroke=\"{}\" stroke-width=\"{width}\"{dash}", hex(colour))
            });
            let title = titled(title);
            writeln!(svg, "<path d=\"{path}{close}\" fill=\"{fill}\"{line}>{title}</path>")
        }
        Shape::Text { at: (x, y), text, size, anchor, colour, upright } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn = if *upright {
                format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"")
            } else {
                String::new()
            };
            let (colour, text) = (hex(*colour), escape(text));
            writeln!(
                svg,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                 fill=\"{colour}\"{turn}>{text}</text>"
            )
        }
        Shape::Image { at: (x, y), size: (width, height), picture, title } => {
            let png = STANDARD.encode(encode_rgb(picture.width, picture.height, &picture.rgb)?);
            writeln!(
                svg,
                "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" \
                 preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
                 href=\"data:image/png;base64,{png}\">{}</image>",
                titled(title)
            )
        }
    };
    Ok(())
}

fn titled(title: &str) -> String {
    if title.is_empty() { String::new() } else { format!("<title>{}</title>", escape(title)) }
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
