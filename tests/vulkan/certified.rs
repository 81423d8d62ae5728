//! Certified tables from devices: the same bytes as from the CPU, whatever the tiles; and the bounds of a device's
//! values.

use crate::DeviceTest;
use crate::common::{Random, ggx};
use libtest_mimic::Failed;
use splitsum::axis::{Axis, AxisSpec, Parameter};
use splitsum::backend::vulkan::bake::bake;
use splitsum::backend::vulkan::gpu::{Gpu, GpuOptions};
use splitsum::backend::{Backend, BackendChoice, cpu};
use splitsum::encode::{Format, encode};
use splitsum::error::ExitCode;
use splitsum::integrate::rule::{CHARLIE_LIMIT, Method, Rule};
use splitsum::lut::{Dfg, DfgChannels, Grid, Lut};
use splitsum::model::{Diffuse, Masking, Microfacet, Ndf};
use splitsum::precision::Precision;
use splitsum::request::{Accuracy, Request};

pub const TESTS: &[DeviceTest] = &[
    ("a certified table of 512 x 512 has the CPU's bytes in any tiles", the_usual_table_in_any_tiles),
    ("certified tables of every lobe have the CPU's bytes", every_lobe),
    ("certified tables in every precision have the CPU's bytes", every_precision),
    ("the device stays within the bounds that certification trusts", within_its_bounds),
];

fn file(lut: Lut, size: usize, precision: Precision, backend: &Backend) -> Result<Vec<u8>, Failed> {
    let axis = |words: &str| Axis::new(words.parse()?, size);
    // Charlie's albedo is infinite at n.v = 0, and certified from a roughness of 0.07 on.
    let (x, y) = (axis("nov,min=1e-4")?, axis("roughness,min=0.07")?);
    let plain = |parameter| Axis::new(AxisSpec::of(parameter), size);
    let charlie = matches!(lut, Lut::Dfg(Dfg { lobe: Microfacet { ndf: Ndf::Charlie, .. }, .. }));
    let (x, y) = if charlie { (x, y) } else { (plain(Parameter::Nov)?, plain(Parameter::Roughness)?) };
    let request = Request::new(lut, x, y, Accuracy::by_default(&lut, precision), precision)?;
    let baked = splitsum::bake(&request, backend, &|_| ())?;
    let format = if precision == Precision::F16 || precision == Precision::F32 { Format::Exr } else { Format::Png };
    Ok(encode(&[baked.table], format)?)
}

fn on(gpu: &Gpu, tile: Option<usize>) -> Result<Backend, Failed> {
    let options = GpuOptions { device: Some(gpu.info().uuid.clone()), tile, validate: false };
    Ok(Backend::open(BackendChoice::Vulkan, &options)?)
}

fn ab(lobe: Microfacet) -> Lut {
    Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab })
}

fn the_usual_table_in_any_tiles(gpu: &Gpu) -> Result<(), Failed> {
    let lut = ab(ggx(Masking::HeightCorrelated));
    let truth = file(lut, 512, Precision::F16, &Backend::cpu())?;
    for tile in [Some(8), Some(64), Some(512 * 512), None] {
        if file(lut, 512, Precision::F16, &on(gpu, tile)?)? != truth {
            return Err(format!("tiles of {tile:?} give other bytes").into());
        }
    }
    Ok(())
}

fn every_lobe(gpu: &Gpu) -> Result<(), Failed> {
    let whole = on(gpu, Some(128 * 128))?;
    for lobe in Microfacet::all() {
        if file(ab(lobe), 128, Precision::F16, &whole)? != file(ab(lobe), 128, Precision::F16, &Backend::cpu())? {
            return Err(format!("{lobe:?}: other bytes").into());
        }
    }
    // What tiles can change is the device's own values: not a bit of them; tests/vulkan/tables.rs tries more sizes.
    let rule = Rule::named("h640").ok().map(|rule| rule.method);
    let Some(Method::HSpace(nodes)) = rule else { return Err("no h640".into()) };
    let grid = Request::with_default_axes(ab(ggx(Masking::HeightCorrelated)), (128, 128), Precision::F16)?.grid()?;
    for lobe in Microfacet::all() {
        let values = |tile| -> Result<Vec<[u64; 2]>, Failed> {
            let options = GpuOptions { device: Some(gpu.info().uuid.clone()), tile: Some(tile), validate: false };
            let baked = bake(&Gpu::open(&options)?, lobe, &grid, &nodes, &|_| ())?;
            Ok(baked.integrals.iter().map(|value| [value.a.to_bits(), value.b.to_bits()]).collect())
        };
        let whole = values(128 * 128)?;
        if values(8)? != whole {
            return Err(format!("{lobe:?}: tiles change bits").into());
        }
    }
    Ok(())
}

fn every_precision(gpu: &Gpu) -> Result<(), Failed> {
    let device = on(gpu, None)?;
    for lut in [ab(ggx(Masking::HeightCorrelated)), ab(ggx(Masking::Joint))] {
        for precision in [Precision::F16, Precision::Unorm16, Precision::Unorm8] {
            if file(lut, 48, precision, &device)? != file(lut, 48, precision, &Backend::cpu())? {
                return Err(format!("{lut:?} in {precision:?}: other bytes").into());
            }
        }
    }
    // Where a device could decide nothing it is refused, and left alone where there is a choice.
    for (lut, precision) in
        [(ab(ggx(Masking::HeightCorrelated)), Precision::F32), (Lut::Diffuse(Diffuse::Burley), Precision::F16)]
    {
        let (x, y) = (Axis::new(AxisSpec::of(Parameter::Nov), 8)?, Axis::new(AxisSpec::of(Parameter::Roughness), 8)?);
        let request = Request::new(lut, x, y, Accuracy::by_default(&lut, precision), precision)?;
        let refused = splitsum::bake(&request, &device, &|_| ());
        if !refused.is_err_and(|error| error.exit_code() == ExitCode::BadInput) {
            return Err(format!("{lut:?} in {precision:?} by a device").into());
        }
    }
    Ok(())
}

fn within_its_bounds(gpu: &Gpu) -> Result<(), Failed> {
    let mut random = Random(20261124);
    let mut spread = |count: usize, decades: f64| -> Vec<f64> {
        (0..count)
            .map(|i| match i % 3 {
                0 => random.next(),
                1 => 10f64.powf(-decades * random.next()),
                _ => 1.0 - 10f64.powf(-decades * random.next()),
            })
            .collect()
    };
    let (mus, roughnesses) = (spread(96, 7.0), spread(96, 4.0));
    for lobe in Microfacet::all() {
        // f32's numbers, so that device and CPU mean the same points.
        let mut grid = Grid::of(
            mus.iter().map(|&mu| f64::from(mu as f32)).collect(),
            roughnesses.iter().map(|r| f64::from((r * r) as f32)).collect(),
        );
        if lobe.ndf == Ndf::Charlie {
            grid.alphas.retain(|&alpha| alpha >= CHARLIE_LIMIT);
            grid.mus.retain(|&mu| mu >= 1e-4);
        }
        let truth = cpu::bake(lobe, &grid, &Rule::named("d10240")?, &|_| ());
        for name in ["h640", "h1536", "h6144"] {
            let rule = Rule::named(name)?;
            let Method::HSpace(nodes) = rule.method else { return Err(name.into()) };
            for (i, value) in bake(gpu, lobe, &grid, &nodes, &|_| ())?.integrals.iter().enumerate() {
                let (mu, alpha) = grid.point(i);
                let allowed = rule.device_errors_at(lobe, alpha, *value);
                let (a, b) = ((value.a - truth[i].a).abs(), (value.b - truth[i].b).abs());
                // Written so that NaN fails.
                let within = a <= allowed.a && b <= allowed.b;
                if !within {
                    return Err(
                        format!("{name} of {lobe:?} at ({mu}, {alpha}) errs by {a:e}, {b:e}: {allowed:?}").into()
                    );
                }
            }
        }
    }
    Ok(())
}
