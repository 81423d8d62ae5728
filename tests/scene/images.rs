//! Images of all kinds, and what is read of them.

use super::helper::{
    base, close, glb, gltf, jpeg, ktx2, no_files, png, png_of, scene, uri, with_images,
};
use png::{BitDepth, ColorType};
use serde_json::{Value, json};
use splitsum::scene::{Assumptions, Lobe, Span, read};
use std::cell::Cell;

/// A material whose roughness and metalness come from texture 0.
fn textured(metallic: f64, roughness: f64) -> Value {
    json!({"pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": roughness,
        "metallicRoughnessTexture": {"index": 0}}})
}

/// The roughness that an image gives.
fn roughness(image: &[u8]) -> Lobe {
    base(&with_images(textured(0.0, 1.0), &[image]))
}

#[test]
fn roughness_is_green_times_the_factor() {
    let image = png(16, 16, |x, y| [255, (51 + x + 10 * y) as u8, 255, 7]);
    let found = base(&with_images(textured(0.0, 0.5), &[&image]));
    close(found.roughness, 0.1, 0.5 * 216.0 / 255.0);
    let counts = found.histogram.unwrap();
    assert_eq!(counts.iter().sum::<u64>(), 256);
    assert_eq!((counts[0], counts[7]), (0, 0));
    assert!(found.from[0].contains("texture 0 (image 0, 16x16) x 0.5"), "{:?}", found.from);
}

#[test]
fn png_of_every_type_is_read() {
    let wide = [0x33, 0x33, 0xff, 0xff];
    for (kind, width, data, low, high) in [
        ((ColorType::Grayscale, BitDepth::Eight), 2, vec![51, 204], 0.2, 0.8),
        ((ColorType::Grayscale, BitDepth::Sixteen), 2, wide.to_vec(), 0.2, 1.0),
        ((ColorType::Grayscale, BitDepth::One), 2, vec![0x40], 0.0, 1.0),
        ((ColorType::Grayscale, BitDepth::Four), 2, vec![0x3f], 0.2, 1.0),
        ((ColorType::GrayscaleAlpha, BitDepth::Eight), 1, vec![51, 0], 0.2, 0.2),
        ((ColorType::Indexed, BitDepth::One), 2, vec![0x40], 0.2, 0.8),
        ((ColorType::Rgb, BitDepth::Eight), 1, vec![9, 102, 9], 0.4, 0.4),
    ] {
        close(roughness(&png_of(width, 1, kind, &data)).roughness, low, high);
    }
    // The palette's second colour is transparent by 0.6.
    let image = png_of(2, 1, (ColorType::Indexed, BitDepth::One), &[0x40]);
    let glossy = json!({"specularGlossinessTexture": {"index": 0}});
    let material = json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": glossy}});
    close(base(&with_images(material, &[&image])).roughness, 0.0, 0.4);
}

#[test]
fn jpeg_is_read_and_noted() {
    let gray = jpeg(&[51, 204, 100], 1);
    close(roughness(&jpeg(&[51, 204, 100], 3)).roughness, 0.2, 0.8);
    let file = with_images(textured(0.0, 1.0), &[&gray]);
    let found = scene(&file);
    close(found.lobes[0].roughness, 0.2, 0.8);
    assert!(found.lobes[0].from[0].contains("24x8"), "{:?}", found.lobes[0].from);
    assert!(found.notes.iter().any(|note| note.contains("JPEG")), "{:?}", found.notes);
}

#[test]
fn ktx2_is_read_in_all_its_levels() {
    let large = [[0, 51, 0, 0], [0, 102, 0, 0]].concat();
    let small = [0, 204, 0, 0];
    close(roughness(&ktx2(2, 1, 0, &[&large])).roughness, 0.2, 0.4);
    close(roughness(&ktx2(2, 1, 0, &[&large, &small])).roughness, 0.2, 0.8);
    let level = ruzstd::encoding::CompressionLevel::Fastest;
    let packed = ruzstd::encoding::compress_to_vec(large.as_slice(), level);
    close(roughness(&ktx2(2, 1, 2, &[&packed])).roughness, 0.2, 0.4);
}

#[test]
fn images_lie_in_buffers_and_files_too() {
    let image = png(1, 1, |_, _| [0, 51, 0, 0]);
    let parts = |image: Value, buffer: Value| {
        gltf(json!({"materials": [textured(0.0, 1.0)], "textures": [{"source": 0}],
            "images": [image], "buffers": [buffer],
            "bufferViews": [{"buffer": 0, "byteOffset": 3, "byteLength": image_length()}]}))
    };
    let view = json!({"bufferView": 0, "mimeType": "image/png"});
    let data = [b"abc", image.as_slice()].concat();
    let in_glb = glb(&parts(view.clone(), json!({"byteLength": data.len()})), &data);
    close(base(&in_glb).roughness, 0.2, 0.2);
    let in_uri = parts(view.clone(), json!({"byteLength": data.len(), "uri": uri(&data)}));
    close(base(&in_uri).roughness, 0.2, 0.2);
    let files = |path: &str| match path {
        "a folder/b.png" => Ok(image.clone()),
        "c.bin" => Ok(data.clone()),
        other => no_files(other),
    };
    let beside = |file: &[u8]| {
        let scene = read("a.gltf", file, &Assumptions::default(), &files).unwrap();
        scene.lobes[0].clone()
    };
    let file = parts(json!({"uri": "a%20folder/b.png"}), json!({"byteLength": 0}));
    let found = beside(&file);
    close(found.roughness, 0.2, 0.2);
    assert!(found.from[0].contains("(b.png, 1x1)"), "{:?}", found.from);
    close(beside(&parts(view, json!({"byteLength": 9, "uri": "c.bin"}))).roughness, 0.2, 0.2);
}

fn image_length() -> usize {
    png(1, 1, |_, _| [0, 51, 0, 0]).len()
}

#[test]
fn an_image_of_two_materials_is_fetched_once() {
    let image = png(4, 4, |x, _| [0, 60 * x as u8, 0, 0]);
    let fetched = Cell::new(0);
    let files = |_: &str| {
        fetched.set(fetched.get() + 1);
        Ok(image.clone())
    };
    let file = gltf(json!({"materials": [textured(0.0, 1.0), textured(0.0, 0.5)],
        "textures": [{"source": 0}], "images": [{"uri": "a.png"}]}));
    let scene = read("a.gltf", &file, &Assumptions::default(), &files).unwrap();
    close(scene.lobes[0].roughness, 0.0, 180.0 / 255.0);
    close(scene.lobes[1].roughness, 0.0, 90.0 / 255.0);
    assert_eq!(fetched.get(), 1);
}

/// Metal where the base is white, dielectric where it is dark.
fn metal_and_dielectric(width: u32) -> Lobe {
    let metalness = png(2, 1, |x, _| [0, 255, if x == 0 { 255 } else { 0 }, 255]);
    let colour = png(width, 1, |x, _| if x == 0 { [255; 4] } else { [13, 13, 13, 255] });
    let material = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 1},
        "metallicRoughnessTexture": {"index": 0}}});
    base(&with_images(material, &[&metalness, &colour]))
}

#[test]
fn metalness_and_colour_of_one_size_are_taken_texel_by_texel() {
    close(metal_and_dielectric(2).f0, 0.04, 1.0);
    // Over all combinations there is dark metal too: 13/255 in sRGB is 0.0040.
    let box_of_both = metal_and_dielectric(4).f0;
    assert!(box_of_both.low < 0.005 && box_of_both.high == 1.0, "{box_of_both:?}");
}

#[test]
fn ignored_texels_narrow_the_intervals_and_are_noted() {
    let image = png(100, 10, |x, y| {
        let rough = if (x, y) == (0, 0) { 0 } else { 102 };
        [0, rough, if (x, y) == (9, 9) { 255 } else { 0 }, 255]
    });
    let white = png(100, 10, |_, _| [255; 4]);
    let material = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 1},
        "metallicRoughnessTexture": {"index": 0}}});
    let file = with_images(material, &[&image, &white]);
    let strict = base(&file);
    close(strict.roughness, 0.0, 0.4);
    close(strict.f0, 0.04, 1.0);
    let assumptions = Assumptions { ignore_texels: 0.001, ..Default::default() };
    let scene = read("a.gltf", &file, &assumptions, &no_files).unwrap();
    close(scene.lobes[0].roughness, 0.4, 0.4);
    close(scene.lobes[0].f0, 0.04, 0.04);
    assert!(scene.notes.iter().any(|note| note.contains("nothing is proved")));
}

#[test]
fn what_is_not_read_may_be_anything_up_to_the_factor() {
    let fallback = png(1, 1, |_, _| [0, 51, 0, 0]);
    let basis = {
        let mut file = ktx2(4, 4, 1, &[&[0; 16]]);
        file[12] = 0;
        file
    };
    let file = gltf(json!({
        "materials": [textured(0.0, 0.9)],
        "textures": [{"source": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}}],
        "images": [{"uri": uri(&fallback)}, {"uri": uri(&basis)}]
    }));
    let found = scene(&file);
    assert_eq!(found.lobes[0].roughness, Span { low: 0.0, high: 0.9 });
    assert_eq!(found.lobes[0].histogram, None);
    assert!(found.notes.iter().any(|note| note.contains("Basis Universal")), "{:?}", found.notes);
}
