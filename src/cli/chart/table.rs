//! `splitsum chart table`

use crate::backend::BackendChoice;
use crate::backend::device::GpuOptions;
use crate::bake::Plan;
use crate::bake::plan::working_bytes;
use crate::cli::table_args::TableArgs;
use crate::cli::{output, resources, usage};
use crate::error::{Error, Result};
use crate::image::{panels, sequential};
use crate::lut::Lut;
use crate::request::Accuracy;
use crate::table::precision::Precision;

const DEFAULT_OUTPUT: &str = "out/dfg.png";

pub fn run(table: &TableArgs) -> Result<()> {
    if let Some(flag) = table.flag_of_files() {
        let got = format!("--{flag}");
        return Err(usage("chart table", "flags of a picture", &got, "leave it out"));
    }
    let output = table.output.as_deref().unwrap_or(DEFAULT_OUTPUT);
    output::check_picture(output)?;
    // As they are integrated: a storage may not hold what the picture's scale shows.
    let uncertified = |lut: &Lut| Ok(Accuracy::uncertified(lut, Precision::F64));
    let request = table.request(Precision::F64, uncertified)?;
    if request.layout().slice_count() > 1 {
        let got = "several";
        return Err(Error::bad_input("f0", "one F0 for a picture", got, "draw one at a time"));
    }
    // Of each value the integral, its channel's plane, the same scaled, and three bytes of the
    // picture.
    let values = request.layout().values_of_slice();
    let bytes = (working_bytes(&request) + values * (3 * 8 + 3)) as u64;
    resources::start(bytes, None, resources::ALLOW)?;
    let backend = resources::open_backend(BackendChoice::Auto, &GpuOptions::default(), bytes)?;
    let table = Plan::new(&request, &backend)?.bake(&|_| ())?.table;
    let (n, size) = (table.channels().len(), (table.x().size(), table.y().size()));
    let channels: Vec<Vec<f64>> = (0..n).map(|channel| table.plane(0, channel)).collect();
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let scaled = |values: &Vec<f64>| {
        let end = largest(values).max(f64::MIN_POSITIVE);
        values.iter().map(|value| value / end).collect()
    };
    let picture = panels(&channels.iter().map(scaled).collect::<Vec<_>>(), size, n, sequential);
    output::write_picture(output, &picture)?;
    let line = |(channel, values): (usize, &Vec<f64>)| {
        format!("{}: 0 to {:.4}", table.channels()[channel].name, largest(values))
    };
    crate::cli::print(&channels.iter().enumerate().map(line).collect::<Vec<_>>().join(", "))
}
