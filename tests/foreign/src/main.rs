//! Reads files by other people's crates: `foreign FILE...` prints a line for each file and reader,
//! with the largest difference from the values of FILE.f64, or the reader's refusal. Bevy's image
//! has the bytes of FILE.raw, or it is a fault.

mod bevy;
mod dds;
mod ktx2;

use std::error::Error;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Values slice by slice, row 0 first, row by row, components side by side.
type Values = Vec<f64>;

fn main() -> Result<()> {
    for path in std::env::args().skip(1) {
        let file = std::fs::read(&path)?;
        let expected = numbers(&std::fs::read(format!("{path}.f64"))?, f64::from_le_bytes);
        let raw = std::fs::read(format!("{path}.raw"))?;
        let values = match path.rsplit('.').next() {
            Some("ktx2") => ("ktx2", ktx2::read(&file)),
            _ => ("dds", dds::read(&file)),
        };
        let found = values.1.and_then(|values| difference(&values, &expected));
        say(&path, values.0, found);
        say(&path, "bevy", bevy::read(&path, &file, &raw));
    }
    Ok(())
}

fn say(path: &str, reader: &str, found: Result<f64>) {
    match found {
        Ok(difference) => println!("{path}\t{reader}\t{difference:e}"),
        Err(error) => println!("{path}\t{reader}\trefused: {error}"),
    }
}

/// The largest difference; an error where there are not as many values.
fn difference(values: &[f64], expected: &[f64]) -> Result<f64> {
    if values.len() != expected.len() {
        return Err(format!("{} values for {}", values.len(), expected.len()).into());
    }
    // A difference that is no number is the largest.
    let larger = |worst: f64, d: f64| if d <= worst { worst } else { d };
    Ok(values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, larger))
}

/// Numbers of N bytes each.
fn numbers<const N: usize>(data: &[u8], value: impl Fn([u8; N]) -> f64) -> Values {
    data.as_chunks::<N>().0.iter().map(|&bytes| value(bytes)).collect()
}

/// The value of a half.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    match bits >> 10 & 31 {
        0 => sign * fraction * 2f64.powi(-14),
        31 => f64::NAN,
        exponent => sign * (1.0 + fraction) * 2f64.powi(i32::from(exponent) - 15),
    }
}
