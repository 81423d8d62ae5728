//! `splitsum preview`

mod planned;

use super::choices;
use super::device_args::DeviceArgs;
use super::progress::Progress;
use super::{output, resources};
use crate::backend::device::GpuOptions;
use crate::brdf::{Microfacet, Ndf};
use crate::choice::{Choice, choice};
use crate::error::{Complaint, Result};
use crate::preview::material::{self, Material};
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
    Glass,
    Coat,
    Metal,
}

choice!(Light, "scene", {
    Punctual = "punctual", "one light; Blinn-Phong, Beckmann and GGX below each other";
    Furnace = "furnace", "from everywhere; for Beckmann and GGX the split sum with a table, the \
                          integral, their difference times 100";
    Sky = "sky", "a sky; Blinn-Phong, Beckmann and GGX below each other";
    Glass = "glass", "glass of n = 1.5 in the furnace, then under the sky, on the CPU: with a \
                      table, by the integral, their difference times 100";
    Coat = "coat", "the same of a red base below an interface of n = 1.5";
    Metal = "metal", "the same of gold by its measured index";
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
    let backend = arguments.device.open(GpuOptions::default(), bytes)?;
    let rows = match arguments.scene {
        Light::Punctual => Rows::Lobes(rows(&ALL, &[Scene::Punctual])?),
        Light::Furnace => Rows::Lobes(rows(&ALL[1..], &FURNACE)?),
        Light::Sky => Rows::Lobes(rows(&ALL, &[Scene::Sky])?),
        Light::Glass => Rows::Of(Material::Glass),
        Light::Coat => Rows::Of(Material::Coat),
        Light::Metal => Rows::Of(Material::Metal),
    };
    let progress = Progress::of_pixels(name, rows.count() * ROUGHNESSES.len() * size * size);
    let told = |pixels| progress.advance(pixels);
    let (picture, device) = match &rows {
        Rows::Lobes(rows) => {
            let device = backend.device().map_or("the CPU", |gpu| &gpu.info().name);
            (render(rows, size, &backend, &told)?, device.to_string())
        }
        Rows::Of(material) => {
            let expected = "punctual, furnace or sky, for a device";
            let got = arguments.scene.word();
            let complaint = Complaint::new("scene", expected, got, "use --backend cpu");
            let reason = backend.choose(Some(complaint), 0.0)?.reason;
            let reason =
                reason.map_or(String::new(), |reason| format!("; not on Vulkan: {reason}"));
            (material::render(*material, size, &told)?, format!("the CPU{reason}"))
        }
    };
    drop(progress);
    output::write_picture(name, &picture)?;
    let roughnesses = ROUGHNESSES.map(|r| r.to_string()).join(", ");
    let lines = format!(
        "wrote     {name}, rendered by {device}\nrows      {}\nroughness {roughnesses}",
        rows.about()
    );
    let _ = writeln!(std::io::stderr(), "{lines}");
    Ok(())
}

/// What a picture shows.
enum Rows {
    /// A row for each lobe and light.
    Lobes(Vec<Row>),
    /// The rows of a material.
    Of(Material),
}

impl Rows {
    fn count(&self) -> usize {
        match self {
            Rows::Lobes(rows) => rows.len(),
            Rows::Of(_) => material::ROWS.len(),
        }
    }

    fn about(&self) -> String {
        match self {
            Rows::Lobes(rows) => {
                let about = |row: &Row| format!("{} {}", row.lobe.ndf, row.scene.about());
                rows.iter().map(about).collect::<Vec<_>>().join(", ")
            }
            Rows::Of(_) => "in a furnace with a table, by the integral, their difference times \
                            100; the same under a sky"
                .into(),
        }
    }
}

const ALL: [Ndf; 3] = [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx];

const FURNACE: [Scene; 3] = [Scene::FurnaceTable, Scene::FurnaceIntegral, Scene::FurnaceDifference];

fn rows(ndfs: &[Ndf], scenes: &[Scene]) -> Result<Vec<Row>> {
    let lobe = |ndf: Ndf| Microfacet { ndf, masking: ndf.default_masking() };
    let pairs = ndfs.iter().flat_map(|&ndf| scenes.iter().map(move |&scene| (ndf, scene)));
    pairs.map(|(ndf, scene)| Row::new(lobe(ndf), scene)).collect()
}
