//! The layers of glTF's extensions: specular and glossiness in place of the base, a clear coat,
//! sheen.

use super::animation::property;
use super::fresnel::DIELECTRIC;
use super::schema::{Clearcoat, Sheen, SpecularGlossiness};
use super::span::Span;
use super::surface::{ALPHA, GREEN, Input, Surface, hull};
use super::{Layer, Lobe};
use crate::error::Result;

impl Surface<'_, '_> {
    /// The diffuse and specular of KHR_materials_pbrSpecularGlossiness.
    pub fn specular_glossiness(&mut self, glossy: &SpecularGlossiness) -> Result<Lobe> {
        self.reader.notes.count(
            "read by KHR_materials_pbrSpecularGlossiness; engines without it show other values",
        );
        let texture = glossy.specular_glossiness_texture;
        let value = glossy.glossiness_factor;
        let factor = self.factor(property::GLOSSINESS, 0, value, Span::UNIT)?;
        let input = Input { what: "glossiness", factor, texture };
        let (glossiness, line) = self.product(input, ALPHA);
        let histogram = self.histogram(input, ALPHA, |code| 1.0 - code * value);
        let roughness = glossiness.complement();
        let mut from = vec![line, format!("roughness {roughness}: 1 - glossiness")];
        let name = property::SPECULAR_OF_GLOSSINESS;
        let factors = self.color(name, glossy.specular_factor, Span::UNIT)?;
        let f0 = self.colors(factors, texture);
        let f0 = Span::hull_of(f0).unwrap_or(Span::UNIT);
        from.push(self.line(Input { what: "F0", factor: hull(factors), texture }, f0));
        let roughness = self.reader.assumptions.applied_to(roughness);
        let (material, f90) = (self.name.clone(), Span::point(1.0));
        Ok(Lobe { material, layer: Layer::Base, roughness, f0, f90, histogram, from })
    }

    /// The coat of KHR_materials_clearcoat, of index 1.5; none where its factor is 0.
    pub fn clearcoat(&mut self, coat: &Clearcoat) -> Result<Option<Lobe>> {
        let weight = self.factor(property::CLEARCOAT, 0, coat.clearcoat_factor, Span::UNIT)?;
        if weight.high == 0.0 {
            return Ok(None);
        }
        let texture = coat.clearcoat_roughness_texture;
        let value = coat.clearcoat_roughness_factor;
        let factor = self.factor(property::CLEARCOAT_ROUGHNESS, 0, value, Span::UNIT)?;
        let input = Input { what: "roughness", factor, texture };
        let (roughness, line) = self.product(input, GREEN);
        Ok(Some(Lobe {
            material: self.name.clone(),
            layer: Layer::Clearcoat,
            roughness: self.reader.assumptions.applied_to(roughness),
            f0: Span::point(DIELECTRIC),
            f90: Span::point(1.0),
            histogram: self.histogram(input, GREEN, |code| code * value),
            from: vec![line],
        }))
    }

    /// The fibres of KHR_materials_sheen; none where their colour is black.
    pub fn sheen(&mut self, sheen: &Sheen) -> Result<Option<Lobe>> {
        let factors = self.color(property::SHEEN_COLOR, sheen.sheen_color_factor, Span::UNIT)?;
        if hull(factors).high == 0.0 {
            return Ok(None);
        }
        let texture = sheen.sheen_color_texture;
        let color = Span::hull_of(self.colors(factors, texture)).unwrap_or(Span::UNIT);
        let of_color = self.line(Input { what: "colour", factor: hull(factors), texture }, color);
        let texture = sheen.sheen_roughness_texture;
        let value = sheen.sheen_roughness_factor;
        let factor = self.factor(property::SHEEN_ROUGHNESS, 0, value, Span::UNIT)?;
        let input = Input { what: "roughness", factor, texture };
        let (roughness, line) = self.product(input, ALPHA);
        Ok(Some(Lobe {
            material: self.name.clone(),
            layer: Layer::Sheen,
            roughness: self.reader.assumptions.applied_to(roughness),
            f0: color,
            f90: color,
            histogram: self.histogram(input, ALPHA, |code| code * value),
            from: vec![line, of_color],
        }))
    }
}
