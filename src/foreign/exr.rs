//! OpenEXR: flat layers of halves and floats, each a slice. Sizes are read from the header before
//! the crate allocates what they ask for.

use super::shape::count;
use super::{Foreign, Read, refuse, refused};
use crate::error::clean;
use crate::format::metadata::KEY;
use crate::table::precision::Precision;
use ::exr::image::{AnyChannel, FlatSamples};
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{AttributeValue, SampleType};
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, Vec2, read as reader};
use std::io::Cursor;

/// The numbers that a byte of a file may hold: the best compression of numbers that are no table.
/// A file that promises more is refused before its promise is allocated.
const MOST_A_BYTE: usize = 2000;

pub fn read(bytes: &[u8]) -> Read<Foreign> {
    let failed = |error| refused("EXR", error);
    let metadata = MetaData::read_from_buffered(bytes, true).map_err(failed)?;
    let [first, ..] = &metadata.headers[..] else { return refuse("a layer", "none") };
    let Vec2(columns, rows) = first.layer_size;
    let size = [columns, rows, metadata.headers.len()];
    for header in &metadata.headers {
        check(header, first)?;
    }
    let components = first.channels.list.len();
    let count = count(size, components)?;
    if count > bytes.len().saturating_mul(MOST_A_BYTE) {
        return refuse("a file of that size", format!("{count} numbers in {} bytes", bytes.len()));
    }
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    let order = order(&image.layer_data[0].channel_data.list);
    let mut values = vec![0.0; count];
    let mut storage = Precision::F16;
    for (slice, layer) in image.layer_data.iter().enumerate() {
        let channels = &layer.channel_data.list;
        if channels.len() != components {
            return refuse("layers with the same channels", "others");
        }
        for (component, &channel) in order.iter().enumerate() {
            let at = slice * columns * rows * components + component;
            let values = values[at..].iter_mut().step_by(components).take(columns * rows);
            if copy(&channels[channel].sample_data, values)? == Precision::F32 {
                storage = Precision::F32;
            }
        }
    }
    let mut table = Foreign::new("EXR", size, components, storage, values);
    let channels = &image.layer_data[0].channel_data.list;
    table.names = order.iter().map(|&at| clean(&channels[at].name.to_string(), 40)).collect();
    for layer in &image.layer_data {
        if let Some(AttributeValue::Text(text)) = layer.attributes.other.get(KEY.as_bytes()) {
            table.own.push(text.to_string());
        }
    }
    Ok(table)
}

/// Refuses what a table is not: deep or subsampled texels, whole numbers, layers of other sizes.
fn check(header: &Header, first: &Header) -> Read<()> {
    if header.deep {
        return refuse("flat layers", "a deep one");
    }
    if header.layer_size != first.layer_size
        || header.channels.list.len() != first.channels.list.len()
    {
        return refuse("layers of one size with the same channels", "others");
    }
    for channel in &header.channels.list {
        if channel.sampling != Vec2(1, 1) || channel.sample_type == SampleType::U32 {
            let name = clean(&channel.name.to_string(), 40);
            return refuse("halves or floats for every texel", format!("channel {name}"));
        }
    }
    Ok(())
}

/// The places of channels in the order R, G, B, A, then others by name, as the file has them.
fn order(channels: &[AnyChannel<FlatSamples>]) -> Vec<usize> {
    let rank = |name: &str| {
        let last = name.rsplit('.').next().unwrap_or(name);
        ["R", "G", "B", "A"].iter().position(|known| *known == last).unwrap_or(4)
    };
    let mut order: Vec<usize> = (0..channels.len()).collect();
    order.sort_by_key(|&at| rank(&channels[at].name.to_string()));
    order
}

/// Copies the samples of a channel; their storage.
fn copy<'a>(samples: &FlatSamples, values: impl Iterator<Item = &'a mut f32>) -> Read<Precision> {
    match samples {
        FlatSamples::F16(samples) => {
            values.zip(samples).for_each(|(value, half)| *value = half.to_f32());
            Ok(Precision::F16)
        }
        FlatSamples::F32(samples) => {
            values.zip(samples).for_each(|(value, float)| *value = *float);
            Ok(Precision::F32)
        }
        FlatSamples::U32(_) => refuse("halves or floats", "whole numbers"),
    }
}
