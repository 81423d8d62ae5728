//! Scenes: which roughnesses and which reflectances their materials have. A table has to be right
//! there, and nowhere else.
//!
//! [`read`] takes glTF 2.0 (JSON or GLB) or a list of materials. Each material gives a [`Lobe`] for
//! each of its layers: intervals that hold whatever a shader can meet, from factors, texels and
//! animations. Mip maps and filters average texels and stay inside. What cannot be read becomes
//! the whole range of it, with a note.

mod accessor;
mod animation;
mod decode;
mod fresnel;
mod glb;
mod gltf;
mod in_use;
mod layers;
mod list;
mod material;
mod notes;
mod schema;
mod span;
mod statistics;
mod store;
mod surface;
mod textures;
mod uri;

pub use span::Span;

use crate::choice::choice;
use crate::error::clean;
use crate::error::{Error, Result};
use serde::Deserialize;
use serde::de::IgnoredAny;

/// The JSON of a scene may have so many bytes.
const MOST_JSON_BYTES: usize = 512 << 20;

/// The JSON of a scene may have so many objects: each takes memory.
const MOST_OBJECTS: usize = 4_000_000;

/// A scene may have so many materials.
const MOST_MATERIALS: usize = 65_536;

/// Which layer of a material a lobe is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// The reflection of the base.
    Base,
    /// The layer of KHR_materials_clearcoat.
    Clearcoat,
    /// The fibres of KHR_materials_sheen.
    Sheen,
}

choice!(Layer, "layer", {
    Base = "base", "the reflection of the base";
    Clearcoat = "clearcoat", "a clear coat over the base";
    Sheen = "sheen", "fibres over the base";
});

/// What a shader can meet on one layer of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobe {
    /// The material's name, or "material 3" by its index in the file.
    pub material: String,
    /// Its layer.
    pub layer: Layer,
    /// Perceptual roughness, in [0, 1].
    pub roughness: Span,
    /// Reflectance at normal incidence, of R, G and B together. Of sheen: the colour by which its
    /// albedo is multiplied.
    pub f0: Span,
    /// Reflectance at grazing incidence. Of sheen: the same as `f0`.
    pub f90: Span,
    /// If an image was read: how many of its texels, times the factor, have a roughness in each
    /// sixteenth of [0, 1].
    pub histogram: Option<[u64; 16]>,
    /// What was read from where, in lines.
    pub from: Vec<String>,
}

/// The lobes of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The file.
    pub name: String,
    /// All lobes of all materials in use.
    pub lobes: Vec<Lobe>,
    /// What was assumed or could not be read, in lines.
    pub notes: Vec<String>,
}

/// What a file cannot tell.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Assumptions {
    /// The engine widens roughness at run time, up to 1 (specular antialiasing, Toksvig 2005).
    pub specular_antialiasing: bool,
    /// The engine raises perceptual roughness to at least this, in [0, 1].
    pub least_roughness: f64,
    /// The share of texels that is ignored at each end of a channel's range, in [0, 0.5). Above 0
    /// the intervals prove nothing of the texels beyond.
    pub ignore_texels: f64,
}

impl Assumptions {
    fn check(&self) -> Result<()> {
        let wrong = |what: &str, expected: &str, got: f64| {
            let got = crate::units::short(got);
            Err(Error::bad_input(what, expected, got, "give a value in that range"))
        };
        if !(0.0..=1.0).contains(&self.least_roughness) {
            return wrong("least roughness", "0 to 1", self.least_roughness);
        }
        if !(0.0..0.5).contains(&self.ignore_texels) {
            return wrong("ignored share of texels", "0 to below 0.5", self.ignore_texels);
        }
        Ok(())
    }

    /// The roughness that reaches the lookup.
    fn applied_to(&self, roughness: Span) -> Span {
        let high = if self.specular_antialiasing { 1.0 } else { roughness.high };
        Span { low: roughness.low, high }.map(|end| end.max(self.least_roughness))
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.specular_antialiasing {
            notes.push("assumed: the engine widens roughness up to 1 at run time".to_owned());
        }
        if self.least_roughness > 0.0 {
            let least = self.least_roughness;
            notes.push(format!("assumed: the engine raises roughness to at least {least}"));
        }
        if self.ignore_texels > 0.0 {
            let percent = 100.0 * self.ignore_texels;
            notes.push(format!(
                "{percent}% of texels at each end are ignored: nothing is proved for them"
            ));
        }
        notes
    }
}

/// Reads a scene: glTF, GLB or a list of materials, told apart by content. `files` fetches the file
/// of a relative path, which has no `..`, and has a limit of its size.
pub fn read(
    name: &str,
    bytes: &[u8],
    assumptions: &Assumptions,
    files: &dyn Fn(&str) -> Result<Vec<u8>>,
) -> Result<Scene> {
    assumptions.check()?;
    let (json, binary) = match bytes.starts_with(glb::MAGIC) {
        true => glb::split(name, bytes)?,
        false => (bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None),
    };
    check_size(name, json)?;
    let (lobes, mut notes) = match kind(name, json)? {
        Kind::Gltf => gltf::lobes(gltf::Source { name, json, binary, files }, assumptions)?,
        Kind::List => (list::lobes(name, json, assumptions)?, Vec::new()),
    };
    notes.extend(assumptions.notes());
    if lobes.is_empty() {
        notes.push("there is no material that reflects by a table".into());
    }
    Ok(Scene { name: name.to_owned(), lobes, notes })
}

/// A scene of given intervals: a base for each of roughness.
pub fn of_values(roughness: &[Span], f0: Span, f90: Span) -> Scene {
    let lobe = |(index, &roughness): (usize, &Span)| Lobe {
        material: format!("value {}", index + 1),
        layer: Layer::Base,
        roughness,
        f0,
        f90,
        histogram: None,
        from: vec![format!("roughness {roughness}, F0 {f0}, F90 {f90}: given")],
    };
    let lobes = roughness.iter().enumerate().map(lobe).collect();
    Scene { name: "given values".into(), lobes, notes: Vec::new() }
}

enum Kind {
    Gltf,
    List,
}

/// What tells the kinds apart.
#[derive(Deserialize)]
struct Top {
    asset: Option<Asset>,
    materials: Option<IgnoredAny>,
}

#[derive(Deserialize)]
struct Asset {
    version: Option<String>,
}

fn kind(name: &str, json: &[u8]) -> Result<Kind> {
    let top: Top = serde_json::from_slice(json).map_err(|error| not_json(name, &error))?;
    let other = |expected: &str, got: &str| {
        Err(Error::bad_input(name, expected, got, "name a .gltf or .glb file or a list"))
    };
    match top {
        Top { asset: Some(asset), .. } => match asset.version {
            Some(version) if !version.starts_with("2.") => {
                other("glTF of version 2", &format!("version {}", clean(&version, 20)))
            }
            _ => Ok(Kind::Gltf),
        },
        Top { materials: Some(_), .. } => Ok(Kind::List),
        _ => other("a glTF file or a list of materials", "JSON with neither asset nor materials"),
    }
}

fn not_json(name: &str, error: &serde_json::Error) -> Error {
    let got = clean(&error.to_string(), 200);
    let cure = "name a .gltf or .glb file or a list of materials";
    Error::bad_input(name, "glTF, GLB or JSON of materials", got, cure)
}

/// Refuses what would take too much memory, before it is parsed.
fn check_size(name: &str, json: &[u8]) -> Result<()> {
    let cure = "split the scene";
    if json.len() > MOST_JSON_BYTES {
        let got = format!("{} bytes", json.len());
        return Err(Error::bad_input(name, "at most 512 MiB of JSON", got, cure));
    }
    let objects = json.iter().filter(|&&byte| byte == b'{').count();
    if objects > MOST_OBJECTS {
        let expected = format!("at most {MOST_OBJECTS} objects in its JSON");
        return Err(Error::bad_input(name, expected, objects.to_string(), cure));
    }
    Ok(())
}

/// A material by name, or by index where it has none.
fn named(name: Option<&str>, index: usize) -> String {
    let name = name.map(|name| clean(name, 64)).filter(|name| !name.trim().is_empty());
    name.unwrap_or_else(|| format!("material {index}"))
}
