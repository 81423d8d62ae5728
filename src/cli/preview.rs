//! `splitsum preview`

mod planned;

use super::choices;
use super::device_args::DeviceArgs;
use super::progress::Progress;
use super::{output, resources};
use crate::backend::device::GpuOptions;
use crate::brdf::{Microfacet, Ndf};
use crate::choice::choice;
use crate::error::Result;
use crate::preview::{ROUGHNESSES, Row, Scene, render};
use std::io::Write;

#[derive(clap::Args)]
pub struct PreviewArgs {
    /// Light on the spheres
    #[arg(
        long, value_name = "NAME", default_value = "punctual",
        value_parser = choices::of::<Light>()
    )]
    scene: Light,
    /// Show the materials of a plan in a furnace instead, on the CPU, since the lookup is the
    /// plan's own: E(F0) by that lookup, by the integral, their difference times 100, at either end
    /// of the range of F0; columns from smooth to rough
    #[arg(
        long, value_name = "PLAN.toml", conflicts_with_all = ["scene", "backend", "device"]
    )]
    plan: Option<String>,
    /// Pixels along the edge of a sphere's cell, 16 to 512
    #[arg(
        long, value_name = "N", default_value_t = 96,
        value_parser = clap::value_parser!(u16).range(16..=512)
    )]
    size: u16,
    #[command(flatten)]
    device: DeviceArgs,
    /// Picture to write
    #[arg(short, long, value_name = "FILE.png", default_value = "preview.png")]
    output: String,
}

/// The light of a preview.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    Punctual,
    Furnace,
    Sky,
}

choice!(Light, "scene", {
    Punctual = "punctual", "one light; Blinn-Phong, Beckmann and GGX below each other";
    Furnace = "furnace", "from everywhere; for Beckmann and GGX the split sum with a table, the \
                          integral, their difference times 100";
    Sky = "sky", "a sky; Blinn-Phong, Beckmann and GGX below each other";
});

pub fn run(arguments: &PreviewArgs) -> Result<()> {
    let (name, size) = (&arguments.output, usize::from(arguments.size));
    if let Some(plan) = &arguments.plan {
        return planned::run(plan, name, size);
    }
    output::check_picture(name)?;
    // A pixel of a row has its light, and of the picture its colour, twice while it is encoded; the
    // most scenes have six rows.
    let bytes = (ROUGHNESSES.len() * size * size * (24 + 6 * 6) + (16 << 20)) as u64;
    resources::start(bytes, None, resources::ALLOW)?;
    let rows = rows(arguments.scene)?;
    let backend = arguments.device.open(GpuOptions::default(), bytes)?;
    let progress = Progress::of_pixels(name, rows.len() * ROUGHNESSES.len() * size * size);
    let picture = render(&rows, size, &backend, &|pixels| progress.advance(pixels))?;
    drop(progress);
    output::write_picture(name, &picture)?;
    let device = backend.device().map_or("the CPU", |gpu| &gpu.info().name);
    let lobes: Vec<String> =
        rows.iter().map(|row| format!("{} {}", row.lobe.ndf, row.scene.about())).collect();
    let roughnesses = ROUGHNESSES.map(|r| r.to_string()).join(", ");
    let lines = format!(
        "wrote     {name}, rendered by {device}\nrows      {}\nroughness {roughnesses}",
        lobes.join(", ")
    );
    let _ = writeln!(std::io::stderr(), "{lines}");
    Ok(())
}

fn rows(light: Light) -> Result<Vec<Row>> {
    let lobe = |ndf: Ndf| Microfacet { ndf, masking: ndf.default_masking() };
    let each = |ndfs: &[Ndf], scenes: &[Scene]| {
        let pairs = ndfs.iter().flat_map(|&ndf| scenes.iter().map(move |&scene| (ndf, scene)));
        pairs.map(|(ndf, scene)| Row::new(lobe(ndf), scene)).collect()
    };
    let all = [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx];
    match light {
        Light::Punctual => each(&all, &[Scene::Punctual]),
        Light::Furnace => each(
            &all[1..],
            &[Scene::FurnaceTable, Scene::FurnaceIntegral, Scene::FurnaceDifference],
        ),
        Light::Sky => each(&all, &[Scene::Sky]),
    }
}
