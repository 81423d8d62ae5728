//! What a foreign table is, and how wrong: its convention by comparison with tables of ours, each
//! choice with what the data say for it, and its error where the convention is known.
//!
//! A table is identified by texels alone. Of the hypotheses (axes, mappings, nodes, lobe, channels,
//! encoding) the nearest counts, and each choice is decided only where every other is clearly
//! farther off.

mod candidates;
mod catalogue;
mod channel;
mod convention;
mod decision;
mod decoding;
mod errors;
mod expected;
mod family;
mod fault;
mod fingerprint;
mod fit;
mod identify;
mod layout;
mod meaning;
mod others;
mod page;
mod quantisation;
mod refinement;
mod report;
mod run;
mod sample;
mod sampled;
mod search;
mod surface;
mod truth;

pub use catalogue::{Shipped, catalogue};
pub use convention::{Sampler, Words, offsets_in_words};
pub use decision::Decision;
pub use errors::{Errors, Place};
pub use expected::Expected;
pub use fault::{Fault, Kind};
pub use page::page;
pub use report::{ChannelReport, FileFacts, Report, Status};
pub use run::{Demands, verify};
