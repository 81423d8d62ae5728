//! glTF 2.0: the lobes of the materials in use.

use super::animation::Motions;
use super::in_use::InUse;
use super::material::{default_lobe, lobes_of};
use super::notes::Notes;
use super::schema::Document;
use super::store::Store;
use super::surface::{Reader, Surface};
use super::textures::Textures;
use super::{Assumptions, Lobe, MOST_MATERIALS, named};
use crate::error::clean;
use crate::error::{Error, Result};

/// Extensions of materials that are read, or that change no reflection.
const KNOWN: [&str; 14] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

/// A glTF file in its parts.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The file, for errors.
    pub name: &'a str,
    /// Its JSON.
    pub json: &'a [u8],
    /// The binary chunk of GLB.
    pub binary: Option<&'a [u8]>,
    /// Fetches a file beside it.
    pub files: &'a dyn Fn(&str) -> Result<Vec<u8>>,
}

/// The lobes, and notes.
pub fn lobes(source: Source, assumptions: &Assumptions) -> Result<(Vec<Lobe>, Vec<String>)> {
    let name = source.name;
    let document: Document = serde_json::from_slice(source.json).map_err(|error| {
        let got = clean(&error.to_string(), 200);
        Error::bad_input(name, "glTF 2.0", got, "correct the file or export it again")
    })?;
    let count = document.materials.len();
    if count > MOST_MATERIALS {
        let cure = "split the scene";
        return Err(Error::bad_input(name, "at most 65536 materials", count.to_string(), cure));
    }
    let in_use = InUse::find(name, &document)?;
    let mut notes = Notes::default();
    say_what_is_in_use(&in_use, &document, &mut notes);
    let mut store = Store::new(&document, source.binary, source.files);
    let motions = Motions::read(&mut store);
    let textures = Textures::new(store);
    let mut reader = Reader { file: name, textures, motions, assumptions, notes };
    let mut lobes = Vec::new();
    for &index in &in_use.materials {
        let Some(material) = document.materials.get(index) else { continue };
        let surface = Surface {
            reader: &mut reader,
            index,
            name: named(material.name.as_deref(), index),
            colored: in_use.colored.contains(&index),
        };
        lobes.extend(lobes_of(material, surface)?);
    }
    if in_use.default {
        lobes.push(default_lobe(assumptions));
    }
    Ok((lobes, reader.notes.lines()))
}

fn say_what_is_in_use(in_use: &InUse, document: &Document, notes: &mut Notes) {
    let count = document.materials.len();
    let left_out = count - in_use.materials.len();
    if in_use.all {
        notes.add(format!("no mesh names a material: all {count} are taken"));
    }
    if left_out > 0 {
        notes.add(format!("{left_out} of {count} materials are left out: no mesh names them"));
    }
    if in_use.default {
        notes.add("meshes without a material have glTF's default: metal of roughness 1".into());
    }
    let used = document.extensions_used.iter().filter(|name| name.contains("_materials_"));
    for unknown in used.filter(|name| !KNOWN.contains(&name.as_str())) {
        let name = clean(unknown, 60);
        notes.add(format!("{name} is not known here: what it changes is left out"));
    }
}
