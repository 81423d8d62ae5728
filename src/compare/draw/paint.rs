//! A drawing in pixels.

use super::{Anchor, Colour, Drawing, Shape, font};
use crate::error::{Error, Result};
use crate::image::Picture;
use tiny_skia::{FillRule, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

pub fn paint(drawing: &Drawing, scale: f64) -> Result<Picture> {
    let length = |length: f64| (length * scale).round() as u32;
    let sheet = Pixmap::new(length(drawing.width), length(drawing.height));
    let mut sheet = sheet.ok_or_else(|| Error::Internal("a drawing without pixels".into()))?;
    sheet.fill(tiny_skia::Color::WHITE);
    for shape in &drawing.shapes {
        paint_shape(&mut sheet, shape, scale)?;
    }
    let rgb = sheet
        .pixels()
        .iter()
        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    Ok(Picture { width: sheet.width() as usize, height: sheet.height() as usize, rgb })
}

fn paint_shape(sheet: &mut Pixmap, shape: &Shape, scale: f64) -> Result<()> {
    let enlarge = Transform::from_scale(scale as f32, scale as f32);
    match shape {
        Shape::Path { points, line, fill, dashed, .. } => {
            let mut path = PathBuilder::new();
            for (i, &(x, y)) in points.iter().enumerate() {
                if i == 0 {
                    path.move_to(x as f32, y as f32)
                } else {
                    path.line_to(x as f32, y as f32)
                }
            }
            if fill.is_some() {
                path.close();
            }
            let Some(path) = path.finish() else { return Ok(()) };
            if let Some(colour) = fill {
                sheet.fill_path(&path, &ink(*colour), FillRule::Winding, enlarge, None);
            }
            if let Some((colour, width)) = line {
                let dash = if *dashed {
                    StrokeDash::new(super::svg::DASH.map(|x| x as f32).to_vec(), 0.0)
                } else {
                    None
                };
                let stroke = Stroke { width: *width as f32, dash, ..Stroke::default() };
                sheet.stroke_path(&path, &ink(*colour), &stroke, enlarge, None);
            }
        }
        Shape::Text { at, text, size, anchor, colour, upright } => {
            let back = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => -0.5 * font::width_of(text, *size),
                Anchor::End => -font::width_of(text, *size),
            };
            let turn = if *upright { -90.0 } else { 0.0 };
            let place = enlarge
                .pre_translate(at.0 as f32, at.1 as f32)
                .pre_rotate(turn)
                .pre_translate(back as f32, 0.0);
            if let Some(path) = font::outline(text, *size)?.finish() {
                sheet.fill_path(&path, &ink(*colour), FillRule::Winding, place, None);
            }
        }
        Shape::Image { at, size, picture, .. } => {
            let start = |at: f64| (at * scale).round().max(0.0) as usize;
            let end = |at: f64, limit: u32| start(at).min(limit as usize);
            let (width, height) = (sheet.width(), sheet.height());
            for y in start(at.1)..end(at.1 + size.1, height) {
                for x in start(at.0)..end(at.0 + size.0, width) {
                    let place = |x: usize, at: f64, size: f64, n: usize| {
                        (((x as f64 + 0.5) / scale - at) / size * n as f64)
                            .clamp(0.0, n as f64 - 1.0) as usize
                    };
                    let (i, j) = (
                        place(x, at.0, size.0, picture.width),
                        place(y, at.1, size.1, picture.height),
                    );
                    let from = 3 * (j * picture.width + i);
                    let to = 4 * (y * width as usize + x);
                    sheet.data_mut()[to..to + 3].copy_from_slice(&picture.rgb[from..from + 3]);
                }
            }
        }
    }
    Ok(())
}

fn ink([r, g, b]: Colour) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint
}
