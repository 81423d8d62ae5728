//! Bevy's own asset loader of images.

use super::Result;
use bevy_image::{CompressedImageFormats, Image, ImageSampler, ImageType};

/// 0 where the image has these bytes.
pub fn read(path: &str, file: &[u8], raw: &[u8]) -> Result<f64> {
    let extension = path.rsplit('.').next().unwrap_or_default();
    let image = Image::from_buffer(
        file,
        ImageType::Extension(extension),
        CompressedImageFormats::NONE,
        false,
        ImageSampler::linear(),
        Default::default(),
    )?;
    match image.data {
        Some(data) if data == raw => Ok(0.0),
        Some(data) => Err(format!("other bytes, {} for {}", data.len(), raw.len()).into()),
        None => Err("no data".into()),
    }
}
