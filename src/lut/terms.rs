//! Channels by their words, as in `b,e,charlie` or `burley-0.5`: from a list of terms to the tables
//! that a texel is packed from.

use super::packing::{Content, Packing, Source};
use super::{Dfg, DfgChannels, Energy, EnergyChannels, Lut, lobe_flags};
use crate::brdf::{Diffuse, Fresnel, Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::units::F0;

/// A number that a texel can hold, before it is scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    /// An integral of the table's own lobe and Fresnel model.
    Integral(usize),
    /// E of the table's own lobe at F = 1.
    Albedo,
    /// A, B or E of the table's own lobe, averaged over all directions.
    Average(usize),
    /// E at F = 1 of another lobe.
    AlbedoOf(Microfacet),
    /// The albedo of a diffuse lobe.
    Diffuse(Diffuse),
    /// What needs no integral.
    Filler(Source),
}

/// The averages by their words, in the order of [`EnergyChannels::Average`].
const AVERAGES: [&str; 3] = ["a_avg", "b_avg", "e_avg"];

/// The words of a term, for `--help` and errors.
pub const TERM_WORDS: &str = "a, b, c, e, 1-e, a_avg, b_avg, e_avg; another lobe's E, as in \
                              charlie, charlie/neubelt or burley; nov, roughness or a number; each \
                              but 1-e and a number with *SCALE and +OFFSET or -OFFSET behind it";

/// The packing of a list of terms with commas between, for this lobe and Fresnel model.
pub fn packing(lobe: Microfacet, fresnel: Fresnel, words: &str) -> Result<Packing> {
    let (mut luts, mut contents) = (Vec::new(), Vec::new());
    for word in words.split(',').map(str::trim) {
        let Some((quantity, scale, offset)) = term(fresnel, word)? else {
            let named = DfgChannels::served_by(fresnel).map(|channels| channels.word(fresnel));
            let named = named.collect::<Vec<_>>().join(", ");
            let expected = format!("{named}, or terms with commas between: {TERM_WORDS}");
            let what = format!("channels of {fresnel}");
            return Err(Error::bad_input(what, expected, format!("'{word}'"), "use those words"));
        };
        let source = source((lobe, fresnel), quantity, &mut luts)?;
        contents.push(Content { source, scale, offset });
    }
    let own = Dfg::new(lobe, fresnel, DfgChannels::All)?;
    let words = words.split(',').map(str::trim).collect::<Vec<_>>().join(",");
    // A shell expands a bare *, and takes a leading - for a flag.
    let quoted = match words.contains('*') || words.starts_with('-') {
        true => format!("--channels='{words}'"),
        false => format!("--channels {words}"),
    };
    let packing =
        Packing::new(luts, contents, format!("--lut dfg {} {quoted}", lobe_flags(own.lobe())))?;
    // A list that is all of a table has that table's name.
    Ok(named(&packing).unwrap_or(packing))
}

/// The place of a table among these, to which it is added where it is missing.
fn place(luts: &mut Vec<Lut>, lut: Lut) -> usize {
    luts.iter().position(|known| *known == lut).unwrap_or_else(|| {
        luts.push(lut);
        luts.len() - 1
    })
}

/// The same packing as a table whose channels have a word of their own, if there is one.
fn named(packing: &Packing) -> Option<Packing> {
    let [Lut::Dfg(dfg)] = packing.luts() else { return None };
    let plain = |channels| {
        Dfg::new(dfg.lobe(), dfg.fresnel(), channels).map(|dfg| Packing::from(Lut::Dfg(dfg))).ok()
    };
    DfgChannels::served_by(dfg.fresnel())
        .filter_map(plain)
        .find(|plain| plain.channels() == packing.channels())
}

/// The source of a quantity of this lobe and Fresnel model; the table that has it is added to those
/// where it is missing.
fn source(
    (lobe, fresnel): (Microfacet, Fresnel),
    quantity: Quantity,
    luts: &mut Vec<Lut>,
) -> Result<Source> {
    let every = |lobe, fresnel| Dfg::new(lobe, fresnel, DfgChannels::Every).map(Lut::Dfg);
    let (lut, channel) = match quantity {
        Quantity::Integral(integral) => (every(lobe, fresnel)?, integral),
        Quantity::Albedo => (every(lobe, fresnel)?, fresnel.count()),
        Quantity::AlbedoOf(other) => (every(other, Fresnel::Schlick)?, Fresnel::Schlick.count()),
        Quantity::Average(channel) => {
            let energy = Energy::new(lobe, F0::new(0.0)?, EnergyChannels::Average)?;
            (Lut::Energy(energy), channel)
        }
        Quantity::Diffuse(diffuse) => (Lut::Diffuse(diffuse), 0),
        Quantity::Filler(source) => return Ok(source),
    };
    Ok(Source::Of { part: place(luts, lut), channel })
}

/// Quantity, scale and offset of a term; none where there is no such word.
fn term(fresnel: Fresnel, word: &str) -> Result<Option<(Quantity, f64, f64)>> {
    if let Ok(number) = word.parse::<f64>() {
        return Ok(Some((Quantity::Filler(Source::Constant), 1.0, number)));
    }
    if word == "1-e" {
        return Ok(Some((Quantity::Albedo, -1.0, 1.0)));
    }
    let (word, offset) = split_offset(word);
    let (word, scale) = match word.split_once('*') {
        Some((word, scale)) => match scale.parse() {
            Ok(scale) => (word, scale),
            Err(_) => return Ok(None),
        },
        None => (word, 1.0),
    };
    Ok(quantity(fresnel, word)?.map(|quantity| (quantity, scale, offset)))
}

/// A word and the offset behind it: what follows the last sign, if that is a number.
fn split_offset(word: &str) -> (&str, f64) {
    // The sign of an exponent, as in 1e-3, is none of an offset, nor is that of a scale.
    let before = |at: usize| word[..at].strip_suffix('e').unwrap_or(&word[..at]);
    let belongs = |at: usize| before(at).ends_with(|c: char| c.is_ascii_digit() || c == '*');
    let sign = |&(at, c): &(usize, char)| {
        let of_number = word[..at].ends_with(['e', '*']) && belongs(at);
        (c == '+' || c == '-') && !of_number
    };
    let split = word.char_indices().rfind(sign).map(|(at, _)| word.split_at(at));
    match split.map(|(word, offset)| (word, offset.parse())) {
        Some((word, Ok(offset))) => (word, offset),
        _ => (word, 0.0),
    }
}

fn quantity(fresnel: Fresnel, word: &str) -> Result<Option<Quantity>> {
    let integrals = fresnel.definition().integrals;
    let is_named = |name: &str| name.to_lowercase() == word;
    if let Some(place) = integrals.iter().position(|integral| is_named(integral.name)) {
        return Ok(Some(Quantity::Integral(place)));
    }
    if let Some(place) = AVERAGES.iter().position(|average| *average == word) {
        return Ok(Some(Quantity::Average(place)));
    }
    let filler = |source| Ok(Some(Quantity::Filler(source)));
    match word {
        "e" if fresnel.count() >= 2 => return Ok(Some(Quantity::Albedo)),
        "nov" => return filler(Source::Nov),
        "roughness" => return filler(Source::Roughness),
        _ => (),
    }
    if let Ok(diffuse) = Diffuse::named(word) {
        return Ok(Some(Quantity::Diffuse(diffuse)));
    }
    let (ndf, masking) = match word.split_once('/') {
        Some((ndf, masking)) => (ndf, Some(masking)),
        None => (word, None),
    };
    let Ok(ndf) = Ndf::named(ndf) else { return Ok(None) };
    let masking = masking.map(Masking::named).transpose()?;
    Ok(Some(Quantity::AlbedoOf(Microfacet::new(ndf, masking)?)))
}
