//! `splitsum chart table`

use crate::backend::BackendChoice;
use crate::backend::device::GpuOptions;
use crate::bake::Plan;
use crate::bake::plan::working_bytes;
use crate::cli::table_args::{FLAGS_OF_FILES, TableArgs};
use crate::cli::{output, print, resources, usage};
use crate::error::Result;
use crate::image::{panels, sequential};
use crate::lut::Packing;
use crate::request::Accuracy;
use crate::table::precision::Precision;

const DEFAULT_OUTPUT: &str = "out/dfg.png";

pub fn run(table: &TableArgs) -> Result<()> {
    if let Some((flag, _)) = FLAGS_OF_FILES.iter().find(|(_, is_given)| is_given(table)) {
        let got = format!("--{flag}");
        return Err(usage("chart table", "flags of a picture", &got, "leave it out"));
    }
    let output = table.output.as_deref().unwrap_or(DEFAULT_OUTPUT);
    output::check_picture(output)?;
    // As they are integrated: a storage may not hold what the picture's scale shows.
    let uncertified = |packing: &Packing| Ok(Accuracy::uncertified(packing, Precision::F64));
    let request = table.request(Precision::F64, uncertified)?;
    // Of each value the integral, its channel's plane, the same scaled, and three bytes of the
    // picture.
    let values = request.layout().slice_count() * request.layout().values_of_slice();
    let bytes = (working_bytes(&request) + values * (3 * 8 + 3)) as u64;
    resources::start(bytes, None, resources::ALLOW)?;
    let backend = resources::open_backend(BackendChoice::Auto, &GpuOptions::default(), bytes)?;
    let table = Plan::new(&request, &backend)?.bake(&|_| ())?.table;
    let (n, size) = (table.channels().len(), (table.x().size(), table.y().size()));
    let slices = table.layout().slice_count();
    let mut planes: Vec<Vec<f64>> = (0..slices * n).map(|i| table.plane(i / n, i % n)).collect();
    let mut lines = Vec::new();
    for (channel, about) in table.channels().iter().enumerate() {
        let of_channel = || planes.iter().skip(channel).step_by(n).flatten();
        let largest = of_channel().copied().fold(0.0, f64::max);
        let least = of_channel().copied().fold(0.0, f64::min);
        let scale = 1.0 / largest.max(f64::MIN_POSITIVE);
        let values = planes.iter_mut().skip(channel).step_by(n).flatten();
        values.for_each(|value| *value *= scale);
        // An estimate of 0 may lie a little below.
        let from = match least < -5e-5 {
            true => format!("{least:.4}, shown as 0,"),
            false => "0".into(),
        };
        lines.push(format!("{}: {from} to {largest:.4}", about.name));
    }
    output::write_picture(output, &panels(&planes, size, n, sequential))?;
    print(&lines.join(", "))
}
