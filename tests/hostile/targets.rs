//! What reads bytes of others: each takes any bytes, and may refuse them.

use splitsum::foreign::{Foreign, Reading};
use splitsum::scene::{self, Assumptions};
use splitsum::{Axis, AxisSpec, Error, Estimator, Fresnel, Masking, Microfacet, Ndf};

/// A reader of hostile bytes.
pub struct Target {
    /// Its name, that of its folder in the corpus.
    pub name: &'static str,
    /// Reads bytes.
    pub read: fn(&[u8]),
}

/// All of them.
pub const TARGETS: [Target; 11] = [
    Target { name: "exr", read: container },
    Target { name: "ktx2", read: container },
    Target { name: "dds", read: container },
    Target { name: "png", read: container },
    Target { name: "npy", read: container },
    Target { name: "raw", read: raw },
    Target { name: "source", read: source },
    Target { name: "config", read: |bytes| _ = splitsum::cli::count_tables(bytes) },
    Target { name: "study", read: |bytes| _ = splitsum::cli::draw_study(bytes) },
    Target { name: "words", read: words },
    Target { name: "scene", read: scene },
];

/// A container by its first bytes.
fn container(bytes: &[u8]) {
    table(bytes, &Reading::default());
}

/// A line with a layout, and texels.
fn raw(bytes: &[u8]) {
    let (line, texels) = first_line(bytes);
    let layout = std::str::from_utf8(line).ok().and_then(|words| words.parse().ok());
    if let Some(layout) = layout {
        table(&texels[1.min(texels.len())..], &Reading { raw: Some(layout), array: None });
    }
}

/// The first line, and what begins with its end.
fn first_line(bytes: &[u8]) -> (&[u8], &[u8]) {
    let end = bytes.iter().position(|&byte| byte == b'\n').unwrap_or(bytes.len());
    bytes.split_at(end)
}

/// Source code, whose first line names an array where it begins with a colon.
fn source(bytes: &[u8]) {
    let Some(named) = bytes.strip_prefix(b":") else { return container(bytes) };
    let (line, code) = first_line(named);
    let array = String::from_utf8_lossy(line).into_owned();
    table(code, &Reading { raw: None, array: Some(array) });
}

/// A table that is read has as many numbers as it says.
fn table(bytes: &[u8], reading: &Reading) {
    if let Ok(table) = Foreign::read("hostile", bytes, reading) {
        let [columns, rows, slices] = table.size;
        assert_eq!(table.values.len(), columns * rows * slices * table.components());
    }
}

/// Words of axes, estimators and terms of channels.
fn words(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(spec) = text.parse::<AxisSpec>() {
        let axes = [1, 2, 17].map(|size| Axis::new(spec, size));
        // Words of an axis that there can be are written as words of the same axis.
        if axes.iter().any(Result::is_ok) {
            assert_eq!(spec.to_string().parse::<AxisSpec>().ok(), Some(spec));
        }
    }
    if let Ok(estimator) = text.parse::<Estimator>() {
        assert_eq!(estimator.to_string().parse::<Estimator>().ok(), Some(estimator));
    }
    let lobe = Microfacet { ndf: Ndf::Ggx, masking: Masking::Separable };
    let _ = splitsum::packing(lobe, Fresnel::Schlick, text);
    let _ = text.parse::<Fresnel>();
}

/// glTF, GLB or a list of materials, whose files beside it are the same bytes.
fn scene(bytes: &[u8]) {
    let files = |name: &str| match name.len() % 2 {
        0 => Ok(bytes.to_vec()),
        _ => Err(Error::bad_input(name, "a file", "none", "name one")),
    };
    let _ = scene::read("hostile", bytes, &Assumptions::default(), &files);
}
