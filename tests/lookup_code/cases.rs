//! Tables with their lookups: the stored values, read bilinearly in f64 at many points.

use crate::common::{Random, printed, read_npy};
use libtest_mimic::Failed;
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::lookup::fields::{Field, From, fields};
use splitsum::lut::{Dfg, Energy, EnergyChannels, Lut, Packing, terms};
use splitsum::table::axis::{Axis, Parameter};
use splitsum::table::slices::Slices;
use splitsum::table::{Layout, bilinear, srgb};
use splitsum::units::F0;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A table in a folder, and what its lookup has to give.
pub struct Case {
    pub name: String,
    /// The flags of its bake.
    pub flags: String,
    pub folder: PathBuf,
    pub layout: Layout,
    /// Components of a texel.
    pub components: usize,
    /// The values of the components, slice by slice and row by row.
    pub values: Vec<f64>,
    pub fields: Vec<Field>,
}

/// Tables that between them have every mapping, node, flip, parameter, storage and packing.
pub const CASES: [(&str, &str); 11] = [
    ("plain", "--size 64 --precision f16"),
    (
        "packed",
        "--channels b,e,burley*0.9655212-0.5 --x nov,sqrt,edges --y roughness,edges,flip --size \
         33x20 --precision f16",
    ),
    (
        "tinted",
        "--fresnel f82 --channels abc --x roughness,edges --y \
         nov,sqrt-complement,edges,min=1e-4,max=0.9999 --size 24 --precision f32",
    ),
    ("complement", "--channels 1-e --x nov,edges,min=1e-3 --size 32 --precision unorm16"),
    ("bytes", "--channels a,b,e --size 40 --precision unorm8"),
    ("ten", "--channels a,e,1-e --size 32x16 --precision a2b10g10r10"),
    ("curve", "--channels a,b,e --size 32x16 --precision srgb8"),
    ("shared", "--channels b,e,charlie*0.5 --size 32 --precision rgbd8"),
    ("alpha", "--channels be --y alpha,offset=1.5,flip --size 30 --precision f16"),
    ("exponent", "--model blinn-phong --y exponent --size 32 --precision f16"),
    ("slices", "--lut energy --z f0,sqrt --size 16x12x5 --precision f16"),
];

/// The value of a flag.
fn flag<'a>(flags: &'a str, name: &str) -> Option<&'a str> {
    let mut words = flags.split_whitespace();
    words.find(|word| *word == name)?;
    words.next()
}

/// What a texel holds.
fn packing(flags: &str) -> Packing {
    let ndf = flag(flags, "--model").map_or(Ndf::Ggx, |word| Ndf::named(word).unwrap());
    let masking = flag(flags, "--masking").map(|word| Masking::named(word).unwrap());
    let lobe = Microfacet::new(ndf, masking).unwrap();
    if flag(flags, "--lut") == Some("energy") {
        let f0 = F0::new(0.04).unwrap();
        return Lut::Energy(Energy::new(lobe, f0, EnergyChannels::Split).unwrap()).into();
    }
    let fresnel = flag(flags, "--fresnel").map_or(Fresnel::Schlick, |word| word.parse().unwrap());
    let words = flag(flags, "--channels").unwrap_or("ab");
    match Dfg::with_channels(lobe, fresnel, words) {
        Ok(dfg) => Lut::Dfg(dfg).into(),
        Err(_) => terms::packing(lobe, fresnel, words).unwrap(),
    }
}

/// Axes, slices and channels.
fn layout(flags: &str) -> Layout {
    let size = flag(flags, "--size").unwrap_or("128");
    let sizes: Vec<usize> = size.split('x').map(|size| size.parse().unwrap()).collect();
    let axis = |name: &str, default: &str, size: usize| {
        Axis::new(flag(flags, name).unwrap_or(default).parse().unwrap(), size).unwrap()
    };
    let x = axis("--x", "nov", sizes[0]);
    let other = if x.spec().parameter == Parameter::Nov { "roughness" } else { "nov" };
    let y = axis("--y", other, *sizes.get(1).unwrap_or(&sizes[0]));
    let slices = sizes.get(2).map(|&depth| Slices::along(&axis("--z", "f0", depth)).unwrap());
    Layout { x, y, slices, channels: packing(flags).channels() }
}

/// The program in a folder.
pub fn splitsum(folder: &Path, arguments: &str) -> Result<Vec<u8>, Failed> {
    let words = arguments.split_whitespace();
    printed(Command::new(env!("CARGO_BIN_EXE_splitsum")).args(words).current_dir(folder))
}

impl Case {
    /// Bakes the table of these flags as NAME.npy, from which the values are read.
    pub fn bake(folder: &Path, name: &str, flags: &str) -> Result<Case, Failed> {
        // An array has no packed texels: the same values as floats, which are rounded again below.
        let tens = flag(flags, "--precision") == Some("a2b10g10r10");
        let array_flags = flags.replace("a2b10g10r10", "f32");
        splitsum(folder, &format!("bake -q {array_flags} --format npy -o {name}.npy"))?;
        let (components, mut values) = read_npy(&fs::read(folder.join(format!("{name}.npy")))?);
        let precision = flag(flags, "--precision").unwrap_or("f16");
        for value in &mut values {
            *value = match precision {
                "unorm8" => *value / 255.0,
                "unorm16" => *value / 65535.0,
                "srgb8" => srgb::value(*value as u8),
                _ if tens => (*value * 1023.0).round() / 1023.0,
                _ => *value,
            };
        }
        if precision == "rgbd8" {
            for texel in values.chunks_exact_mut(4) {
                let divisor = texel[3] / 255.0;
                texel.iter_mut().for_each(|code| *code = (*code / 255.0).powf(2.2) / divisor);
            }
        }
        let layout = layout(flags);
        let fields = fields(&layout);
        let (name, flags, folder) = (name.to_owned(), flags.to_owned(), folder.to_owned());
        Ok(Case { name, flags, folder, layout, components, values, fields })
    }

    /// The value of a component.
    fn value(&self, slice: usize, i: usize, j: usize, component: usize) -> f64 {
        let (width, height) = (self.layout.x.size(), self.layout.y.size());
        self.values[((slice * height + j) * width + i) * self.components + component]
    }

    /// A component at (n·v, roughness), and F0 where there are slices.
    fn component(&self, [nov, roughness, f0]: [f64; 3], component: usize) -> f64 {
        let parameter = |axis: &Axis| match axis.spec().parameter {
            Parameter::Nov | Parameter::Critical => nov,
            Parameter::Roughness => roughness,
            Parameter::Alpha => roughness * roughness,
            // p = log10(n)/7, n = 2/α² - 2.
            Parameter::Exponent => {
                let n = 2.0 / roughness.powi(4).max(1e-7) - 2.0;
                libm::log10(n.max(1.0)) / 7.0
            }
            Parameter::F0 | Parameter::Ior | Parameter::Control => f0,
        };
        let Layout { x, y, .. } = &self.layout;
        let place = bilinear(x, y, parameter(x), parameter(y));
        let of = |slice| place.read(|i, j| self.value(slice, i, j, component));
        match self.layout.slices.as_ref().and_then(|slices| slices.axis()) {
            None => of(0),
            Some(axis) => {
                let (low, high, weight) = axis.neighbours(f0);
                of(low) + weight * (of(high) - of(low))
            }
        }
    }

    /// The fields at a point.
    pub fn expected(&self, point: [f64; 3]) -> Vec<f64> {
        let mut found: Vec<f64> = Vec::new();
        for field in &self.fields {
            let named = |name: &str| self.fields.iter().position(|field| field.name == name);
            let of = |name: &str| found[named(name).unwrap()];
            found.push(match &field.from {
                &From::Component { index, scale, offset } => {
                    (self.component(point, index) - offset) / scale
                }
                From::Sum(a, b) => of(a) + of(b),
                From::Difference(a, b) => of(a) - of(b),
            });
        }
        found
    }

    /// The largest difference between neighbouring texels in a field: what a sampler blends.
    pub fn step(&self) -> f64 {
        let (width, height) = (self.layout.x.size(), self.layout.y.size());
        let mut largest = 0.0f64;
        for field in &self.fields {
            let From::Component { index, scale, .. } = field.from else { continue };
            for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                let (right, below) = ((i + 1).min(width - 1), (j + 1).min(height - 1));
                let here = self.value(0, i, j, index);
                for there in [self.value(0, right, j, index), self.value(0, i, below, index)] {
                    largest = largest.max((here - there).abs() / scale.abs());
                }
            }
        }
        largest
    }

    /// `count` points as f32: spread, at the ends, near them, and at nodes.
    pub fn points(&self, count: usize) -> Vec<[f32; 3]> {
        let mut random = Random(20_261_126);
        let mut coordinate = |i: usize, nodes: &[f64]| {
            let u = random.next();
            match i % 8 {
                // The ends, and a little beyond, where a shader's rounding may lie.
                0 => [0.0, 1.0, -1e-7, 1.0 + 1e-6][i / 8 % 4],
                1 => 1e-4 * u,
                2 => 1.0 - 1e-4 * u,
                3 => nodes[(u * nodes.len() as f64) as usize],
                _ => u,
            }
        };
        let (x, y) = (self.layout.x.values(), self.layout.y.values());
        (0..count)
            .map(|i| {
                let point =
                    [coordinate(i, &x), coordinate(i / 3, &y), coordinate(i / 5, &[0.04, 0.5])];
                point.map(|value| value as f32)
            })
            .collect()
    }
}

/// A, B and E follow from each other, and scale and offset are gone: against the integrals.
pub fn fields_are_the_integrals() -> Result<(), Failed> {
    let lobe = crate::common::ggx(Masking::HeightCorrelated);
    let rule = splitsum::integrate::rule::Rule::named("h6144")?;
    let folder = tempfile::tempdir()?;
    for flags in [
        "--channels a,b --precision f32 --size 4",
        "--channels e*0.5+0.25,b --precision f32 --size 4",
        "--channels 1-e,a --precision f32 --size 4",
    ] {
        let case = Case::bake(folder.path(), "fields", flags)?;
        for (i, j) in (0..4).flat_map(|j| (0..4).map(move |i| (i, j))) {
            let (mu, roughness) = (case.layout.x.value(i), case.layout.y.value(j));
            let truth =
                splitsum::backend::cpu::bake_points(lobe, &[(mu, roughness.powi(2))], &rule)
                    .scale_bias()[0];
            let found = case.expected([mu, roughness, 0.0]);
            for (name, value) in [("A", truth.a), ("B", truth.b), ("E", truth.e())] {
                let place = case.fields.iter().position(|field| field.name == name).unwrap();
                // f32 stores halves of E to 1.5e-8, and the difference doubles it.
                assert!((found[place] - value).abs() < 1e-6, "{flags}: {name}");
            }
        }
    }
    Ok(())
}
