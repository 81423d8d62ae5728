//! The parts of a glTF file that say how rough its surfaces are and what they reflect (glTF 2.0,
//! section 5, and the extensions named below). All else is passed over.

use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeSet;

/// The file.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Document {
    pub extensions_used: BTreeSet<String>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub images: Vec<Image>,
    pub buffers: Vec<Buffer>,
    pub buffer_views: Vec<BufferView>,
    pub accessors: Vec<Accessor>,
    pub meshes: Vec<Mesh>,
    pub animations: Vec<Animation>,
}

/// A material (glTF 2.0, section 5.19).
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Material {
    pub name: Option<String>,
    pub pbr_metallic_roughness: MetallicRoughness,
    pub extensions: Extensions,
}

/// Its base (section 5.22): linear factors; roughness is perceptual.
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct MetallicRoughness {
    pub base_color_factor: [f64; 4],
    pub base_color_texture: Option<TextureInfo>,
    pub metallic_factor: f64,
    pub roughness_factor: f64,
    pub metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        MetallicRoughness {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

/// The extensions of a material.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Extensions {
    #[serde(rename = "KHR_materials_specular")]
    pub specular: Option<Box<Specular>>,
    #[serde(rename = "KHR_materials_ior")]
    pub ior: Option<Box<Ior>>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Box<Clearcoat>>,
    #[serde(rename = "KHR_materials_sheen")]
    pub sheen: Option<Box<Sheen>>,
    #[serde(rename = "KHR_materials_anisotropy")]
    pub anisotropy: Option<Box<Anisotropy>>,
    #[serde(rename = "KHR_materials_iridescence")]
    pub iridescence: Option<Box<Iridescence>>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<Box<SpecularGlossiness>>,
    #[serde(rename = "KHR_materials_transmission")]
    pub transmission: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_volume")]
    pub volume: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<IgnoredAny>,
}

/// KHR_materials_specular.
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Specular {
    pub specular_factor: f64,
    pub specular_texture: Option<TextureInfo>,
    pub specular_color_factor: [f64; 3],
    pub specular_color_texture: Option<TextureInfo>,
}

impl Default for Specular {
    fn default() -> Self {
        Specular {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

/// KHR_materials_ior.
#[derive(Deserialize)]
#[serde(default)]
pub struct Ior {
    pub ior: f64,
}

impl Default for Ior {
    fn default() -> Self {
        Ior { ior: 1.5 }
    }
}

/// KHR_materials_clearcoat.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Clearcoat {
    pub clearcoat_factor: f64,
    pub clearcoat_roughness_factor: f64,
    pub clearcoat_roughness_texture: Option<TextureInfo>,
}

/// KHR_materials_sheen.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Sheen {
    pub sheen_color_factor: [f64; 3],
    pub sheen_color_texture: Option<TextureInfo>,
    pub sheen_roughness_factor: f64,
    pub sheen_roughness_texture: Option<TextureInfo>,
}

/// KHR_materials_anisotropy.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Anisotropy {
    pub anisotropy_strength: f64,
    pub anisotropy_texture: Option<TextureInfo>,
}

/// KHR_materials_iridescence.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Iridescence {
    pub iridescence_factor: f64,
}

/// KHR_materials_pbrSpecularGlossiness.
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct SpecularGlossiness {
    pub specular_factor: [f64; 3],
    pub glossiness_factor: f64,
    pub specular_glossiness_texture: Option<TextureInfo>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        SpecularGlossiness {
            specular_factor: [1.0; 3],
            glossiness_factor: 1.0,
            specular_glossiness_texture: None,
        }
    }
}

/// Which texture. Its transform and its set of coordinates move texels and change none.
#[derive(Clone, Copy, Deserialize)]
pub struct TextureInfo {
    pub index: usize,
}

/// A texture: an image and how it is sampled.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Texture {
    pub source: Option<usize>,
    pub extensions: TextureExtensions,
}

/// Images in place of the source, in formats that not every engine reads.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct TextureExtensions {
    #[serde(rename = "KHR_texture_basisu")]
    pub basisu: Option<Source>,
    #[serde(rename = "EXT_texture_webp")]
    pub webp: Option<Source>,
    #[serde(rename = "EXT_texture_avif")]
    pub avif: Option<Source>,
    #[serde(rename = "MSFT_texture_dds")]
    pub dds: Option<Source>,
}

#[derive(Clone, Copy, Deserialize)]
pub struct Source {
    pub source: Option<usize>,
}

/// An image, in a file, a buffer or its URI.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub struct Image {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

/// Bytes; without a URI those of the GLB file.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Buffer {
    pub uri: Option<String>,
}

/// A part of a buffer, in bytes.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

/// Numbers in a view of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<IgnoredAny>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Mesh {
    pub primitives: Vec<Primitive>,
}

/// A part of a mesh, of one material.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Primitive {
    pub material: Option<usize>,
    pub mode: Option<u32>,
    pub attributes: Attributes,
    pub extensions: PrimitiveExtensions,
}

#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Attributes {
    #[serde(rename = "COLOR_0")]
    pub color: Option<IgnoredAny>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
pub struct PrimitiveExtensions {
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Option<Box<Variants>>,
}

/// KHR_materials_variants.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Variants {
    pub mappings: Vec<VariantMapping>,
}

#[derive(Deserialize)]
pub struct VariantMapping {
    pub material: usize,
}

/// An animation: what it moves, and by which values.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Animation {
    pub channels: Vec<Channel>,
    pub samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
pub struct Channel {
    pub sampler: usize,
    #[serde(default)]
    pub target: Target,
}

#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Target {
    pub extensions: TargetExtensions,
}

#[derive(Deserialize, Default)]
#[serde(default)]
pub struct TargetExtensions {
    #[serde(rename = "KHR_animation_pointer")]
    pub pointer: Option<Pointer>,
}

/// KHR_animation_pointer: a JSON pointer to a property.
#[derive(Deserialize)]
pub struct Pointer {
    pub pointer: String,
}

#[derive(Deserialize)]
pub struct Sampler {
    pub output: usize,
    pub interpolation: Option<String>,
}
