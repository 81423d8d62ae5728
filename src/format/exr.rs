//! OpenEXR: R, G, B in half or float, losslessly compressed. three.js refuses files with fewer than
//! three channels.

use super::metadata::{KEY, TOOL, metadata};
use super::{WriteSeek, failed, texel_bytes};
use crate::error::{Error, Result};
use crate::table::Table;
use crate::table::precision::Precision;
use ::exr::error::Error as ExrError;
use ::exr::image::{Layers, SpecificChannels};
use ::exr::meta::attribute::AttributeValue;
use ::exr::prelude::{
    Blocks, Compression, Encoding, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes,
    LineOrder, Text, Vec2, WritableImage, f16,
};

const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Writes an EXR file; slices are as many parts, named for their parameter. Lines are read from the
/// table as they are compressed: no second copy of the values is made.
pub fn write(table: &Table, file: &mut dyn WriteSeek) -> Result<()> {
    // A layer's type depends on how it reads a texel, so that each precision has a type of its own.
    macro_rules! write_as {
        ($sample:ty, $from:expr) => {{
            let layer = |slice| {
                let pixel = move |Vec2(i, j)| {
                    let [red, green, blue] =
                        [0, 1, 2].map(|channel| $from(texel_bytes(table, slice, (i, j), channel)));
                    (red, green, blue)
                };
                let channels = SpecificChannels::build()
                    .with_channel::<$sample>("R")
                    .with_channel::<$sample>("G")
                    .with_channel::<$sample>("B")
                    .with_pixel_fn(pixel);
                Ok(Layer::new(size_of(table), attributes(table, slice)?, ENCODING, channels))
            };
            let layers: Layers<_> =
                (0..table.layout().slice_count()).map(layer).collect::<Result<_>>()?;
            let size = IntegerBounds::from_dimensions(size_of(table));
            let image = Image::from_layers(ImageAttributes::new(size), layers);
            let writer = image.write();
            // The crate has threads of its own: none beside the only one that there is to be.
            let written = match rayon::current_num_threads() {
                1 => writer.non_parallel().to_buffered(file),
                _ => writer.to_buffered(file),
            };
            written.map_err(refused)
        }};
    }
    match table.precision() {
        Precision::F16 => write_as!(f16, f16::from_le_bytes),
        Precision::F32 => write_as!(f32, f32::from_le_bytes),
        Precision::Unorm16 | Precision::Unorm8 | Precision::F64 => {
            Err(internal("a table that is no float"))
        }
    }
}

fn size_of(table: &Table) -> Vec2<usize> {
    Vec2(table.x().size(), table.y().size())
}

fn internal(text: &str) -> Error {
    Error::Internal(format!("EXR: {text}"))
}

fn refused(error: ExrError) -> Error {
    match error {
        ExrError::Io(error) => failed(error),
        other => internal(&other.to_string()),
    }
}

fn attributes(table: &Table, slice: usize) -> Result<LayerAttributes> {
    let mut attributes =
        LayerAttributes { software_name: Some(Text::from(TOOL)), ..LayerAttributes::default() };
    if let Some(slices) = &table.layout().slices {
        attributes.layer_name = Some(Text::from(slices.label(slice).as_str()));
    }
    // One custom attribute and no more: the crate keeps them in a hash map, whose order is not the
    // same twice.
    let text = metadata(table, slice, &["R", "G", "B"])?;
    let text = Text::new_or_none(text).ok_or_else(|| internal("metadata that is not ASCII"))?;
    attributes.other.insert(Text::from(KEY), AttributeValue::Text(text));
    Ok(attributes)
}
