//! Writes out/scene.gltf: three spheres to plan a table for, and to look at in any viewer of glTF.
//! A rough dielectric, a metal whose roughness is a texture, and a clear coat over red.
//!
//! ```text
//! cargo run --example scene
//! ```

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::f32::consts::PI;
use std::{error, fs};

/// Steps around a sphere, and from pole to pole.
const COLUMNS: u16 = 48;
const ROWS: u16 = 24;

/// The side of the texture, in texels.
const SIDE: u32 = 128;

/// The roughness of the texture's texels, from 0.25 to 0.8 as codes of 8 bits.
const LEAST: f32 = 64.0;
const LARGEST: f32 = 204.0;

fn main() -> Result<(), Box<dyn error::Error>> {
    let sphere = Sphere::new();
    let scene = scene(&sphere, &texture()?);
    fs::create_dir_all("out")?;
    fs::write("out/scene.gltf", serde_json::to_vec_pretty(&scene)?)?;
    println!("out/scene.gltf: 3 spheres of {} triangles", sphere.indices.len() / 3);
    Ok(())
}

/// The vertices of a sphere of radius 1, where position and normal are the same.
struct Sphere {
    normals: Vec<[f32; 3]>,
    coordinates: Vec<[f32; 2]>,
    indices: Vec<u16>,
}

impl Sphere {
    fn new() -> Self {
        let mut sphere =
            Sphere { normals: Vec::new(), coordinates: Vec::new(), indices: Vec::new() };
        for row in 0..=ROWS {
            for column in 0..=COLUMNS {
                let u = f32::from(column) / f32::from(COLUMNS);
                let v = f32::from(row) / f32::from(ROWS);
                let (sin_phi, cos_phi) = (2.0 * PI * u).sin_cos();
                let (sin_theta, cos_theta) = (PI * v).sin_cos();
                sphere.normals.push([sin_theta * sin_phi, cos_theta, sin_theta * cos_phi]);
                sphere.coordinates.push([u, v]);
                if row == ROWS || column == COLUMNS {
                    continue;
                }
                // A square in two triangles, of which one is left at a pole.
                let here = row * (COLUMNS + 1) + column;
                let below = here + COLUMNS + 1;
                if row > 0 {
                    sphere.indices.extend([here, below, here + 1]);
                }
                if row < ROWS - 1 {
                    sphere.indices.extend([here + 1, below, below + 1]);
                }
            }
        }
        sphere
    }
}

/// A PNG of roughness in green and metalness in blue: stripes that rise and fall from pole to pole.
fn texture() -> Result<Vec<u8>, png::EncodingError> {
    let mut texels = Vec::new();
    for y in 0..SIDE {
        let wave = 0.5 - 0.5 * (6.0 * PI * y as f32 / SIDE as f32).cos();
        let roughness = (LEAST + wave * (LARGEST - LEAST)).round() as u8;
        texels.extend([0, roughness, 255].repeat(SIDE as usize));
    }
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, SIDE, SIDE);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&texels)?;
    Ok(file)
}

fn scene(sphere: &Sphere, texture: &[u8]) -> Value {
    let floats = sphere.normals.as_flattened().iter().chain(sphere.coordinates.as_flattened());
    let mut data: Vec<u8> = floats.flat_map(|float| float.to_le_bytes()).collect();
    let vertices = sphere.normals.len();
    let (coordinates, indices) = (12 * vertices, 20 * vertices);
    data.extend(sphere.indices.iter().flat_map(|index| index.to_le_bytes()));
    let attributes = json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2});
    let mesh = |material: usize| {
        let primitive = json!({"attributes": attributes, "indices": 3, "material": material});
        json!({"primitives": [primitive]})
    };
    let node = |mesh: usize| json!({"mesh": mesh, "translation": [2.5 * mesh as f64 - 2.5, 0, 0]});
    json!({
        "asset": {"version": "2.0", "generator": "splitsum's example scene"},
        "extensionsUsed": ["KHR_materials_clearcoat"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [node(0), node(1), node(2)],
        "meshes": [mesh(0), mesh(1), mesh(2)],
        "materials": materials(),
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987}],
        "images": [{"name": "stripes", "mimeType": "image/png", "uri": uri("image/png", texture)}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
                "min": [-1, -1, -1], "max": [1, 1, 1]},
            {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": sphere.indices.len(),
                "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": coordinates, "target": 34962},
            {"buffer": 0, "byteOffset": coordinates, "byteLength": indices - coordinates,
                "target": 34962},
            {"buffer": 0, "byteOffset": indices, "byteLength": data.len() - indices,
                "target": 34963}
        ],
        "buffers": [{"byteLength": data.len(), "uri": uri("application/octet-stream", &data)}]
    })
}

fn materials() -> Value {
    json!([
        {"name": "rough plastic", "pbrMetallicRoughness":
            {"baseColorFactor": [0.2, 0.3, 0.5, 1], "metallicFactor": 0, "roughnessFactor": 0.6}},
        {"name": "striped gold", "pbrMetallicRoughness":
            {"baseColorFactor": [1.0, 0.77, 0.34, 1], "metallicRoughnessTexture": {"index": 0}}},
        {"name": "coated red", "pbrMetallicRoughness":
            {"baseColorFactor": [0.5, 0.02, 0.02, 1], "metallicFactor": 0, "roughnessFactor": 0.5},
            "extensions": {"KHR_materials_clearcoat":
                {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1}}}
    ])
}

fn uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}
