//! From a table to its report.

use super::channel::channels;
use super::convention::Words;
use super::decision::{self, Decision};
use super::decoding::Decoding;
use super::errors::{Convention, TOLERANCE};
use super::expected::Expected;
use super::fault::{self, Fault, Kind};
use super::fingerprint::{Fingerprint, Suspect, fingerprint};
use super::fit::offsets;
use super::identify::{Identity, MANY, around, identify};
use super::layout::Layout;
use super::meaning::Meaning;
use super::others::meanings;
use super::quantisation::quantisation;
use super::report::{ChannelReport, FileFacts, Report, Status};
use super::sample::Sample;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use std::time::Instant;

/// The distance beyond which a table is none that is known. Of tables that are known the farthest
/// lay at 0.013, of an LTC fit and two of sheen the nearest at 0.07.
const FARTHEST: f64 = 0.03;

/// Below this distance a table is as good as exact, and no sampler is sought.
const EXACT: f64 = 5e-5;

/// What is asked of a table.
#[derive(Clone, Debug, Default)]
pub struct Demands {
    /// The largest error of a stored value.
    pub largest_error: Option<f64>,
    /// What it is to be.
    pub expected: Option<Expected>,
}

/// The report of a table.
pub fn verify(name: &str, table: &Foreign, demands: &Demands) -> Result<Report> {
    let start = Instant::now();
    let mut report = report_of_file(name, table);
    let found = match identify(table, 0)? {
        Some(identity) => {
            report.distance = Some(identity.nearest.distance);
            report.tried = identity.tried;
            report.decisions.clone_from(&identity.decisions);
            report.file.channels.clone_from(&identity.channels);
            match identity.nearest.distance <= FARTHEST {
                true => Some(describe(&mut report, table, identity)?),
                false => None,
            }
        }
        None => None,
    };
    match (&demands.expected, &found) {
        (Some(expected), found) => compare(&mut report, table, expected, found.as_ref())?,
        (None, Some(found)) => report.channels = errors(table, &found.convention(), found.own)?,
        (None, None) => (),
    }
    if let Some(most) = demands.largest_error {
        for channel in &report.channels {
            // It is a number: what is none is a fault of its own.
            if channel.stored.largest > most {
                let got = channel.stored.largest;
                let text = format!("{} errs by {got:.2e}, {most:e} allowed", channel.name);
                report.faults.push(Fault::new(Kind::BeyondBound, text));
            }
        }
    }
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// A convention that was found.
struct Found {
    decoding: Decoding,
    layout: Layout,
    meanings: Vec<Meaning>,
    own: Integrand,
}

impl Found {
    fn convention(&self) -> Convention<'_> {
        let Found { decoding, layout, ref meanings, .. } = *self;
        Convention { decoding, layout, meanings }
    }
}

/// Adds the errors of a table as its engine reads it, and where it is not what it is to be.
fn compare(
    report: &mut Report,
    table: &Foreign,
    expected: &Expected,
    found: Option<&Found>,
) -> Result<()> {
    let meanings = expected.meanings(0, table.components(), TOLERANCE);
    let (decoding, layout) = (expected.decoding(), expected.layout());
    let convention = Convention { decoding, layout, meanings: &meanings };
    let own = expected.request.packing().main().integrand();
    report.channels = errors(table, &convention, own)?;
    match found {
        Some(found) => {
            let decisions = report.decisions.clone();
            report.faults.extend(expected.faults(table, &found.convention(), &decisions));
        }
        // What is not sought may be known by its name.
        None => {
            let spreads = channels(table, 0, decoding);
            let share = |channel: &ChannelReport| {
                let named = spreads.iter().find(|other| other.name == channel.name);
                channel.stored.mean / named.map_or(1.0, |other| other.spread.max(1e-3))
            };
            let distance = report.channels.iter().map(share).fold(0.0, f64::max);
            report.distance = Some(distance);
            if distance <= FARTHEST && !report.channels.is_empty() {
                report.status = Status::Known;
                report.decisions.clear();
                report.convention = Some(Words::of_request(&expected.request, table));
            }
        }
    }
    Ok(())
}

/// The errors of the channels whose meaning is known.
fn errors(table: &Foreign, convention: &Convention, own: Integrand) -> Result<Vec<ChannelReport>> {
    let mut reports = Vec::new();
    for (place, meaning) in convention.meanings.iter().enumerate() {
        if !meaning.varies() {
            continue;
        }
        let stored = convention.stored(table, 0, place)?;
        let sampled = convention.sampled(table, 0, place)?;
        if let Some((stored, sampled)) = stored.zip(sampled) {
            reports.push(ChannelReport {
                name: table.names[place].clone(),
                meaning: meaning.term(own).unwrap_or_default(),
                stored: stored.errors,
                sampled,
                differences: stored.values,
            });
        }
    }
    Ok(reports)
}

/// What the file says.
fn report_of_file(name: &str, table: &Foreign) -> Report {
    let channels = channels(table, 0, Decoding::Linear);
    let faults = fault::of_file(table, &channels);
    let file = FileFacts {
        name: name.into(),
        container: table.container,
        size: table.size,
        storage: table.storage.to_string(),
        steps: quantisation(table).to_string(),
        notes: table.notes.clone(),
        channels,
    };
    Report {
        file,
        status: Status::Unknown,
        lobe: None,
        convention: None,
        distance: None,
        tried: 0,
        decisions: Vec::new(),
        channels: Vec::new(),
        faults,
        seconds: 0.0,
    }
}

/// Fills in what is known of a table whose convention is.
fn describe(report: &mut Report, table: &Foreign, identity: Identity) -> Result<Found> {
    let Identity { decoding, channels, mut nearest, mut decisions, .. } = identity;
    let (lut, size) = (nearest.truth.lut, [table.size[0], table.size[1]]);
    let (truth, packing) = (nearest.truth, &nearest.packing);
    let suspect = Suspect { table, slice: 0, decoding, channels: &channels, packing, truth };
    let sampler = match nearest.distance > EXACT {
        true => fingerprint(suspect, &around(nearest.layout)),
        false => None,
    };
    if let Some(sampler) = &sampler {
        prove(sampler, nearest.distance, &mut decisions);
        nearest.layout = sampler.layout;
    }
    let meanings = meanings(table, 0, decoding, &channels, &nearest)?;
    let sample = Sample::new(table, 0, decoding, &channels, MANY);
    let offsets = offsets(nearest.truth, nearest.layout, &nearest.packing, size, &sample);
    let found = Found { decoding, layout: nearest.layout, meanings, own: lut.integrand() };
    let words = Words::new(
        table,
        (decoding, found.layout),
        &found.meanings,
        found.own,
        (offsets, sampler.as_ref()),
    );
    let numbers = quantisation(table);
    report.faults.extend(fault::of_storage(table, numbers, decoding));
    report.faults.extend(fault::of_layout(table, &found.layout, &decisions));
    for (place, channel) in channels.iter().enumerate() {
        let meaning = &found.meanings[place];
        if let Some(stored) =
            found.convention().stored(table, 0, place)?.filter(|_| meaning.varies())
        {
            let half_step = numbers.half_step();
            report.faults.extend(fault::of_values(table, channel, meaning, &stored, half_step));
        }
    }
    report.status = Status::Known;
    report.convention = Some(words);
    let undecided = |decision: &Decision| {
        ["distribution", "masking"].contains(&decision.dimension) && !decision.decided
    };
    report.lobe = match lut.integrand() {
        Integrand::Specular(lobe, _) if !decisions.iter().any(undecided) => Some(lobe),
        _ => None,
    };
    report.decisions = decisions;
    Ok(found)
}

/// A sampler that repeats a table proves its nodes and its masking.
fn prove(sampler: &Fingerprint, distance: f64, decisions: &mut [Decision]) {
    let ratio = distance / sampler.left.0.max(f64::MIN_POSITIVE);
    for decision in decisions {
        let choice = match decision.dimension {
            "nodes of nov" => decision::nodes(sampler.layout.nov()),
            "nodes of roughness" => decision::nodes(sampler.layout.roughness()),
            "masking" => decision.choice.clone(),
            _ => continue,
        };
        decision.choice = choice;
        decision.ratio = decision.ratio.max(ratio);
        decision.decided = true;
        decision.others.clear();
    }
}
