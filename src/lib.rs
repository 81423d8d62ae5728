//! splitsum bakes preintegrated BRDF tables, on Vulkan compute or on the CPU, and says how far each is from the truth.
//!
//! ```text
//!   Request ──► Lut + Rule over a Grid ──► backend ──► certify ──► Table ──► encode ──► bytes
//!   (request)   (lut, integrate, model)   (cpu, vulkan)                      (exr, png)    │
//!                                                          report ◄────────────────────────┘
//! ```
//!
//! A module uses only modules that stand above it in this list:
//!
//! - [`error`]: every failure, with what was expected, what was got and the cure; the exit codes
//! - [`units`]: perceptual roughness, α, cosines, index of refraction, F0; each conversion once
//! - [`ball`]: a number with a bound of its error, carried through arithmetic
//! - [`lanes`]: eight numbers side by side, for the CPU's vector registers
//! - [`axis`]: texel ↔ parameter, the only half-texel arithmetic
//! - [`half`]: correctly rounded binary16
//! - [`precision`]: how a value is stored
//! - [`stored`]: numbers in the bytes of a file
//! - [`certificate`]: what is certified of a table
//! - [`table`]: values over two axes, bilinear lookup, differences
//! - [`special`]: the special functions of the models
//! - [`quadrature`]: Gauss-Legendre, the slope map, double exponential; point sets
//! - [`model`]: distributions of normals, masking, Fresnel, with their citations
//! - [`integrate`]: how a lobe becomes (A, B): over half vectors, over light directions, by the reference; the rules
//! - [`sampling`]: the field's estimators of the same integrals, for comparison
//! - [`lut`]: what is baked, over which grid, into which channels
//! - [`request`]: a checked job, which prints itself as the command that repeats it
//! - [`backend`]: the CPU, the shaders, the Vulkan host
//! - [`certify`]: every value rounded correctly; a device's table against the CPU, any table against the reference
//! - [`furnace`]: what a material gives back in a white furnace
//! - [`report`]: what is said of a bake; pictures
//! - [`mod@bake`]: from a request to a table
//! - [`preview`]: spheres lit with tables and with integrals
//! - [`encode`]: a table as the bytes of a file
//! - [`study`]: what methods are worth: errors beside times, and where formulas fail
//! - [`draw`]: shapes as SVG and as pixels, the axes of charts
//! - [`chart`]: charts of a study
//! - `cli`: flags and configurations to requests; files and terminals
//!
//! What is absent, and kept absent by `tests/tidy.rs`: models know no tables; backends know no files; encoders know
//! only tables; nothing but `cli` touches the disk or prints; `unsafe` stands in `backend/vulkan` alone; every WGSL
//! function has a Rust twin of the same name.
//!
//! ```
//! use splitsum::{backend::Backend, lut::{Dfg, DfgChannels, Lut}, model::{Masking, Microfacet, Ndf}};
//! use splitsum::{precision::Precision, request::Request};
//!
//! let lobe = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };
//! let lut = Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab });
//! let request = Request::with_default_axes(lut, (16, 16), Precision::F16)?;
//! let baked = splitsum::bake(&request, &Backend::cpu(), &|_| ())?;
//! assert_eq!(baked.report.certificate().map(|certificate| certificate.undecided), Some(0));
//! # Ok::<(), splitsum::error::Error>(())
//! ```

pub mod error;
pub mod units;
pub mod ball;
pub mod lanes;
pub mod axis;
pub mod half;
pub mod precision;
pub mod stored;
pub mod certificate;
pub mod table;
pub mod special;
pub mod quadrature;
pub mod model;
pub mod integrate;
pub mod sampling;
pub mod lut;
pub mod request;
pub mod backend;
pub mod certify;
pub mod furnace;
pub mod report;
pub mod bake;
pub mod preview;
pub mod encode;
pub mod study;
pub mod draw;
pub mod chart;
pub mod cli;

pub use bake::{Baked, bake};
