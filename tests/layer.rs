//! Lookups over T, as the chart of lookups judges them: by the search that judges tables over n·v
//! and roughness.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::brdf::{Microfacet, Ndf};
use splitsum::compare::study::lookup::corner;
use splitsum::compare::study::lookup::layer::{Judge, Where, nets, tables};
use splitsum::table::precision::Precision;

fn ggx() -> Microfacet {
    Microfacet::new(Ndf::Ggx, None).unwrap()
}

#[test]
fn exact_values_over_t_resolve_the_corner() {
    let judge = Judge::new(ggx()).unwrap().unwrap();
    let reading = |size: usize, precision: Precision| {
        let reading = tables(&judge, size, &[precision]).unwrap().remove(0);
        assert_eq!(reading.bytes, 2 * size * size * precision.bytes());
        assert!(reading.practical <= reading.everywhere && reading.rms < reading.practical);
        reading
    };
    let readings = [16, 32, 64].map(|size| reading(size, Precision::F32));
    // A bilinear lookup of smooth functions errs by the square of the spacing: 4 for each halving,
    // and a little more while the spacing is wide.
    for pair in readings.windows(2) {
        let ratio = pair[0].rms / pair[1].rms;
        assert!((3.9..4.5).contains(&ratio), "{readings:?}");
    }
    let errors = readings.map(|reading| reading.everywhere);
    // No lookup that is continuous in n·v and roughness gets below this.
    assert!(errors[0] < corner(ggx()).unwrap(), "{errors:?}");
    // A code of 8 bits is off by half a step of its channel's range, which is below 1, in either
    // channel.
    let rounded = reading(64, Precision::Unorm8).everywhere;
    assert!(rounded > errors[2] && rounded < errors[2] + 2.0 * 0.5 / 255.0, "{rounded}");
}

#[test]
fn nets_keep_their_tolerance_where_the_chart_judges_them() {
    let nets = nets(ggx(), &[1e-2], &|_| ()).unwrap();
    // Bytes of the best that an earlier study found by hand.
    for (net, (domain, most)) in nets.iter().zip([(Where::Everywhere, 126), (Where::Practical, 84)])
    {
        assert_eq!(net.domain, domain);
        assert!(net.bytes <= most, "{net:?}");
        // The search climbs to the largest error, which the planner allows up to 0.98 of the
        // tolerance at its own points; what is cheaper does not meet it, so that little is left.
        assert!(net.largest <= 1e-2 && net.largest > 8e-3, "{net:?}");
        // The largest error lies in a few places only.
        assert!(net.rms < 0.6 * net.largest, "{net:?}");
    }
    assert_eq!(nets.len(), 2);
}
