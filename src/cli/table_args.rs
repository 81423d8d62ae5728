//! The description of a table, as flags and as the keys of a configuration: the same names for both.

use crate::axis::{Axis, AxisSpec, Parameter};
use crate::encode::Format;
use crate::error::{Error, Result};
use crate::integrate::rule::Rule;
use crate::lut::{Dfg, Energy, Lut};
use crate::model::{Microfacet, Ndf};
use crate::precision::Precision;
use crate::request::{Accuracy, DEFAULT_SIZE, Request, check_masking};
use crate::units::{F0, Ior, word};
use serde::{Deserialize, de::DeserializeOwned};
use std::fmt;
use std::path::Path;

/// What to bake; everything has a default.
#[derive(Clone, Debug, Default, clap::Args, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TableArgs {
    /// Family of tables: dfg, the split sum's E(F0) = F0*A + B (Karis 2013); sheen, the same with charlie and E
    /// alone; energy, what a specular lobe leaves for a diffuse base and loses between its facets (Kulla and Conty
    /// 2017; Turquin 2019); diffuse, the albedo of a white diffuse lobe [default: dfg]
    #[arg(long, value_name = "NAME")]
    pub lut: Option<String>,
    /// Model: a distribution of normals, or a diffuse lobe; they are listed below [default: ggx; charlie for sheen,
    /// burley for diffuse]
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Masking: height-correlated or separable (Smith; Heitz 2014), schlick-smith (k = alpha/2; Karis 2013), joint
    /// (Unreal's approximation; Hammon 2017), implicit (G = n.l n.v), neubelt (for charlie; 2013) [default:
    /// height-correlated; implicit for blinn-phong, neubelt for charlie]
    #[arg(long, value_name = "NAME")]
    pub masking: Option<String>,
    /// Channels of dfg: ab (scale, bias), be (bias, E = A + B: the multiple-scattering packing), e (E alone)
    /// [default: ab]. Of energy: average (A, B, E over all directions), kulla-conty (E, E_avg), turquin ((1-E)/E),
    /// split (the diffuse factor 1-F, 1-E, and the reciprocal one for each direction) [default: split]
    #[arg(long, value_name = "NAME")]
    pub channels: Option<String>,
    /// Reflectance at normal incidence, for the split of energy; several, with commas between, are layers of an .exr
    /// [default: 0.04]
    #[arg(long, value_name = "F0[,F0...]", conflicts_with = "ior")]
    pub f0: Option<Numbers>,
    /// Index of refraction instead of F0: F0 = ((1-n)/(1+n))^2
    #[arg(long, value_name = "N")]
    pub ior: Option<f64>,
    /// Columns x rows, each 1 to 16384; one number for a square [default: 128]
    #[arg(long, value_name = "N|WxH")]
    pub size: Option<Size>,
    /// What runs along a row, for example nov,sqrt,edges: PARAMETER nov, roughness (perceptual), alpha or exponent (n
    /// = 10^(7p), Blinn-Phong's); then, where they differ from linear,centres: MAPPING linear, sqrt (t = sqrt(p)) or
    /// sqrt-complement (t = sqrt(1-p)); NODES centres, edges (i/(N-1)) or offset=X ((i+X)/N); flip; min=X. n.v is 0
    /// or from 1e-30 to 1, roughness 0 or from 5e-10 to 1 [default: nov]
    #[arg(long, value_name = "AXIS")]
    pub x: Option<String>,
    /// What runs from row to row, in the same words [default: roughness, or nov where x is a roughness]
    #[arg(long, value_name = "AXIS")]
    pub y: Option<String>,
    /// How values are stored: f16 or f32 (.exr), unorm16 or unorm8 (.png) [default: the first for the format]
    #[arg(long, value_name = "NAME")]
    pub precision: Option<String>,
    /// on certifies every value: rounded correctly, or within the tolerance in f32, the same whoever computes it; off
    /// stores what a rule gives, checked on a sample [default: on; off where a rule is named]
    #[arg(long, value_name = "on|off")]
    pub certify: Option<String>,
    /// Largest absolute error of an integral, 1e-13 to 0.1, where its values are stored in f32 or not certified
    /// [default: 1e-6 for f32 and unorm16, 1.5e-5 for f16, 1e-4 for unorm8; more for models of which a device keeps
    /// less]
    #[arg(long, value_name = "ERROR", conflicts_with = "rule")]
    pub tolerance: Option<f64>,
    /// Store what this quadrature rule gives, not certified: h56 to h6144 (CPU and Vulkan), l288 to l4608, s640, s2304,
    /// d6144, d10240, reference (CPU)
    #[arg(long, value_name = "NAME")]
    pub rule: Option<String>,
    /// File format: exr or png [default: by the extension of the output]
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// Where to write; - is standard output [default: out/dfg.exr]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<String>,
}

/// A table's size as users write it.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Size {
    /// One number for a square.
    Square(i64),
    /// Text, with columns and rows.
    Text(String),
}

/// One number or several as users write them.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Numbers {
    /// One.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// Text, with commas between.
    Text(String),
}

/// Where a table goes when nothing is said.
pub const DEFAULT_OUTPUT: &str = "out/dfg.exr";

/// F0 of most dielectrics: an index of refraction of 1.5.
const DEFAULT_F0: f64 = 0.04;

/// A table to bake and where it goes.
#[derive(Clone, Debug)]
pub struct Job {
    /// One for each layer, alike but for F0.
    pub requests: Vec<Request>,
    pub format: Format,
    /// A path as the user wrote it, or `-`.
    pub output: String,
}

impl TableArgs {
    /// The checked job.
    pub fn job(&self) -> Result<Job> {
        let output = self.output.clone().unwrap_or_else(|| DEFAULT_OUTPUT.into());
        let format = match &self.format {
            Some(name) => Format::of_extension(name)?,
            None if output == "-" => Format::Exr,
            None => {
                let extension = Path::new(&output).extension().unwrap_or_default();
                Format::of_extension(&extension.to_string_lossy())?
            }
        };
        let wanted = self.precision.as_deref().map(|name| choice("precision", name)).transpose()?;
        let precision = format.precision(wanted)?;
        let (x, y) = self.axes()?;
        let request = |f0| {
            let lut = self.lut(f0)?;
            Request::new(lut, x, y, self.accuracy(&lut, precision)?, precision)
        };
        let requests: Vec<Request> = self.f0s()?.into_iter().map(request).collect::<Result<_>>()?;
        if format == Format::Png && requests.len() > 1 {
            let cure = "write an .exr, or one F0 at a time";
            return Err(Error::bad_input(
                "f0",
                "one for a .png, which has no layers",
                requests.len().to_string(),
                cure,
            ));
        }
        Ok(Job { requests, format, output })
    }

    fn lut(&self, f0: F0) -> Result<Lut> {
        let family = self.lut.as_deref().unwrap_or("dfg");
        if family != "energy" && (self.f0.is_some() || self.ior.is_some()) {
            let cure = "leave out f0 and ior: the other tables serve every F0";
            return Err(Error::bad_input("lut", "energy where f0 or ior is given", format!("'{family}'"), cure));
        }
        let channels = |default| self.channels.as_deref().unwrap_or(default);
        match family {
            "dfg" => Ok(Lut::Dfg(Dfg { lobe: self.lobe("ggx")?, channels: choice("channels", channels("ab"))? })),
            "sheen" => Ok(Lut::Dfg(Dfg { lobe: self.lobe("charlie")?, channels: choice("channels", channels("e"))? })),
            "energy" => {
                let channels = choice("channels", channels("split"))?;
                Ok(Lut::Energy(Energy::new(self.lobe("ggx")?, f0, channels)?))
            }
            "diffuse" => {
                if self.masking.is_some() || self.channels.is_some() {
                    let got = "masking or channels";
                    return Err(Error::bad_input("lut", "a model alone for diffuse", got, "leave them out"));
                }
                Ok(Lut::Diffuse(choice("model", self.model.as_deref().unwrap_or("burley"))?))
            }
            other => {
                let expected = "dfg, sheen, energy or diffuse";
                Err(Error::bad_input("lut", expected, format!("'{other}'"), "name one of these"))
            }
        }
    }

    fn lobe(&self, default: &str) -> Result<Microfacet> {
        lobe(self.model.as_deref().unwrap_or(default), self.masking.as_deref())
    }

    /// F0 of each layer.
    fn f0s(&self) -> Result<Vec<F0>> {
        match (&self.f0, self.ior) {
            (Some(_), Some(_)) => {
                Err(Error::bad_input("f0", "F0 or an index of refraction", "both", "leave one of them out"))
            }
            (Some(f0s), None) => f0s.parse()?.into_iter().map(F0::new).collect(),
            (None, Some(n)) => Ok(vec![F0::from(Ior::new(n)?)]),
            (None, None) => Ok(vec![F0::new(DEFAULT_F0)?]),
        }
    }

    fn axes(&self) -> Result<(Axis, Axis)> {
        let (columns, rows) = self.size.as_ref().map_or(Ok((DEFAULT_SIZE, DEFAULT_SIZE)), Size::parse)?;
        let spec = |text: &Option<String>| text.as_deref().map(str::parse::<AxisSpec>).transpose();
        let x = spec(&self.x)?;
        let y = spec(&self.y)?;
        let other = |axis: Option<AxisSpec>| match axis.map(|axis| axis.parameter) {
            Some(Parameter::Roughness | Parameter::Alpha | Parameter::Exponent) => Parameter::Nov,
            _ => Parameter::Roughness,
        };
        let x = x.unwrap_or_else(|| match y.map(|y| y.parameter) {
            Some(Parameter::Nov) => AxisSpec::of(Parameter::Roughness),
            _ => AxisSpec::of(Parameter::Nov),
        });
        let y = y.unwrap_or_else(|| AxisSpec::of(other(Some(x))));
        Ok((Axis::new(x, columns)?, Axis::new(y, rows)?))
    }

    fn accuracy(&self, lut: &Lut, precision: Precision) -> Result<Accuracy> {
        let certify = match self.certify.as_deref() {
            None => None,
            Some("on") => Some(true),
            Some("off") => Some(false),
            Some(other) => {
                return Err(Error::bad_input("certify", "on or off", format!("'{other}'"), "name one of these"));
            }
        };
        match (&self.rule, self.tolerance, certify) {
            (Some(_), Some(_), _) => {
                Err(Error::bad_input("rule", "a rule or a tolerance", "both", "leave one of them out"))
            }
            (Some(_), None, Some(true)) => {
                let cure = "leave out the rule, or set certify to off";
                Err(Error::bad_input("rule", "none where values are certified", "a rule", cure))
            }
            (Some(name), None, _) => Ok(Accuracy::Rule(Rule::named(name)?)),
            (None, tolerance, Some(false)) => {
                Ok(tolerance.map_or_else(|| Accuracy::uncertified(lut, precision), Accuracy::Tolerance))
            }
            (None, None, _) => Ok(Accuracy::by_default(lut, precision)),
            (None, Some(tolerance), _) if precision == Precision::F32 => Ok(Accuracy::Certified(tolerance)),
            (None, Some(_), _) => {
                let expected = format!("none where values are rounded to {} correctly", word(precision));
                Err(Error::bad_input("tolerance", expected, "a tolerance", "leave it out, or set certify to off"))
            }
        }
    }
}

impl Size {
    fn parse(&self) -> Result<(usize, usize)> {
        let text = self.to_string();
        let (columns, rows) = text.split_once('x').unwrap_or((&text, &text));
        match (columns.trim().parse(), rows.trim().parse()) {
            (Ok(columns), Ok(rows)) => Ok((columns, rows)),
            _ => Err(Error::bad_input(
                "size",
                "a number, or two with an x between",
                format!("'{text}'"),
                "as in 128 or 64x32",
            )),
        }
    }
}

impl Numbers {
    /// The numbers, no two alike and no more than 64.
    fn parse(&self) -> Result<Vec<f64>> {
        let numbers = match self {
            Numbers::One(number) => vec![*number],
            Numbers::List(numbers) => numbers.clone(),
            Numbers::Text(text) => {
                let number = |word: &str| word.trim().parse().ok();
                text.split(',').map(number).collect::<Option<Vec<f64>>>().unwrap_or_default()
            }
        };
        let repeated = (1..numbers.len()).any(|i| numbers[..i].contains(&numbers[i]));
        if numbers.is_empty() || numbers.len() > 64 || repeated {
            let expected = "1 to 64 different numbers with commas between";
            return Err(Error::bad_input("f0", expected, format!("{self:?}"), "as in 0.02,0.04,0.08"));
        }
        Ok(numbers)
    }
}

impl From<String> for Numbers {
    fn from(text: String) -> Self {
        Numbers::Text(text)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Size::Square(n) => write!(f, "{n}"),
            Size::Text(text) => f.write_str(text),
        }
    }
}

impl From<String> for Size {
    fn from(text: String) -> Self {
        Size::Text(text)
    }
}

/// The lobe of that model and masking, or of the model's default masking.
pub fn lobe(model: &str, masking: Option<&str>) -> Result<Microfacet> {
    let ndf: Ndf = choice("model", model)?;
    let masking = masking.map_or(Ok(ndf.default_masking()), |name| choice("masking", name))?;
    let lobe = Microfacet { ndf, masking };
    check_masking(lobe)?;
    Ok(lobe)
}

/// The variant of a choice that is spelled `text`.
pub fn choice<T: DeserializeOwned>(what: &str, text: &str) -> Result<T> {
    serde_json::from_value(text.into()).map_err(|error| {
        // serde says: unknown variant `x`, expected one of `a`, `b`
        let error = error.to_string();
        let expected = error.split_once(", expected ").map_or(error.as_str(), |(_, expected)| expected);
        Error::bad_input(what, expected.replace('`', ""), format!("'{text}'"), "name one of these")
    })
}
