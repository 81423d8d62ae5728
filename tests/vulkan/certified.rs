//! Certified tables from devices: the same bytes as from the CPU, whatever the tiles; and the
//! bounds of a device's values.

use crate::DeviceTest;
use crate::common::{Random, ab, ggx};
use libtest_mimic::Failed;
use splitsum::Baked;
use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Backend, BackendChoice, Gpu, bake, cpu};
use splitsum::brdf::{Diffuse, Fresnel, Masking, Microfacet, Ndf};
use splitsum::error::ExitCode;
use splitsum::format::{Format, encode};
use splitsum::integrate::Integrand;
use splitsum::integrate::rule::{Method, Rule};
use splitsum::lut::terms::packing;
use splitsum::lut::{Dfg, DfgChannels, Lut};
use splitsum::report::Computed;
use splitsum::request::{Accuracy, Request};
use splitsum::table::axis::{Axis, AxisSpec, Parameter};
use splitsum::table::grid::Grid;
use splitsum::table::precision::Precision;

pub const TESTS: &[DeviceTest] = &[
    (
        "a certified table of 512 x 512 has the CPU's bytes in any tiles",
        the_usual_table_in_any_tiles,
    ),
    ("certified tables of every lobe have the CPU's bytes", every_lobe),
    ("certified tables in every precision have the CPU's bytes", every_precision),
    ("certified tables of several lobes have the CPU's bytes", several_lobes),
    ("the device stays within the bounds that certification trusts", within_its_bounds),
];

fn file(lut: Lut, size: usize, precision: Precision, backend: &Backend) -> Result<Vec<u8>, Failed> {
    let axis = |words: &str| Axis::new(words.parse()?, size);
    // Charlie's albedo is infinite at n.v = 0, and certified from a roughness of 0.07 on.
    let (x, y) = (axis("nov,min=1e-4")?, axis("roughness,min=0.07")?);
    let plain = |parameter| Axis::new(AxisSpec::of(parameter), size);
    let charlie =
        matches!(lut.integrand(), Integrand::Specular(Microfacet { ndf: Ndf::Charlie, .. }, _));
    let (x, y) =
        if charlie { (x, y) } else { (plain(Parameter::Nov)?, plain(Parameter::Roughness)?) };
    let request = Request::new(lut, x, y, Accuracy::by_default(&lut.into(), precision), precision)?;
    let baked = splitsum::bake(&request, backend)?;
    let extension =
        if precision == Precision::F16 || precision == Precision::F32 { "exr" } else { "png" };
    Ok(encode(&baked.table, Format::named(extension)?)?)
}

fn on(gpu: &Gpu, tile: Option<usize>) -> Result<Backend, Failed> {
    let options = GpuOptions { device: Some(gpu.info().uuid.clone()), tile, validate: false };
    Ok(Backend::open(BackendChoice::Vulkan, &options)?)
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
        if file(ab(lobe), 128, Precision::F16, &whole)?
            != file(ab(lobe), 128, Precision::F16, &Backend::cpu())?
        {
            return Err(format!("{lobe:?}: other bytes").into());
        }
    }
    // What tiles can change is the device's own values: not a bit of them; tests/vulkan/tables.rs
    // tries more sizes.
    let rule = Rule::named("h640").ok().map(|rule| rule.method);
    let Some(Method::HalfVectors(nodes)) = rule else { return Err("no h640".into()) };
    let request =
        Request::with_default_axes(ab(ggx(Masking::HeightCorrelated)), (128, 128), Precision::F16)?;
    for lobe in Microfacet::all() {
        let values = |tile| -> Result<Vec<u64>, Failed> {
            let options = GpuOptions {
                device: Some(gpu.info().uuid.clone()),
                tile: Some(tile),
                validate: false,
            };
            let gpu = Gpu::open(&options)?;
            let baked = bake(&gpu, (lobe, Fresnel::Schlick), request.grid(), &nodes, &|_| ())?;
            assert_eq!(baked.integrals.len(), 128 * 128);
            Ok(baked.integrals.values().iter().map(|value| value.to_bits()).collect())
        };
        let whole = values(128 * 128)?;
        if values(8)? != whole {
            return Err(format!("{lobe:?}: tiles change bits").into());
        }
    }
    Ok(())
}

/// Schlick's models with every lobe, the others with one: their formulas know no lobe.
fn is_measured(lobe: Microfacet, fresnel: Fresnel) -> bool {
    match fresnel {
        Fresnel::Schlick | Fresnel::SchlickF82 => true,
        _ => lobe == ggx(Masking::HeightCorrelated),
    }
}

fn every_precision(gpu: &Gpu) -> Result<(), Failed> {
    let device = on(gpu, None)?;
    let smith = ggx(Masking::HeightCorrelated);
    let tinted = Lut::Dfg(Dfg::new(smith, Fresnel::SchlickF82, DfgChannels::All)?);
    for lut in [ab(smith), ab(ggx(Masking::HeightCorrelatedApprox)), tinted] {
        for precision in [Precision::F16, Precision::Unorm16, Precision::Unorm8] {
            if file(lut, 48, precision, &device)? != file(lut, 48, precision, &Backend::cpu())? {
                return Err(format!("{lut:?} in {precision:?}: other bytes").into());
            }
        }
    }
    // Where a device could decide nothing it is refused, and left alone where there is a choice.
    for (lut, precision) in [
        (ab(ggx(Masking::HeightCorrelated)), Precision::F32),
        (Lut::Diffuse(Diffuse::Burley), Precision::F16),
    ] {
        let (x, y) = (
            Axis::new(AxisSpec::of(Parameter::Nov), 8)?,
            Axis::new(AxisSpec::of(Parameter::Roughness), 8)?,
        );
        let request =
            Request::new(lut, x, y, Accuracy::by_default(&lut.into(), precision), precision)?;
        let refused = splitsum::bake(&request, &device);
        if !refused.is_err_and(|error| error.exit_code() == ExitCode::BadInput) {
            return Err(format!("{lut:?} in {precision:?} by a device").into());
        }
    }
    Ok(())
}

/// Channels of lobes that a device integrates, and of one that the CPU has in closed form;
/// roughness from half a texel beyond 1 on.
fn several_lobes(gpu: &Gpu) -> Result<(), Failed> {
    let x: Axis = Axis::new("nov,sqrt,edges,min=1e-3".parse()?, 24)?;
    let y: Axis = Axis::new("roughness,offset=1.5,flip,unclamped".parse()?, 24)?;
    for precision in [Precision::F16, Precision::A2b10g10r10, Precision::Srgb8] {
        let words = "b,1-e,burley*0.5,1";
        let packing = packing(ggx(Masking::Separable), Fresnel::Schlick, words)?;
        let request = Request::new(packing, x, y, Accuracy::Rounded, precision)?;
        let by =
            |backend: &Backend| -> Result<Baked, Failed> { Ok(splitsum::bake(&request, backend)?) };
        let (device, cpu) = (by(&on(gpu, None)?)?, by(&Backend::cpu())?);
        assert!(matches!(device.reports[0].computed, Computed::Vulkan { .. }));
        assert!(matches!(device.reports[1].computed, Computed::Cpu { .. }));
        assert_eq!(device.table, cpu.table, "{precision}");
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
    let every = Fresnel::samples()
        .into_iter()
        .flat_map(|fresnel| Microfacet::all().map(move |lobe| (lobe, fresnel)));
    for (lobe, fresnel) in every.filter(|&(lobe, fresnel)| is_measured(lobe, fresnel)) {
        // f32's numbers, so that device and CPU mean the same points.
        let grid = Grid::of(
            mus.iter().map(|&mu| f64::from(mu as f32)).collect(),
            roughnesses.iter().map(|r| f64::from((r * r) as f32)).collect(),
        );
        let integrand = Integrand::Specular(lobe, fresnel);
        // Far sharper than what a device may err by, and cheap.
        let sharp = match (lobe.ndf, lobe.diverges_at_grazing()) {
            (Ndf::Charlie, true) => "b2544",
            (Ndf::Charlie, false) => "r976",
            _ => "d10240",
        };
        let truth = cpu::bake(integrand, &grid, &Rule::named(sharp)?, &|_| ());
        for name in ["h640", "h1536", "h6144"] {
            let rule = Rule::named(name)?;
            let Method::HalfVectors(nodes) = rule.method else { return Err(name.into()) };
            let errors = rule.device_errors(integrand);
            let table = bake(gpu, (lobe, fresnel), &grid, &nodes, &|_| ())?.integrals;
            assert_eq!((table.len(), table.count()), (grid.len(), fresnel.count()));
            for (i, (values, truth)) in table.iter().zip(truth.iter()).enumerate() {
                let (mu, alpha) = grid.point(i);
                let allowed = errors.at((0.0, alpha), values);
                let off: Vec<f64> =
                    values.iter().zip(truth).map(|(value, truth)| (value - truth).abs()).collect();
                // Written so that NaN fails.
                let within = off.iter().zip(allowed).all(|(off, allowed)| *off <= allowed);
                if !within {
                    let which = format!("{name} of {lobe:?}, {fresnel}");
                    return Err(
                        format!("{which} at ({mu}, {alpha}) errs by {off:?}: {allowed:?}").into()
                    );
                }
            }
        }
    }
    Ok(())
}
