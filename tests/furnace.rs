//! The white furnace: what closes, what does not, and by how much.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::brdf::{Diffuse, Masking, Microfacet, Ndf};
use splitsum::furnace::{Extremes, Material, MultipleScattering, Split, furnaces};
use splitsum::integrate::rule::Rule;
use splitsum::table::axis::Axis;
use splitsum::table::grid::Grid;

fn grid() -> Grid {
    let axis = |words: &str| Axis::new(words.parse().unwrap(), 17).unwrap();
    Grid::new(&axis("nov,edges"), &axis("roughness,edges")).unwrap()
}

fn material(ndf: Ndf, masking: Masking, multiple_scattering: MultipleScattering) -> Material {
    Material { lobe: Microfacet { ndf, masking }, multiple_scattering, base: Diffuse::Lambert }
}

fn extremes(material: Material, f0: f64, split: Split) -> Extremes {
    let rule = Rule::named("h1536").unwrap();
    furnaces(material, &[f0], &[split], &grid(), &rule).unwrap()[0].extremes(&grid())
}

const F0S: [f64; 5] = [0.02, 0.04, 0.08, 0.5, 1.0];

#[test]
fn the_reciprocal_split_closes_within_1e_6_by_other_nodes_than_its_average() {
    use MultipleScattering::{FdezAguera, KullaConty, None, Turquin};
    for ndf in [Ndf::Ggx, Ndf::Beckmann] {
        for multiple_scattering in [None, KullaConty, Turquin, FdezAguera] {
            for f0 in F0S {
                let found = extremes(
                    material(ndf, Masking::HeightCorrelated, multiple_scattering),
                    f0,
                    Split::Reciprocal,
                );
                assert!(
                    found.least > 1.0 - 1e-6 && found.most < 1.0 + 1e-6,
                    "{ndf:?} {multiple_scattering:?} {f0}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn the_naive_split_loses_nearly_everything_at_rough_grazing_angles() {
    for f0 in [0.02, 0.04, 0.08] {
        let found = extremes(
            material(Ndf::Ggx, Masking::HeightCorrelated, MultipleScattering::None),
            f0,
            Split::Naive,
        );
        // There 1 - F is 0 and E(F0) = F0 A + B = F0 20/21 + 1/21 in closed form.
        assert_eq!(found.least_at, (0.0, 1.0));
        assert!((found.least - (f0 * 20.0 + 1.0) / 21.0).abs() < 1e-6, "{found:?}");
        assert!(found.mean < 0.92, "{found:?}");
    }
}

#[test]
fn multiple_scattering_makes_a_white_metal_white() {
    for masking in [Masking::HeightCorrelated, Masking::Separable] {
        let metal =
            |scattering| extremes(material(Ndf::Ggx, masking, scattering), 1.0, Split::Naive);
        assert!(metal(MultipleScattering::None).least < 0.32);
        for scattering in [
            MultipleScattering::KullaConty,
            MultipleScattering::Turquin,
            MultipleScattering::FdezAguera,
        ] {
            let found = metal(scattering);
            assert!(
                (found.least - 1.0).abs() < 1e-12 && (found.most - 1.0).abs() < 1e-12,
                "{scattering:?}: {found:?}"
            );
        }
    }
}

#[test]
fn combinations_without_a_meaning_are_refused() {
    let rule = Rule::named("h56").unwrap();
    let refused = |material, split| furnaces(material, &[0.04], &[split], &grid(), &rule).is_err();
    assert!(refused(
        material(Ndf::Charlie, Masking::Neubelt, MultipleScattering::None),
        Split::Albedo
    ));
    let burley = Material {
        base: Diffuse::Burley,
        ..material(Ndf::Ggx, Masking::HeightCorrelatedApprox, MultipleScattering::None)
    };
    assert!(refused(burley, Split::Reciprocal) && !refused(burley, Split::Albedo));
}
