//! From a table to its report.

use super::channel::channels;
use super::convention::Words;
use super::decision::{self, Decision};
use super::decoding::Decoding;
use super::errors::{Convention, Differences, TOLERANCE};
use super::expected::Expected;
use super::family::{farthest, is_split_sum};
use super::fault::{self, Fault, Kind};
use super::fingerprint::{Fingerprint, Suspect, fingerprint};
use super::fit::offsets;
use super::identify::{Identity, MANY, identify};
use super::layout::Layout;
use super::meaning::Meaning;
use super::others::meanings;
use super::quantisation::{quantisation, rounding};
use super::refinement::around;
use super::report::{ChannelReport, FileFacts, Report, Status};
use super::sample::Sample;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use std::time::Instant;

/// The distance beyond which a table is none that its metadata name.
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
    let found = match identify(table, 0, report.file.steps)? {
        Some(identity) => {
            report.distance = Some(identity.nearest.distance);
            report.tried = identity.tried;
            report.decisions.clone_from(&identity.decisions);
            report.file.channels.clone_from(&identity.channels);
            let most =
                farthest(&identity.nearest, &rounding(report.file.steps, &identity.channels));
            match identity.nearest.distance <= most {
                true => Some(describe(&mut report, table, identity)?),
                false => None,
            }
        }
        None => None,
    };
    match (&demands.expected, &found) {
        (Some(expected), found) => compare(&mut report, table, expected, found.as_ref())?,
        (None, Some(found)) => {
            let convention = found.convention();
            report.channels = errors(table, &convention, found.own, &found.stored)?;
        }
        (None, None) => (),
    }
    let not_finite = report.faults.iter().any(|fault| fault.name == Kind::NotFinite);
    for channel in report.channels.iter().filter(|_| !not_finite) {
        let (count, all) = channel.stored.not_finite;
        if count > 0 {
            let text = format!("{count} of {all} values of {} are no numbers", channel.name);
            report.faults.push(Fault::new(Kind::NotFinite, text));
        }
    }
    if let Some(most) = demands.largest_error {
        report.faults.extend(beyond(&report, found.as_ref(), most));
    }
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// Where an error exceeds the largest that is allowed, or cannot be told.
fn beyond(report: &Report, found: Option<&Found>, most: f64) -> Vec<Fault> {
    let mut texts = Vec::new();
    for channel in &report.channels {
        if channel.stored.largest > most {
            let got = channel.stored.largest;
            texts.push(format!("{} errs by {got:.2e}, {most:e} allowed", channel.name));
        }
    }
    let meanings = found.map_or(&[][..], |found| &found.meanings);
    for (channel, meaning) in report.file.channels.iter().zip(meanings) {
        let judged = report.channels.iter().any(|judged| judged.name == channel.name);
        if *meaning == Meaning::Unknown && !judged {
            texts.push(format!("{} is unknown, and has no error", channel.name));
        }
    }
    if report.file.size[2] > 1 {
        texts.push("slices behind the first have no error".into());
    }
    texts.into_iter().map(|text| Fault::new(Kind::BeyondBound, text)).collect()
}

/// A convention that was found.
struct Found {
    decoding: Decoding,
    layout: Layout,
    meanings: Vec<Meaning>,
    own: Integrand,
    /// The differences of each channel that is known.
    stored: Vec<Option<Differences>>,
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
    report.channels = errors(table, &convention, own, &[])?;
    report.faults.extend(expected.fault_of_size(table));
    match found {
        _ if expected.certain => {
            report.status = Status::Known;
            // Its axes are what it says, which hypotheses need not hold; so are its faults.
            let of_file = [Kind::InvalidContainer, Kind::NotFinite, Kind::Constant, Kind::EightBit];
            report.faults.retain(|fault| of_file.contains(&fault.name));
            if found.is_none() {
                report.distance = None;
                report.decisions.clear();
                report.convention = Some(Words::of_request(&expected.request, table));
            }
        }
        Some(found) => {
            let decisions = report.decisions.clone();
            let theirs = (&found.convention(), found.own);
            report.faults.extend(expected.faults(table, theirs, &decisions));
        }
        // What is not sought may be known by its name.
        None => {
            let spreads = channels(table, 0, decoding);
            let share = |channel: &ChannelReport| {
                let (count, all) = channel.stored.not_finite;
                if count * 5 > all {
                    return f64::INFINITY;
                }
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

/// The errors of the channels whose meaning is known; those of stored values may be known already.
fn errors(
    table: &Foreign,
    convention: &Convention,
    own: Integrand,
    known: &[Option<Differences>],
) -> Result<Vec<ChannelReport>> {
    let mut reports = Vec::new();
    for (place, meaning) in convention.meanings.iter().enumerate().take(table.components()) {
        if !meaning.varies() {
            continue;
        }
        let stored = match known.get(place).cloned().flatten() {
            Some(stored) => Some(stored),
            None => convention.stored(table, 0, place)?,
        };
        let sampled = convention.sampled(table, 0, place)?;
        if let Some((Differences { size, values, errors }, sampled)) = stored.zip(sampled) {
            reports.push(ChannelReport {
                name: table.names[place].clone(),
                meaning: meaning.term(own).unwrap_or_default(),
                stored: errors,
                sampled,
                measured: size,
                differences: values,
            });
        }
    }
    Ok(reports)
}

/// What the file says.
fn report_of_file(name: &str, table: &Foreign) -> Report {
    let channels = channels(table, 0, Decoding::Linear);
    let faults = fault::of_file(table, &channels);
    let mut notes = table.notes.clone();
    if table.size[2] > 1 {
        notes.push("the first slice is told; errors are its own".into());
    }
    let file = FileFacts {
        name: name.into(),
        container: table.container,
        size: table.size,
        storage: table.storage,
        steps: quantisation(table),
        notes,
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
        prove(sampler, &mut decisions);
        nearest.layout = sampler.layout;
    }
    let meanings = meanings(table, 0, decoding, &channels, &nearest)?;
    let sample = Sample::new(table, 0, decoding, &channels, MANY);
    let offsets = offsets(nearest.truth, nearest.layout, &nearest.packing, size, &sample);
    let (own, layout) = (lut.integrand(), nearest.layout);
    let mut found = Found { decoding, layout, meanings, own, stored: Vec::new() };
    let words = Words::new(
        table,
        (decoding, found.layout),
        &found.meanings,
        found.own,
        (offsets, sampler.as_ref()),
    );
    let numbers = report.file.steps;
    report.faults.extend(fault::of_storage(table, numbers, decoding));
    report.faults.extend(fault::of_layout(&found.layout, &decisions));
    for (place, channel) in channels.iter().enumerate() {
        let meaning = &found.meanings[place];
        let stored = match meaning.varies() {
            true => found.convention().stored(table, 0, place)?,
            false => None,
        };
        if let Some(stored) = &stored {
            let half_step = numbers.half_step();
            report.faults.extend(fault::of_values(channel, meaning, stored, half_step));
        }
        found.stored.push(stored);
    }
    report.status = Status::Known;
    report.convention = Some(words);
    let undecided = |decision: &Decision| {
        ["distribution", "masking"].contains(&decision.dimension) && !decision.decided
    };
    report.lobe = match lut.integrand() {
        _ if decisions.iter().any(undecided) => None,
        // Of another family an engine's table would be another one.
        Integrand::Specular(lobe, _) if is_split_sum(nearest.truth) => Some(lobe),
        _ => None,
    };
    report.decisions = decisions;
    Ok(found)
}

/// A sampler that repeats a table proves its nodes and its masking, whatever else fits.
fn prove(sampler: &Fingerprint, decisions: &mut [Decision]) {
    for decision in decisions {
        decision.choice = match decision.dimension {
            "nodes of nov" => decision::nodes(sampler.layout.nov()),
            "nodes of roughness" => decision::nodes(sampler.layout.roughness()),
            "masking" => decision.choice.clone(),
            _ => continue,
        };
        (decision.decided, decision.proved) = (true, true);
        decision.others.clear();
    }
}
