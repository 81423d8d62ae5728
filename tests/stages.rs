//! The stages of certification hold each other to account: margins, audits, ranges, and what is
//! left undecided.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Integrator, ab, certify, certify_by, errors_at, field, ggx, part};
use splitsum::backend::cpu::{self, Baker};
use splitsum::brdf::interface::Interface;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::certify::decision::Task;
use splitsum::certify::stages::{LARGEST_F32, LARGEST_F32_OF_GLASS, Stages, rules};
use splitsum::certify::ziv::DeviceTable;
use splitsum::error::ExitCode;
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::{CHARLIE_LIMIT, CHARLIE_UNKNOWN, GRAZING, Rule};
use splitsum::integrate::rules::{D10240, REFERENCE, RULES};
use splitsum::lut::{Energy, EnergyChannels, Glass, GlassChannels, Lut, Part};
use splitsum::table::axis::Axis;
use splitsum::table::grid::Grid;
use splitsum::table::precision::Precision;
use splitsum::units::F0;
use splitsum::{Accuracy, Request};

fn grid(columns: usize, rows: usize) -> Grid {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    Grid::new(&axis("nov", columns), &axis("roughness", rows)).unwrap()
}

fn task<'a>(lut: &'a Part, grid: &'a Grid, precision: Precision) -> Task<'a> {
    Task { lut, grid, slices: 1, precision, tolerance: precision.default_tolerance() }
}

/// A lobe with three stages on the CPU.
const BECKMANN: Microfacet = Microfacet { ndf: Ndf::Beckmann, masking: Masking::HeightCorrelated };

/// n·v at which A of the rule, at α = 1/4, lies `distance` above the boundary of rounding that is
/// next above A(0.6).
fn beside_a_boundary(rule: &Rule, distance: f64) -> f64 {
    let integrator = Integrator(*rule);
    let a = |mu| integrator.integrate(BECKMANN, mu, 0.25).a;
    let step = splitsum::numeric::half::step(a(0.6));
    let target = ((a(0.6) / step).floor() + 1.5) * step + distance;
    let (mut low, mut high) = (0.6, 0.65);
    assert!(a(low) < target && target < a(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if a(middle) < target { low = middle } else { high = middle }
    }
    high
}

#[test]
fn a_stage_decides_nothing_nearer_than_its_error_and_twice_the_next_ones() {
    let lut = part(BECKMANN);
    let some = Grid::of(vec![0.6], vec![0.25]);
    let rules = rules(&task(&lut, &some, Precision::F16));
    let value = Integrator(rules[0]).integrate(BECKMANN, 0.6, 0.25);
    let [own, last] =
        [0, rules.len() - 2].map(|i| errors_at(&rules[i], BECKMANN, (0.0, 0.25), value).a);
    // The last rule before the reference is not the first, and its margin is seen.
    assert!(rules.len() == 3 && last > 0.0);
    for (distance, decided) in [(own + last, 0), (own + 3.0 * last, 1)] {
        let grid = Grid::of(vec![beside_a_boundary(&rules[0], distance)], vec![0.25]);
        let certified = certify(&task(&lut, &grid, Precision::F16), None).unwrap();
        assert_eq!(certified.stages[0].decided, Some(decided), "{distance:e} from a boundary");
        assert_eq!(certified.certificate.undecided, 0);
    }
}

#[test]
fn a_rule_that_keeps_less_than_it_promises_is_found_out_by_the_next() {
    let lobe = ggx(Masking::HeightCorrelated);
    let (lut, grid) = (part(lobe), grid(24, 24));
    let task = task(&lut, &grid, Precision::F16);
    let coarse = Rule::named("h56").unwrap();
    let through = |first: Rule| certify_by(&task, &Stages::by(&task, &[first, REFERENCE]), None);
    // h56 errs by up to 1e-3; it says so, or not.
    assert!(through(coarse).is_ok());
    let error = through(coarse.promising(1e-6)).unwrap_err();
    assert_eq!(error.exit_code(), ExitCode::CheckFailed);
    assert!(error.to_string().contains("rule h56 beside reference"), "{error}");
    // Only the tests of what guards bounds may have such a rule: no table is baked by it.
    let request = Request::with_default_axes(ab(lobe), (4, 4), Precision::F16).unwrap();
    let promised = request.stored(Accuracy::Rule(coarse.promising(1e-6)), Precision::F16);
    assert!(promised.unwrap_err().to_string().contains("its own bounds"));
    assert!(request.stored(Accuracy::Rule(coarse), Precision::F16).is_ok());
}

#[test]
fn the_report_of_a_stage_tells_the_widest_bound_on_the_grid() {
    let lobe = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    let (lut, sheen) = (part(lobe), |alphas| Grid::of(vec![0.5], alphas));
    let stage = |grid: &Grid, rule| {
        let task = task(&lut, grid, Precision::F16);
        certify_by(&task, &Stages::by(&task, &[rule, REFERENCE]), None).unwrap().stages
    };
    // Below roughness 0.07 the other double exponential rules have no bound.
    let no_bound = stage(&sheen(vec![1e-4]), D10240);
    assert!(no_bound[0].error.is_none() && no_bound[0].decided == Some(0));
    for (alphas, reference) in [(vec![1e-11, 0.25], 2e-6), (vec![1e-4, 0.25], 1e-13)] {
        let grid = sheen(alphas);
        let stages = stage(&grid, REFERENCE);
        assert_eq!(stages[0].error.unwrap().largest, reference);
    }
}

#[test]
fn a_device_with_one_value_below_every_albedo_is_found_out() {
    // 64 texels in turn: all but one of them are in no sample.
    let lobe = Microfacet { ndf: Ndf::Beckmann, masking: Masking::Separable };
    let (lut, grid, rule) = (part(lobe), grid(16, 16), Rule::named("h640").unwrap());
    let points = cpu::bake(lobe, &grid, &rule, &|_| ()).scale_bias();
    for texel in 64..128 {
        for channel in 0..2 {
            let mut points = points.clone();
            let value = &mut points[texel];
            *if channel == 0 { &mut value.a } else { &mut value.b } = -1e-5;
            let device = DeviceTable { integrals: &field(&points), rule: &rule, name: "a device" };
            let error = certify(&task(&lut, &grid, Precision::F16), Some(device)).unwrap_err();
            assert!(error.to_string().contains("no albedo can be"), "texel {texel}: {error}");
        }
    }
}

#[test]
fn as_many_f32_values_as_the_limit_says_are_rounded_correctly() {
    let lobe = ggx(Masking::HeightCorrelated);
    let lut = part(lobe);
    let grid = grid(64, LARGEST_F32 / 128);
    let certified = certify(&task(&lut, &grid, Precision::F32), None).unwrap();
    assert_eq!((certified.values.len(), certified.certificate.undecided), (LARGEST_F32, 0));
    let truth = cpu::bake(lobe, &grid, &REFERENCE, &|_| ()).scale_bias();
    let rounded =
        truth.iter().flat_map(|value| [value.a, value.b]).map(|value| f64::from(value as f32));
    assert!(certified.values.iter().copied().eq(rounded));
}

#[test]
fn more_f32_values_are_kept_within_the_tolerance_whatever_their_slices() {
    let interface = Interface::samples().into_iter().find(|interface| interface.ior() == 1.5);
    let glass = Part::from(Lut::Glass(Glass::new(interface.unwrap(), GlassChannels::Rt)));
    for (lut, most) in
        [(part(ggx(Masking::HeightCorrelated)), LARGEST_F32), (glass, LARGEST_F32_OF_GLASS)]
    {
        let grid = grid(16, most / 32);
        let one = task(&lut, &grid, Precision::F32);
        let promise = |task: &Task| certify(task, None).unwrap().certificate.promise;
        assert!(promise(&one).contains("rounded once"), "{most}");
        assert!(promise(&Task { slices: 2, ..one }).contains("before it was rounded"), "{most}");
    }
}

#[test]
fn an_interpolant_ends_where_its_domain_does() {
    let lobe = ggx(Masking::HeightCorrelated);
    let [interpolant, source] =
        ["s2304", "l4608"].map(|name| Baker::new(lobe, &Rule::named(name).unwrap()));
    let bits = |value: &ScaleBias| [value.a.to_bits(), value.b.to_bits()];
    let same = |roughness: f64| {
        let points: Vec<_> =
            (0..=20).map(|i| (f64::from(i) / 20.0, roughness * roughness)).collect();
        let (one, other) = (
            interpolant.bake_points(&points).scale_bias(),
            source.bake_points(&points).scale_bias(),
        );
        one.iter().zip(&other).filter(|(a, b)| bits(a) == bits(b)).count()
    };
    // It is fitted from a roughness of 1/1024 on.
    for below in [0.999_999, 0.9, 0.8, 0.5] {
        assert_eq!(same(below / 1024.0), 21, "{below}");
    }
    assert!(same(1.000_001 / 1024.0) < 21);
}

#[test]
fn charlies_bias_is_no_better_known_than_its_scale_where_its_ring_is_at_the_horizon() {
    let charlie = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    let value = ScaleBias { a: 0.5, b: 1e-6 };
    let limits = [(REFERENCE, CHARLIE_UNKNOWN), (Rule::named("h6144").unwrap(), CHARLIE_LIMIT)];
    for (rule, limit) in limits {
        let below = errors_at(&rule, charlie, (0.0, 0.99 * limit), value);
        assert_eq!(below.b, below.a, "{}", rule.name);
        assert_eq!(below.a, rule.bound(charlie));
    }
    let above = errors_at(&REFERENCE, charlie, (0.0, CHARLIE_UNKNOWN), value);
    assert!(above.b < 1e-16 && above.a < 1e-12);
}

#[test]
fn a_certificate_counts_the_errors_of_averages_and_of_channels() {
    let energy = |lobe, channels| {
        Part::from(Lut::Energy(Energy::new(lobe, F0::new(0.9999).unwrap(), channels).unwrap()))
    };
    let smith = ggx(Masking::HeightCorrelated);
    let lut = energy(smith, EnergyChannels::Split);
    let certified = certify(&task(&lut, &grid(12, 12), Precision::F16), None).unwrap();
    // What the nodes of averages may err.
    assert!(certified.certificate.reference_error >= 1e-12);
    // R of 41 x 41 texels divides by √(1-E_avg): the truth by the reference on other nodes is as
    // near as is promised.
    let axis = |words: &str| Axis::new(words.parse().unwrap(), 41).unwrap();
    let grid = Grid::new(&axis("nov,edges"), &axis("roughness,edges")).unwrap();
    let rough = Task { tolerance: 1e-5, ..task(&lut, &grid, Precision::F32) };
    let rough = certify(&rough, None).unwrap();
    let fine = certify_by(
        &Task { precision: Precision::F64, ..task(&lut, &grid, Precision::F64) },
        &Stages::by(&task(&lut, &grid, Precision::F32), &[REFERENCE]),
        None,
    )
    .unwrap();
    let error = |(a, b): (&f64, &f64)| (a - b).abs() / b.abs().max(1.0);
    let worst = rough.values.iter().zip(&fine.values).map(error).fold(0.0, f64::max);
    assert!(worst <= rough.certificate.bound, "{worst:e}, {:e} promised", rough.certificate.bound);
    // The integral's own tolerance would have been too little.
    assert!(worst > 1e-5, "{worst:e}");
}

#[test]
fn no_bound_narrows_as_grazing_incidence_comes_nearer() {
    let alphas = [1e-11, 1e-9, 1e-3, 0.006, 0.1, 0.3, 1.0];
    for lobe in Microfacet::all() {
        for rule in RULES.iter().filter(|rule| rule.applies_to(lobe)) {
            for (alpha, b) in
                alphas.into_iter().flat_map(|alpha| [1e-9, 1e-4, 0.5].map(|b| (alpha, b)))
            {
                let at = |mu| rule.errors(lobe).at((mu, alpha), &[0.5, b]);
                for (grazing, beyond) in at(0.999 * GRAZING).into_iter().zip(at(GRAZING)) {
                    assert!(grazing >= beyond, "{} of {lobe:?} at {alpha}, {b}", rule.name);
                }
            }
        }
    }
}
