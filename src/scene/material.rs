//! A material of glTF: its lobes, and the mix of dielectric and metal of its base.

use super::animation::property;
use super::fresnel::{DIELECTRIC, Dielectric, f0_of_ior};
use super::notes::Read;
use super::schema::{Anisotropy, Material, MetallicRoughness, TextureInfo};
use super::span::Span;
use super::surface::{ALPHA, BLUE, Curve, GREEN, Input, Surface, hull, times};
use super::{Assumptions, Layer, Lobe};
use crate::error::Result;

/// Factors that may exceed 1: beyond this they are mistakes.
const LARGE: Span = Span { low: 0.0, high: 1e6 };

/// The lobes of a material.
pub fn lobes_of(material: &Material, mut surface: Surface) -> Result<Vec<Lobe>> {
    let extensions = &material.extensions;
    let notes = &mut surface.reader.notes;
    if extensions.unlit.is_some() {
        notes.count("unlit (KHR_materials_unlit), so without a lobe");
        return Ok(Vec::new());
    }
    if extensions.transmission.is_some() || extensions.volume.is_some() {
        notes.count("with transmission; reflection is the base's, glass has tables of its own");
    }
    let mut lobes = Vec::new();
    lobes.push(match &extensions.specular_glossiness {
        Some(glossy) => surface.specular_glossiness(glossy)?,
        None => surface.base(material)?,
    });
    if let Some(clearcoat) = &extensions.clearcoat {
        lobes.extend(surface.clearcoat(clearcoat)?);
    }
    if let Some(sheen) = &extensions.sheen {
        lobes.extend(surface.sheen(sheen)?);
    }
    Ok(lobes)
}

/// The lobe of meshes without a material: white metal of roughness 1 (glTF 2.0, section 5.19).
pub fn default_lobe(assumptions: &Assumptions) -> Lobe {
    Lobe {
        material: "default material".into(),
        layer: Layer::Base,
        roughness: assumptions.applied_to(Span::point(1.0)),
        f0: Span::point(1.0),
        f90: Span::point(1.0),
        histogram: None,
        from: vec!["roughness 1, F0 1: glTF's default".into()],
    }
}

impl Surface<'_, '_> {
    /// The base of pbrMetallicRoughness.
    fn base(&mut self, material: &Material) -> Result<Lobe> {
        let pbr = &material.pbr_metallic_roughness;
        let texture = pbr.metallic_roughness_texture;
        let factor = self.factor(property::ROUGHNESS, 0, pbr.roughness_factor, Span::UNIT)?;
        let input = Input { what: "roughness", factor, texture };
        let (mut roughness, line) = self.product(input, GREEN);
        let mut from = vec![line];
        let histogram = self.histogram(input, GREEN, |value| value * pbr.roughness_factor);
        if let Some(anisotropy) = &material.extensions.anisotropy {
            roughness = self.widened(roughness, anisotropy, &mut from)?;
        }
        let dielectric = self.dielectric(material)?;
        let factor = self.factor(property::METALLIC, 0, pbr.metallic_factor, Span::UNIT)?;
        let input = Input { what: "metallic", factor, texture };
        let (metallic, line) = self.product(input, BLUE);
        from.push(line);
        let mut f0 = self.reflectance(pbr, &dielectric, input, metallic, &mut from)?;
        if let Some(iridescence) = &material.extensions.iridescence {
            let value = iridescence.iridescence_factor;
            if self.factor(property::IRIDESCENCE, 0, value, Span::UNIT)?.high > 0.0 {
                f0 = Span::UNIT;
                from.push("F0 0..1: KHR_materials_iridescence".into());
            }
        }
        let f90 = dielectric.f90_with(metallic);
        from.push(format!("F0 {f0}, F90 {f90}"));
        let roughness = self.reader.assumptions.applied_to(roughness);
        let material = self.name.clone();
        Ok(Lobe { material, layer: Layer::Base, roughness, f0, f90, histogram, from })
    }

    /// Roughness along the tangent: α is mix(α, 1, s²) there (KHR_materials_anisotropy).
    fn widened(
        &mut self,
        roughness: Span,
        anisotropy: &Anisotropy,
        from: &mut Vec<String>,
    ) -> Result<Span> {
        let value = anisotropy.anisotropy_strength;
        let factor = self.factor(property::ANISOTROPY, 0, value, Span::UNIT)?;
        let input = Input { what: "anisotropy", factor, texture: anisotropy.anisotropy_texture };
        let (strength, line) = self.product(input, BLUE);
        if strength.high == 0.0 {
            return Ok(roughness);
        }
        let alpha = roughness.high * roughness.high;
        let along = alpha + (1.0 - alpha) * strength.high * strength.high;
        let high = along.sqrt().clamp(roughness.high, 1.0);
        from.push(line);
        from.push(format!("roughness up to {} along the tangent", Span::point(high)));
        Ok(Span { low: roughness.low, high })
    }

    /// The dielectric part, of KHR_materials_ior and KHR_materials_specular.
    fn dielectric(&mut self, material: &Material) -> Result<Dielectric> {
        let f0 = match &material.extensions.ior {
            Some(ior) => {
                // An index of 0 is a word for F = 1, not the end of an interval.
                let least = if ior.ior == 0.0 { 0.0 } else { 1.0 };
                let range = Span { low: least, ..LARGE };
                f0_of_ior(self.factor(property::IOR, 0, ior.ior, range)?)
            }
            None => Span::point(DIELECTRIC),
        };
        let Some(specular) = &material.extensions.specular else {
            return Ok(Dielectric::new(f0, [Span::point(1.0); 3], Span::point(1.0)));
        };
        let weight = self.factor(property::SPECULAR, 0, specular.specular_factor, Span::UNIT)?;
        let weight = self.texels(specular.specular_texture, ALPHA, Curve::Linear).times(weight);
        let color = self.color(property::SPECULAR_COLOR, specular.specular_color_factor, LARGE)?;
        let color = self.colors(color, specular.specular_color_texture);
        Ok(Dielectric::new(f0, color, weight))
    }

    /// F0 of the mix of the dielectric with the base colour: over texels where metalness and colour
    /// are on images of one size, otherwise over all combinations of the two.
    fn reflectance(
        &mut self,
        pbr: &MetallicRoughness,
        dielectric: &Dielectric,
        input: Input,
        metallic: Span,
        from: &mut Vec<String>,
    ) -> Result<Span> {
        let [r, g, b, _] = pbr.base_color_factor;
        let mut factors = self.color(property::BASE_COLOR, [r, g, b], Span::UNIT)?;
        if metallic.high == 0.0 {
            return Ok(dielectric.f0_with(factors, metallic));
        }
        let texture = pbr.base_color_texture;
        let colors = self.colors(factors, texture);
        from.push(
            self.line(Input { what: "base colour", factor: hull(factors), texture }, hull(colors)),
        );
        if self.colored {
            // The colours of vertices may be anything up to 1.
            factors = factors.map(|factor| Span { low: 0.0, ..factor });
            from.push("base colour down to 0: colours of vertices".into());
        }
        if let (Some(of_metal), Some(of_color)) = (input.texture, texture)
            && !metallic.is_point()
            && let Ok(Some(f0)) = self.reflectance_of_texels(
                dielectric,
                (of_metal, input.factor),
                (of_color, factors),
            )
        {
            from.push(format!("F0 {f0}: texel by texel of metalness and base colour"));
            return Ok(f0);
        }
        Ok(dielectric.f0_with(self.colors(factors, texture), metallic))
    }

    /// The same over texels; an error where the two images do not match.
    fn reflectance_of_texels(
        &mut self,
        dielectric: &Dielectric,
        (of_metal, metallic_factor): (TextureInfo, Span),
        (of_color, color_factors): (TextureInfo, [Span; 3]),
    ) -> Read<Option<Span>> {
        let joint = self.reader.textures.joint(of_metal, of_color)?;
        let statistics = self.reader.textures.statistics(of_metal)?;
        let metals = self.texels(Some(of_metal), BLUE, Curve::Linear);
        let within = [0, 1, 2].map(|channel| self.texels(Some(of_color), channel, Curve::Srgb));
        Ok(Span::hull_of(statistics.channel(BLUE).bins().filter_map(|(index, bin)| {
            let metallic = bin.span()?.overlap(metals)?.times(metallic_factor);
            let mut colors = joint.colors(index)?;
            for (color, within) in colors.iter_mut().zip(within) {
                *color = color.map(|code| Curve::Srgb.value(code)).clamped(within);
            }
            Some(dielectric.f0_with(times(color_factors, colors), metallic))
        })))
    }
}
