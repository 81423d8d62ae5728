//! What is kept of an image: how often each channel takes which values, and which colours stand
//! where another image has which value.

use super::decode::{Header, Texel};
use super::span::Span;

/// The codes of a channel that share their upper eight bits. Of an image of 8 bits that is one
/// code.
#[derive(Clone, Copy)]
pub struct Bin {
    count: u64,
    low: u16,
    high: u16,
}

impl Bin {
    const EMPTY: Bin = Bin { count: 0, low: u16::MAX, high: 0 };

    fn take(&mut self, code: u16) {
        self.count += 1;
        self.low = self.low.min(code);
        self.high = self.high.max(code);
    }

    /// The interval of its values; none if it has none.
    pub fn span(&self) -> Option<Span> {
        (self.count > 0).then(|| span_of(self.low, self.high))
    }

    /// How many texels it has.
    pub fn count(&self) -> u64 {
        self.count
    }
}

/// Codes as numbers of [0, 1].
fn span_of(low: u16, high: u16) -> Span {
    Span { low: f64::from(low), high: f64::from(high) }.map(|code| code / 65535.0)
}

/// The bin of a code.
pub fn bin_of(code: u16) -> usize {
    usize::from(code >> 8)
}

/// The values of a channel.
pub struct Channel(Vec<Bin>);

impl Channel {
    /// Its bins in rising order; the others are empty.
    pub fn bins(&self) -> impl Iterator<Item = (usize, &Bin)> {
        self.0.iter().enumerate().filter(|(_, bin)| bin.count > 0)
    }

    /// The interval of its values without this share of texels at each end: without any, its least
    /// and its greatest value.
    pub fn span(&self, ignored: f64) -> Option<Span> {
        let texels: u64 = self.0.iter().map(Bin::count).sum();
        let skipped = (ignored * texels as f64).floor() as u64;
        let low = end(self.0.iter(), skipped)?.low;
        let high = end(self.0.iter().rev(), skipped)?.high;
        Some(Span { low, high })
    }
}

/// The bin that holds the texel after so many others.
fn end<'a>(bins: impl Iterator<Item = &'a Bin>, skipped: u64) -> Option<Span> {
    let mut before = 0;
    for bin in bins {
        before += bin.count;
        if before > skipped {
            return bin.span();
        }
    }
    None
}

/// The statistics of an image.
pub struct Statistics {
    /// Its size.
    pub header: Header,
    channels: [Channel; 4],
}

impl Statistics {
    /// Of no texel yet.
    pub fn new(header: Header) -> Self {
        let empty = || Channel(vec![Bin::EMPTY; 256]);
        Statistics { header, channels: [empty(), empty(), empty(), empty()] }
    }

    /// Adds texels.
    pub fn take(&mut self, texels: &[Texel]) {
        for texel in texels {
            for (channel, &code) in self.channels.iter_mut().zip(texel) {
                if let Some(bin) = channel.0.get_mut(bin_of(code)) {
                    bin.take(code);
                }
            }
        }
    }

    /// A channel: R, G, B, A.
    pub fn channel(&self, channel: usize) -> &Channel {
        &self.channels[channel.min(3)]
    }
}

/// Of two images of one size: the colours of the second where a channel of the first is in each
/// bin.
pub struct Joint {
    bins: Vec<[Bin; 3]>,
}

impl Joint {
    /// Of no texel yet.
    pub fn new() -> Self {
        Joint { bins: vec![[Bin::EMPTY; 3]; 256] }
    }

    /// Adds texels of the second image and the bins of the first.
    pub fn take(&mut self, bins: &[u8], texels: &[Texel]) {
        for (&bin, texel) in bins.iter().zip(texels) {
            for (bin, &code) in self.bins[usize::from(bin)].iter_mut().zip(texel) {
                bin.take(code);
            }
        }
    }

    /// The intervals of R, G and B where the first image is in this bin.
    pub fn colors(&self, bin: usize) -> Option<[Span; 3]> {
        let [r, g, b] = self.bins.get(bin)?;
        Some([r.span()?, g.span()?, b.span()?])
    }
}
