//! A convention in words: the command that bakes a table like it, and the one that bakes it right.

use super::decoding::Decoding;
use super::fingerprint::Fingerprint;
use super::layout::Layout;
use super::meaning::Meaning;
use crate::brdf::Fresnel;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use crate::request::Request;
use crate::table::axis::{AxisSpec, Nodes};
use crate::table::precision::Precision;
use crate::units::short;
use serde::Serialize;

/// A convention in words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Words {
    /// The axis along a row.
    pub x: String,
    /// The axis from row to row.
    pub y: String,
    /// What each channel is.
    pub channels: Vec<String>,
    /// The command of a table in this convention; none where ours have no words for it.
    pub command: Option<String>,
    /// The command of the table that it should be: true integrals, at nodes that lookups read.
    pub right: Option<String>,
    /// The offsets of the nodes of n·v and roughness, as the values have them.
    pub offsets: Option<[f64; 2]>,
    /// The sampler that repeats the values, and the middle and largest difference that is left.
    pub sampler: Option<Sampler>,
}

/// A sampler in words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sampler {
    /// Its word.
    pub estimator: String,
    /// The middle and the largest difference that is left.
    pub left: (f64, f64),
}

impl Words {
    /// The words of a convention for a table.
    pub fn new(
        table: &Foreign,
        (decoding, layout): (Decoding, Layout),
        meanings: &[Meaning],
        own: Integrand,
        (offsets, sampler): (Option<[f64; 2]>, Option<&Fingerprint>),
    ) -> Self {
        let names = &table.names;
        let about = |(place, meaning): (usize, &Meaning)| match meaning {
            Meaning::Copy(of) => format!("{}: the same as {}", names[place], names[*of]),
            meaning => match meaning.term(own) {
                Some(term) => format!("{}: {term}", names[place]),
                None => format!("{}: unknown", names[place]),
            },
        };
        let flags = flags(table, decoding, meanings, own);
        let command = |layout: Layout| {
            let [columns, rows, _] = table.size;
            flags.as_ref().map(|(lobe, storage)| {
                format!(
                    "splitsum bake {lobe} --size {columns}x{rows} --x {} --y {} {storage}",
                    layout.x, layout.y
                )
            })
        };
        let estimator = sampler.map(|found| format!(" --estimator {}", found.points));
        let repeated = command(layout).map(|command| command + &estimator.unwrap_or_default());
        let sampler =
            sampler.map(|found| Sampler { estimator: found.points.to_string(), left: found.left });
        Words {
            x: layout.x.to_string(),
            y: layout.y.to_string(),
            channels: meanings.iter().enumerate().map(about).collect(),
            command: repeated,
            right: command(readable(layout)),
            offsets,
            sampler,
        }
    }
}

impl Words {
    /// The words of a request that a table fits.
    pub fn of_request(request: &Request, table: &Foreign) -> Self {
        let layout = request.layout();
        let channels = layout.channels.iter().zip(&table.names);
        let command = Some(request.to_string());
        Words {
            x: layout.x.spec().to_string(),
            y: layout.y.spec().to_string(),
            channels: channels.map(|(channel, name)| format!("{name}: {}", channel.name)).collect(),
            right: command.clone(),
            command,
            offsets: None,
            sampler: None,
        }
    }
}

/// The same axes with nodes that a sampler reads: centres in place of shifted ones.
fn readable(layout: Layout) -> Layout {
    let of = |spec: AxisSpec| match spec.nodes {
        Nodes::Edges => spec,
        Nodes::Offset(_) => AxisSpec { nodes: Nodes::Offset(0.5), ..spec },
    };
    Layout { x: of(layout.x), y: of(layout.y) }
}

/// Lobe and channels, and the storage, as flags; none where ours have no words for them.
fn flags(
    table: &Foreign,
    decoding: Decoding,
    meanings: &[Meaning],
    own: Integrand,
) -> Option<(String, String)> {
    let Integrand::Specular(lobe, _) = own else { return None };
    let tinted = |meaning: &Meaning| match meaning {
        Meaning::Number { truth, .. } => {
            matches!(truth.lut.integrand(), Integrand::Specular(_, Fresnel::SchlickF82))
        }
        _ => false,
    };
    let fresnel = if meanings.iter().any(tinted) { " --fresnel f82" } else { "" };
    let mut terms: Vec<String> = Vec::new();
    for meaning in meanings {
        let term = match meaning {
            Meaning::Copy(of) => terms.get(*of).cloned(),
            meaning => meaning.term(own),
        };
        terms.push(term?);
    }
    // What a format fills up is no channel.
    for (place, filler) in [(3, "1"), (2, "0")] {
        if terms.len() == place + 1 && terms[place] == filler {
            terms.pop();
        }
    }
    let precision = match decoding {
        Decoding::Linear => table.storage,
        Decoding::Srgb => Precision::Srgb8,
        Decoding::Rgbd => Precision::Rgbd8,
        Decoding::Gamma | Decoding::RgbdSrgb => return None,
    };
    let format = match table.container {
        "EXR" => "exr",
        "KTX2" => "ktx2",
        "DDS" => "dds",
        "PNG" => "png",
        "npy" => "npy",
        "raw" => "raw",
        _ => "txt",
    };
    let flags = format!(
        "--model {} --masking {}{fresnel} --channels {}",
        lobe.ndf,
        lobe.masking,
        terms.join(",")
    );
    Some((flags, format!("--precision {precision} --format {format}")))
}

/// Offsets in words, as in "n.v 0.499, roughness 1.486".
pub fn offsets_in_words([nov, roughness]: [f64; 2]) -> String {
    let three = |value: f64| short((value * 1000.0).round() / 1000.0);
    format!("nov {}, roughness {}", three(nov), three(roughness))
}
