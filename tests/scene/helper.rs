//! Small scenes and images, made here.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use splitsum::scene::{Assumptions, Layer, Lobe, Scene, Span, read};
use splitsum::{Error, Result};

/// The bytes of a PNG file of R, G, B, A from a function of the texel.
pub fn png(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let data: Vec<u8> = places.flat_map(|(x, y)| texel(x, y)).collect();
    png_of(width, height, (png::ColorType::Rgba, png::BitDepth::Eight), &data)
}

/// The bytes of a PNG file of any type.
pub fn png_of(
    width: u32,
    height: u32,
    (color, depth): (png::ColorType, png::BitDepth),
    data: &[u8],
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![0, 51, 102, 0, 204, 255]);
        encoder.set_trns(vec![255, 153]);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    file
}

/// A gray JPEG of one block of 8 x 8 for each value, stored as one channel or three. The
/// quantisation is 8, so that the first coefficient of a block is its mean less 128; all others
/// are 0.
pub fn jpeg(values: &[u8], channels: u8) -> Vec<u8> {
    let width = 8 * values.len() as u8;
    let mut file = vec![0xff, 0xd8, 0xff, 0xdb, 0, 67, 0];
    file.extend([8; 64]);
    file.extend([0xff, 0xc0, 0, 8 + 3 * channels, 8, 0, 8, 0, width, channels]);
    file.extend((1..=channels).flat_map(|channel| [channel, 0x11, 0]));
    // Twelve sizes of means with four bits each, then the end of a block with one bit.
    file.extend([0xff, 0xc4, 0, 31, 0x00, 0, 0, 0, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    file.extend(0..12);
    file.extend([0xff, 0xc4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    file.extend([0xff, 0xda, 0, 6 + 2 * channels, channels]);
    file.extend((1..=channels).flat_map(|channel| [channel, 0]));
    file.extend([0, 63, 0]);
    let means = values.iter().map(|&value| i32::from(value) - 128);
    let mut last = 0;
    let mut bits = String::new();
    for mean in means {
        bits.push_str(&block_of(mean - last));
        last = mean;
        // Chroma stays at 128.
        bits.extend((1..channels).map(|_| "00000"));
    }
    while !bits.len().is_multiple_of(8) {
        bits.push('1');
    }
    for byte in bits.as_bytes().chunks(8) {
        let byte = byte.iter().fold(0, |byte, &bit| 2 * byte + (bit - b'0'));
        file.push(byte);
        if byte == 0xff {
            file.push(0);
        }
    }
    file.extend([0xff, 0xd9]);
    file
}

/// The bits of a block whose mean lies so far above that of the block before.
fn block_of(step: i32) -> String {
    let size = 32 - step.unsigned_abs().leading_zeros();
    let code = if step < 0 { step + (1 << size) - 1 } else { step };
    let code =
        if size > 0 { format!("{code:0size$b}", size = size as usize) } else { String::new() };
    format!("{size:04b}{code}0")
}

/// A KTX2 file of bytes of R, G, B, A; its levels as they are stored.
pub fn ktx2(width: u32, height: u32, supercompression: u32, levels: &[&[u8]]) -> Vec<u8> {
    let mut file = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    let levels_count = levels.len() as u32;
    for word in [37, 1, width, height, 0, 0, 1, levels_count, supercompression] {
        file.extend(u32::to_le_bytes(word));
    }
    file.resize(80, 0);
    let mut start = 80 + 24 * levels.len();
    for level in levels {
        for long in [start, level.len(), level.len()] {
            file.extend((long as u64).to_le_bytes());
        }
        start += level.len();
    }
    file.extend(levels.concat());
    file
}

/// A data: URI.
pub fn uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes))
}

/// A glTF file of these parts.
pub fn gltf(mut parts: Value) -> Vec<u8> {
    parts["asset"] = json!({"version": "2.0"});
    serde_json::to_vec(&parts).unwrap()
}

/// A glTF file of one material with textures 0, 1, … of these images.
pub fn with_images(material: Value, images: &[&[u8]]) -> Vec<u8> {
    let textures: Vec<Value> = (0..images.len()).map(|source| json!({"source": source})).collect();
    let images: Vec<Value> = images.iter().map(|bytes| json!({"uri": uri(bytes)})).collect();
    gltf(json!({"materials": [material], "textures": textures, "images": images}))
}

/// A GLB file of JSON and data.
pub fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

/// No file is beside the scene.
pub fn no_files(path: &str) -> Result<Vec<u8>> {
    Err(Error::bad_input(path, "no file", "a request", "give none"))
}

/// A scene without files beside it.
pub fn scene(bytes: &[u8]) -> Scene {
    read("test.gltf", bytes, &Assumptions::default(), &no_files).unwrap()
}

/// The error of a scene.
pub fn refused(bytes: &[u8]) -> String {
    let error = read("test.gltf", bytes, &Assumptions::default(), &no_files).unwrap_err();
    assert!(matches!(error, Error::BadInput(_)), "{error}");
    error.to_string()
}

/// The lobes of one material without textures.
pub fn lobes(material: Value) -> Vec<Lobe> {
    scene(&gltf(json!({"materials": [material]}))).lobes
}

/// The only lobe of one material.
pub fn lobe(material: Value) -> Lobe {
    let lobes = lobes(material);
    assert_eq!(lobes.len(), 1);
    lobes.into_iter().next().unwrap()
}

/// The base of a scene's first material.
pub fn base(bytes: &[u8]) -> Lobe {
    let scene = scene(bytes);
    scene.lobes.into_iter().find(|lobe| lobe.layer == Layer::Base).unwrap()
}

/// Asserts that an interval has these ends, up to the rounding of f64.
#[track_caller]
pub fn close(span: Span, low: f64, high: f64) {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    assert!(near(span.low, low) && near(span.high, high), "{span:?}, not {low}..{high}");
}
