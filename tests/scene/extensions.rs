//! Each extension of materials.

use super::helper::{base, close, gltf, lobe, lobes, png, refused, scene, uri, with_images};
use serde_json::{Value, json};
use splitsum::scene::{Layer, Scene, Span};

/// A dielectric of roughness 0.5 with these extensions.
fn dielectric(extensions: Value) -> Value {
    json!({
        "name": "m",
        "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5},
        "extensions": extensions
    })
}

#[test]
fn an_index_of_refraction_is_f0() {
    for (ior, f0) in [(1.5, 0.04), (1.0, 0.0), (2.0, 1.0 / 9.0), (0.0, 1.0)] {
        let lobe = lobe(dielectric(json!({"KHR_materials_ior": {"ior": ior}})));
        close(lobe.f0, f0, f0);
    }
    let metal = lobe(dielectric(json!({"KHR_materials_ior": {"ior": 1000}})));
    close(metal.f0, (999.0f64 / 1001.0).powi(2), (999.0f64 / 1001.0).powi(2));
    for wrong in [0.5, -1.0, 1e30] {
        let material = dielectric(json!({"KHR_materials_ior": {"ior": wrong}}));
        let error = refused(&gltf(json!({"materials": [material]})));
        assert!(error.contains("ior of m"), "{error}");
    }
}

#[test]
fn specular_scales_both_ends_and_colours_f0() {
    let specular = json!({"specularFactor": 0.5, "specularColorFactor": [0.5, 1.0, 2.0]});
    let found = lobe(dielectric(json!({"KHR_materials_specular": specular})));
    close(found.f0, 0.01, 0.04);
    close(found.f90, 0.5, 0.5);
    // F0 is at most 1 before it is scaled.
    let specular = json!({"specularFactor": 0.5, "specularColorFactor": [100, 100, 100]});
    close(lobe(dielectric(json!({"KHR_materials_specular": specular}))).f0, 0.5, 0.5);
    // The metal part is not scaled.
    let metal = lobe(json!({"extensions": {"KHR_materials_specular": {"specularFactor": 0}}}));
    assert_eq!((metal.f0, metal.f90), (Span::point(1.0), Span::point(1.0)));
    // Its textures: weight in alpha, colour in sRGB.
    let image = png(2, 1, |x, _| if x == 0 { [255, 255, 255, 255] } else { [0, 0, 0, 51] });
    let specular = json!({"specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}});
    let found =
        base(&with_images(dielectric(json!({"KHR_materials_specular": specular})), &[&image]));
    close(found.f0, 0.0, 0.04);
    close(found.f90, 0.2, 1.0);
}

#[test]
fn a_clearcoat_is_a_lobe() {
    let image = png(2, 1, |x, _| [0, if x == 0 { 51 } else { 204 }, 0, 255]);
    let coat = json!({"clearcoatFactor": 0.3, "clearcoatRoughnessFactor": 0.5,
        "clearcoatRoughnessTexture": {"index": 0}});
    let material = dielectric(json!({"KHR_materials_clearcoat": coat}));
    let found = scene(&with_images(material, &[&image]));
    assert_eq!(found.lobes.len(), 2);
    let coat = &found.lobes[1];
    assert_eq!((coat.layer, coat.material.as_str()), (Layer::Clearcoat, "m"));
    close(coat.roughness, 0.1, 0.4);
    assert_eq!((coat.f0, coat.f90), (Span::point(0.04), Span::point(1.0)));
    assert_eq!(coat.histogram.map(|counts| (counts[1], counts[6])), Some((1, 1)));
    assert_eq!(found.lobes[0].roughness, Span::point(0.5));
    for none in [json!({}), json!({"clearcoatFactor": 0})] {
        assert_eq!(lobes(dielectric(json!({"KHR_materials_clearcoat": none}))).len(), 1);
    }
}

#[test]
fn a_sheen_is_a_lobe_with_its_roughness_in_alpha() {
    let image = png(2, 1, |x, _| [255, 255, 0, if x == 0 { 102 } else { 255 }]);
    let sheen = json!({"sheenColorFactor": [0.5, 0.2, 0.1], "sheenRoughnessFactor": 0.5,
        "sheenRoughnessTexture": {"index": 0}, "sheenColorTexture": {"index": 0}});
    let found = scene(&with_images(dielectric(json!({"KHR_materials_sheen": sheen})), &[&image]));
    let sheen = &found.lobes[1];
    assert_eq!(sheen.layer, Layer::Sheen);
    close(sheen.roughness, 0.2, 0.5);
    close(sheen.f0, 0.0, 0.5);
    assert_eq!(lobes(dielectric(json!({"KHR_materials_sheen": {}}))).len(), 1);
}

#[test]
fn anisotropy_widens_roughness_upward() {
    let found = lobe(dielectric(json!({"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}})));
    // α is 0.25 across and mix(0.25, 1, 0.36) = 0.52 along.
    close(found.roughness, 0.5, 0.52f64.sqrt());
    let none = lobe(dielectric(json!({"KHR_materials_anisotropy": {}})));
    assert_eq!(none.roughness, Span::point(0.5));
}

#[test]
fn iridescence_may_reflect_anything() {
    let found = lobe(dielectric(json!({"KHR_materials_iridescence": {"iridescenceFactor": 0.1}})));
    assert_eq!(found.f0, Span::UNIT);
    let none = lobe(dielectric(json!({"KHR_materials_iridescence": {}})));
    assert_eq!(none.f0, Span::point(0.04));
}

#[test]
fn transmission_and_unknown_extensions_are_noted() {
    let glass = dielectric(json!({"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {}}));
    let scene = scene(&gltf(json!({"materials": [glass],
        "extensionsUsed": ["KHR_materials_transmission", "ACME_materials_fur"]})));
    assert_eq!((scene.lobes.len(), scene.lobes[0].f0), (1, Span::point(0.04)));
    for said in ["1 material: with transmission", "ACME_materials_fur is not known"] {
        assert!(scene.notes.iter().any(|note| note.contains(said)), "{:?}", scene.notes);
    }
    assert_eq!(scene.notes.len(), 3, "{:?}", scene.notes);
}

#[test]
fn glossiness_is_one_minus_roughness() {
    let image = png(2, 1, |x, _| if x == 0 { [255, 0, 0, 51] } else { [255, 0, 0, 255] });
    let glossy = json!({"specularFactor": [0.5, 0.5, 0.5], "glossinessFactor": 0.5,
        "specularGlossinessTexture": {"index": 0}});
    let material = json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": glossy}});
    let found = base(&with_images(material, &[&image]));
    close(found.roughness, 0.5, 0.9);
    close(found.f0, 0.0, 0.5);
    assert_eq!(found.histogram.map(|counts| (counts[8], counts[14])), Some((1, 1)));
}

/// A scene whose roughness is animated: the accessor's component type, its data, its sampler.
fn animated(pointer: &str, component_type: u32, data: &[u8], interpolation: &str) -> Scene {
    let size = if component_type == 5126 { 4 } else { 1 };
    scene(&gltf(json!({
        "materials": [dielectric(json!({"KHR_materials_clearcoat": {}}))],
        "buffers": [{"byteLength": data.len(), "uri": uri(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": data.len()}],
        "accessors": [{"bufferView": 0, "componentType": component_type, "normalized": true,
            "count": data.len() / size, "type": "SCALAR"}],
        "animations": [{
            "samplers": [{"input": 0, "output": 0, "interpolation": interpolation}],
            "channels": [{"sampler": 0, "target": {"path": "pointer",
                "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}}]
        }]
    })))
}

#[test]
fn animations_widen_factors() {
    let pointer = "/materials/0/pbrMetallicRoughness/roughnessFactor";
    let floats: Vec<u8> = [0.25f32, 0.75, 0.5].iter().flat_map(|f| f.to_le_bytes()).collect();
    let found = animated(pointer, 5126, &floats, "LINEAR");
    assert_eq!(found.lobes[0].roughness, Span { low: 0.25, high: 0.75 });
    let found = animated(pointer, 5121, &[51, 255], "STEP");
    close(found.lobes[0].roughness, 0.2, 1.0);
    // A spline overshoots; not a number is none; a bent pointer moves nothing.
    let spline = animated(pointer, 5126, &floats, "CUBICSPLINE");
    assert_eq!(spline.lobes[0].roughness, Span::UNIT);
    assert!(spline.notes.iter().any(|note| note.contains("spline")), "{:?}", spline.notes);
    let wrong = animated(pointer, 5126, &f32::NAN.to_le_bytes(), "LINEAR");
    assert_eq!(wrong.lobes[0].roughness, Span::UNIT);
    let other = animated("/materials/99999999999999999999/x/y", 5126, &floats, "LINEAR");
    assert_eq!(other.lobes[0].roughness, Span::point(0.5));
    // What is 0 in the file comes to be.
    let coat = "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor";
    assert_eq!(animated(coat, 5126, &floats, "LINEAR").lobes.len(), 2);
    let metallic = "/materials/0/pbrMetallicRoughness/metallicFactor";
    close(animated(metallic, 5126, &floats, "LINEAR").lobes[0].f0, 0.04, 0.76);
}
