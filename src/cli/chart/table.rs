//! `splitsum chart table`

use crate::backend::BackendChoice;
use crate::backend::vulkan::gpu::GpuOptions;
use crate::bake::working_bytes;
use crate::cli::output;
use crate::cli::resources;
use crate::cli::table_args::TableArgs;
use crate::encode::Format;
use crate::error::{Error, Result};
use crate::precision::Precision;
use crate::report::map::{panels, sequential};
use crate::request::{Accuracy, Request};

pub fn run(table: &TableArgs) -> Result<()> {
    let job = table.job()?;
    if job.format != Format::Png {
        return Err(Error::bad_input("output", "a name that ends in .png", job.output, "name a picture with -o"));
    }
    output::check(&job.output)?;
    // Of each value the integral, its channel's plane, the same scaled, and three bytes of the picture.
    let bytes = |request: &Request| {
        let texels = request.x.size * request.y.size;
        working_bytes(texels) + request.lut.channels().len() * texels * (3 * 8 + 3)
    };
    let bytes = job.requests.iter().map(bytes).max().unwrap_or(0) as u64;
    resources::start(bytes, None, resources::ALLOW)?;
    let backend = resources::open_backend(BackendChoice::Auto, &GpuOptions::default(), bytes)?;
    for request in &job.requests {
        // As they are integrated: a storage may not hold what the picture's scale shows.
        let accuracy = match request.accuracy {
            Accuracy::Certified(_) => Accuracy::uncertified(&request.lut, Precision::F64),
            accuracy => accuracy,
        };
        let request = Request::new(request.lut, request.x, request.y, accuracy, Precision::F64)?;
        let table = crate::bake(&request, &backend, &|_| ())?.table;
        let (n, size) = (table.channels.len(), (table.x.size, table.y.size));
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let channels: Vec<Vec<f64>> = (0..n).map(|c| table.plane(c)).collect();
        let scaled = channels.iter().map(|values| {
            let end = largest(values).max(f64::MIN_POSITIVE);
            values.iter().map(|value| value / end).collect()
        });
        let picture = panels(&scaled.collect::<Vec<_>>(), size, n, sequential);
        output::write_picture(&job.output, &picture)?;
        let line = |(c, values): (usize, &Vec<f64>)| format!("{}: 0 to {:.4}", table.channels[c].name, largest(values));
        crate::cli::print(&channels.iter().enumerate().map(line).collect::<Vec<_>>().join(", "))?;
    }
    Ok(())
}
