//! Which materials a scene uses: those that a mesh names, or a variant of it
//! (KHR_materials_variants).

use super::schema::{Document, Primitive};
use crate::error::{Error, Result};
use std::collections::BTreeSet;

/// The mode of the first primitives that are triangles; points and lines come before.
const TRIANGLES: u32 = 4;

/// The materials in use.
#[derive(Default)]
pub struct InUse {
    /// By index.
    pub materials: BTreeSet<usize>,
    /// Those whose base colour is multiplied by the colours of vertices.
    pub colored: BTreeSet<usize>,
    /// Triangles without a material have glTF's default material.
    pub default: bool,
    /// No mesh names a material, so all are taken.
    pub all: bool,
}

impl InUse {
    /// Of a document.
    pub fn find(name: &str, document: &Document) -> Result<Self> {
        let mut found = InUse::default();
        let primitives = document.meshes.iter().flat_map(|mesh| &mesh.primitives);
        for primitive in primitives {
            found.add(primitive);
        }
        let count = document.materials.len();
        if let Some(&last) = found.materials.last().filter(|&&last| last >= count) {
            let expected = format!("indices of {count} materials");
            let cure = "export the file again";
            return Err(Error::bad_input(name, expected, format!("material {last}"), cure));
        }
        if found.materials.is_empty() {
            found.all = count > 0;
            found.materials = (0..count).collect();
        }
        Ok(found)
    }

    fn add(&mut self, primitive: &Primitive) {
        let variants = primitive.extensions.variants.iter().flat_map(|variants| &variants.mappings);
        let named = primitive.material.into_iter().chain(variants.map(|mapping| mapping.material));
        for material in named {
            self.materials.insert(material);
            if primitive.attributes.color.is_some() {
                self.colored.insert(material);
            }
        }
        let triangles = primitive.mode.is_none_or(|mode| mode >= TRIANGLES);
        self.default |= primitive.material.is_none() && triangles;
    }
}
