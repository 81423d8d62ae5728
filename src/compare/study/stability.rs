//! Where formulas and methods fail: their errors over angle and roughness, far into the corners, in
//! f64, in f32 and on devices.

mod maps;
mod case;
mod cases;
mod formulas;
mod ways;

pub use case::Case;
pub use cases::cases;

use super::Share;
use crate::backend::Gpu;
use crate::backend::vulkan::evaluate::evaluate;
use crate::brdf::Ndf;
use crate::compare::device::formula_source;
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// An axis of a map, evenly spaced by the logarithm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// The quantity that varies.
    pub name: String,
    /// The first value, apart from 0.
    pub from: f64,
    /// The last.
    pub to: f64,
    /// Whether 0 itself stands before them.
    pub zero: bool,
}

/// A fault of a value, apart from its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fault {
    /// It is not a number.
    Nan,
    /// It is infinite.
    Infinite,
    /// It is below 0, where nothing is.
    Negative,
    /// It reflects more light than falls in.
    AboveOne,
}

/// A family of maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// A formula on the CPU.
    Formulas,
    /// Ways of integrating.
    Methods,
    /// Ways of storing.
    Storage,
    /// A formula on a device.
    Devices,
}

/// Errors over two axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Its family.
    pub family: Family,
    /// The case.
    pub case: String,
    /// Which way of computing it.
    pub variant: String,
    /// Along a row.
    pub x: Scale,
    /// From row to row.
    pub y: Scale,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Row by row; 0 where there is a fault instead.
    pub errors: Vec<f64>,
    /// Row by row: the place in [`Map::errors`], and what is wrong there.
    pub faults: Vec<(usize, Fault)>,
}

/// A property of a device's built-in functions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviceFact {
    /// The question.
    pub what: String,
    /// The device.
    pub device: String,
    /// The answer; a value that is no number is named in words.
    pub value: String,
}

/// All maps and facts of a machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// The maps.
    pub maps: Vec<Map>,
    /// The facts of devices.
    pub facts: Vec<DeviceFact>,
}

impl Scale {
    /// From one value to another.
    pub fn new(name: &str, from: f64, to: f64) -> Self {
        Scale { name: name.into(), from, to, zero: false }
    }

    /// The same with 0 before it.
    pub fn with_zero(name: &str, from: f64, to: f64) -> Self {
        Scale { zero: true, ..Scale::new(name, from, to) }
    }

    /// The value at place `i` of `n`, rounded to f32, so that all arithmetic starts from the same.
    pub fn value(&self, i: usize, n: usize) -> f64 {
        let first = usize::from(self.zero);
        if i < first {
            return 0.0;
        }
        let share = (i - first) as f64 / (n - 1 - first).max(1) as f64;
        let log = libm::log10(self.from) * (1.0 - share) + libm::log10(self.to) * share;
        f64::from(libm::exp10(log) as f32)
    }
}

impl Map {
    /// The map of these cells: an error, or what is wrong instead.
    pub fn of(
        (family, case, variant): (Family, &str, &str),
        (x, y): (&Scale, &Scale),
        size: [usize; 2],
        cells: &[std::result::Result<f64, Fault>],
    ) -> Self {
        // Three digits are enough for a colour, and for a reader; JSON holds no infinity.
        let digits = |error: f64| format!("{:.2e}", error.min(1e300)).parse().unwrap_or(error);
        let fault = |(i, cell): (usize, &std::result::Result<f64, Fault>)| {
            cell.err().map(|fault| (i, fault))
        };
        Map {
            family,
            case: case.into(),
            variant: variant.into(),
            x: x.clone(),
            y: y.clone(),
            size,
            errors: cells.iter().map(|cell| digits(cell.unwrap_or(0.0))).collect(),
            faults: cells.iter().enumerate().filter_map(fault).collect(),
        }
    }

    /// Whether there is an error for each point, and no fault beyond them.
    fn is_whole(&self) -> bool {
        let [columns, rows] = self.size;
        let points = columns.checked_mul(rows);
        points.is_some_and(|points| points > 0 && points == self.errors.len())
            && self.faults.iter().all(|(place, _)| *place < self.errors.len())
    }

    /// The largest error where there is no fault.
    pub fn largest(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }
}

impl Stability {
    /// Whether all maps have as many errors as points: what is read from a file may be anything.
    pub fn is_whole(&self) -> bool {
        self.maps.iter().all(Map::is_whole)
    }

    /// The facts of devices, as Markdown.
    pub fn facts_table(&self) -> String {
        let mut devices: Vec<&str> = self.facts.iter().map(|fact| fact.device.as_str()).collect();
        devices.dedup();
        let heads: String = devices.iter().map(|device| format!(" {device} |")).collect();
        let mut text = format!("| |{heads}\n| --- |{}\n", " --- |".repeat(devices.len()));
        for DeviceFact { what, .. } in
            self.facts.iter().take_while(|fact| fact.device == devices[0])
        {
            let value = |device: &str| {
                self.facts.iter().find(|fact| fact.what == *what && fact.device == device)
            };
            let cells = devices
                .iter()
                .map(|device| format!(" {} |", value(device).map_or("", |fact| &fact.value)));
            text += &format!("| {what} |{}\n", cells.collect::<String>());
        }
        text
    }

    /// The largest error and the faults of every map, as Markdown.
    pub fn summary(&self) -> String {
        let mut text =
            String::from("| | way | largest error | faults |\n| --- | --- | --- | --- |\n");
        for map in &self.maps {
            let [columns, rows] = map.size;
            let faults = map.faults.len();
            text += &format!(
                "| {} | {} | {:.1e} | {faults} of {} |\n",
                map.case,
                map.variant,
                map.largest(),
                columns * rows
            );
        }
        text
    }
}

/// The points of a map, row by row.
pub fn points(x: &Scale, y: &Scale, [columns, rows]: [usize; 2]) -> Vec<(f64, f64)> {
    let row = |j| (0..columns).map(move |i| (x.value(i, columns), y.value(j, rows)));
    (0..rows).flat_map(row).collect()
}

/// Measures all cases in `columns` × `rows` points, on the CPU and on these devices.
pub fn measure(size: [usize; 2], devices: &[Gpu], share: Share) -> Result<Stability> {
    let mut stability = Stability::default();
    let cases = cases();
    for (done, case) in cases.iter().enumerate() {
        stability.maps.extend(case.maps(size));
        for gpu in devices {
            stability.maps.extend(case.maps_on(gpu, size)?);
        }
        share((done + 1) as f64 / cases.len() as f64);
    }
    for gpu in devices {
        stability.facts.extend(facts(gpu)?);
    }
    Ok(stability)
}

/// The results of a device's built-in functions for a few arguments.
fn facts(gpu: &Gpu) -> Result<Vec<DeviceFact>> {
    let source = formula_source(Ndf::Ggx);
    let at = |expression: &str, arguments: &[[f32; 4]]| {
        evaluate(gpu, &source, expression, &[], arguments)
    };
    let fact = |what: &str, value: String| DeviceFact {
        what: what.into(),
        device: gpu.info().name.clone(),
        value,
    };
    let turns: Vec<[f32; 4]> =
        (0..4096).map(|i| [i as f32 * (std::f32::consts::TAU / 4096.0), 0.0, 0.0, 0.0]).collect();
    let circular = at("vec4(sin(p.x), cos(p.x), 0.0, 0.0)", &turns)?;
    let off = |(angle, result): (&[f32; 4], &[f32; 4])| {
        let angle = f64::from(angle[0]);
        (f64::from(result[0]) - libm::sin(angle))
            .abs()
            .max((f64::from(result[1]) - libm::cos(angle)).abs())
    };
    // NaN stays.
    let worse = |worst: f64, error: f64| if error <= worst { worst } else { error };
    let sine = turns.iter().zip(&circular).map(off).fold(0.0, worse);
    let exponents: Vec<[f32; 4]> =
        (0..4096).map(|i| [-20.0 * i as f32 / 4096.0, 1.0 + i as f32, 0.0, 0.0]).collect();
    let grown = at("vec4(exp(p.x), log(p.y), 0.0, 0.0)", &exponents)?;
    let relative = |value: f32, truth: f64| {
        if truth == 0.0 { 0.0 } else { (f64::from(value) / truth - 1.0).abs() }
    };
    let growth = |i: usize, f: fn(f64) -> f64| {
        let errors =
            exponents.iter().zip(&grown).map(|(p, result)| relative(result[i], f(p[i].into())));
        errors.fold(0.0, worse)
    };
    let odd =
        at("vec4(pow(p.x, p.x), pow(p.x, p.y), p.z * 0.5, p.x / p.x)", &[[0.0, 5.0, 2e-38, 0.0]])?;
    let [power, fifth, half, quotient] = odd[0];
    let said = |value: f32| if value.is_nan() { "NaN".into() } else { format!("{value:e}") };
    Ok(vec![
        fact("largest error of sin and cos over a turn", format!("{sine:.1e}")),
        fact(
            "largest relative error of exp from -20 to 0",
            format!("{:.1e}", growth(0, libm::exp)),
        ),
        fact(
            "largest relative error of log from 1 to 4096",
            format!("{:.1e}", growth(1, libm::log)),
        ),
        fact("pow(0, 0)", said(power)),
        fact("pow(0, 5)", said(fifth)),
        fact("half of 2e-38, which is subnormal", said(half)),
        fact("0/0", said(quotient)),
    ])
}
