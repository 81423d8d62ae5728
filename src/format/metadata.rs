//! Every convention of a table as one JSON text, for whichever field a format has for it.

use super::texels::Texels;
use crate::error::{Error, Result};
use crate::table::axis::{Axis, Parameter};
use crate::table::claim::Claim;
use crate::table::precision::Precision;
use crate::table::slices::SliceValue;
use crate::table::{Part, Provenance};
use serde::Serialize;

/// The key under which files carry the text.
pub const KEY: &str = "splitsum";

pub use crate::lookup::TOOL;

#[derive(Serialize)]
struct Metadata<'a> {
    tool: &'static str,
    #[serde(flatten)]
    provenance: &'a Provenance,
    #[serde(flatten)]
    claim: &'a Claim,
    command: String,
    channels: Vec<String>,
    /// The components that the claim is of, where there are others.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    claimed: Vec<&'a str>,
    /// The parts besides the main one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    others: Vec<Other<'a>>,
    x: AxisText,
    y: AxisText,
    #[serde(skip_serializing_if = "Option::is_none")]
    slice: Option<SliceText<'a>>,
    origin: &'static str,
    stored: Precision,
    rounding: &'static str,
    rounding_error: f64,
}

/// A part besides the main one.
#[derive(Serialize)]
struct Other<'a> {
    channels: Vec<&'a str>,
    #[serde(flatten)]
    provenance: &'a Provenance,
    #[serde(flatten)]
    claim: &'a Claim,
}

#[derive(Serialize)]
struct AxisText {
    parameter: Parameter,
    size: usize,
    axis: String,
    texel: String,
}

#[derive(Serialize)]
struct SliceText<'a> {
    parameter: &'static str,
    index: usize,
    count: usize,
    value: SliceValue<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    axis: Option<String>,
}

impl AxisText {
    fn new(axis: &Axis) -> Self {
        let spec = axis.spec();
        AxisText {
            parameter: spec.parameter,
            size: axis.size(),
            axis: spec.to_string(),
            texel: axis.formula(),
        }
    }
}

/// The components that a part fills.
fn named<'a>(part: &Part, names: &[&'a str]) -> Vec<&'a str> {
    part.channels.iter().filter_map(|&place| names.get(place).copied()).collect()
}

impl<'a> Other<'a> {
    fn new(part: &'a Part, names: &[&'a str]) -> Self {
        Other { channels: named(part, names), provenance: &part.provenance, claim: &part.claim }
    }
}

/// The text of a slice in ASCII: what each component of a texel is, and all that a reader has to
/// know of the numbers.
pub fn metadata(texels: &Texels, slice: usize) -> Result<String> {
    let (table, names) = (texels.table, texels.names());
    let precision = table.precision();
    let [main, others @ ..] = table.parts(slice) else {
        return Err(Error::Internal("a table without parts".into()));
    };
    let metadata = Metadata {
        tool: TOOL,
        provenance: &main.provenance,
        claim: &main.claim,
        command: texels.command(),
        channels: texels.about_components(),
        claimed: match main.channels.len() == table.channels().len() {
            true => Vec::new(),
            false => named(main, names),
        },
        others: others.iter().map(|part| Other::new(part, names)).collect(),
        x: AxisText::new(table.x()),
        y: AxisText::new(table.y()),
        slice: table.layout().slices.as_ref().map(|slices| SliceText {
            parameter: slices.word(),
            index: slice,
            count: slices.count(),
            value: slices.value(slice),
            axis: slices.spec().map(|spec| spec.to_string()),
        }),
        origin: match precision {
            Precision::Srgb8 => {
                "texel i = 0 is the left end of a row, row 0 is the first and topmost; codes are \
                 on the curve of sRGB"
            }
            Precision::Rgbd8 => {
                "texel i = 0 is the left end of a row, row 0 is the first and topmost; a value is \
                 (code/255)^2.2 / (A/255)"
            }
            _ => {
                "texel i = 0 is the left end of a row, row 0 is the first and topmost; values are \
                 linear"
            }
        },
        stored: precision,
        rounding: precision.rounding(),
        rounding_error: table.rounding(),
    };
    let json = serde_json::to_string(&metadata)
        .map_err(|error| Error::Internal(format!("metadata: {error}")))?;
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
