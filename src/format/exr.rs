//! OpenEXR: R, G, B and, where there is a fourth, A in half or float, losslessly compressed.
//! three.js refuses files with fewer than three channels.

use super::metadata::{KEY, TOOL, metadata};
use super::texels::Texels;
use super::{WriteSeek, failed};
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

/// So many bytes of values are compressed sooner than threads start for them.
const FEW_BYTES: usize = 1 << 18;

/// Writes an EXR file; slices are as many parts, named for their parameter. Lines are read from the
/// table as they are compressed: no second copy of the values is made.
pub fn write(texels: &Texels, file: &mut dyn WriteSeek) -> Result<()> {
    // A layer's type depends on how it reads a texel, so that each precision and number of
    // components has a type of its own.
    macro_rules! write_as {
        ($sample:ty, $from:expr, $($name:literal = $component:literal),+) => {{
            let layer = |slice| {
                let pixel = move |Vec2(i, j)| {
                    ($($from(texels.component(slice, (i, j), $component))),+)
                };
                let channels = SpecificChannels::build()
                    $(.with_channel::<$sample>($name))+
                    .with_pixel_fn(pixel);
                let size = size_of(texels.table);
                Ok(Layer::new(size, attributes(texels, slice)?, ENCODING, channels))
            };
            let layers: Layers<_> = (0..texels.size()[2]).map(layer).collect::<Result<_>>()?;
            let size = IntegerBounds::from_dimensions(size_of(texels.table));
            let image = Image::from_layers(ImageAttributes::new(size), layers);
            let writer = image.write();
            // The crate has threads of its own: none beside the only one that there is to be.
            let bytes = texels.size().iter().product::<usize>() * texels.bytes();
            let alone = rayon::current_num_threads() == 1 || bytes <= FEW_BYTES;
            let written = match alone {
                true => writer.non_parallel().to_buffered(file),
                false => writer.to_buffered(file),
            };
            written.map_err(refused)
        }};
    }
    match (texels.precision(), texels.components()) {
        (Precision::F16, 3) => write_as!(f16, f16::from_le_bytes, "R" = 0, "G" = 1, "B" = 2),
        (Precision::F32, 3) => write_as!(f32, f32::from_le_bytes, "R" = 0, "G" = 1, "B" = 2),
        (Precision::F16, 4) => {
            write_as!(f16, f16::from_le_bytes, "R" = 0, "G" = 1, "B" = 2, "A" = 3)
        }
        (Precision::F32, 4) => {
            write_as!(f32, f32::from_le_bytes, "R" = 0, "G" = 1, "B" = 2, "A" = 3)
        }
        _ => Err(internal("a table that is no float, or has other components")),
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

fn attributes(texels: &Texels, slice: usize) -> Result<LayerAttributes> {
    let mut attributes =
        LayerAttributes { software_name: Some(Text::from(TOOL)), ..LayerAttributes::default() };
    if let Some(slices) = &texels.table.layout().slices {
        attributes.layer_name = Some(Text::from(slices.label(slice).as_str()));
    }
    // One custom attribute and no more: the crate keeps them in a hash map, whose order is not the
    // same twice.
    let text = metadata(texels, slice)?;
    let text = Text::new_or_none(text).ok_or_else(|| internal("metadata that is not ASCII"))?;
    attributes.other.insert(Text::from(KEY), AttributeValue::Text(text));
    Ok(attributes)
}
