//! What a texel holds: channels of one table or of several side by side, each scaled and shifted
//! where an engine wants it so, and numbers that need no integral.

use super::{Lut, MOST_CHANNELS};
use crate::brdf::Fresnel;
use crate::brdf::interface::Side;
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::numeric::ball::Ball;
use crate::table::Channel;
use crate::table::axis::Parameter;
use crate::units::{roughness_of, short};
use std::ops::Deref;

/// The origin of a channel before it is scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A channel of one of the tables.
    Of {
        /// The table.
        part: usize,
        /// Its channel.
        channel: usize,
    },
    /// n·v of the texel.
    Nov,
    /// Perceptual roughness of the texel.
    Roughness,
    /// The offset alone.
    Constant,
}

/// A channel of a texel: scale × source + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Content {
    /// The origin.
    pub source: Source,
    /// A factor, not 0.
    pub scale: f64,
    /// What is added.
    pub offset: f64,
}

/// What a texel holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    luts: Vec<Lut>,
    contents: Vec<Content>,
    /// Family, lobe and channels as flags.
    flags: String,
}

/// One of the tables of a packing, and the channels of a texel that it fills.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    lut: Lut,
    picks: Vec<Pick>,
    /// Whether the picks are the table's channels as they are.
    plain: bool,
    /// The ends of the range that each pick is known to keep.
    ranges: [(f64, f64); MOST_CHANNELS],
}

/// A channel of a table on its way to a channel of a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pick {
    channel: usize,
    /// The channel of the texel.
    place: usize,
    scale: f64,
    offset: f64,
}

impl Content {
    /// A source as it is.
    pub const fn of(source: Source) -> Self {
        Content { source, scale: 1.0, offset: 0.0 }
    }
}

impl From<Lut> for Packing {
    fn from(lut: Lut) -> Self {
        let of = |channel| Content::of(Source::Of { part: 0, channel });
        let contents = (0..lut.channels().len()).map(of).collect();
        Packing {
            luts: vec![lut],
            contents,
            flags: format!("--lut {} {}", lut.name(), lut.flags()),
        }
    }
}

impl Packing {
    /// These contents of these tables, the main one first; `flags`: they as flags.
    pub(super) fn new(luts: Vec<Lut>, contents: Vec<Content>, flags: String) -> Result<Self> {
        if !(1..=MOST_CHANNELS).contains(&contents.len()) {
            let expected = format!("1 to {MOST_CHANNELS} of them");
            let (got, cure) = (contents.len().to_string(), "leave some out");
            return Err(Error::bad_input("channels", expected, got, cure));
        }
        // Lookups undo them in f32.
        let normal = f64::from(f32::MIN_POSITIVE)..=f64::from(f32::MAX);
        let right = |content: &&Content| {
            let Content { scale, offset, .. } = content;
            normal.contains(&scale.abs()) && offset.abs() <= *normal.end()
        };
        if let Some(Content { scale, offset, .. }) = contents.iter().find(|content| !right(content))
        {
            let got = format!("a scale of {scale:e} and an offset of {offset:e}");
            let expected = "scales and offsets that f32 holds, and no scale of 0";
            return Err(Error::bad_input("channels", expected, got, "give other numbers"));
        }
        let packing = Packing { luts, contents, flags };
        let fills = |part: &Part| !part.picks.is_empty();
        if packing.luts.is_empty() || !packing.parts().iter().all(fills) {
            let (expected, got) = ("at least one integral", "none");
            return Err(Error::bad_input("channels", expected, got, "add one, such as e"));
        }
        Ok(packing)
    }

    /// The main table.
    pub fn main(&self) -> &Lut {
        &self.luts[0]
    }

    /// The cosine of the critical angle of glass that is seen from inside alone.
    pub fn critical(&self) -> Option<f64> {
        match self.luts[..] {
            [Lut::Glass(glass)] if glass.interface().side() == Side::Inside => {
                Some(glass.interface().critical())
            }
            _ => None,
        }
    }

    /// Family, lobe and channels as flags.
    pub fn flags(&self) -> &str {
        &self.flags
    }

    /// All tables.
    pub fn luts(&self) -> &[Lut] {
        &self.luts
    }

    /// The channels of a texel.
    pub fn contents(&self) -> &[Content] {
        &self.contents
    }

    /// The tables with the channels that they fill.
    pub fn parts(&self) -> Vec<Part> {
        (0..self.luts.len()).map(|part| self.part(part)).collect()
    }

    fn part(&self, index: usize) -> Part {
        let mut picks = Vec::new();
        for (place, &Content { source, scale, offset }) in self.contents.iter().enumerate() {
            if let Source::Of { part, channel } = source
                && part == index
            {
                picks.push(Pick { channel, place, scale, offset });
            }
        }
        let lut = self.luts[index];
        let as_it_is = |(i, pick): (usize, &Pick)| {
            pick.channel == i && pick.scale == 1.0 && pick.offset == 0.0
        };
        let plain = picks.len() == lut.channels().len() && picks.iter().enumerate().all(as_it_is);
        // No channel of a table is negative.
        let end = if lut.at_most_one() { 1.0 } else { f64::INFINITY };
        let mut ranges = [(0.0, end); MOST_CHANNELS];
        for (range, pick) in ranges.iter_mut().zip(&picks) {
            let (low, high) = (pick.offset, pick.scale * end + pick.offset);
            *range = (low.min(high), low.max(high));
        }
        Part { lut, picks, plain, ranges }
    }

    /// The same contents in a slice in which `parameter` has this value; an error where none varies
    /// with it.
    pub fn at(&self, parameter: Parameter, value: f64) -> Result<Packing> {
        let mut slice = self.clone();
        let mut varies = Err(Error::Internal("a packing without a table".into()));
        for lut in &mut slice.luts {
            match lut.at(parameter, value) {
                Ok(at) => {
                    *lut = at;
                    varies = Ok(());
                }
                Err(error) => varies = varies.or(Err(error)),
            }
        }
        varies.map(|()| slice)
    }

    /// The same contents with another Fresnel model; an error where none can be chosen.
    pub fn with_fresnel(&self, fresnel: Fresnel) -> Result<Packing> {
        let [lut] = self.luts[..] else {
            let (expected, got) = ("one in all slices", "several, beside terms of other tables");
            let cure = "bake those terms in a table of their own";
            return Err(Error::bad_input("fresnel", expected, got, cure));
        };
        Ok(Packing { luts: vec![lut.with_fresnel(fresnel)?], ..self.clone() })
    }

    /// The channels of a texel by name.
    pub fn channels(&self) -> Vec<Channel> {
        self.contents.iter().map(|content| self.channel(content)).collect()
    }

    fn channel(&self, content: &Content) -> Channel {
        let &Content { source, scale, offset } = content;
        let channel = match source {
            Source::Of { part, channel } => self.named(part, channel),
            Source::Nov => Channel::new("n.v", "cosine to the view"),
            Source::Roughness => Channel::new("r", "perceptual roughness"),
            Source::Constant => {
                let meaning = "the same in every texel".to_owned();
                return Channel { name: short(offset), meaning, base: None, scale, offset };
            }
        };
        let Channel { name, meaning, base, .. } = channel;
        let affine = affine(&name, scale, offset);
        let meaning = if affine == name { meaning } else { format!("{name} = {meaning}") };
        Channel { name: affine, meaning, base, scale, offset }
    }

    /// The channel of a table, named for its lobe where it is not the main table's.
    fn named(&self, part: usize, channel: usize) -> Channel {
        let lut = &self.luts[part];
        let channel = lut.channels().swap_remove(channel);
        match (lut.integrand(), self.main().integrand()) {
            (theirs, ours) if theirs == ours => channel,
            (Integrand::Specular(lobe, _), Integrand::Specular(main, _)) if lobe == main => channel,
            (Integrand::Specular(lobe, _), _) => {
                let masking = match lobe.masking == lobe.ndf.default_masking() {
                    true => String::new(),
                    false => format!("_{}", lobe.masking),
                };
                Channel::new(
                    format!("{}_{}{masking}", channel.name, lobe.ndf),
                    format!("{}, of {} with {}", channel.meaning, lobe.ndf, lobe.masking),
                )
            }
            (Integrand::Glass(interface), _) => Channel::new(
                format!("{}_{}", channel.name, interface.side()),
                format!("{}, seen from {}", channel.meaning, interface.side()),
            ),
            (Integrand::Diffuse(diffuse), _) => Channel::new(
                format!("{}_{diffuse}", channel.name),
                format!("{}, {}", channel.meaning, diffuse.source()),
            ),
        }
    }

    /// The channels that need no integral, each with its place and its value at (n·v, α).
    pub fn fillers(&self) -> impl Iterator<Item = (usize, impl Fn(f64, f64) -> f64)> {
        let filler = |(place, content): (usize, &Content)| {
            let Content { source, scale, offset } = *content;
            let value: fn(f64, f64) -> f64 = match source {
                Source::Of { .. } => return None,
                Source::Nov => |mu, _| mu,
                Source::Roughness => |_, alpha| roughness_of(alpha),
                Source::Constant => |_, _| 0.0,
            };
            Some((place, move |mu, alpha| scale * value(mu, alpha) + offset))
        };
        self.contents.iter().enumerate().filter_map(filler)
    }
}

/// `name` scaled and shifted, as in `16 C` or `E - 0.5`.
fn affine(name: &str, scale: f64, offset: f64) -> String {
    let scaled = match scale {
        1.0 => name.to_owned(),
        -1.0 if offset > 0.0 => return format!("{} - {name}", short(offset)),
        scale => format!("{} {name}", short(scale)),
    };
    match offset {
        0.0 => scaled,
        offset if offset < 0.0 => format!("{scaled} - {}", short(-offset)),
        offset => format!("{scaled} + {}", short(offset)),
    }
}

/// The table itself answers what does not depend on the channels.
impl Deref for Part {
    type Target = Lut;

    fn deref(&self) -> &Lut {
        &self.lut
    }
}

impl From<Lut> for Part {
    fn from(lut: Lut) -> Self {
        Packing::from(lut).part(0)
    }
}

impl Part {
    /// The number of channels of a texel that it fills.
    pub fn count(&self) -> usize {
        self.picks.len()
    }

    /// The places of those channels in a texel.
    pub fn places(&self) -> Vec<usize> {
        self.picks.iter().map(|pick| pick.place).collect()
    }

    /// The least and the most that each channel can be: an estimate beyond is nearer to the truth
    /// at that end.
    #[inline(always)]
    pub fn ranges(&self) -> &[(f64, f64); MOST_CHANNELS] {
        &self.ranges
    }

    /// Whether a texel's values are its integrals, as many and in their order, none of them less
    /// than 0.
    pub fn is_integrals(&self) -> bool {
        let integrals = matches!(&self.lut, Lut::Dfg(dfg) if dfg.is_integrals());
        integrals && self.plain && self.ranges.iter().all(|range| range.0 <= 0.0)
    }

    /// The values of its channels: see [`Lut::values`]. The first [`Part::count`] are used.
    #[inline(always)]
    pub fn values(&self, mu: f64, integrals: &[Ball], averages: &[Ball]) -> [Ball; MOST_CHANNELS] {
        let values = self.lut.values(mu, integrals, averages);
        if self.plain { values } else { self.picked(values) }
    }

    #[inline(never)]
    fn picked(&self, values: [Ball; MOST_CHANNELS]) -> [Ball; MOST_CHANNELS] {
        let mut picked = [Ball::default(); MOST_CHANNELS];
        for (ball, pick) in picked.iter_mut().zip(&self.picks) {
            // A product with 1 and a sum with 0 are exact, and cost nothing.
            *ball = Ball::exact(pick.scale) * values[pick.channel] + Ball::exact(pick.offset);
        }
        picked
    }
}
