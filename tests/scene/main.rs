//! Scenes: the intervals of roughness and reflectance that materials have, by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod extensions;
mod helper;
mod hostile;
mod images;

use helper::{base, close, glb, gltf, lobe, lobes, no_files, refused, scene};
use serde_json::json;
use splitsum::choice::Choice;
use splitsum::scene::{Assumptions, Layer, Span, of_values, read};

#[test]
fn a_material_without_properties_has_gltfs_defaults() {
    let lobe = lobe(json!({}));
    assert_eq!(lobe.material, "material 0");
    assert_eq!(lobe.layer, Layer::Base);
    assert_eq!(lobe.roughness, Span::point(1.0));
    // White metal.
    assert_eq!((lobe.f0, lobe.f90), (Span::point(1.0), Span::point(1.0)));
    assert_eq!(lobe.histogram, None);
}

#[test]
fn a_dielectric_has_f0_of_index_1_5_and_a_metal_its_base_colour() {
    let plastic = lobe(json!({"name": "red plastic", "pbrMetallicRoughness":
        {"metallicFactor": 0, "roughnessFactor": 0.6, "baseColorFactor": [1, 0, 0, 1]}}));
    assert_eq!(plastic.material, "red plastic");
    assert_eq!((plastic.roughness, plastic.f0), (Span::point(0.6), Span::point(0.04)));
    let gold = lobe(json!({"pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.7, 0.3, 1]}}));
    assert_eq!(gold.f0, Span { low: 0.3, high: 1.0 });
    let half = lobe(json!({"pbrMetallicRoughness":
        {"metallicFactor": 0.5, "baseColorFactor": [1.0, 0.7, 0.3, 1]}}));
    close(half.f0, 0.17, 0.52);
}

#[test]
fn materials_of_meshes_and_variants_are_in_use() {
    let materials: Vec<_> = (0..5)
        .map(|i| json!({"pbrMetallicRoughness": {"roughnessFactor": 0.1 * f64::from(i)}}))
        .collect();
    let mapping = json!([{"material": 3, "variants": [0]}]);
    let file = gltf(json!({
        "materials": materials,
        "meshes": [{"primitives": [
            {"material": 1, "attributes": {"POSITION": 0},
             "extensions": {"KHR_materials_variants": {"mappings": mapping}}},
            {"mode": 1}
        ]}]
    }));
    let scene = scene(&file);
    let names: Vec<_> = scene.lobes.iter().map(|lobe| lobe.material.as_str()).collect();
    assert_eq!(names, ["material 1", "material 3"]);
    assert!(scene.notes.iter().any(|note| note.contains("3 of 5")), "{:?}", scene.notes);
}

#[test]
fn triangles_without_a_material_have_the_default_one() {
    let file = gltf(json!({"materials": [{}], "meshes": [{"primitives": [
        {"material": 0}, {"attributes": {"POSITION": 0}}]}]}));
    let lobes = scene(&file).lobes;
    assert_eq!(lobes.len(), 2);
    assert_eq!(lobes[1].material, "default material");
    assert_eq!((lobes[1].roughness, lobes[1].f0), (Span::point(1.0), Span::point(1.0)));
}

#[test]
fn colours_of_vertices_darken_metals_alone() {
    for (metallic, low) in [(1.0, 0.0), (0.0, 0.04)] {
        let file = gltf(json!({
            "materials": [{"pbrMetallicRoughness":
                {"metallicFactor": metallic, "baseColorFactor": [0.9, 0.9, 0.9, 1]}}],
            "meshes": [{"primitives": [{"material": 0, "attributes": {"COLOR_0": 0}}]}]
        }));
        assert_eq!(base(&file).f0.low, low);
    }
}

#[test]
fn a_glb_is_its_json() {
    let json = gltf(json!({"materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.25}}]}));
    assert_eq!(scene(&glb(&json, b"")), scene(&json));
    assert_eq!(base(&glb(&json, &[1; 7])).roughness, Span::point(0.25));
    // A byte order mark is passed over.
    assert_eq!(scene(&[b"\xef\xbb\xbf", json.as_slice()].concat()), scene(&json));
}

#[test]
fn names_are_made_fit_to_print() {
    for (name, printed) in [
        ("a\u{1b}[31m\nb", "a [31m b".to_owned()),
        ("\u{202e}x", "x".to_owned()),
        ("", "material 0".to_owned()),
        ("\u{7}", "material 0".to_owned()),
        (&"x".repeat(200), "x".repeat(63) + "…"),
    ] {
        assert_eq!(lobe(json!({"name": name})).material.trim(), printed);
    }
}

#[test]
fn assumptions_change_roughness_and_are_noted() {
    let file = gltf(json!({"materials": [
        {"pbrMetallicRoughness": {"roughnessFactor": 0.02}},
        {"pbrMetallicRoughness": {"roughnessFactor": 0.5}}]}));
    let with = |assumptions| read("a.gltf", &file, &assumptions, &no_files).unwrap();
    let clamped = with(Assumptions { least_roughness: 0.045, ..Default::default() });
    assert_eq!(clamped.lobes[0].roughness, Span::point(0.045));
    assert_eq!(clamped.lobes[1].roughness, Span::point(0.5));
    let widened = with(Assumptions { specular_antialiasing: true, ..Default::default() });
    assert_eq!(widened.lobes[1].roughness, Span { low: 0.5, high: 1.0 });
    assert_eq!(
        clamped.notes.iter().chain(&widened.notes).filter(|n| n.contains("assumed")).count(),
        2
    );
    for wrong in [f64::NAN, -0.1, 1.5] {
        let assumptions = Assumptions { least_roughness: wrong, ..Default::default() };
        assert!(read("a", &file, &assumptions, &no_files).is_err());
        let assumptions = Assumptions { ignore_texels: wrong, ..Default::default() };
        assert!(read("a", &file, &assumptions, &no_files).is_err());
    }
}

#[test]
fn a_list_of_materials_is_read() {
    let scene = scene(
        br#"{"materials": [{"name": "oak", "roughness": [0.3, 0.6]},
            {"roughness": 0.5, "f0": [0.1, 0.9], "f90": 0.8, "layer": "sheen"}]}"#,
    );
    let [oak, second] = scene.lobes.as_slice() else { unreachable!("{:?}", scene.lobes) };
    assert_eq!((oak.material.as_str(), oak.layer), ("oak", Layer::Base));
    assert_eq!(oak.roughness, Span { low: 0.3, high: 0.6 });
    assert_eq!((oak.f0, oak.f90), (Span::point(0.04), Span::point(1.0)));
    assert_eq!((second.material.as_str(), second.layer), ("material 1", Layer::Sheen));
    assert_eq!((second.f0, second.f90), (Span { low: 0.1, high: 0.9 }, Span::point(0.8)));
    for (wrong, said) in [
        (r#"{"materials": [{"roughness": 1.5}]}"#, "roughness of material 0: expected 0 to 1"),
        (r#"{"materials": [{"roughness": [0.5, 0.2]}]}"#, "in order"),
        (r#"{"materials": [{"roughness": 0.5, "f0": -1}]}"#, "f0 of material 0"),
        (r#"{"materials": [{"roughness": 0.5, "colour": 1}]}"#, "unknown field"),
        (r#"{"materials": [{"roughness": 0.5, "layer": "skin"}]}"#, "base, clearcoat, sheen"),
        (r#"{"materials": [{"roughness": "rough"}]}"#, "a number or [low, high]"),
        (r#"{"materials": [{"f0": 0.5}]}"#, "roughness"),
        (r#"{"materials": {}}"#, "materials"),
    ] {
        let error = refused(wrong.as_bytes());
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn given_values_are_a_scene() {
    let rough = [Span { low: 0.3, high: 1.0 }, Span::point(0.1)];
    let scene = of_values(&rough, Span::point(0.04), Span::point(1.0));
    assert_eq!(scene.lobes.iter().map(|lobe| lobe.roughness).collect::<Vec<_>>(), rough);
    assert!(scene.lobes.iter().all(|lobe| lobe.f0 == Span::point(0.04)));
    assert!(Span::new("x", 1.0, 0.0).is_err() && Span::new("x", f64::NAN, 0.0).is_err());
    assert_eq!(Span::new("x", 0.0, 1.0).unwrap(), Span::UNIT);
}

#[test]
fn layers_have_words() {
    assert_eq!(Layer::named("clearcoat").unwrap(), Layer::Clearcoat);
    assert_eq!(Layer::Sheen.to_string(), "sheen");
}

#[test]
fn a_scene_without_reflections_says_so() {
    let scene = scene(&gltf(json!({})));
    assert!(scene.lobes.is_empty());
    assert!(scene.notes.iter().any(|note| note.contains("no material")), "{:?}", scene.notes);
    assert!(lobes(json!({"extensions": {"KHR_materials_unlit": {}}})).is_empty());
}
