//! splitsum bakes preintegrated BRDF lookup tables, on Vulkan compute or on the CPU, and states how
//! far each is from the truth.
//!
//! ```
//! use splitsum::{Backend, Dfg, DfgChannels, Fresnel, Lut, Microfacet, Ndf, Precision, Request};
//!
//! let lobe = Microfacet::new(Ndf::Ggx, None)?;
//! let lut = Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All)?);
//! let request = Request::with_default_axes(lut, (16, 16), Precision::F16)?;
//! let table = splitsum::bake(&request, &Backend::cpu())?.table;
//! assert_eq!(table.claim(0).certificate().map(|certificate| certificate.undecided), Some(0));
//! # Ok::<(), splitsum::Error>(())
//! ```
//!
//! [`packing`] puts channels of several lobes into a texel, from their words. [`encode`] makes a
//! file of a table, an [`Encoding`] one in another style, and a [`Lookup`] the code that reads it.
//! A [`Plan`] tells beforehand which rules and which device a bake takes, and takes a progress
//! callback.
//!
//! The names above are the library; the modules below are its inside, open to its own tests and
//! program. Data flows one way:
//!
//! ```text
//!   Request ──► Plan ──► backend ──► certify ──► Table ──► format ──► bytes
//!                        (cpu, vulkan)             │
//!                                                  └─────► Report
//! ```
//!
//! A module uses only modules that stand above it in this list:
//!
//! - `error`: failures, with expectation, finding and cure; the exit codes
//! - `choice`: choices that have a word each
//! - `units`: roughness, α, cosines, index of refraction, F0, and their conversions
//! - `image`: pictures of numbers
//! - `numeric`: vector registers, error bounds, halves, special functions, quadrature
//! - `table`: axes, storage, claims, slices
//! - `brdf`: distributions of normals, masking, Fresnel, interfaces, diffuse lobes, with their
//!   citations
//! - `integrate`: from a lobe to its integrals; the rules, their bounds and costs
//! - `lut`: the families of tables and their channels
//! - `request`: a checked job, which prints itself as the command that repeats it
//! - `backend`: the CPU, the shaders, the Vulkan host
//! - `certify`: every value rounded correctly; a device's table checked by the CPU, any table by
//!   the reference
//! - `report`: the report of a bake
//! - `bake`: the plan of a bake and its execution
//! - `lookup`: code that looks a table up, in six languages
//! - `format`: a table as the bytes of a file
//! - `html`: pages of HTML
//! - `approximation`: shapes with few numbers that follow the integrals over a region
//! - `preset`: the tables that engines expect, as flags
//! - `scene`: the roughnesses and reflectances of the materials of a scene file
//! - `foreign`: tables of any maker, out of their files
//! - `verify`: what a foreign table is, and how wrong
//! - `planner`: the cheapest approximation for a scene, and proofs that cheaper ones fail
//! - `furnace`: the energy that a material gives back in a white furnace
//! - `preview`: spheres lit with tables and with integrals
//! - `compare`: methods compared: estimators, fits, textbook formulas; studies and charts
//! - `cli`: flags and configurations to requests; files and terminals
//!
//! `tests/tidy.rs` keeps this order, and what is absent: models know no tables; backends know no
//! files; encoders know only tables; nothing but `cli` touches the disk or prints; `unsafe` stands
//! in `backend/vulkan` alone; every WGSL function has a Rust twin of the same name.

#[doc(hidden)]
pub mod error;
#[doc(hidden)]
pub mod choice;
#[doc(hidden)]
pub mod units;
#[doc(hidden)]
pub mod image;
#[doc(hidden)]
pub mod numeric;
#[doc(hidden)]
pub mod table;
#[doc(hidden)]
pub mod brdf;
#[doc(hidden)]
pub mod integrate;
#[doc(hidden)]
pub mod lut;
#[doc(hidden)]
pub mod request;
#[doc(hidden)]
pub mod backend;
#[doc(hidden)]
pub mod certify;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod bake;
#[doc(hidden)]
pub mod lookup;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod html;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod approximation;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod preset;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod scene;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod foreign;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod verify;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod planner;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod furnace;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod preview;
#[doc(hidden)]
#[cfg(feature = "compare")]
pub mod compare;
#[doc(hidden)]
#[cfg(feature = "cli")]
pub mod cli;

pub use backend::device::{DeviceInfo, GpuOptions};
pub use backend::{Backend, BackendChoice};
pub use bake::{Baked, Plan, bake};
pub use brdf::fresnel::{Conductor, Dielectric, SchlickPower};
pub use brdf::interface::{Interface, Side, TransmissionMasking};
pub use brdf::{Diffuse, Fresnel, Masking, Microfacet, Ndf};
pub use choice::Choice;
pub use error::{Complaint, Error, ExitCode, Result};
pub use format::encoding::{Notation, Supercompress};
pub use format::{Encoding, FORMATS, Format, Style, encode};
pub use integrate::estimator::Estimator;
pub use integrate::hammersley::{Frame, Hammersley};
pub use integrate::rule::Rule;
pub use lookup::{Extra, Language, Lookup, Store};
pub use lut::terms::packing;
pub use lut::{Dfg, DfgChannels, Energy, EnergyChannels, Glass, GlassChannels, Lut, Packing};
pub use report::{Checks, Computed, Report, Seconds};
pub use request::{Accuracy, Request};
pub use table::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
pub use table::claim::{Certificate, Claim, Stage, StageError};
pub use table::precision::Precision;
pub use table::slices::{Slices, SlicesAs};
pub use table::{Channel, Layout, Part, Provenance, Table};
pub use units::{F0, Ior};
