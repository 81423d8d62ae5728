//! OpenEXR: R, G, B in half or float, losslessly compressed. three.js refuses files with fewer than three channels.

use super::metadata::{KEY, TOOL, metadata};
use super::rgb_planes;
use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::table::Table;
use ::exr::image::Layers;
use ::exr::meta::attribute::AttributeValue;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, LineOrder, Text, Vec2, WritableImage, f16,
};

/// The bytes of an EXR file; several tables are as many parts, named for their F0.
pub fn encode(tables: &[Table], precision: Precision) -> Result<Vec<u8>> {
    let layers: Layers<AnyChannels<FlatSamples>> =
        tables.iter().map(|table| layer(table, precision, tables.len() > 1)).collect::<Result<_>>()?;
    let size = tables.first().map_or(Vec2(1, 1), |table| Vec2(table.x.size, table.y.size));
    let image = Image::from_layers(ImageAttributes::new(IntegerBounds::from_dimensions(size)), layers);
    let mut file = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).map_err(|error| failed(&error.to_string()))?;
    Ok(file.into_inner())
}

fn failed(text: &str) -> Error {
    Error::Internal(format!("EXR: {text}"))
}

fn layer(table: &Table, precision: Precision, named: bool) -> Result<Layer<AnyChannels<FlatSamples>>> {
    let samples = |plane: Vec<u32>| match precision {
        Precision::F16 => Ok(FlatSamples::F16(plane.into_iter().map(|bits| f16::from_bits(bits as u16)).collect())),
        Precision::F32 => Ok(FlatSamples::F32(plane.into_iter().map(f32::from_bits).collect())),
        _ => Err(failed("no such precision")),
    };
    let [red, green, blue] = rgb_planes(table, precision)?;
    let channels = [("R", red), ("G", green), ("B", blue)]
        .into_iter()
        .map(|(name, plane)| samples(plane).map(|samples| AnyChannel::new(name, samples)));
    let mut attributes = LayerAttributes { software_name: Some(Text::from(TOOL)), ..LayerAttributes::default() };
    if let (true, Some(f0)) = (named, table.provenance.f0) {
        attributes.layer_name = Some(Text::from(format!("F0 = {f0}").as_str()));
    }
    // One custom attribute and no more: the crate keeps them in a hash map, whose order is not the same twice.
    let text = Text::new_or_none(metadata(table, precision)?).ok_or_else(|| failed("metadata that is not ASCII"))?;
    attributes.other.insert(Text::from(KEY), AttributeValue::Text(text));
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let channels = AnyChannels::sort(channels.collect::<Result<_>>()?);
    Ok(Layer::new(Vec2(table.x.size, table.y.size), attributes, encoding, channels))
}
