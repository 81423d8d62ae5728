//! What holds of the code without a compiler: its words, what it costs, and what it refuses.

use crate::cases::{Case, approximation, cases};
use splitsum::approximation::code::{Code, words};
use splitsum::approximation::cost::Lookup;
use splitsum::approximation::{
    Across, Along, Approximation, Channels, Numbers, Region, Shape, Storage,
};
use splitsum::lookup::Language;

/// The words hold every number where the code says it lies.
pub fn words_hold_the_numbers() {
    let one = |case: &Case| {
        for one in &case.approximations {
            let words = words(one);
            let nonempty: Vec<&Numbers> =
                one.numbers.iter().filter(|numbers| !numbers.is_empty()).collect();
            let same = nonempty.windows(2).all(|pair| {
                pair[0].storage() == pair[1].storage() && pair[0].len() == pair[1].len()
            });
            let storage = match nonempty[0].storage() {
                // Halves are packed as floats.
                storage if same && storage != Storage::F16 => storage,
                _ => Storage::F32,
            };
            let bits = 8 * storage.bytes();
            for (c, numbers) in one.numbers.iter().enumerate() {
                for index in 0..numbers.len() {
                    let place = bits * (index * one.channels.count() + c);
                    let field = words[place / 32] >> (place % 32);
                    let value = match numbers {
                        Numbers::Codes { offset, scale, last, .. } if same => {
                            f64::from(offset + scale * (field & u32::from(*last)) as f32)
                        }
                        _ => f32::from_bits(field).into(),
                    };
                    assert_eq!(value, numbers.get(index), "{}: {index}", case.name);
                }
            }
            let longest = nonempty.iter().map(|numbers| numbers.len()).max().unwrap();
            assert_eq!(words.len(), (longest * one.channels.count() * bits).div_ceil(32));
        }
    };
    cases().iter().for_each(one);
}

const BILINEAR: Shape = Shape::Spline { x: Along::Nov, y: Across::Linear, size: [8, 8], degree: 1 };
const POLYNOMIAL: Shape = Shape::Polynomial { x: Along::Nov };
const ALL: Region = Region { least_nov: 0.0, roughness: [0.0, 1.0] };
const ONE: Region = Region { least_nov: 0.0, roughness: [0.3, 0.3] };

pub fn costs_are_those_counted_by_hand() {
    let made = |shape, channels, storage, region: Region, count| {
        let lookup = Lookup { region: &region, channels, shape, counts: [count; 2], storage };
        (lookup.operations(), lookup.loads())
    };
    // A clamp, a product and a sum, and five products and sums.
    assert_eq!(made(POLYNOMIAL, Channels::Albedo, Storage::F32, ONE, 6), (2 + 2 + 10, 0));
    // And (1 - n.v)^5 of a clamped n.v, F, and its product.
    assert_eq!(made(POLYNOMIAL, Channels::Ratio, Storage::F32, ONE, 6), (14 + 2 + 4 + 3 + 1, 0));
    // Two clamps and two places; two spans with their weights; three times three of each channel;
    // a product and a sum.
    let places = 4 + 2 + 10;
    let bilinear = made(BILINEAR, Channels::ScaleBias, Storage::F32, ALL, 64);
    assert_eq!(bilinear, (places + 2 * 9 + 2, 4));
    // Of codes four conversions, a product and a sum of each channel.
    let codes = made(BILINEAR, Channels::ScaleBias, Storage::Unorm8, ALL, 64);
    assert_eq!(codes, (places + 2 * (9 + 6) + 2, 4));
}

pub fn what_has_no_code_is_refused() {
    let spline = approximation(1, BILINEAR, Channels::EnergyRest, Storage::F32, ALL, 64);
    let polynomial = approximation(2, POLYNOMIAL, Channels::EnergyRest, Storage::F32, ONE, 4);
    let albedo = approximation(3, POLYNOMIAL, Channels::Albedo, Storage::F32, ONE, 4);
    let with = |numbers: Vec<Numbers>| Approximation { numbers, ..spline.clone() };
    let of = |shape, region| Approximation { shape, region, ..spline.clone() };
    let degree_four = Shape::Spline { x: Along::Nov, y: Across::Linear, size: [8, 8], degree: 4 };
    let cases: [(&[Approximation], &str); 11] = [
        (&[], "splitsum"),
        (std::slice::from_ref(&spline), "splitsum_"),
        (std::slice::from_ref(&spline), "float"),
        (&[spline.clone(), spline.clone()], "splitsum"),
        (&[with(vec![Numbers::Floats(vec![f32::NAN; 64]); 2])], "splitsum"),
        (&[with(vec![Numbers::Floats(vec![0.5; 63]); 2])], "splitsum"),
        (&[with(vec![Numbers::Floats(Vec::new()); 2])], "splitsum"),
        (&[with(vec![Numbers::Floats(vec![0.5; 64])])], "splitsum"),
        (&[of(BILINEAR, ONE)], "splitsum"),
        (&[of(degree_four, ALL)], "splitsum"),
        (&[of(POLYNOMIAL, ALL)], "splitsum"),
    ];
    let code = |approximations: &[Approximation], prefix: &str| {
        Code { approximations, prefix, about: Vec::new() }.write(Language::Wgsl)
    };
    for (approximations, prefix) in cases {
        let refused = code(approximations, prefix);
        assert!(refused.is_err(), "{prefix}: {approximations:?}");
    }
    assert!(code(&[spline], "splitsum").is_ok());
    assert!(code(std::slice::from_ref(&polynomial), "splitsum").is_ok());
    // Materials with two channels and with one have E(F0) in common.
    let mixed = code(&[polynomial, albedo], "splitsum").unwrap();
    assert!(mixed.contains("fn splitsum_albedo(nov: f32, material: i32, f0: f32)"), "{mixed}");
    assert!(!mixed.contains("fn splitsum_scale_bias("), "{mixed}");
    naga::front::wgsl::parse_str(&mixed).unwrap();
}
