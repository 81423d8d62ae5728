//! `splitsum chart`

mod bounds;
mod speed;
mod stability;
mod table;

use super::progress::Progress;
use super::table_args::{FLAGS_OF_FILES, TableArgs};
use super::{output, place, resources, usage};
use crate::backend::device::{DeviceInfo, GpuOptions};
use crate::backend::{Gpu, list_devices};
use crate::compare::draw::Drawing;
use crate::compare::study::{Device, Machine};
use crate::error::{Error, Result};
use crate::format::metadata::TOOL;
use clap::Subcommand;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;

#[derive(Subcommand)]
pub enum ChartArgs {
    /// Draw a table: a panel for each channel, a row of them for each slice, dark at 0, yellow at
    /// the channel's largest value, which is printed
    #[command(mut_args(of_picture))]
    Table(Box<TableArgs>),
    /// Measure speed against accuracy, the field's estimators beside ours, on this CPU and on every
    /// Vulkan device
    Speed(speed::SpeedArgs),
    /// Map where formulas and methods fail: into the corners of angle and roughness, in f64, in f32
    /// and on every Vulkan device
    Stability(stability::StabilityArgs),
    /// Climb towards the largest error over its bound, of every rule, lobe and channel, on this CPU
    /// and on every Vulkan device
    Bounds(bounds::BoundsArgs),
}

/// The flags of every study.
#[derive(clap::Args)]
pub struct StudyArgs {
    /// Fewer points and smaller tables: seconds instead of minutes
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    measured: MeasuredArgs,
    /// The folder for the charts (SVG and PNG), a page about them (Markdown) and the measurements
    /// (JSON; of speed CSV too)
    #[arg(short, long, value_name = "FOLDER", default_value = output::DEFAULT_FOLDER)]
    output: String,
    /// Measure nothing, and draw what this JSON file of an earlier run holds
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "device", "cpu"])]
    from: Option<String>,
}

/// The flags of what measures this machine.
#[derive(clap::Args)]
pub struct MeasuredArgs {
    /// The one Vulkan device to measure, by UUID or a part of its name [default: all of them]
    #[arg(long, value_name = "NAME|UUID", conflicts_with = "cpu")]
    device: Option<String>,
    /// Measure the CPU alone
    #[arg(long)]
    cpu: bool,
    /// Show no progress
    #[arg(short, long)]
    quiet: bool,
}

/// The flags of a table as those of its picture.
fn of_picture(argument: clap::Arg) -> clap::Arg {
    match argument.get_id().as_str() {
        "output" => argument.help("Picture to write, a .png [default: out/dfg.png]"),
        name if FLAGS_OF_FILES.iter().any(|flag| flag.0.replace('-', "_") == name) => {
            argument.hide(true)
        }
        _ => argument,
    }
}

/// The memory of a study on the CPU, about; a device's driver has memory of its own.
const STUDY_BYTES: u64 = 128 << 20;

/// The measurements that are saved beside the charts.
#[derive(Serialize, Deserialize)]
struct Saved<T> {
    tool: String,
    machine: Machine,
    #[serde(flatten)]
    measured: T,
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
        ChartArgs::Bounds(arguments) => bounds::run(arguments),
    }
}

impl StudyArgs {
    /// The folder, once it is known that the files can be written there.
    fn folder(&self, files: &[impl AsRef<str>]) -> Result<String> {
        let folder = self.output.trim_end_matches(std::path::is_separator);
        let paths = files.iter().map(|file| format!("{folder}/{}", file.as_ref()));
        let mut written = place::Files::default();
        if let Some(file) = &self.from {
            written.add("the file of measurements", file);
        }
        // What is read from a file is not saved again.
        for path in paths.filter(|path| self.from.is_none() || !path.ends_with(".json")) {
            output::check(&path)?;
            if let Some(other) = written.add(path.as_str(), &path) {
                let got = format!("{path}, which is {other}");
                return Err(usage(
                    "output",
                    "a file of its own for each chart",
                    &got,
                    "choose another folder with -o",
                ));
            }
        }
        Ok(folder.into())
    }

    /// Reads what an earlier run saved, or measures by `measure` and saves that at `path`.
    fn saved<T: Serialize + DeserializeOwned>(
        &self,
        path: &str,
        measure: impl FnOnce(&Devices, &Progress) -> Result<T>,
    ) -> Result<Saved<T>> {
        if let Some(file) = &self.from {
            return read_study(file);
        }
        let (devices, progress) = self.measured.start("measuring")?;
        let measured = measure(&devices, &progress)?;
        let saved = Saved { tool: TOOL.into(), machine: devices.machine(), measured };
        let json =
            serde_json::to_string(&saved).map_err(|error| Error::Internal(error.to_string()))?;
        output::write(path, json.as_bytes())?;
        Ok(saved)
    }
}

impl MeasuredArgs {
    /// Starts threads for work of this name; its devices, and its bar.
    fn start(&self, work: &str) -> Result<(Devices, Progress)> {
        resources::start(STUDY_BYTES, None, resources::ALLOW)?;
        Ok((self.devices()?, Progress::of_work(work, self.quiet)))
    }

    /// The one that is named, or all; none where there is no driver, or the CPU alone is wanted.
    fn devices(&self) -> Result<Devices> {
        let named =
            |device: &str| GpuOptions { device: Some(device.into()), ..GpuOptions::default() };
        let infos = match &self.device {
            Some(name) => vec![Gpu::open(&named(name))?.info().clone()],
            None if self.cpu => Vec::new(),
            None => list_devices()
                .unwrap_or_default()
                .into_iter()
                .filter(|info| info.unusable.is_none())
                .collect(),
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
        Machine {
            processor: Machine::processor_in(&about)
                .map_or_else(|| format!("{} processor", std::env::consts::ARCH), str::to_owned),
            threads: rayon::current_num_threads(),
            devices: self.infos.iter().map(Device::from).collect(),
            version: env!("CARGO_PKG_VERSION").into(),
        }
    }
}

/// Drawings, and pages with their extensions, by their names.
type Files = (Vec<(&'static str, Drawing)>, Vec<(&'static str, String)>);

/// Writes drawings and pages.
fn write_files(folder: &str, (drawings, pages): &Files) -> Result<()> {
    for (name, drawing) in drawings {
        write_drawing(folder, name, drawing)?;
    }
    for (name, page) in pages {
        output::write(&format!("{folder}/{name}"), page.as_bytes())?;
    }
    Ok(())
}

/// Writes a drawing as `name`.svg and `name`.png, the latter with twice the pixels, for sharp
/// screens.
fn write_drawing(folder: &str, name: &str, drawing: &Drawing) -> Result<()> {
    output::write(&format!("{folder}/{name}.svg"), drawing.to_svg()?.as_bytes())?;
    output::write_picture(&format!("{folder}/{name}.png"), &drawing.to_picture(2.0)?)
}

/// Reads what [`StudyArgs::saved`] wrote.
fn read_study<T: DeserializeOwned>(path: &str) -> Result<Saved<T>> {
    let cure = "name the .json of an earlier run";
    study(path, &fs::read(path).map_err(Error::io("read", path, cure))?)
}

/// The measurements with these bytes at `path`.
fn study<T: DeserializeOwned>(path: &str, bytes: &[u8]) -> Result<Saved<T>> {
    serde_json::from_slice(bytes).map_err(|error| {
        let expected = "measurements that this command has saved";
        Error::bad_input(path, expected, error.to_string(), "measure anew")
    })
}

/// Draws the measurements of either study with these bytes, without a disk.
#[doc(hidden)]
pub fn draw(bytes: &[u8]) -> Result<()> {
    let path = "a study";
    let (drawings, _) = match study(path, bytes) {
        Ok(saved) => stability::files(path, &saved)?,
        Err(_) => speed::files(&study(path, bytes)?),
    };
    for (_, drawing) in drawings {
        drawing.to_svg()?;
        drawing.to_picture(1.0)?;
    }
    Ok(())
}
