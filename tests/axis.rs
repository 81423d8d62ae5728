//! Axes: the parameter of a texel, its inverse, and the conventions that other tools use.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use splitsum::table::axis::{Axis, AxisSpec};
use splitsum::table::grid::Grid;

fn axis(words: &str, size: usize) -> Axis {
    Axis::new(words.parse().unwrap(), size).unwrap()
}

#[test]
fn texel_is_the_inverse_of_value() {
    for mapping in ["linear", "sqrt", "square", "sqrt-complement"] {
        for nodes in ["centres", "edges", "offset=0.25"] {
            for flip in ["", ",flip"] {
                let axis = axis(&format!("nov,{mapping},{nodes}{flip}"), 37);
                for i in 0..37 {
                    // The square root of 1 - t² loses half the digits at t = 0; every other node is
                    // exact to rounding.
                    let slack = if mapping == "sqrt-complement" { 37.0 * 1.5e-8 } else { 1e-13 };
                    let back = axis.texel(axis.value(i));
                    assert!(
                        (back - i as f64).abs() < slack,
                        "{} texel {i} came back as {back}",
                        axis.spec()
                    );
                }
            }
        }
    }
}

/// The value of an expression of WGSL, by naga's evaluator of constants.
fn evaluated(expression: &str) -> f64 {
    let module = naga::front::wgsl::parse_str(&format!("const t: f32 = {expression};")).unwrap();
    let (_, constant) = module.constants.iter().next().unwrap();
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::F32(value)) => value.into(),
        ref other => panic!("{expression} gave {other:?}"),
    }
}

#[test]
fn uv_is_the_centre_of_the_texel_that_holds_the_parameter() {
    for (parameter, mapping) in [
        ("nov", "linear"),
        ("nov", "sqrt"),
        ("roughness", "sqrt-complement"),
        ("alpha", "sqrt"),
        ("alpha", "square"),
        ("exponent", "linear"),
    ] {
        for nodes in ["centres", "edges", "offset=0.25", "offset=0.25,flip", "edges,flip"] {
            let axis = axis(&format!("{parameter},{mapping},{nodes}"), 37);
            for i in [0, 1, 17, 35, 36] {
                let p = match parameter {
                    "exponent" => 10f64.powf(7.0 * axis.value(i)),
                    _ => axis.value(i),
                };
                let uv = evaluated(&axis.uv(&format!("f32({p:?})")));
                let expected = (axis.texel(axis.value(i)) + 0.5) / 37.0;
                // The parameter is rounded to f32, and the square root of 1 - t² makes up to the
                // root of 2^-24 of that.
                let slack = if mapping == "sqrt-complement" { 2.5e-4 } else { 1e-6 };
                assert!((uv - expected).abs() < slack, "{}: {i} at {uv}", axis.spec());
            }
        }
    }
}

#[test]
fn ends_are_where_the_nodes_say() {
    assert_eq!((axis("nov,edges", 5).value(0), axis("nov,edges", 5).value(4)), (0.0, 1.0));
    assert_eq!((axis("nov", 4).value(0), axis("nov", 4).value(3)), (0.125, 0.875));
    assert_eq!((axis("nov,flip", 4).value(0), axis("nov,flip", 4).value(3)), (0.875, 0.125));
    assert_eq!(axis("nov,sqrt", 4).value(0), 0.125 * 0.125);
    assert_eq!(
        axis("alpha,square,edges", 5).values(),
        [0.0, 0.5, 0.5f64.sqrt(), 0.75f64.sqrt(), 1.0]
    );
    assert_eq!(axis("nov,sqrt-complement,edges", 3).values(), [1.0, 0.75, 0.0]);
    assert_eq!(axis("nov,edges", 1).value(0), 0.0);
    assert_eq!(axis("nov", 1).value(0), 0.5);
}

#[test]
fn known_conventions_can_be_said() {
    // Filament stores roughness flipped and one texel off: row y holds (h - y + 0.5)/h, clamped to
    // 1.
    let filament = axis("roughness,offset=1.5,flip", 64);
    for y in 0..64 {
        assert_eq!(filament.value(y), ((64.0 - y as f64 + 0.5) / 64.0).min(1.0));
    }
    // panda3d-simplepbr: i/N. Cycles: i/(N-1), at least 1e-4. LTC: sqrt(1 - n.v) = i/63.
    assert_eq!(axis("roughness,offset=0", 512).value(3), 3.0 / 512.0);
    assert_eq!(axis("nov,edges,min=1e-4", 32).value(0), 1e-4);
    assert_eq!(axis("nov,sqrt-complement,edges", 64).value(63), 0.0);
}

#[test]
fn words_read_back_to_the_same_axis() {
    for words in [
        "nov,linear,centres",
        "roughness,sqrt,edges,flip",
        "alpha,sqrt-complement,offset=-0.25,min=0.001",
        "roughness,linear,offset=1.5,flip,unclamped",
        "nov,sqrt-complement,edges,min=0.0001,max=0.9999",
    ] {
        let spec: AxisSpec = words.parse().unwrap();
        assert_eq!(spec.to_string(), words);
    }
    assert_eq!("nov".parse::<AxisSpec>().unwrap().to_string(), "nov,linear,centres");
}

#[test]
fn a_texel_is_clamped_where_the_min_raises_it_and_not_where_it_is_the_min() {
    // Texels at 0, 1/4, …, 1.
    for (words, clamped) in
        [("nov,edges,min=0.25", 1), ("nov,edges,min=0.2501", 2), ("nov,edges", 0)]
    {
        assert_eq!(axis(words, 5).clamped(), clamped, "{words}");
        assert_eq!(axis(&words.replace("edges", "edges,flip"), 5).clamped(), clamped, "{words}");
    }
}

#[test]
fn a_max_lowers_texels_and_an_unclamped_axis_keeps_them() {
    // EEVEE's n·v, and Godot's roughness, whose row 0 is half a texel beyond 1.
    let view = axis("nov,sqrt-complement,edges,min=1e-4,max=0.9999", 64);
    assert_eq!((view.value(0), view.value(63), view.clamped()), (0.9999, 1e-4, 2));
    let rough = axis("roughness,offset=1.5,flip,unclamped", 128);
    assert_eq!((rough.value(0), rough.value(127)), (128.5 / 128.0, 1.5 / 128.0));
    assert_eq!(axis("roughness,offset=1.5,flip", 128).value(0), 1.0);
    // To 1.06 and no farther, as n·v not beyond 1 at all.
    let beyond = |words: &str, size| Axis::new(words.parse().unwrap(), size);
    assert!(beyond("roughness,offset=1.5,unclamped", 9).is_ok());
    assert!(beyond("roughness,offset=1.5,unclamped", 8).is_err());
    assert!(beyond("nov,offset=1.5,unclamped", 64).is_err());
    assert!(beyond("nov,edges,min=0.5,max=0.4", 4).is_err());
}

#[test]
fn wrong_words_sizes_and_values_are_refused() {
    for words in [
        "",
        "mu",
        "nov,cubic",
        "nov,offset",
        "nov,offset=x",
        "nov,,",
        "nov,sqrt,linear",
        "nov,edges,centres",
        "nov,min=0.1,min=0.2",
        "nov,max=0.1,max=0.2",
        "nov,unclamped,unclamped",
        "nov,unclamped=1",
    ] {
        assert!(words.parse::<AxisSpec>().is_err(), "{words:?} was taken");
    }
    for words in [
        "offset=nan",
        "offset=1e9",
        "offset=-2.1",
        "min=nan",
        "min=-1",
        "min=2",
        "max=nan",
        "max=0",
        "max=-1",
    ] {
        let spec: AxisSpec = format!("nov,{words}").parse().unwrap();
        let error = Axis::new(spec, 4).unwrap_err().to_string();
        let name = words.split('=').next().unwrap();
        let got = error.split("got").nth(1).unwrap();
        assert!(error.contains("X in [-2, 2]") && got.contains(name), "{words}: {error}");
    }
    for size in [0, 16385, usize::MAX] {
        assert!(Axis::new("nov".parse().unwrap(), size).is_err());
    }
    // n·v so small that its square is no number; 0 is its limit.
    for (min, taken) in
        [("1e-200", false), ("5e-324", false), ("9.9e-31", false), ("1e-30", true), ("0", true)]
    {
        let axis = Axis::new(format!("nov,edges,min={min}").parse().unwrap(), 2);
        assert_eq!(axis.is_ok(), taken, "n.v from {min}");
        let said = axis.err().map_or(String::new(), |error| error.to_string());
        assert!(taken || said.contains("expected 0, or 1e-30 to 1"), "{said}");
    }
    // Roughness so small that alpha² would not be a normal f32.
    assert!(Axis::new("roughness,offset=1e-9".parse().unwrap(), 16).is_err());
    assert!(Axis::new("roughness,sqrt".parse().unwrap(), 16384).is_ok());
}

#[test]
fn one_axis_is_the_view_and_the_other_a_roughness() {
    let (view, rough, alpha) = (axis("nov", 3), axis("roughness", 2), axis("alpha", 2));
    assert!(Grid::new(&view, &view).is_err() && Grid::new(&rough, &alpha).is_err());
    let grid = Grid::new(&rough, &view).unwrap();
    assert_eq!((grid.len(), grid.mus.len()), (6, 3));
    // Perceptual roughness is squared, alpha is not.
    assert_eq!(grid.alphas, [0.0625, 0.5625]);
    assert_eq!(Grid::new(&view, &alpha).unwrap().alphas, [0.25, 0.75]);
    // Blinn-Phong's exponent runs from 1 to 1e7 by its logarithm, and α² = 2/(n+2).
    let exponents = Grid::new(&view, &axis("exponent,edges", 8)).unwrap().alphas;
    let n = exponents.iter().map(|alpha| 2.0 / (alpha * alpha) - 2.0);
    assert!(n.enumerate().all(|(i, n)| (n / 10f64.powi(i as i32) - 1.0).abs() < 1e-12));
}
