//! `splitsum preview`

use super::progress::Progress;
use super::{output, resources};
use crate::backend::BackendChoice;
use crate::backend::vulkan::gpu::GpuOptions;
use crate::error::{Error, Result};
use crate::model::{Microfacet, Ndf};
use crate::preview::{ROUGHNESSES, Row, Scene, render};
use std::io::Write;

#[derive(clap::Args)]
pub struct PreviewArgs {
    /// What lights the spheres: punctual (one light; Blinn-Phong, Beckmann and GGX below each other), furnace (light
    /// from everywhere; for Beckmann and GGX the split sum with a table, the integral, their difference times 100) or
    /// sky
    #[arg(long, value_name = "NAME", default_value = "punctual")]
    scene: String,
    /// Pixels along the edge of a sphere's cell, 16 to 512
    #[arg(long, value_name = "N", default_value_t = 96)]
    size: usize,
    /// auto, vulkan or cpu
    #[arg(long, value_name = "NAME", default_value = "auto")]
    backend: String,
    /// Vulkan device, by UUID or a part of its name that no other has
    #[arg(long, value_name = "NAME|UUID")]
    device: Option<String>,
    /// Where to write
    #[arg(short, long, value_name = "FILE.png", default_value = "preview.png")]
    output: String,
}

pub fn run(arguments: &PreviewArgs) -> Result<()> {
    let PreviewArgs { scene, size, output: name, .. } = arguments;
    if !(16..=512).contains(size) {
        return Err(Error::bad_input("size", "16 to 512", size.to_string(), "give a number in that range"));
    }
    output::check_picture(name)?;
    // A pixel of a row has its light, and of the picture its colour, twice while it is encoded; the most scenes have
    // six rows.
    let bytes = (ROUGHNESSES.len() * size * size * (24 + 6 * 6) + (16 << 20)) as u64;
    resources::start(bytes, None, resources::ALLOW)?;
    let rows = rows(scene)?;
    let choice: BackendChoice = arguments.backend.parse()?;
    let options = GpuOptions { device: arguments.device.clone(), ..GpuOptions::default() };
    let backend = resources::open_backend(choice, &options, bytes)?;
    let progress = Progress::of_pixels(name, rows.len() * ROUGHNESSES.len() * size * size);
    let picture = render(&rows, *size, &backend, &|pixels| progress.advance(pixels))?;
    drop(progress);
    output::write_picture(name, &picture)?;
    let device = backend.device().map_or("the CPU", |gpu| &gpu.info().name);
    let lobes: Vec<String> = rows.iter().map(|row| format!("{:?} {:?}", row.lobe.ndf, row.scene)).collect();
    let roughnesses = ROUGHNESSES.map(|r| r.to_string()).join(", ");
    let lines =
        format!("wrote     {name}, rendered by {device}\nrows      {}\nroughness {roughnesses}", lobes.join(", "));
    let _ = writeln!(std::io::stderr(), "{lines}");
    Ok(())
}

fn rows(scene: &str) -> Result<Vec<Row>> {
    let lobe = |ndf: Ndf| Microfacet { ndf, masking: ndf.default_masking() };
    let each = |ndfs: &[Ndf], scenes: &[Scene]| {
        let pairs = ndfs.iter().flat_map(|&ndf| scenes.iter().map(move |&scene| (ndf, scene)));
        pairs.map(|(ndf, scene)| Row::new(lobe(ndf), scene)).collect()
    };
    let all = [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx];
    match scene {
        "punctual" => each(&all, &[Scene::Punctual]),
        "furnace" => each(&all[1..], &[Scene::FurnaceTable, Scene::FurnaceIntegral, Scene::FurnaceDifference]),
        "sky" => each(&all, &[Scene::Sky]),
        _ => Err(Error::bad_input("scene", "punctual, furnace or sky", format!("'{scene}'"), "name one of these")),
    }
}
