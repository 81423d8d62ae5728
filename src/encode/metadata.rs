//! Every convention of a table as one JSON text, for whichever field a format has for it.

use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::table::{Provenance, Table};
use serde::Serialize;

/// The key under which files carry the text.
pub const KEY: &str = "splitsum";

/// The tool and its version.
pub const TOOL: &str = concat!("splitsum ", env!("CARGO_PKG_VERSION"));

#[derive(Serialize)]
struct Metadata<'a> {
    tool: &'static str,
    #[serde(flatten)]
    provenance: &'a Provenance,
    channels: [String; 3],
    x: AxisText,
    y: AxisText,
    origin: &'static str,
    stored: Precision,
    rounding: &'static str,
    rounding_error: f64,
}

#[derive(Serialize)]
struct AxisText {
    parameter: crate::axis::Parameter,
    size: usize,
    axis: String,
    texel: String,
}

impl AxisText {
    fn new(axis: &Axis) -> Self {
        AxisText { parameter: axis.spec.parameter, size: axis.size, axis: axis.spec.to_string(), texel: axis.formula() }
    }
}

/// The text, in ASCII.
pub fn metadata(table: &Table) -> Result<String> {
    let precision = table.values.precision();
    let channel = |(i, letter): (usize, &str)| match table.channels.get(i) {
        Some(channel) => format!("{letter} = {} ({})", channel.name, channel.meaning),
        None => format!("{letter} = 0 (unused)"),
    };
    let mut letters = ["R", "G", "B"].into_iter().enumerate().map(channel);
    let metadata = Metadata {
        tool: TOOL,
        provenance: &table.provenance,
        channels: std::array::from_fn(|_| letters.next().unwrap_or_default()),
        x: AxisText::new(&table.x),
        y: AxisText::new(&table.y),
        origin: "texel i = 0 is the left end of a row, row 0 is the first and topmost; values are linear",
        stored: precision,
        rounding: "to nearest, ties to even",
        rounding_error: precision.half_step(),
    };
    let json = serde_json::to_string(&metadata).map_err(|error| Error::Internal(format!("metadata: {error}")))?;
    Ok(ascii(&json))
}

/// The same JSON in ASCII, which is all that some readers of text fields take.
fn ascii(json: &str) -> String {
    let escape = |unit: u16| match char::from_u32(unit.into()) {
        Some(c) if c.is_ascii() => c.to_string(),
        _ => format!("\\u{unit:04x}"),
    };
    json.encode_utf16().map(escape).collect()
}
