//! Files that are broken, or made to break a reader.

use super::helper::{
    glb, gltf, jpeg, ktx2, no_files, png, png_of, refused, scene, uri, with_images,
};
use png::{BitDepth, ColorType};
use serde_json::{Value, json};
use splitsum::Error;
use splitsum::scene::{Assumptions, Scene, Span, read};

/// The texture of a material's roughness.
fn textured() -> Value {
    json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5,
        "metallicRoughnessTexture": {"index": 0}}})
}

/// Asserts that an image is not read, and why.
#[track_caller]
fn unread(scene: &Scene, why: &str) {
    assert_eq!(scene.lobes[0].roughness, Span { low: 0.0, high: 0.5 }, "{:?}", scene.notes);
    assert!(scene.notes.iter().any(|note| note.contains(why)), "{why}: {:?}", scene.notes);
}

#[test]
fn glb_of_wrong_lengths_is_refused() {
    let whole = glb(&gltf(json!({"materials": [{}]})), &[7; 40]);
    // Every cut at once, and lengths that lie.
    for end in 0..whole.len() {
        refused(&whole[..end]);
    }
    for (place, value) in [(4, 1), (8, 0), (8, 11), (8, u32::MAX), (12, u32::MAX), (16, 0)] {
        let mut file = whole.clone();
        file[place..place + 4].copy_from_slice(&u32::to_le_bytes(value));
        refused(&file);
    }
    // What follows the stated length is no part of it.
    assert_eq!(scene(&[whole.as_slice(), b"more"].concat()), scene(&whole));
}

#[test]
fn files_that_are_no_scene_are_refused() {
    let deep = "[".repeat(200_000);
    let deep = format!(r#"{{"asset": {{"version": "2.0"}}, "extras": {deep}"#);
    let many =
        format!(r#"{{"asset": {{"version": "2.0"}}, "extras": "{}"}}"#, "{".repeat(4_000_001));
    for file in [
        "",
        "null",
        "[]",
        "{}",
        "{\"asset\": ",
        r#"{"asset": {"version": "1.0"}, "materials": {}}"#,
        r#"{"asset": {"version": "2.0"}, "materials": [{"name": 3}]}"#,
        r#"{"asset": {"version": "2.0"}, "materials": [{"pbrMetallicRoughness":
            {"roughnessFactor": 1e999}}]}"#,
        r#"{"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"material": -1}]}]}"#,
        &deep,
        &many,
    ] {
        let error = refused(file.as_bytes());
        assert!(error.len() < 500, "{error}");
    }
    refused(b"\xff\xfe\0\0");
}

#[test]
fn factors_beyond_their_range_name_the_material() {
    for (name, factors) in [
        ("roughnessFactor", json!({"roughnessFactor": 1.5})),
        ("metallicFactor", json!({"metallicFactor": -0.5})),
        ("baseColorFactor", json!({"baseColorFactor": [1e300, 0, 0, 1]})),
    ] {
        let material = json!({"name": "oak", "pbrMetallicRoughness": factors});
        let error = refused(&gltf(json!({"materials": [material]})));
        assert!(error.contains(&format!("{name} of oak: expected 0 to 1")), "{error}");
    }
    // A rounding of f32 is none.
    let material = json!({"pbrMetallicRoughness": {"roughnessFactor": 1.0000001}});
    assert_eq!(scene(&gltf(json!({"materials": [material]}))).lobes[0].roughness, Span::point(1.0));
}

#[test]
fn indices_beyond_their_lists_are_found() {
    let error = refused(&gltf(json!({"materials": [{}],
        "meshes": [{"primitives": [{"material": 7}]}]})));
    assert!(error.contains("material 7"), "{error}");
    let parts = |more: Value| {
        let mut parts = json!({"materials": [textured()]});
        for (key, value) in more.as_object().unwrap() {
            parts[key] = value.clone();
        }
        scene(&gltf(parts))
    };
    let largest = usize::MAX;
    unread(&parts(json!({})), "no texture 0");
    unread(&parts(json!({"textures": [{}]})), "no image");
    unread(&parts(json!({"textures": [{"source": largest}]})), "no image");
    let texture = json!([{"source": 0}]);
    unread(&parts(json!({"textures": texture, "images": [{}]})), "neither");
    let image = json!([{"bufferView": 0}]);
    unread(&parts(json!({"textures": texture, "images": image})), "no buffer view 0");
    let view = |buffer: usize, offset: usize, length: usize| {
        let views = json!([{"buffer": buffer, "byteOffset": offset, "byteLength": length}]);
        parts(json!({"textures": texture, "images": image, "bufferViews": views,
            "buffers": [{"byteLength": 4, "uri": uri(b"abcd")}]}))
    };
    unread(&view(9, 0, 4), "no buffer 9");
    unread(&view(0, 2, 3), "leaves buffer 0");
    unread(&view(0, largest, 2), "leaves buffer 0");
    unread(&view(0, 0, 4), "neither PNG nor JPEG");
}

#[test]
fn huge_accessors_are_not_followed() {
    for (count, stride, offset) in
        [(usize::MAX, 4, 0), (3, usize::MAX, 0), (0, 4, 0), (2, 1, 1), (1, 4, usize::MAX)]
    {
        let found = scene(&gltf(json!({
            "materials": [textured()],
            "buffers": [{"uri": uri(&[0; 4])}],
            "bufferViews": [{"buffer": 0, "byteLength": 4, "byteStride": stride}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": count,
                "byteOffset": offset, "type": "SCALAR"}],
            "animations": [{"samplers": [{"output": 0}], "channels": [{"sampler": 0, "target":
                {"extensions": {"KHR_animation_pointer":
                    {"pointer": "/materials/0/pbrMetallicRoughness/metallicFactor"}}}}]}]
        })));
        assert!(found.notes.iter().any(|note| note.contains("metallicFactor of material 0")));
        assert_eq!(found.lobes[0].f0, Span { low: 0.04, high: 1.0 });
    }
}

#[test]
fn uris_stay_in_the_folder() {
    for (bad, why) in [
        ("/etc/passwd", "absolute"),
        ("file:///etc/passwd", "scheme"),
        ("https://example.com/a.png", "scheme"),
        ("C:%5Ca.png", "scheme"),
        ("%5C%5Cserver%5Ca.png", "absolute"),
        ("../a.png", "'..'"),
        ("a/%2e%2e/%2E%2E/b.png", "'..'"),
        ("a%5C..%5Cb.png", "'..'"),
        ("a%00.png", "no name"),
        ("", "no name"),
        ("%ff%fe", "UTF-8"),
        ("data:image/png;base64", "comma"),
        ("data:image/png;base64,!!!!", "base64"),
        ("data:image/png;base64,", "empty"),
        (&"a".repeat(5000), "too long"),
        ("missing.png", "expected no file"),
    ] {
        let files = |path: &str| {
            assert_eq!(path, "missing.png");
            no_files(path)
        };
        let file = gltf(json!({"materials": [textured()], "textures": [{"source": 0}],
            "images": [{"uri": bad}]}));
        unread(&read("a.gltf", &file, &Assumptions::default(), &files).unwrap(), why);
    }
}

#[test]
fn images_too_large_are_not_decoded() {
    let whole = png_of(1, 1, (ColorType::Grayscale, BitDepth::Eight), &[9]);
    let mut bomb = whole.clone();
    bomb[16..20].copy_from_slice(&20_000u32.to_be_bytes());
    bomb[20..24].copy_from_slice(&20_000u32.to_be_bytes());
    let sum = crc32(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&sum.to_be_bytes());
    unread(&scene(&with_images(textured(), &[&bomb])), "20000 x 20000 texels are too many");
    let mut large = jpeg(&[9], 1);
    let frame = large.windows(2).position(|bytes| bytes == [0xff, 0xc0]).unwrap();
    large[frame + 5..frame + 9].copy_from_slice(&[0x30, 0, 0x30, 0]);
    unread(&scene(&with_images(textured(), &[&large])), "12288 x 12288");
    unread(&scene(&with_images(textured(), &[&ktx2(1 << 20, 1, 0, &[&[]])])), "1048576 x 1");
}

/// The checksum of PNG's chunks.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 * (sum & 1)))
    })
}

#[test]
fn broken_images_are_not_read_and_break_nothing() {
    let picture = png(8, 8, |x, y| [x as u8, (8 * y) as u8, 0, 9]);
    let texels = [9; 256];
    for whole in [picture, jpeg(&[51, 204], 3), ktx2(8, 8, 0, &[&texels])] {
        let cut = &whole[..whole.len() / 2];
        unread(&scene(&with_images(textured(), &[cut])), "(image 0, not read)");
        for place in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut file = whole.clone();
                file[place] ^= flip;
                let lobe = &scene(&with_images(textured(), &[&file])).lobes[0];
                assert!(lobe.roughness.is_in(Span { low: 0.0, high: 0.5 }));
            }
        }
    }
}

#[test]
fn a_file_with_a_wrong_byte_is_read_or_refused() {
    let image = png(2, 2, |x, y| [90, (80 * x) as u8, (255 * y) as u8, 9]);
    let texture = json!({"index": 0});
    let json = gltf(json!({
        "materials": [{
            "pbrMetallicRoughness":
                {"metallicRoughnessTexture": texture, "baseColorTexture": texture},
            "extensions": {
                "KHR_materials_specular": {"specularTexture": texture},
                "KHR_materials_clearcoat": {"clearcoatFactor": 1},
                "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}
            }
        }],
        "meshes": [{"primitives": [{"material": 0}]}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": image.len()},
            {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
        "accessors": [{"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
        "buffers": [{"byteLength": image.len()}],
        "animations": [{"samplers": [{"output": 0}], "channels": [{"sampler": 0, "target":
            {"extensions": {"KHR_animation_pointer":
                {"pointer": "/materials/0/pbrMetallicRoughness/baseColorFactor"}}}}]}]
    }));
    let whole = glb(&json, &image);
    assert_eq!(scene(&whole).lobes.len(), 3);
    let mut read_anyway = 0;
    for place in 0..whole.len() {
        for wrong in [b'0', b'9', b'"', b'-', 0xff] {
            let mut file = whole.clone();
            file[place] = wrong;
            match read("a.glb", &file, &Assumptions::default(), &no_files) {
                Ok(scene) => {
                    assert!(scene.lobes.iter().all(|lobe| lobe.roughness.is_in(Span::UNIT)));
                    read_anyway += 1;
                }
                Err(error) => assert!(matches!(error, Error::BadInput(_)), "{error}"),
            }
        }
    }
    assert!(read_anyway > 100);
}

#[test]
fn notes_are_bounded() {
    let materials: Vec<Value> = (0..3000)
        .map(
            |index| json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": index}}}),
        )
        .collect();
    let found = scene(&gltf(json!({"materials": materials})));
    assert_eq!(found.lobes.len(), 3000);
    assert!(found.notes.len() < 1010, "{}", found.notes.len());
    assert!(found.notes.iter().any(|note| note.contains("further notes")));
}
