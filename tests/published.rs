//! Published tables: what others ship is what we bake, in their conventions and within their own
//! error.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Difference, figures, ggx, number};
use splitsum::backend::Backend;
use splitsum::brdf::{Fresnel, Masking};
use splitsum::integrate::rule::Rule;
use splitsum::lut::{Dfg, DfgChannels, Lut};
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::table::axis::Axis;
use splitsum::table::precision::Precision;

fn bake(channels: DfgChannels, x: &str, y: &str, size: usize) -> Table {
    let axis = |words: &str| Axis::new(words.parse().unwrap(), size).unwrap();
    let lut =
        Lut::Dfg(Dfg::new(ggx(Masking::HeightCorrelated), Fresnel::Schlick, channels).unwrap());
    let rule = Accuracy::Rule(Rule::named("h6144").unwrap());
    let request = Request::new(lut, axis(x), axis(y), rule, Precision::F32).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

#[test]
fn blender_cycles_ggx_e() {
    let table = bake(DfgChannels::E, "roughness,edges,min=1e-4", "nov,edges,min=1e-4", 32);
    let rows = figures(include_str!("figures/cycles_ggx_e_32.csv"));
    assert_eq!(rows.len(), 1024);
    for row in rows {
        let (j, i) = (row[0].parse().unwrap(), row[1].parse().unwrap());
        let ours = table.texel(0, i, j)[0];
        // Six decimals of a Monte Carlo table: its own error is 9.9e-7.
        assert!((ours - number(row[2])).abs() < 1.1e-6, "{row:?}: {ours}");
    }
}

#[test]
fn three_js_dfg() {
    let table = bake(DfgChannels::All, "roughness", "nov", 16);
    let rows = figures(include_str!("figures/threejs_r187_dfg_16.csv"));
    assert_eq!(rows.len(), 256);
    let pairs = rows.iter().flat_map(|row| {
        let texel = table.texel(0, row[1].parse().unwrap(), row[0].parse().unwrap());
        [(texel[0], number(row[2])), (texel[1], number(row[3]))]
    });
    let difference = Difference::between(pairs);
    // Their table errs by that much: 4,096 samples of the half vector.
    assert!(difference.rms < 1.6e-3 && difference.rms > 1e-3, "{difference:?}");
}

#[test]
fn a_wrong_convention_is_far_from_what_is_published() {
    // The same figures read with the axes the wrong way round, or centres taken for edges, do not
    // fit at all.
    let rows = figures(include_str!("figures/cycles_ggx_e_32.csv"));
    for (x, y) in [
        ("nov,edges", "roughness,edges"),
        ("roughness", "nov"),
        ("roughness,edges,flip", "nov,edges"),
    ] {
        let table = bake(DfgChannels::E, x, y, 32);
        let pairs = rows.iter().map(|row| {
            (table.texel(0, row[1].parse().unwrap(), row[0].parse().unwrap())[0], number(row[2]))
        });
        assert!(Difference::between(pairs).max > 0.01, "{x} {y}");
    }
}

#[test]
fn bilinear_lookup_is_exact_at_nodes_and_between_them_linear() {
    let table = bake(DfgChannels::All, "nov", "roughness", 8);
    let (x, y) = (table.x().value(3), table.y().value(5));
    assert_eq!(table.bilinear(0, x, y), table.texel(0, 3, 5));
    let middle = table.bilinear(0, 0.5 * (x + table.x().value(4)), y);
    assert!((middle[0] - 0.5 * (table.texel(0, 3, 5)[0] + table.texel(0, 4, 5)[0])).abs() < 1e-15);
    assert_eq!(table.bilinear(0, 0.0, 1.0), table.texel(0, 0, 7));
}
