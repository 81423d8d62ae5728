//! The files that readers are tried on, with the values that they have to find.

use crate::common::{Random, ggx};
use splitsum::approximation::table::Promise;
use splitsum::approximation::{
    Across, Along, Approximation, Channels, Numbers, Region, Shape, Storage,
};
use splitsum::backend::Backend;
use splitsum::brdf::{Fresnel, Masking};
use splitsum::format::encoding::Supercompress;
use splitsum::format::{Encoding, Format, Style};
use splitsum::lut::{Energy, EnergyChannels, Lut, Packing, terms};
use splitsum::request::Request;
use splitsum::table::Table;
use splitsum::table::precision::Precision;
use splitsum::table::slices::{Slices, SlicesAs};
use splitsum::table::{rgbd, srgb};
use splitsum::units::F0;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Columns and rows of tables: Babylon.js reads powers of two alone.
const SIZE: (usize, usize) = (32, 16);

/// A file on the disk.
#[derive(Debug)]
pub struct File {
    pub path: PathBuf,
    /// Columns and rows.
    pub size: (usize, usize),
    pub precision: Precision,
    pub components: usize,
    pub slices: usize,
    pub style: Style,
    /// Slice by slice, row by row, the components of a texel side by side: of codes the fraction of
    /// the largest.
    pub values: Vec<f64>,
}

/// The formats that have readers.
const FORMATS: [&str; 5] = ["exr", "png", "ktx2", "dds", "npy"];

impl File {
    /// Its extension.
    pub fn kind(&self) -> &str {
        self.path.extension().and_then(|extension| extension.to_str()).unwrap_or_default()
    }

    /// The file with this ending beside it.
    pub fn beside(&self, ending: &str) -> PathBuf {
        PathBuf::from(format!("{}.{ending}", self.path.display()))
    }
}

/// A file of every format and storage, with every number of components, and slices.
pub fn write_all(folder: &Path) -> Vec<File> {
    let mut files = Vec::new();
    for extension in FORMATS {
        for &precision in Format::named(extension).unwrap().precisions() {
            for channels in ["e", "a,b", "b,e,burley*0.5", "a,b,roughness,1"] {
                let count = channels.split(',').count();
                let of_three = matches!(precision, Precision::Rgbd8) && count > 3;
                let of_two_bits = matches!(precision, Precision::A2b10g10r10) && count < 3;
                if of_three || of_two_bits {
                    continue;
                }
                let table = packed(channels, precision);
                files.extend(write(folder, extension, &table, Style::default()));
                let two = Style { components: Some(2), ..Style::default() };
                if extension == "dds" && count == 2 && precision != Precision::Srgb8 {
                    files.extend(write(folder, extension, &table, two));
                }
            }
        }
        for slices in [SlicesAs::Layers, SlicesAs::Depth] {
            let takes_both = ["ktx2", "dds"].contains(&extension);
            if extension == "png" || slices == SlicesAs::Depth && !takes_both {
                continue;
            }
            let style = Style { slices, ..Style::default() };
            files.extend(write(folder, extension, &sliced(), style));
        }
    }
    for channels in ["a,b", "b,e,burley*0.5"] {
        let style = Style { supercompress: Supercompress::Zstd, ..Style::default() };
        files.extend(write(folder, "ktx2", &packed(channels, Precision::F16), style));
    }
    files.extend(write_nets(folder));
    files
}

/// The control points of a plan, one channel and two, in every storage that a table of them has and
/// every format that takes it. Rows end at odd bytes.
fn write_nets(folder: &Path) -> Vec<File> {
    let mut files = Vec::new();
    for storage in [Storage::Unorm8, Storage::Unorm16, Storage::F32] {
        for (channels, size) in [(Channels::EnergyRest, [7, 9]), (Channels::Ratio, [5, 6])] {
            let net = net(storage, channels, size);
            let table = net.table(&promise()).unwrap();
            for extension in FORMATS {
                let Some(file) = write(folder, extension, &table, Style::default()) else {
                    continue;
                };
                assert_eq!(first_components(&file, channels.count()), stored(&net), "{file:?}");
                files.push(file);
            }
        }
    }
    files
}

/// A net of random control points.
fn net(storage: Storage, channels: Channels, size: [usize; 2]) -> Approximation {
    let mut random = Random(20_261_128);
    let mut points = || (0..size[0] * size[1]).map(|_| random.next() - 0.5).collect::<Vec<f64>>();
    let numbers = (0..channels.count()).map(|_| storage.store(&points())).collect();
    let shape = Shape::Spline { x: Along::Layer(3.0), y: Across::Sqrt, size, degree: 3 };
    let region = Region { least_nov: 0.0, roughness: [0.0, 1.0] };
    Approximation { lobe: ggx(Masking::HeightCorrelated), region, channels, shape, numbers }
}

/// What a plan would say of it.
fn promise() -> Promise {
    let (tolerance, command) = ("0.004".to_owned(), "splitsum plan".to_owned());
    Promise { tolerance, f0: [0.0, 1.0], measured_error: (0.003, 1000), command }
}

/// The numbers of a net, point by point: of codes the fraction of the largest.
fn stored(net: &Approximation) -> Vec<f64> {
    let count = net.numbers[0].len();
    let number = |index: usize, numbers: &Numbers| match numbers {
        Numbers::Floats(floats) | Numbers::Halves(floats) => f64::from(floats[index]),
        Numbers::Codes { last, codes, .. } => f64::from(codes[index]) / f64::from(*last),
    };
    (0..count).flat_map(|i| net.numbers.iter().map(move |channel| number(i, channel))).collect()
}

/// The first components of each texel: formats fill up the rest.
fn first_components(file: &File, count: usize) -> Vec<f64> {
    let texels = file.values.chunks(file.components);
    texels.flat_map(|texel| texel[..count].iter().copied()).collect()
}

/// A table of these channels.
fn packed(channels: &str, precision: Precision) -> Table {
    let lobe = ggx(Masking::HeightCorrelated);
    let packing: Packing = terms::packing(lobe, Fresnel::Schlick, channels).unwrap();
    let request = Request::with_default_axes(packing, SIZE, precision).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

/// A table of three slices.
fn sliced() -> Table {
    let f0s = [0.02, 0.04, 0.5].map(|f0| F0::new(f0).unwrap());
    let lobe = ggx(Masking::HeightCorrelated);
    let energy = Energy::new(lobe, f0s[0], EnergyChannels::Split).unwrap();
    let request = Request::with_default_axes(Lut::Energy(energy), SIZE, Precision::F16).unwrap();
    let request = request.with_slices(Slices::at_f0s(&f0s).unwrap()).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

/// Writes a table, its values and its bytes; none where the format has not so few components.
fn write(folder: &Path, extension: &str, table: &Table, style: Style) -> Option<File> {
    let format = Format::named(extension).unwrap();
    let (layout, precision) = (table.layout(), table.precision());
    let encoding = Encoding::new(format, style.clone(), layout, precision).ok()?;
    let (components, slices) = (encoding.components(), layout.slice_count());
    let size = (table.x().size(), table.y().size());
    let name = format!(
        "{}x{}_{precision}_{}_{components}_{slices}_{}_{}.{extension}",
        size.0,
        size.1,
        layout.channels.len(),
        style.slices,
        style.supercompress
    );
    let path = folder.join(name);
    let mut bytes = Cursor::new(Vec::new());
    encoding.write(table, &mut bytes).unwrap();
    fs::write(&path, bytes.get_ref()).unwrap();
    let values: Vec<f64> =
        (0..slices).flat_map(|slice| values_of(table, slice, components)).collect();
    let file = File { path, size, precision, components, slices, style, values };
    let le: Vec<u8> = file.values.iter().flat_map(|value| value.to_le_bytes()).collect();
    fs::write(file.beside("f64"), le).unwrap();
    let mut raw = Cursor::new(Vec::new());
    let raw_style = Style { components: Some(components), ..Style::default() };
    let raw_encoding =
        Encoding::new(Format::named("raw").unwrap(), raw_style, layout, precision).unwrap();
    raw_encoding.write(table, &mut raw).unwrap();
    fs::write(file.beside("raw"), raw.get_ref()).unwrap();
    Some(file)
}

/// The components of the texels of a slice.
fn values_of(table: &Table, slice: usize, components: usize) -> Vec<f64> {
    let (columns, rows) = (table.x().size(), table.y().size());
    let texels = (0..rows).flat_map(|j| (0..columns).map(move |i| table.texel(slice, i, j)));
    let filled = |texel: Vec<f64>| -> Vec<f64> {
        let filler = |component: usize| if component == 3 { 1.0 } else { 0.0 };
        match table.precision() {
            Precision::Rgbd8 => {
                let (codes, divisor) = rgbd::codes(&texel);
                let code = |c: usize| if c == 3 { divisor } else { *codes.get(c).unwrap_or(&0) };
                (0..components).map(|c| f64::from(code(c)) / 255.0).collect()
            }
            Precision::Srgb8 => (0..components)
                .map(|c| texel.get(c).map_or(filler(c), |&v| f64::from(srgb::code(v)) / 255.0))
                .collect(),
            _ => (0..components).map(|c| texel.get(c).copied().unwrap_or(filler(c))).collect(),
        }
    };
    texels.flat_map(filled).collect()
}
