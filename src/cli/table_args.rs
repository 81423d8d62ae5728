//! The description of a table, as flags and as the keys of a configuration: the same names for
//! both.

mod family;
mod preset;
mod slices;
mod values;

use self::family::{Family, Sides};
use self::values::{Numbers, Size};
use super::choices;
use super::lookup::language_of;
use super::output::DEFAULT_FOLDER;
use crate::brdf::Masking;
use crate::brdf::interface::TransmissionMasking;
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::format::encoding::{Notation, Supercompress};
use crate::format::{Encoding, Format, Style};
use crate::integrate::rule::Rule;
use crate::lookup::Language;
use crate::lut::{Lut, Packing};
use crate::request::{Accuracy, DEFAULT_SIZE, Request};
use crate::table::axis::{Axis, AxisSpec, Parameter};
use crate::table::precision::Precision;
use crate::table::slices::SlicesAs;
use serde::Deserialize;

/// The table; everything has a default.
#[derive(Clone, Debug, Default, PartialEq, clap::Args, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TableArgs {
    /// The table that an engine expects, with its format and file name; flags beside it change it
    /// ('splitsum presets' lists them)
    #[arg(long, value_name = "NAME", value_parser = choices::preset(), hide_possible_values = true)]
    preset: Option<String>,
    /// Family of tables [default: dfg]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Family>())]
    lut: Option<Family>,
    /// Model: a distribution of normals, or a diffuse lobe [default: ggx; charlie for sheen, burley
    /// for diffuse]
    #[arg(long, value_name = "NAME", value_parser = choices::model())]
    model: Option<String>,
    /// Masking [default: height-correlated; implicit for blinn-phong, neubelt for charlie]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Masking>())]
    masking: Option<Masking>,
    /// Fresnel of dfg; several, with commas between, are slices, layers of an .exr [default:
    /// schlick]
    #[arg(long, value_name = "NAME[,NAME...]", value_parser = choices::fresnel())]
    fresnel: Option<String>,
    /// Channels: a name, or up to four terms of dfg with commas between, for example b,e,charlie:
    /// a, b, c, e, 1-e, a_avg, b_avg, e_avg; another lobe's E, as in charlie, charlie/neubelt or
    /// burley; nov, roughness or a number; each but 1-e and a number with *SCALE and +OFFSET or
    /// -OFFSET behind it [default: all integrals for dfg, e for sheen, split for energy]
    #[arg(
        long, value_name = "NAME|TERM[,TERM...]", value_parser = choices::channels(),
        allow_hyphen_values = true
    )]
    channels: Option<String>,
    /// Reflectance at normal incidence, for the split of energy; several, with commas between, are
    /// slices, layers of an .exr [default: 0.04]
    #[arg(
        long, value_name = "F0[,F0...]", conflicts_with_all = ["ior", "z"],
        allow_hyphen_values = true
    )]
    f0: Option<Numbers>,
    /// Index of refraction from 1 to 100 of glass, and of the split of energy in place of F0, with
    /// Fresnel's equations; several are slices [default of glass: 1.5]
    #[arg(long, value_name = "N[,N...]", conflicts_with = "z", allow_hyphen_values = true)]
    ior: Option<Numbers>,
    /// Side of glass from which it is seen [default: outside]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Sides>())]
    side: Option<Sides>,
    /// Masking of what glass transmits; the three differ by up to 0.66 [default: correlated]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<TransmissionMasking>())]
    transmission_masking: Option<TransmissionMasking>,
    /// Columns x rows, each 1 to 16384, and slices, 1 to 64, where there is a z axis; one number
    /// for a square [default: 128]
    #[arg(long, value_name = "N|WxH|WxHxD", allow_hyphen_values = true)]
    size: Option<Size>,
    /// The axis along a row, for example nov,sqrt,edges: PARAMETER nov, critical (n.v centred on
    /// the critical angle of glass seen from inside), roughness (perceptual), alpha or exponent (n
    /// = 10^(7p), Blinn-Phong's); then, where they differ from linear,centres: MAPPING linear, sqrt
    /// (t = sqrt(p)), square (t = p^2) or sqrt-complement (t = sqrt(1-p)); NODES centres, edges
    /// (i/(N-1)) or offset=X ((i+X)/N); flip; unclamped, so that nodes beyond an end stay there;
    /// min=X; max=X. n.v is 0 or from 1e-30 to 1, roughness 0 or from 5e-10 to 1, unclamped to 1.06
    /// [default: nov]
    #[arg(long, value_name = "AXIS")]
    x: Option<String>,
    /// The axis from row to row, in the same words [default: roughness, or nov where x is a
    /// roughness]
    #[arg(long, value_name = "AXIS")]
    y: Option<String>,
    /// The axis from slice to slice, in the same words: PARAMETER f0 of a split, or ior of a split
    /// or of glass, from min to max=3; MAPPING of ior also sqrt-f0 (even steps of
    /// sqrt((n-1)/(n+1)), without max to 99.5) or piecewise (1/max to 1, seen from inside, and 1 to
    /// max) [default: none]
    #[arg(long, value_name = "AXIS")]
    z: Option<String>,
    /// Storage of the values [default: the first for the format]
    #[arg(long, value_name = "NAME", value_parser = choices::precision())]
    precision: Option<Precision>,
    /// on certifies every value: rounded correctly, or in f32 and rgbd8 within the tolerance, the
    /// same on every backend; off stores the values of a rule, checked on a sample [default: on;
    /// off where a rule is named]
    #[arg(
        long,
        value_name = "on|off",
        value_parser = choices::of::<Switch>(),
        hide_possible_values = true
    )]
    certify: Option<Switch>,
    /// Largest absolute error of an integral, 1e-13 to 0.1, where its values are stored in f32 or
    /// rgbd8 or not certified [default: 1e-6 for f32, rgbd8 and unorm16, 1e-5 for srgb8, 1.5e-5 for
    /// f16, 3e-5 for a2b10g10r10, 1e-4 for unorm8; more for models of which a device keeps less]
    #[arg(long, value_name = "ERROR", conflicts_with = "rule", allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Store the values of this quadrature rule, not certified; h56 to h6144, and g560 to g2240,
    /// run on Vulkan too
    #[arg(long, value_name = "NAME", value_parser = choices::rule())]
    rule: Option<String>,
    /// Repeat an engine's own numbers, not certified, for example hammersley,n=1024,frame=cos:
    /// half vectors of GGX by D at Hammersley's points; frame cos as in Filament's cmgen, sin as in
    /// three.js, Unreal and LearnOpenGL. wrong-side: glass with refractions to the side of v, as in
    /// Cycles' ggx_glass_inv_E
    #[arg(
        long, value_name = "hammersley,n=N,frame=cos|sin or wrong-side",
        conflicts_with_all = ["rule", "tolerance"]
    )]
    estimator: Option<String>,
    /// File format [default: by the extension of the output]
    #[arg(long, value_name = "NAME", value_parser = choices::format())]
    format: Option<String>,
    /// Components of a texel, 1 to 4: those without a channel are 0, and the fourth is 1 [default:
    /// as many as the format needs for the channels]
    #[arg(long, value_name = "N")]
    components: Option<usize>,
    /// Compression of a .ktx2 file [default: none]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Supercompress>())]
    supercompress: Option<Supercompress>,
    /// What slices of a .ktx2 or .dds file are [default: layers]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<SlicesAs>())]
    slices_as: Option<SlicesAs>,
    /// How source code has numbers [default: stored]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Notation>())]
    numbers: Option<Notation>,
    /// Name of the array in source code, with which the names of its functions begin [default:
    /// splitsum_table]
    #[arg(long, value_name = "NAME")]
    symbol: Option<String>,
    /// Lookup code to write beside the table, in the language of the extension: .wgsl, .glsl,
    /// .hlsl, .metal, .h or .rs
    #[arg(long, value_name = "FILE")]
    pub lookup: Option<String>,
    /// File to write; - is standard output [default: out/dfg.exr, or by the storage or the preset]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<String>,
}

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    On,
    Off,
}

choice!(Switch, "certify", {
    On = "on", "certify every value";
    Off = "off", "check a sample";
});

/// Whether a flag is given.
#[cfg(feature = "compare")]
type IsGiven = fn(&TableArgs) -> bool;

/// The flags that a picture does not follow, since it has neither storage nor certificate, and
/// whether each is given.
#[cfg(feature = "compare")]
pub const FLAGS_OF_FILES: [(&str, IsGiven); 12] = [
    ("precision", |table| table.precision.is_some()),
    ("certify", |table| table.certify.is_some()),
    ("tolerance", |table| table.tolerance.is_some()),
    ("rule", |table| table.rule.is_some()),
    ("estimator", |table| table.estimator.is_some()),
    ("format", |table| table.format.is_some()),
    ("components", |table| table.components.is_some()),
    ("supercompress", |table| table.supercompress.is_some()),
    ("slices-as", |table| table.slices_as.is_some()),
    ("numbers", |table| table.numbers.is_some()),
    ("symbol", |table| table.symbol.is_some()),
    ("lookup", |table| table.lookup.is_some()),
];

/// A table to bake, its format and its file.
#[derive(Clone, Debug)]
pub struct Job {
    pub request: Request,
    pub encoding: Encoding,
    /// A path as the user wrote it, or `-`.
    pub output: String,
    /// Lookup code and its language.
    pub lookup: Option<(String, Language)>,
}

impl Job {
    /// The files that it writes.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let lookup = self.lookup.as_ref().map(|(name, _)| name.as_str());
        [self.output.as_str()].into_iter().chain(lookup)
    }

    /// The command that repeats the file, but for its name.
    pub fn command(&self) -> String {
        self.encoding.command(&self.request.to_string(), self.request.precision())
    }
}

impl TableArgs {
    /// The checked job.
    pub fn job(&self) -> Result<Job> {
        if self.preset.is_some() {
            return self.with_preset()?.job();
        }
        let format = match (&self.format, self.output.as_deref()) {
            (Some(name), _) => Format::named(name)?,
            (None, None | Some("-")) => Format::of_precision(self.precision),
            (None, Some(output)) => Format::of_file(output)?,
        };
        let default = || format!("{DEFAULT_FOLDER}/dfg.{}", format.extension());
        let output = self.output.clone().unwrap_or_else(default);
        let precision = format.precision(self.precision)?;
        let request = self.request(precision, |packing| self.accuracy(packing, precision))?;
        let encoding = Encoding::new(format, self.style(), request.layout(), precision)?;
        let lookup = self.lookup.as_ref();
        let lookup = lookup.map(|name| Ok((name.clone(), language_of(name)?))).transpose()?;
        Ok(Job { request, encoding, output, lookup })
    }

    /// Whether no other flag than -o is given.
    pub fn is_empty_but_for_output(&self) -> bool {
        *self == TableArgs { output: self.output.clone(), ..TableArgs::default() }
    }

    /// What the format leaves open.
    fn style(&self) -> Style {
        Style {
            components: self.components,
            supercompress: self.supercompress.unwrap_or_default(),
            slices: self.slices_as.unwrap_or_default(),
            numbers: self.numbers.unwrap_or_default(),
            symbol: self.symbol.clone(),
        }
    }

    /// The checked request for a table in this storage.
    pub fn request(
        &self,
        precision: Precision,
        accuracy: impl Fn(&Packing) -> Result<Accuracy>,
    ) -> Result<Request> {
        if self.preset.is_some() {
            return self.with_preset()?.request(precision, accuracy);
        }
        let (columns, rows, depth) =
            self.size.as_ref().map_or(Ok((DEFAULT_SIZE, DEFAULT_SIZE, None)), Size::parse)?;
        let (x, y) = self.axes(columns, rows)?;
        let (iors, fresnels) = (self.iors()?, self.fresnels()?);
        let f0s = self.f0s()?;
        let packing = self.family(f0s[0], iors[0], fresnels[0])?;
        self.check_flags_serve(&packing)?;
        let accuracy = accuracy(&packing)?;
        let request = Request::new(packing, x, y, accuracy, precision)?;
        match self.slices(&request, &f0s, &iors, depth)? {
            None if fresnels.len() > 1 => request.with_fresnel(&fresnels),
            None => Ok(request),
            Some(slices) => request.with_slices(slices),
        }
    }

    /// Refuses flags that the family does not follow.
    fn check_flags_serve(&self, packing: &Packing) -> Result<()> {
        let lut = packing.main();
        let has_f0 = lut.f0().is_some();
        let is_glass = matches!(lut, Lut::Glass(_));
        let got = packing.flags().to_owned();
        if self.f0.is_some() && !has_f0 {
            let cure = "leave it out: no other table depends on F0";
            return Err(Error::bad_input("f0", "the split of energy beside it", got, cure));
        }
        if self.ior.is_some() && lut.ior().is_none() {
            let cure = "leave it out: no other table depends on it";
            let expected = "glass or the split of energy beside it";
            return Err(Error::bad_input("ior", expected, got, cure));
        }
        if (self.side.is_some() || self.transmission_masking.is_some()) && !is_glass {
            let what = if self.side.is_some() { "side" } else { "transmission-masking" };
            return Err(Error::bad_input(what, "glass beside it", got, "add --lut glass"));
        }
        Ok(())
    }

    fn axes(&self, columns: usize, rows: usize) -> Result<(Axis, Axis)> {
        let spec = |text: &Option<String>| text.as_deref().map(str::parse::<AxisSpec>).transpose();
        let (x, y) = (spec(&self.x)?, spec(&self.y)?);
        let x = x.unwrap_or_else(|| match y.map(|y| y.parameter) {
            Some(Parameter::Nov | Parameter::Critical) => AxisSpec::of(Parameter::Roughness),
            _ => AxisSpec::of(Parameter::Nov),
        });
        let y = y.unwrap_or_else(|| match x.parameter {
            Parameter::Nov | Parameter::Critical => AxisSpec::of(Parameter::Roughness),
            _ => AxisSpec::of(Parameter::Nov),
        });
        Ok((Axis::new(x, columns)?, Axis::new(y, rows)?))
    }

    fn accuracy(&self, packing: &Packing, precision: Precision) -> Result<Accuracy> {
        if let Some(estimator) = &self.estimator {
            let others = self.rule.is_some() || self.tolerance.is_some();
            if others || self.certify == Some(Switch::On) {
                let expected = "neither a rule nor a tolerance nor certify beside it";
                return Err(Error::bad_input("estimator", expected, "one", "leave it out"));
            }
            return Ok(Accuracy::Estimator(estimator.parse()?));
        }
        match (&self.rule, self.tolerance, self.certify) {
            (Some(_), Some(_), _) => Err(Error::bad_input(
                "rule",
                "a rule or a tolerance",
                "both",
                "leave one of them out",
            )),
            (Some(_), None, Some(Switch::On)) => {
                let cure = "leave out the rule, or set certify to off";
                Err(Error::bad_input("rule", "none where values are certified", "a rule", cure))
            }
            (Some(name), None, _) => Ok(Accuracy::Rule(Rule::named(name)?)),
            (None, None, Some(Switch::Off)) => Ok(Accuracy::uncertified(packing, precision)),
            (None, Some(tolerance), Some(Switch::Off)) => Ok(Accuracy::Tolerance(tolerance)),
            (None, None, _) => Ok(Accuracy::by_default(packing, precision)),
            // Storages that are rounded correctly refuse it.
            (None, Some(tolerance), _) => Ok(Accuracy::Within(tolerance)),
        }
    }
}
