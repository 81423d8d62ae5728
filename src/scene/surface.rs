//! The inputs of one material: factors with their animations, and textures.

use super::Assumptions;
use super::animation::Motions;
use super::notes::Notes;
use super::schema::TextureInfo;
use super::span::Span;
use super::statistics::{Channel, Statistics};
use super::textures::Textures;
use crate::error::{Error, Result};
use crate::table::srgb;
use crate::units::short;
use std::rc::Rc;

/// Exporters write factors in f32 and beyond their range by a rounding.
const ROUNDING: f64 = 1e-5;

/// The channels of texels.
pub const GREEN: usize = 1;
pub const BLUE: usize = 2;
pub const ALPHA: usize = 3;

/// What all materials of a scene are read with.
pub struct Reader<'a> {
    /// The scene's file, for errors.
    pub file: &'a str,
    pub textures: Textures<'a>,
    pub motions: Motions,
    pub assumptions: &'a Assumptions,
    pub notes: Notes,
}

/// A material that is being read.
pub struct Surface<'r, 'a> {
    pub reader: &'r mut Reader<'a>,
    /// Its index in the file.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Colours of vertices multiply its base colour.
    pub colored: bool,
}

/// A factor and the texture that multiplies it.
#[derive(Clone, Copy)]
pub struct Input {
    /// What it is, for lines of text.
    pub what: &'static str,
    pub factor: Span,
    pub texture: Option<TextureInfo>,
}

impl Input {
    /// The texture, where it matters: 0 times anything is 0.
    fn texture(&self) -> Option<TextureInfo> {
        self.texture.filter(|_| self.factor.high > 0.0)
    }
}

/// The curve between the codes of a texture and its values.
#[derive(Clone, Copy, PartialEq)]
pub enum Curve {
    Linear,
    Srgb,
}

impl Curve {
    /// The value of a code of [0, 1].
    pub fn value(self, code: f64) -> f64 {
        match self {
            Curve::Linear => code,
            Curve::Srgb => srgb::linear(code),
        }
    }
}

impl Surface<'_, '_> {
    /// A factor: its value in the file and those that animations give it, all within a range.
    pub fn factor(
        &mut self,
        name: &'static str,
        component: usize,
        value: f64,
        range: Span,
    ) -> Result<Span> {
        let property = name.rsplit('/').next().unwrap_or(name);
        if !(range.low - ROUNDING..=range.high + ROUNDING).contains(&value) {
            let what = format!("{}: {property} of {}", self.reader.file, self.name);
            let expected = format!("{} to {}", short(range.low), short(range.high));
            return Err(Error::bad_input(what, expected, short(value), "correct the material"));
        }
        let value = Span::point(value).clamped(range);
        match self.reader.motions.of(self.index, name, component) {
            None => Ok(value),
            Some(Ok(moved)) => {
                let factor = value.hull(moved.clamped(range));
                self.reader.notes.add(format!("{property} of {} moves over {factor}", self.name));
                Ok(factor)
            }
            Some(Err(why)) => {
                let note = format!("{property} of {}: {why}; taken as {range}", self.name);
                self.reader.notes.add(note);
                Ok(range)
            }
        }
    }

    /// The factors of R, G and B.
    pub fn color(&mut self, name: &'static str, value: [f64; 3], range: Span) -> Result<[Span; 3]> {
        let [r, g, b] = value;
        Ok([
            self.factor(name, 0, r, range)?,
            self.factor(name, 1, g, range)?,
            self.factor(name, 2, b, range)?,
        ])
    }

    /// The statistics of a texture; a note where it cannot be read.
    pub fn statistics(&mut self, texture: TextureInfo) -> Option<Rc<Statistics>> {
        let reader = &mut *self.reader;
        match reader.textures.statistics(texture) {
            Ok(statistics) => {
                if statistics.header.lossy {
                    reader.notes.add(
                        "JPEG: an engine's decoder may differ by some 255ths from this one".into(),
                    );
                }
                Some(statistics)
            }
            Err(why) => {
                let label = reader.textures.label(texture);
                reader.notes.add(format!("{label}: {why}; taken as 0..1"));
                None
            }
        }
    }

    /// The values of a texture's channel; 1 without a texture.
    pub fn texels(&mut self, texture: Option<TextureInfo>, channel: usize, curve: Curve) -> Span {
        let Some(texture) = texture else { return Span::point(1.0) };
        let ignored = self.reader.assumptions.ignore_texels;
        let statistics = self.statistics(texture);
        let span = statistics.and_then(|statistics| statistics.channel(channel).span(ignored));
        span.map_or(Span::UNIT, |span| span.map(|code| curve.value(code)))
    }

    /// A line on where a result comes from.
    pub fn line(&self, input: Input, result: Span) -> String {
        let Input { what, factor, .. } = input;
        match input.texture() {
            None => format!("{what} {result}: factor"),
            Some(texture) => {
                let label = self.reader.textures.label(texture);
                format!("{what} {result}: {label} x {factor}")
            }
        }
    }

    /// A factor times a channel of a texture, and a line on it.
    pub fn product(&mut self, input: Input, channel: usize) -> (Span, String) {
        let texels = self.texels(input.texture(), channel, Curve::Linear);
        let product = texels.times(input.factor);
        (product, self.line(input, product))
    }

    /// Factors times the colours of a texture.
    pub fn colors(&mut self, factors: [Span; 3], texture: Option<TextureInfo>) -> [Span; 3] {
        let texels = [0, 1, 2].map(|channel| self.texels(texture, channel, Curve::Srgb));
        times(factors, texels)
    }

    /// How often a roughness occurs on the texels of an input's texture.
    pub fn histogram(
        &mut self,
        input: Input,
        channel: usize,
        roughness: impl Fn(f64) -> f64,
    ) -> Option<[u64; 16]> {
        let statistics = self.statistics(input.texture()?)?;
        Some(sixteenths(statistics.channel(channel), roughness))
    }
}

/// The products of two colours.
pub fn times(a: [Span; 3], b: [Span; 3]) -> [Span; 3] {
    let ([ar, ag, ab], [br, bg, bb]) = (a, b);
    [ar.times(br), ag.times(bg), ab.times(bb)]
}

/// The interval of all channels.
pub fn hull([r, g, b]: [Span; 3]) -> Span {
    r.hull(g).hull(b)
}

/// The texels of a channel by sixteenths of their roughness.
fn sixteenths(channel: &Channel, roughness: impl Fn(f64) -> f64) -> [u64; 16] {
    let mut counts = [0; 16];
    for (_, bin) in channel.bins() {
        let Some(span) = bin.span() else { continue };
        let place = (16.0 * roughness(0.5 * (span.low + span.high))) as usize;
        counts[place.min(15)] += bin.count();
    }
    counts
}
