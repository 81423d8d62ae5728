//! Binary16: every half, every boundary between two halves.

use splitsum::numeric::half::{LARGEST, nearest_to_all, round, value};

/// The halves from 0 up to the largest finite one.
fn halves() -> impl Iterator<Item = u16> {
    0..0x7c00
}

#[test]
fn every_half_rounds_to_itself() {
    for bits in halves() {
        assert_eq!(round(value(bits)), bits);
        assert_eq!(round(-value(bits)), bits | 0x8000);
    }
    assert_eq!(value(0x7bff), LARGEST);
    assert_eq!(
        (value(0x3c00), value(0x0001), value(0x0400)),
        (1.0, 2f64.powi(-24), 2f64.powi(-14))
    );
}

#[test]
fn every_boundary_rounds_to_even_and_its_neighbours_to_theirs() {
    for bits in halves().filter(|&bits| bits < 0x7bff) {
        // Two neighbouring halves have an exact midpoint in f64; one step of f64 beside it decides.
        let middle = 0.5 * (value(bits) + value(bits + 1));
        let even = if bits % 2 == 0 { bits } else { bits + 1 };
        assert_eq!(round(middle), even);
        assert_eq!(round(f64::from_bits(middle.to_bits() - 1)), bits);
        assert_eq!(round(f64::from_bits(middle.to_bits() + 1)), bits + 1);
    }
}

#[test]
fn what_may_lie_on_either_side_of_a_boundary_is_in_doubt() {
    // From 1.5 times the smallest normal half, below which all is in doubt.
    for bits in 0x0600..0x7bff {
        let (half, next) = (value(bits), value(bits + 1));
        let (middle, unit) = (0.5 * (half + next), f64::EPSILON * next);
        let inside = (middle - half) - 4.0 * unit;
        assert_eq!(nearest_to_all(half + 0.5 * inside, 0.5 * inside - 4.0 * unit), half);
        assert_eq!(nearest_to_all(middle + 0.25 * inside, 0.25 * inside - 4.0 * unit), next);
        for doubt in [middle - half, next - half, f64::INFINITY, f64::NAN] {
            assert!(nearest_to_all(half, doubt).is_nan() && nearest_to_all(next, doubt).is_nan());
        }
        assert!(nearest_to_all(middle, 0.0).is_nan());
    }
    for beyond in [0.0, -1.0, 2f64.powi(-15), LARGEST, f64::INFINITY, f64::NAN] {
        assert!(nearest_to_all(beyond, 0.0).is_nan(), "{beyond}");
    }
}

#[test]
fn the_ends_overflow_and_vanish_as_ieee_754_says() {
    // Half a step beyond the largest half is a tie, and its even neighbour is infinity.
    assert_eq!((round(65519.999), round(65520.0), round(1e300)), (0x7bff, 0x7c00, 0x7c00));
    assert_eq!((round(2f64.powi(-25)), round(2f64.powi(-25) * 1.000001), round(1e-300)), (0, 1, 0));
    assert_eq!((round(f64::INFINITY), round(f64::NEG_INFINITY)), (0x7c00, 0xfc00));
    assert!(value(round(f64::NAN)).is_nan() && value(0x7c00).is_infinite());
}

#[test]
fn double_rounding_is_not_done() {
    // A known failure of half 2.7.1's from_f64, which drops 32 bits first: it must be nearest all
    // the same.
    let v = 0.03388977178683594;
    let bits = round(v);
    let distance = |bits: u16| (value(bits) - v).abs();
    assert!(distance(bits) <= distance(bits - 1) && distance(bits) <= distance(bits + 1));
}
