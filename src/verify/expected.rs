//! A table against what it is to be: an engine's convention, or that of its own metadata.

use super::decision::{Decision, is_decided};
use super::decoding::Decoding;
use super::errors::Convention;
use super::fault::{Fault, Kind};
use super::layout::Layout;
use super::meaning::Meaning;
use crate::brdf::Fresnel;
use crate::foreign::Foreign;
use crate::integrate::Integrand;
use crate::request::Request;
use crate::table::axis::{AxisSpec, Mapping, Parameter};
use crate::table::precision::Precision;

/// What a table is to be.
#[derive(Clone, Debug)]
pub struct Expected {
    /// Whose convention it is.
    pub whose: String,
    /// A table in it, of the same size.
    pub request: Request,
    /// Columns and rows, where no other size is read.
    pub size: Option<[usize; 2]>,
    /// Whether the file is known to be that table, byte for byte.
    pub certain: bool,
}

impl Expected {
    /// How codes become values.
    pub fn decoding(&self) -> Decoding {
        match self.request.precision() {
            Precision::Srgb8 => Decoding::Srgb,
            Precision::Rgbd8 => Decoding::Rgbd,
            _ => Decoding::Linear,
        }
    }

    /// The axes.
    pub fn layout(&self) -> Layout {
        let layout = self.request.layout();
        Layout { x: layout.x.spec(), y: layout.y.spec() }
    }

    /// The meanings of a slice's channels.
    pub fn meanings(&self, slice: usize, components: usize, tolerance: f64) -> Vec<Meaning> {
        let packings = self.request.packings();
        let packing = &packings[slice.min(packings.len() - 1)];
        Meaning::of_packing(packing, tolerance, components)
    }

    /// Where the size is another than what is read.
    pub fn fault_of_size(&self, table: &Foreign) -> Option<Fault> {
        let ([columns, rows], [i, j, _]) = (self.size?, table.size);
        let text = format!("the size is {i} x {j}, {} reads {columns} x {rows} alone", self.whose);
        ([columns, rows] != [i, j]).then(|| Fault::new(Kind::WrongSize, text))
    }

    /// Where the data decide otherwise.
    pub fn faults(
        &self,
        table: &Foreign,
        (found, own): (&Convention, Integrand),
        decisions: &[Decision],
    ) -> Vec<Fault> {
        let decided = |dimension: &str| is_decided(decisions, dimension);
        let (theirs, wanted) = (found.layout, self.layout());
        let mut faults = Vec::new();
        let mut differ = |kind, what: &str, got: String, wanted: String| {
            let text = format!("{what} {got}, {} {wanted}", self.whose);
            faults.push(Fault::new(kind, text));
        };
        if theirs.is_transposed() != wanted.is_transposed() && decided("axes") {
            let order =
                |layout: Layout| format!("x = {}, y = {}", layout.x.parameter, layout.y.parameter);
            differ(Kind::Transposed, "axes are", order(theirs), order(wanted));
        }
        let axes = [
            (theirs.nov(), wanted.nov(), "nov"),
            (theirs.roughness(), wanted.roughness(), "roughness"),
        ];
        for (theirs, wanted, name) in axes {
            let (theirs, wanted) = (plain(theirs), plain(wanted));
            let same_map = (theirs.parameter, theirs.mapping) == (wanted.parameter, wanted.mapping);
            if !same_map && is_plain(wanted) && decided(of("mapping", name)) {
                differ(Kind::WrongMapping, "an axis is", theirs.to_string(), wanted.to_string());
            } else if theirs.flip != wanted.flip && decided(of("direction", name)) {
                differ(Kind::Flipped, "an axis is", theirs.to_string(), wanted.to_string());
            } else if theirs.nodes != wanted.nodes && decided(of("nodes", name)) {
                differ(Kind::ShiftedNodes, "an axis is", theirs.to_string(), wanted.to_string());
            }
        }
        let lobes = [found.meanings, &self.meanings(0, table.components(), 0.0)].map(main_lobe);
        if let [Some(theirs), Some(wanted)] = lobes {
            if theirs.ndf != wanted.ndf && decided("distribution") {
                let (got, wanted) = (theirs.ndf.to_string(), wanted.ndf.to_string());
                differ(Kind::WrongDistribution, "the distribution is", got, wanted);
            } else if theirs.masking != wanted.masking && decided("masking") {
                let (got, wanted) = (theirs.masking.to_string(), wanted.masking.to_string());
                differ(Kind::WrongMasking, "masking is", got, wanted);
            }
        }
        let main = self.request.packing().main().integrand();
        if let (Some(theirs), Some(wanted)) = (fresnel(own), fresnel(main))
            && theirs != wanted
            && decided("family")
        {
            differ(Kind::WrongFresnel, "Fresnel is", theirs, wanted);
        }
        let count = table.components().max(self.request.layout().channels.len());
        for (place, wanted) in self.meanings(0, count, 0.0).iter().enumerate() {
            let theirs = found.meanings.get(place).unwrap_or(&Meaning::Unknown);
            // Whose lobe it is has faults of its own.
            let (got, word) = (theirs.term(own), wanted.term(main));
            let varies = theirs.varies() || wanted.varies();
            if varies && (got.is_none() || got != word) && decided("channels") {
                let name = table.names.get(place).map_or("that is missing", |name| name);
                let known = |term: Option<String>| term.unwrap_or_else(|| "unknown".into());
                let what = format!("channel {name} is");
                differ(Kind::WrongChannels, &what, known(got), known(word));
            }
        }
        if found.decoding != self.decoding() && decided("encoding") {
            let (got, wanted) = (found.decoding.to_string(), self.decoding().to_string());
            differ(Kind::WrongCurve, "values are", got, wanted);
        }
        faults
    }
}

/// The Fresnel model of a specular lobe; a tint leaves Schlick's A and B as they are.
fn fresnel(integrand: Integrand) -> Option<String> {
    match integrand {
        Integrand::Specular(_, Fresnel::Schlick | Fresnel::SchlickF82) => Some("schlick".into()),
        Integrand::Specular(_, other) => Some(other.to_string()),
        Integrand::Glass(_) | Integrand::Diffuse(_) => None,
    }
}

/// The dimension of an axis.
fn of(what: &str, axis: &str) -> &'static str {
    match (what, axis) {
        ("mapping", "nov") => "mapping of nov",
        ("mapping", _) => "mapping of roughness",
        ("direction", "nov") => "direction of nov",
        ("direction", _) => "direction of roughness",
        (_, "nov") => "nodes of nov",
        _ => "nodes of roughness",
    }
}

/// An axis by the words that are sought: the root of alpha is roughness, whose square is alpha.
fn plain(spec: AxisSpec) -> AxisSpec {
    let (parameter, mapping) = match (spec.parameter, spec.mapping) {
        (Parameter::Alpha, Mapping::Sqrt) => (Parameter::Roughness, Mapping::Linear),
        (Parameter::Roughness, Mapping::Square) => (Parameter::Alpha, Mapping::Linear),
        both => both,
    };
    AxisSpec { parameter, mapping, ..spec }
}

/// Whether an axis is among those that are sought.
fn is_plain(spec: AxisSpec) -> bool {
    matches!(spec.parameter, Parameter::Nov | Parameter::Roughness | Parameter::Alpha)
}

/// The lobe of the first specular channel.
fn main_lobe(meanings: &[Meaning]) -> Option<crate::brdf::Microfacet> {
    meanings.iter().find_map(|meaning| match meaning {
        Meaning::Number { truth, .. } => match truth.lut.integrand() {
            Integrand::Specular(lobe, _) => Some(lobe),
            Integrand::Glass(_) | Integrand::Diffuse(_) => None,
        },
        _ => None,
    })
}
