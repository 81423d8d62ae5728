//! Measured indices of refraction of metals at three wavelengths, for the three channels of a
//! colour.

use super::Conductor;

/// A metal with its n and k at wavelengths in nanometres, red first.
struct Metal {
    name: &'static str,
    source: &'static str,
    /// Wavelength, n, k.
    index: [[f64; 3]; 3],
}

const NOBLE: &str = "Johnson and Christy 1972, Phys. Rev. B 6, 4370";
const TRANSITION: &str = "Johnson and Christy 1974, Phys. Rev. B 9, 5056";

#[allow(clippy::approx_constant, reason = "3.14 is what was measured")]
/// The rows of the papers that lie nearest to 650, 550 and 450 nm, as published.
const METALS: [Metal; 7] = [
    Metal {
        name: "gold",
        source: NOBLE,
        index: [[659.5, 0.14, 3.697], [548.6, 0.43, 2.455], [450.9, 1.38, 1.914]],
    },
    Metal {
        name: "silver",
        source: NOBLE,
        index: [[659.5, 0.05, 4.483], [548.6, 0.06, 3.586], [450.9, 0.04, 2.657]],
    },
    Metal {
        name: "copper",
        source: NOBLE,
        index: [[659.5, 0.22, 3.747], [548.6, 1.02, 2.577], [450.9, 1.24, 2.397]],
    },
    Metal {
        name: "aluminium",
        source: "Rakic 1995, Appl. Opt. 34, 4755",
        index: [[652.25, 1.5724, 7.7354], [563.57, 1.0728, 6.7839], [442.8, 0.6079, 5.3676]],
    },
    Metal {
        name: "iron",
        source: TRANSITION,
        index: [[659.0, 2.92, 3.10], [549.0, 2.95, 2.93], [451.0, 2.59, 2.77]],
    },
    Metal {
        name: "titanium",
        source: TRANSITION,
        index: [[659.0, 2.76, 3.84], [549.0, 2.54, 3.43], [451.0, 2.27, 3.04]],
    },
    Metal {
        name: "chromium",
        source: TRANSITION,
        index: [[659.0, 3.09, 3.34], [549.0, 3.18, 3.33], [451.0, 2.33, 3.14]],
    },
];

/// The names of the metals with commas between.
pub fn names() -> String {
    METALS.map(|metal| metal.name).join(", ")
}

/// A metal's conductors for red, green and blue light; none where there is no such name.
pub fn metal(name: &str) -> Option<[Conductor; 3]> {
    let metal = METALS.iter().find(|metal| metal.name == name)?;
    Some(metal.index.map(|[_, n, k]| Conductor { n, k }))
}

/// Where the index of a conductor was measured, if it is a metal's.
pub(super) fn measured(conductor: Conductor) -> Option<String> {
    let [n, k] = conductor.index();
    METALS.iter().find_map(|metal| {
        let [wavelength, ..] = metal.index.iter().find(|row| row[1..] == [n, k])?;
        Some(format!("{} at {wavelength} nm ({})", metal.name, metal.source))
    })
}
