//! What a storage cannot hold is refused, and what a file promises is kept: at extremes, by the
//! figures of an independent method.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::{ab, average_in_pieces};
use program::{ok, run, stderr};
use splitsum::backend::Backend;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::lut::{Energy, EnergyChannels, Lut};
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::table::precision::Precision;
use splitsum::units::F0;
use std::fs;
use tempfile::tempdir;

#[test]
fn a_value_that_the_storage_cannot_hold_is_named_with_the_storage_that_holds_it() {
    // The largest values of the tables of 128 x 128 by an independent integration (2.21, 1.545,
    // 1.015, 1.63, 4.40), here to four digits; R of a mirror with F0 = 0.04 is 0.96/√(1 - 0.04
    // 20/21 - 1/21) = 1.00399 at normal incidence.
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.png"), "the old file").unwrap();
    for (flags, largest) in [
        ("--lut energy --channels turquin", "2.2099"),
        ("--lut diffuse --model burley", "1.5454"),
        ("--lut diffuse --model oren-nayar", "1.0150"),
        ("--model blinn-phong --masking height-correlated", "1.6308"),
        ("--lut sheen --y roughness,min=0.08", "4.3972"),
        ("--lut energy", "1.0039"),
    ] {
        for precision in ["unorm8", "unorm16"] {
            for certify in ["on", "off"] {
                let bake = format!(
                    "bake --backend cpu {flags} --certify {certify} --precision {precision} -o \
                     a.png"
                );
                let output = run(&folder, &bake);
                let text = stderr(&output);
                assert_eq!(output.status.code(), Some(4), "{bake}: {text}");
                let got = format!("got {largest}");
                for words in [
                    &got,
                    "as the largest, channel",
                    "n.v = ",
                    "f16 or f32, in a file format of floats",
                ] {
                    assert!(text.contains(words), "{bake}: no '{words}' in: {text}");
                }
            }
        }
        // And there it is held.
        ok(&folder, &format!("bake --backend cpu {flags} --size 16 -q -o a.exr"));
    }
    assert_eq!(fs::read(folder.path().join("a.png")).unwrap(), b"the old file");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    // Charlie's fitted term grows without bound: f16 ends at 65504.
    let fitted = "--lut sheen --masking height-correlated --x nov,edges,min=1e-30 --y \
                  roughness,edges,min=0.001 --size 2";
    let text = stderr(&run(&folder, &format!("bake --backend cpu {fitted} -o b.exr")));
    assert!(text.contains("from -65504 to 65504") && text.contains("store them in f32"), "{text}");
}

#[test]
fn what_is_not_certified_is_not_pushed_into_the_range_either() {
    // E reaches 1.05, and the rule errs by up to 4e-2: the estimate is within that of 1, and the
    // truth is not.
    let folder = tempdir().unwrap();
    let lobe = "--model blinn-phong --masking separable --channels e --size 64x1 --x nov,edges \
                --y roughness,edges,min=0.68";
    let output = run(
        &folder,
        &format!("bake --backend cpu {lobe} --certify off --rule h56 --precision unorm16 -o c.png"),
    );
    assert_eq!(output.status.code(), Some(4), "{}", stderr(&output));
    assert!(stderr(&output).contains("got 1.0"), "{}", stderr(&output));
    // An albedo that stays below 1 is meant to be 1 where the rule says a little more.
    ok(
        &folder,
        "bake --backend cpu --size 64 --certify off --rule h56 --precision unorm16 --x nov,edges \
         -q -o c.png",
    );
    // A rule that promises nothing of a lobe is refused for that.
    let output = run(
        &folder,
        "bake --lut sheen --backend cpu --size 64 --certify off --rule d6144 -o d.exr",
    );
    ok(
        &folder,
        "bake --lut sheen --y roughness,min=0.07 --backend cpu --size 4 --certify off --rule \
         d6144 -q -o d.exr",
    );
    assert!(
        output.status.code() == Some(4)
            && stderr(&output).contains("rule: expected one that serves"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn unorms_beside_a_boundary_round_to_the_right_side() {
    // The number just below or above half a step, whose product with the steps is rounded to a tie.
    for (precision, count) in [(Precision::Unorm16, 65535.0), (Precision::Unorm8, 255.0)] {
        let mut ties = 0;
        for whole in 0..255 {
            let boundary = (f64::from(whole) + 0.5) / count;
            for value in [boundary.next_down(), boundary, boundary.next_up()] {
                // value · count - (whole + 1/2), exactly: both are less than 2^9, so that the fused
                // product loses nothing.
                let beyond = value.mul_add(count, -(f64::from(whole) + 0.5));
                let expected = if beyond == 0.0 {
                    f64::from(whole + whole % 2)
                } else {
                    f64::from(whole) + f64::from(beyond > 0.0)
                };
                assert_eq!((precision.nearest(value) * count).round(), expected, "{value:e}");
                ties += usize::from(value * count == f64::from(whole) + 0.5 && beyond != 0.0);
            }
        }
        assert!(ties > 50, "{ties} products were rounded to a tie");
    }
}

#[test]
fn charts_of_tables_show_what_no_unorm_holds() {
    let folder = tempdir().unwrap();
    for (flags, printed) in [
        ("--lut energy --channels turquin", "(1-E)/E: 0 to 2.2099"),
        ("--lut diffuse --model burley", "E: 0 to 1.5455"),
        ("--lut diffuse --model oren-nayar", "E: 0 to 1.0150"),
        ("--model blinn-phong --masking height-correlated", "A: 0 to 1.6309"),
        ("--lut sheen --y roughness,min=0.08", "E: 0 to 4.3973"),
    ] {
        let text = String::from_utf8(ok(&folder, &format!("chart table {flags} -o t.png")).stdout)
            .unwrap();
        assert!(text.starts_with(printed), "{flags}: {text}");
    }
}

/// One texel of the split at F0 = 0.04 and roughness 1/2.
fn split(nov: &str, precision: Precision) -> Table {
    let energy = Energy::new(ggx(), F0::new(0.04).unwrap(), EnergyChannels::Split).unwrap();
    bake(Lut::Energy(energy), nov, "roughness", precision)
}

fn bake(lut: Lut, x: &str, y: &str, precision: Precision) -> Table {
    let axis = |words: &str| splitsum::table::axis::Axis::new(words.parse().unwrap(), 1).unwrap();
    let request = Request::new(
        lut,
        axis(x),
        axis(y),
        Accuracy::by_default(&lut.into(), precision),
        precision,
    )
    .unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

#[test]
fn the_naive_split_is_rounded_correctly_at_grazing_angles() {
    // 1-F = (1-F0) (5 μ - 10 μ² + …): at μ = 1e-10 it is 4.79999999904e-10, and at the other 2e-20
    // below a boundary of f16.
    let table = split("nov,offset=0,min=1e-10", Precision::F32);
    assert_eq!(table.value(0, 0, 0, 0), f64::from(4.8e-10_f32));
    let table = split("nov,offset=0,min=1.114507523220038e-05", Precision::F16);
    assert_eq!(table.value(0, 0, 0, 0), 897.0 / 2f64.powi(24));
}

#[test]
fn averages_of_a_term_that_jumps_keep_what_they_promise() {
    // Tables of 1 x 1401 are rounded by no more than a tolerance.
    let walter = Microfacet { ndf: Ndf::BeckmannWalter, masking: Masking::HeightCorrelated };
    let lut =
        Lut::Energy(Energy::new(walter, F0::new(0.04).unwrap(), EnergyChannels::Average).unwrap());
    let axis =
        |words: &str, size| splitsum::table::axis::Axis::new(words.parse().unwrap(), size).unwrap();
    let accuracy = Accuracy::Within(6e-7);
    let request =
        Request::new(lut, axis("nov", 1), axis("roughness,edges", 1401), accuracy, Precision::F32)
            .unwrap();
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    let certificate = table.claim(0).certificate().unwrap();
    for row in [700, 1050] {
        // tests/energy.rs holds this average, in pieces that meet where the term jumps, against
        // figures.
        let alpha = (row as f64 / 1400.0).powi(2);
        let average = average_in_pieces(walter, alpha, &[walter.break_at(alpha).unwrap()]);
        let error = (table.value(0, 0, row, 2) - average.e()).abs();
        assert!(error <= certificate.bound, "row {row}: {error:e}");
    }
}

#[test]
fn a_table_in_bands_has_the_values_of_its_rows() {
    // 2.2 million texels are three bands; a row alone is one, and goes through other stages.
    let lut = ab(ggx());
    let axis =
        |words: &str, size| splitsum::table::axis::Axis::new(words.parse().unwrap(), size).unwrap();
    let (nov, roughness) = (axis("nov", 2000), axis("roughness", 1100));
    let bake = |x, y| {
        let request = Request::new(
            lut,
            x,
            y,
            Accuracy::by_default(&lut.into(), Precision::F16),
            Precision::F16,
        )
        .unwrap();
        splitsum::bake(&request, &Backend::cpu()).unwrap()
    };
    let (whole, transposed) = (bake(nov, roughness).table, bake(roughness, nov));
    let certificate = transposed.reports[0].claim.certificate().unwrap();
    assert_eq!(
        certificate.decided_before_reference + certificate.decided_by_reference,
        2000 * 1100
    );
    for row in [0, 1, 523, 524, 525, 1048, 1049, 1099] {
        let alone =
            bake(nov, axis(&format!("roughness,edges,min={}", roughness.value(row)), 1)).table;
        for column in 0..2000 {
            assert_eq!(
                whole.texel(0, column, row),
                alone.texel(0, column, 0),
                "column {column} of row {row}"
            );
            assert_eq!(
                whole.texel(0, column, row),
                transposed.table.texel(0, row, column),
                "column {column} of row {row}"
            );
        }
    }
}

fn ggx() -> Microfacet {
    Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated }
}
