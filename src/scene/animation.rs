//! Factors of materials that an animation changes (KHR_animation_pointer).

use super::accessor::Accessors;
use super::notes::Read;
use super::schema::Sampler;
use super::span::Span;
use super::store::Store;
use std::collections::BTreeMap;

/// The properties of a material that matter here, as JSON pointers below it.
pub mod property {
    pub const ROUGHNESS: &str = "pbrMetallicRoughness/roughnessFactor";
    pub const METALLIC: &str = "pbrMetallicRoughness/metallicFactor";
    pub const BASE_COLOR: &str = "pbrMetallicRoughness/baseColorFactor";
    pub const SPECULAR: &str = "extensions/KHR_materials_specular/specularFactor";
    pub const SPECULAR_COLOR: &str = "extensions/KHR_materials_specular/specularColorFactor";
    pub const IOR: &str = "extensions/KHR_materials_ior/ior";
    pub const CLEARCOAT: &str = "extensions/KHR_materials_clearcoat/clearcoatFactor";
    pub const CLEARCOAT_ROUGHNESS: &str =
        "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor";
    pub const SHEEN_COLOR: &str = "extensions/KHR_materials_sheen/sheenColorFactor";
    pub const SHEEN_ROUGHNESS: &str = "extensions/KHR_materials_sheen/sheenRoughnessFactor";
    pub const ANISOTROPY: &str = "extensions/KHR_materials_anisotropy/anisotropyStrength";
    pub const IRIDESCENCE: &str = "extensions/KHR_materials_iridescence/iridescenceFactor";
    pub const GLOSSINESS: &str = "extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor";
    pub const SPECULAR_OF_GLOSSINESS: &str =
        "extensions/KHR_materials_pbrSpecularGlossiness/specularFactor";

    /// All of them.
    pub const ALL: [&str; 14] = [
        ROUGHNESS,
        METALLIC,
        BASE_COLOR,
        SPECULAR,
        SPECULAR_COLOR,
        IOR,
        CLEARCOAT,
        CLEARCOAT_ROUGHNESS,
        SHEEN_COLOR,
        SHEEN_ROUGHNESS,
        ANISOTROPY,
        IRIDESCENCE,
        GLOSSINESS,
        SPECULAR_OF_GLOSSINESS,
    ];
}

/// The values that a property takes, for each of its components, or why they are unknown.
type Motion = Read<Vec<Span>>;

/// All animated properties, by material.
#[derive(Default)]
pub struct Motions(BTreeMap<(usize, &'static str), Motion>);

impl Motions {
    /// Reads them; each accessor once.
    pub fn read(store: &mut Store) -> Self {
        let mut motions = Motions::default();
        let mut accessors = Accessors::default();
        let mut known: BTreeMap<usize, Motion> = BTreeMap::new();
        for animation in &store.document().animations {
            for channel in &animation.channels {
                let pointer = channel.target.extensions.pointer.as_ref();
                let Some(target) = pointer.and_then(|pointer| target(&pointer.pointer)) else {
                    continue;
                };
                let motion = output(animation.samplers.get(channel.sampler)).and_then(|output| {
                    let read = || accessors.spans(store, output);
                    known.entry(output).or_insert_with(read).clone()
                });
                motions.add(target, motion);
            }
        }
        motions
    }

    fn add(&mut self, target: (usize, &'static str), motion: Motion) {
        let joined = match (self.0.remove(&target), motion) {
            (None, motion) => motion,
            (Some(Ok(a)), Ok(b)) if a.len() == b.len() => {
                Ok(a.iter().zip(b).map(|(a, b)| a.hull(b)).collect())
            }
            (Some(Ok(_)), Ok(_)) => Err("its animations do not agree in their type".into()),
            (Some(Err(why)), _) | (_, Err(why)) => Err(why),
        };
        self.0.insert(target, joined);
    }

    /// The values of a component of a property; none if nothing animates it. An accessor of single
    /// numbers may hold the components in turn: then each takes any of the values.
    pub fn of(&self, material: usize, name: &'static str, component: usize) -> Option<Read<Span>> {
        let motion = match self.0.get(&(material, name))? {
            Ok(spans) if spans.len() == 1 => Ok(spans[0]),
            Ok(spans) => spans
                .get(component)
                .copied()
                .ok_or_else(|| "its animation has too few components".into()),
            Err(why) => Err(why.clone()),
        };
        Some(motion)
    }
}

/// The material and the property of a pointer, if it is one of ours.
fn target(pointer: &str) -> Option<(usize, &'static str)> {
    let (material, name) = pointer.strip_prefix("/materials/")?.split_once('/')?;
    let name = property::ALL.into_iter().find(|known| *known == name)?;
    Some((material.parse().ok()?, name))
}

/// The accessor of a sampler's values.
fn output(sampler: Option<&Sampler>) -> Read<usize> {
    let sampler = sampler.ok_or("its animation names a sampler that is not there")?;
    match sampler.interpolation.as_deref() {
        // Splines leave the range of their values.
        Some("CUBICSPLINE") => Err("it is animated along a spline".into()),
        _ => Ok(sampler.output),
    }
}
