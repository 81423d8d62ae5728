//! `splitsum chart`

mod speed;
mod stability;
mod table;

use super::output;
use super::table_args::{DEFAULT_OUTPUT, TableArgs};
use crate::backend::vulkan::devices::{DeviceInfo, list_devices};
use crate::backend::vulkan::gpu::{Gpu, GpuOptions};
use crate::draw::Drawing;
use crate::encode::png::encode_rgb;
use crate::error::{Error, Result};
use crate::study::{Device, Machine};
use clap::Subcommand;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::Path;

#[derive(Subcommand)]
pub enum ChartArgs {
    /// Draw a table: a panel for each channel, dark at 0, yellow at the channel's largest value, which is printed
    Table(Box<TableArgs>),
    /// Measure speed against accuracy, the field's estimators beside ours, on this CPU and on every Vulkan device
    Speed(speed::SpeedArgs),
    /// Map where formulas and methods fail: into the corners of angle and roughness, in f64, in f32 and on every Vulkan device
    Stability(stability::StabilityArgs),
}

/// What every study takes.
#[derive(clap::Args)]
pub struct StudyArgs {
    /// Fewer points and smaller tables: seconds instead of minutes
    #[arg(long)]
    quick: bool,
    /// The one Vulkan device to measure, by UUID or a part of its name [default: all of them]
    #[arg(long, value_name = "NAME|UUID", conflicts_with = "cpu")]
    device: Option<String>,
    /// Measure the CPU alone
    #[arg(long)]
    cpu: bool,
    /// The folder for the charts (SVG and PNG), a page about them (Markdown) and the measurements (JSON; of speed CSV too)
    #[arg(short, long, value_name = "FOLDER", default_value = "out")]
    output: String,
    /// Measure nothing, and draw what this JSON file of an earlier run holds
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "device", "cpu"])]
    from: Option<String>,
    /// Show no progress
    #[arg(short, long)]
    quiet: bool,
}

/// The Vulkan devices of a study.
struct Devices {
    infos: Vec<DeviceInfo>,
    options: Vec<GpuOptions>,
}

pub fn run(arguments: &ChartArgs) -> Result<()> {
    match arguments {
        ChartArgs::Table(table) => table::run(table),
        ChartArgs::Speed(arguments) => speed::run(arguments),
        ChartArgs::Stability(arguments) => stability::run(arguments),
    }
}

impl StudyArgs {
    /// The folder, once it is known that the files can be written there.
    fn folder(&self, files: &[impl AsRef<str>]) -> Result<String> {
        let folder = self.output.trim_end_matches(std::path::is_separator);
        if Path::new(DEFAULT_OUTPUT).parent() == Some(Path::new(folder)) {
            let failed = output::failed("create the folder", folder, "choose another with -o");
            fs::create_dir_all(folder).map_err(failed)?;
        }
        files.iter().try_for_each(|file| output::check(&format!("{folder}/{}", file.as_ref())))?;
        Ok(folder.into())
    }

    /// The devices to measure: none where there is no driver, or none is wanted.
    fn devices(&self) -> Result<Devices> {
        let named = |device: &str| GpuOptions { device: Some(device.into()), ..GpuOptions::default() };
        let infos = match &self.device {
            Some(name) => vec![Gpu::open(&named(name))?.info().clone()],
            None if self.cpu => Vec::new(),
            None => list_devices().unwrap_or_default().into_iter().filter(|info| info.unusable.is_none()).collect(),
        };
        let options = infos.iter().map(|info| named(&info.uuid)).collect();
        Ok(Devices { infos, options })
    }
}

impl Devices {
    fn open(&self) -> Result<Vec<Gpu>> {
        self.options.iter().map(Gpu::open).collect()
    }

    fn machine(&self) -> Machine {
        let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = about.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
        Machine {
            processor: name.map_or_else(|| format!("{} processor", std::env::consts::ARCH), str::to_owned),
            threads: rayon::current_num_threads(),
            devices: self.infos.iter().map(Device::from).collect(),
            version: env!("CARGO_PKG_VERSION").into(),
        }
    }
}

/// Writes a drawing as `name`.svg and `name`.png, the latter with twice the pixels, for sharp screens.
fn write_drawing(folder: &str, name: &str, drawing: &Drawing) -> Result<()> {
    let picture = drawing.to_picture(2.0)?;
    output::write(&format!("{folder}/{name}.svg"), drawing.to_svg()?.as_bytes())?;
    output::write(&format!("{folder}/{name}.png"), &encode_rgb(picture.width, picture.height, &picture.rgb)?)
}

fn write_json(path: &str, study: &impl Serialize) -> Result<()> {
    let json = serde_json::to_string(study).map_err(|error| Error::Internal(error.to_string()))?;
    output::write(path, json.as_bytes())
}

/// Reads what [`write_json`] wrote.
fn read_study<T: DeserializeOwned>(path: &str) -> Result<T> {
    let text = fs::read_to_string(path).map_err(output::failed("read", path, "name the .json of an earlier run"))?;
    serde_json::from_str(&text).map_err(|error| {
        Error::bad_input(path, "measurements that this command has saved", error.to_string(), "measure anew")
    })
}
