//! A convention in words: the command that bakes a table like it, and the one that bakes it right.

use super::decoding::Decoding;
use super::fingerprint::Fingerprint;
use super::layout::Layout;
use super::meaning::Meaning;
use super::sample::Quantity;
use crate::brdf::Fresnel;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use crate::lut::{EnergyChannels, Glass, GlassChannels, Lut, Packing};
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
    let storage = storage(table, decoding)?;
    if let Some(family) = family(meanings) {
        return Some((family, storage));
    }
    let in_list = |meaning: &Meaning| match meaning {
        Meaning::Number { truth, .. } => matches!(truth.lut, Lut::Dfg(_) | Lut::Diffuse(_)),
        _ => true,
    };
    let (Integrand::Specular(lobe, fresnel), true) = (own, meanings.iter().all(in_list)) else {
        return None;
    };
    let tinted = |meaning: &Meaning| match meaning {
        Meaning::Number { truth, .. } => {
            matches!(truth.lut.integrand(), Integrand::Specular(_, Fresnel::SchlickF82))
        }
        _ => false,
    };
    let fresnel = match fresnel {
        Fresnel::Schlick if meanings.iter().any(tinted) => " --fresnel f82".into(),
        Fresnel::Schlick => String::new(),
        other => format!(" --fresnel {other}"),
    };
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
    let flags = format!(
        "--model {} --masking {}{fresnel} --channels {}",
        lobe.ndf,
        lobe.masking,
        terms.join(",")
    );
    Some((flags, storage))
}

/// A table of another family than split sums as flags; none where a channel is no number of it as
/// it is.
fn family(meanings: &[Meaning]) -> Option<String> {
    let number = |meaning: &Meaning| match *meaning {
        Meaning::Number { truth, quantity, scale: 1.0, offset: 0.0 } => Some((truth.lut, quantity)),
        _ => None,
    };
    let filled = |place: usize, meaning: &Meaning| match meaning {
        Meaning::Constant(value) => *value == if place == 3 { 1.0 } else { 0.0 },
        _ => false,
    };
    let count =
        meanings.iter().enumerate().rposition(|(place, meaning)| !filled(place, meaning))?;
    let numbers: Vec<(Lut, Quantity)> =
        meanings[..=count].iter().map(number).collect::<Option<_>>()?;
    // One average has a word among the terms of a split sum.
    if let [(Lut::Energy(energy), quantity @ Quantity::Channel(_))] = numbers[..]
        && energy.channels() == EnergyChannels::Average
    {
        let lobe = energy.lobe();
        let word = super::decision::word(&numbers[0].0, quantity);
        return Some(format!("--model {} --masking {} --channels {word}", lobe.ndf, lobe.masking));
    }
    let lut = match (numbers[0], numbers.len()) {
        // One of a pair has a word of its own.
        ((Lut::Glass(glass), Quantity::Channel(channel)), 1)
            if glass.channels() == GlassChannels::Rt =>
        {
            let word = [GlassChannels::Reflect, GlassChannels::Transmit][channel.min(1)];
            Lut::Glass(Glass::new(glass.interface(), word))
        }
        ((lut @ (Lut::Glass(_) | Lut::Energy(_)), _), count) => {
            let in_order = |(place, &(of, quantity)): (usize, &(Lut, Quantity))| {
                of == lut && quantity == Quantity::Channel(place)
            };
            let all = count == lut.channels().len() && numbers.iter().enumerate().all(in_order);
            all.then_some(lut)?
        }
        _ => return None,
    };
    let number = match (lut.f0(), lut.ior()) {
        (Some(f0), _) => format!(" --f0 {}", short(f0)),
        (_, Some(ior)) => format!(" --ior {}", short(ior)),
        _ => String::new(),
    };
    Some(format!("{}{number}", Packing::from(lut).flags()))
}

/// The storage of a file as flags; none where ours have no words for it.
fn storage(table: &Foreign, decoding: Decoding) -> Option<String> {
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
    Some(format!("--precision {precision} --format {format}"))
}

/// Offsets in words, as in "n.v 0.499, roughness 1.486".
pub fn offsets_in_words([nov, roughness]: [f64; 2]) -> String {
    let three = |value: f64| short((value * 1000.0).round() / 1000.0);
    format!("nov {}, roughness {}", three(nov), three(roughness))
}
