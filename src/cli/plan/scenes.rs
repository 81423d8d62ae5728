//! The scenes of a plan: files, or values.

use super::PlanArgs;
use super::outputs::read_at_most;
use crate::brdf::{Microfacet, Ndf};
use crate::cli::usage;
use crate::error::{Error, Result};
use crate::planner::domain::Domain;
use crate::scene::{Assumptions, Layer, Scene, Span, of_values, read};
use std::path::Path;

/// A scene, or a file that it names, larger than this is refused.
const LARGEST_SCENE: u64 = 512 << 20;

/// The scenes, read, or made of the values that are given.
pub fn scenes(arguments: &PlanArgs) -> Result<Vec<Scene>> {
    match (&arguments.roughness, &*arguments.scenes) {
        (Some(_), [_, ..]) => {
            Err(usage("plan", "scenes or --roughness", "both", "leave one of them out"))
        }
        (None, []) => Err(usage("plan", "a scene", "none", "name one, or give --roughness")),
        (Some(roughness), []) => {
            let roughness = roughness
                .split(',')
                .map(|words| span("roughness", words))
                .collect::<Result<Vec<_>>>()?;
            let f0 = arguments.f0.as_deref().map_or(Ok(Span::UNIT), |words| span("F0", words))?;
            Ok(vec![of_values(&roughness, f0, Span::point(1.0))])
        }
        (None, scenes) => scenes.iter().map(|name| scene(name, arguments)).collect(),
    }
}

/// A number or a range within [0, 1].
fn span(what: &str, words: &str) -> Result<Span> {
    let (low, high) = words.split_once("..").unwrap_or((words, words));
    let number = |word: &str| word.trim().parse::<f64>().ok().filter(|n| (0.0..=1.0).contains(n));
    match (number(low), number(high)) {
        (Some(low), Some(high)) => Span::new(what, low, high),
        _ => {
            let got = format!("'{words}'");
            Err(Error::bad_input(what, "a number or a range from 0 to 1", got, "as in 0.3..1"))
        }
    }
}

fn scene(name: &str, arguments: &PlanArgs) -> Result<Scene> {
    let bytes = bytes_of(Path::new(name), name)?;
    let assumptions = Assumptions {
        specular_antialiasing: arguments.specular_antialiasing,
        least_roughness: arguments.least_roughness,
        ignore_texels: arguments.ignore_texels,
    };
    let folder = Path::new(name).parent().unwrap_or(Path::new(""));
    let files = |path: &str| bytes_of(&folder.join(path), path);
    read(name, &bytes, &assumptions, &files)
}

/// The bytes of a file that is not too large; devices and pipes that never end are refused too.
fn bytes_of(path: &Path, name: &str) -> Result<Vec<u8>> {
    let failed = Error::io("read", name, "name a file that can be read");
    read_at_most(path, LARGEST_SCENE).map_err(failed)?.ok_or_else(|| {
        Error::bad_input(name, "at most 512 MiB", "more".to_owned(), "make it smaller")
    })
}

/// The domain of the layers that have this lobe.
pub fn domain(scenes: &[Scene], lobe: Microfacet, arguments: &PlanArgs) -> Result<Domain> {
    let of_sheen = lobe.ndf == Ndf::Charlie && arguments.roughness.is_none();
    let layers: &[Layer] =
        if of_sheen { &[Layer::Sheen] } else { &[Layer::Base, Layer::Clearcoat] };
    let mut domain = Domain::of(scenes, layers, arguments.nov_min);
    if of_sheen {
        // A colour multiplies the albedo of sheen: E alone is looked up.
        domain.pieces.iter_mut().for_each(|piece| piece.f0 = [1.0, 1.0]);
    }
    if domain.pieces.is_empty() {
        let layers = layers.iter().map(|layer| layer.to_string()).collect::<Vec<_>>().join(" or ");
        let cure = "name another scene, or another --model";
        return Err(Error::bad_input("scene", format!("a layer that is {layers}"), "none", cure));
    }
    Ok(domain)
}
