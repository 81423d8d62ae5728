//! Every failure that the charts show happens, and what is used here instead holds its bound where
//! it does.

use splitsum::compare::study::stability::{Family, Map, cases, measure};

#[test]
fn every_failure_happens_and_ours_holds() {
    // Not the points of the chart, lest the bounds fit those alone.
    for size in [[97, 23], [61, 41]] {
        for case in cases() {
            let maps = case.maps(size);
            let (ours, others) = maps.split_last().unwrap_or((&maps[0], &[]));
            let fails = |map: &Map| {
                map.faults.iter().any(|(_, fault)| format!("{fault:?}") != "AboveOne")
                    || map.largest() >= case.fails
            };
            let single =
                |map: &&Map| case.family() != Family::Formulas || map.variant == "textbook, f32";
            let failing = others.iter().filter(single).filter(|map| fails(map)).count();
            assert!(failing > 0, "nothing fails by {} in {}", case.fails, case.name);
            assert_eq!(ours.faults, [], "{}, {}", case.name, ours.variant);
            let largest = ours.largest();
            assert!(
                largest <= case.holds,
                "{}, {}: {largest:e}, not {:e}",
                case.name,
                ours.variant,
                case.holds
            );
            // In f64 ours is as good as the arithmetic: a few hundred of its last digits.
            for map in maps.iter().filter(|map| map.variant == "ours, f64") {
                assert!(
                    map.faults.is_empty() && map.largest() < 1e-13,
                    "{}: {:e}",
                    case.name,
                    map.largest()
                );
            }
        }
    }
}

#[test]
fn a_study_without_devices_has_every_case() {
    let stability =
        measure([4, 3], &[], &|_| ()).map(|stability| stability.maps).unwrap_or_default();
    for case in cases() {
        let maps =
            stability.iter().filter(|map| map.case == case.name && map.family == case.family());
        assert!(maps.clone().count() >= 2, "{}", case.name);
        assert!(maps.clone().all(|map| map.errors.len() == 12 && map.size == [4, 3]));
    }
}
