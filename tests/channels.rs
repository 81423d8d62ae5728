//! What the arithmetic of channels may err: each formula at extremes against 140 digits, and
//! whatever a ball holds.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Random, figures, ggx, number};
use splitsum::brdf::Masking;
use splitsum::integrate::ScaleBias;
use splitsum::lut::{Energy, EnergyChannels, Lut};
use splitsum::numeric::ball::Ball;
use splitsum::units::F0;

const CHANNELS: &str = include_str!("figures/channels.csv");

/// The family that has a channel, and the channel's place.
fn family(channel: &str, f0: f64) -> (Lut, usize) {
    let (channels, place) = match channel {
        "1-F" => (EnergyChannels::Split, 0),
        "1-E" => (EnergyChannels::Split, 1),
        "R" => (EnergyChannels::Split, 2),
        "(1-E)/E" => (EnergyChannels::Turquin, 0),
        _ => (EnergyChannels::KullaConty, 0),
    };
    let energy =
        Energy::new(ggx(Masking::HeightCorrelated), F0::new(f0).unwrap(), channels).unwrap();
    assert_eq!(channels.list()[place].0, channel);
    (Lut::Energy(energy), place)
}

fn exact(a: f64, b: f64) -> [Ball; 2] {
    [a, b].map(Ball::exact)
}

/// A and B, each at most so far from the truth.
fn within(value: ScaleBias, errors: ScaleBias) -> [Ball; 2] {
    [Ball { value: value.a, error: errors.a }, Ball { value: value.b, error: errors.b }]
}

/// |value - (high + low)|, where the value is near to `high`.
fn distance(value: f64, high: f64, low: f64) -> f64 {
    ((value - high) - low).abs()
}

#[test]
fn every_formula_errs_by_no_more_than_it_says_and_that_is_little() {
    let rows = figures(CHANNELS);
    assert_eq!(rows.len(), 260);
    for row in rows {
        let [f0, mu, a, b, a_avg, b_avg, high, low] = std::array::from_fn(|i| number(row[i + 1]));
        let (lut, place) = family(row[0], f0);
        let got = lut.values(mu, &exact(a, b), &exact(a_avg, b_avg))[place];
        assert!(distance(got.value, high, low) <= got.error, "{row:?}: {got:?}");
        // 1-F has no cancellation; 1-E has that of the last step, and a division magnifies it.
        let divisor = match row[0] {
            "R" => (1.0 - f0 * a_avg - b_avg).powf(1.5),
            "(1-E)/E" => (a + b).powi(2),
            _ => 1.0,
        };
        let scale = if row[0] == "1-F" { high } else { 1.0 / divisor };
        assert!(got.error <= 16.0 * f64::EPSILON * scale, "{row:?}: {got:?}");
    }
}

#[test]
fn what_is_exact_has_no_error_and_what_is_not_has_one() {
    let (half, third) = (Ball::exact(0.5), Ball::exact(1.0) / Ball::exact(3.0));
    assert_eq!((half * half + Ball::exact(1.0)).error, 0.0);
    assert_eq!((Ball::exact(0.25).sqrt(), (half / Ball::exact(4.0)).error), (half, 0.0));
    assert!(third.error > 0.0 && third.error < f64::EPSILON);
    assert!(
        Ball::exact(2.0).sqrt().error > 0.0 && (Ball::exact(1.0) + Ball::exact(1e-17)).error > 0.0
    );
    // What may be 0 divides nothing.
    let about_zero = Ball { value: 1e-13, error: 1e-12 };
    assert!((half / about_zero).error.is_infinite() && about_zero.sqrt().error.is_infinite());
}

#[test]
fn a_ball_holds_whatever_its_operands_can_be() {
    // The corners of the integral's and the average's intervals: every formula is monotonic in each
    // of the four.
    let mut random = Random(20261125);
    for i in 0..4000 {
        let (b, b_avg) = (0.2 * random.next(), 0.2 * random.next());
        let (a, a_avg) =
            ((0.99 - b) * random.next().powf(0.2), (0.99 - b_avg) * random.next().powf(0.2));
        let error = 10f64.powf(-4.0 - 8.0 * random.next());
        let errors = ScaleBias { a: error, b: error * random.next() };
        let average_errors = ScaleBias { a: error * random.next(), b: error };
        for (channel, f0) in
            [("R", 0.9999), ("R", 0.04), ("1-E", 0.5), ("(1-E)/E", 0.04), ("E", 0.04)]
        {
            let (lut, place) = family(channel, f0);
            let (integral, average) = (ScaleBias { a, b }, ScaleBias { a: a_avg, b: b_avg });
            let ball =
                lut.values(0.3, &within(integral, errors), &within(average, average_errors))[place];
            let mut most = 0.0f64;
            for corner in 0..16 {
                // A thousandth inside, for what rounds as the corner is computed.
                let sign = |bit: u32| if corner >> bit & 1 == 0 { 0.999 } else { -0.999 };
                let integral = exact(a + sign(0) * errors.a, b + sign(1) * errors.b);
                let average =
                    exact(a_avg + sign(2) * average_errors.a, b_avg + sign(3) * average_errors.b);
                let at = lut.values(0.3, &integral, &average)[place];
                let within = at.high() >= ball.low() && at.low() <= ball.high();
                assert!(within, "{i}: {channel} {ball:?} does not hold {at:?}");
                most = most.max((at.value - ball.value).abs());
            }
            // And it is not wider than it has to be: to first order it is the largest deviation of
            // a corner.
            assert!(
                ball.error < 1.2 * most + 1e-15 / (1.0 - a_avg - b_avg),
                "{channel}: {ball:?}, {most:e} at a corner"
            );
        }
    }
}
