//! Whole tables on a device, against the CPU in f64.

use crate::DeviceTest;
use crate::common::{Difference, VULKAN, ggx, missing};
use libtest_mimic::{Failed, Trial};
use splitsum::backend::device::GpuOptions;
use splitsum::backend::wgsl::{bake_kernel, kernel};
use splitsum::backend::{Backend, BackendChoice, Gpu, bake, cpu, list_devices};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::certify::deviation::cross_check;
use splitsum::choice::Choice;
use splitsum::compare::device::{bake_samples, estimator_source};
use splitsum::compare::point_set::PointSet;
use splitsum::compare::sampling::Sampler;
use splitsum::integrate::errors::f32_arithmetic;
use splitsum::integrate::half_vectors::HalfVectorRule;
use splitsum::integrate::rule::{Method, Rule};
use splitsum::integrate::rules::RULES;
use splitsum::lut::{Energy, EnergyChannels, Lut};
use splitsum::numeric::quadrature::slope_map::Power;
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::table::axis::Axis;
use splitsum::table::grid::Grid;
use splitsum::table::precision::Precision;
use splitsum::units::F0;
use std::process::Command;

pub const TESTS: &[DeviceTest] = &[
    ("tables are within 1e-6 of f64 at every texel", tables_are_within_1e_6),
    ("every rule runs and passes the cross-check", every_rule_runs),
    ("the closed domain has no holes", the_closed_domain_has_no_holes),
    ("energy tables are those of the CPU", other_tables_are_those_of_the_cpu),
    ("tile sizes do not change a bit", tile_sizes_do_not_change_a_bit),
    ("a table beyond the storage-buffer limit bakes", a_table_beyond_the_limit_bakes),
];

const GGX: (Microfacet, Fresnel) =
    (Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated }, Fresnel::Schlick);

fn grid(x: &str, y: &str, width: usize, height: usize) -> Grid {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    Grid::new(&axis(x, width), &axis(y, height)).unwrap()
}

/// The finest rule: what the device adds to it is f32 arithmetic alone.
fn finest() -> (Rule, HalfVectorRule) {
    on_device(&Rule::named("h6144").unwrap()).unwrap()
}

fn on_device(rule: &Rule) -> Option<(Rule, HalfVectorRule)> {
    match rule.method {
        Method::HalfVectors(nodes) => Some((*rule, nodes)),
        _ => None,
    }
}

fn close(gpu: &Gpu, lobe: Microfacet, grid: &Grid) -> Result<(), Failed> {
    let (rule, nodes) = finest();
    let device = bake(gpu, (lobe, Fresnel::Schlick), grid, &nodes, &|_| ())?.integrals.scale_bias();
    let truth = cpu::bake(lobe, grid, &rule, &|_| ()).scale_bias();
    for (i, (got, truth)) in device.iter().zip(&truth).enumerate() {
        // 8e-7 is what correctly rounded division and root give; more below a roughness of 1e-3
        // where the lobe says so.
        let smooth = grid.point(i).1 < 1e-6;
        let allowed =
            if smooth { f32_arithmetic(lobe).max(1e-6) } else { 1e-6 } * truth.e().max(1.0);
        let close = (got.a - truth.a).abs() <= allowed && (got.b - truth.b).abs() <= allowed;
        if !close {
            return Err(format!(
                "{lobe:?} at (n.v, alpha) = {:?}: {got:?} for {truth:?}",
                grid.point(i)
            )
            .into());
        }
    }
    Ok(())
}

fn tables_are_within_1e_6(gpu: &Gpu) -> Result<(), Failed> {
    Microfacet::all().try_for_each(|lobe| close(gpu, lobe, &grid("nov", "roughness", 32, 32)))
}

fn the_closed_domain_has_no_holes(gpu: &Gpu) -> Result<(), Failed> {
    let mut grid = grid("nov,edges", "roughness,edges", 17, 17);
    let near_edges = [1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1.0 - 1e-4, 1.0 - 1e-6];
    grid.mus.extend(near_edges);
    grid.alphas.extend([5e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 2e-3, 5e-3, 0.999].map(|r| r * r));
    Microfacet::all().try_for_each(|lobe| {
        let mut grid = grid.clone();
        grid.mus.retain(|&mu| mu > 0.0 || !lobe.diverges_at_grazing());
        close(gpu, lobe, &grid)
    })
}

fn every_rule_runs(gpu: &Gpu) -> Result<(), Failed> {
    let grid = grid("nov,sqrt", "roughness,sqrt", 40, 24);
    for (rule, nodes) in RULES.iter().filter_map(on_device) {
        let table = bake(gpu, GGX, &grid, &nodes, &|_| ())?.integrals;
        cross_check(GGX.0, &grid, &rule, &table)?;
    }
    Ok(())
}

fn other_tables_are_those_of_the_cpu(gpu: &Gpu) -> Result<(), Failed> {
    let axis = |words: &str| Axis::new(words.parse().unwrap(), 12).unwrap();
    let options = GpuOptions { device: Some(gpu.info().uuid.clone()), ..GpuOptions::default() };
    let (device, cpu) = (Backend::open(BackendChoice::Vulkan, &options)?, Backend::cpu());
    let energy = [EnergyChannels::Average, EnergyChannels::KullaConty, EnergyChannels::Split].map(
        |channels| {
            let (lobe, f0) = (ggx(Masking::HeightCorrelated), F0::new(0.04).unwrap());
            Lut::Energy(Energy::new(lobe, f0, channels).unwrap())
        },
    );
    for lut in energy {
        let request = Request::new(
            lut,
            axis("nov,edges"),
            axis("roughness,edges"),
            Accuracy::Tolerance(1.25e-6),
            Precision::F64,
        )?;
        let [device, cpu] = [&device, &cpu].map(|backend| splitsum::bake(&request, backend));
        let (device, cpu) = (device?.table, cpu?.table);
        // Sums of A and B, each within 1.25e-6; the division by √(1-E_avg) is by 0.95 here.
        let planes = |table: &Table| {
            (0..lut.channels().len()).flat_map(|k| table.plane(0, k)).collect::<Vec<f64>>()
        };
        let difference = Difference::between(planes(&device).into_iter().zip(planes(&cpu)));
        assert!(difference.max <= 2.7e-6, "{lut:?}: {difference:?}");
    }
    Ok(())
}

fn tile_sizes_do_not_change_a_bit(gpu: &Gpu) -> Result<(), Failed> {
    let grid = grid("nov", "roughness,edges", 50, 41);
    let nodes = Rule::named("h288").ok().as_ref().and_then(on_device).unwrap().1;
    let baked = |tile| -> Result<Vec<u64>, Failed> {
        let options = GpuOptions { device: Some(gpu.info().uuid.clone()), tile, validate: false };
        let integrals = bake(&Gpu::open(&options)?, GGX, &grid, &nodes, &|_| ())?.integrals;
        Ok(integrals.values().iter().map(|value| value.to_bits()).collect())
    };
    let adapted = baked(None)?;
    assert_eq!(adapted.len(), 2 * grid.len());
    for tile in [8, 64, 100, 2050] {
        if baked(Some(tile))? != adapted {
            return Err(format!("a tile of {tile} texels changes bits").into());
        }
    }
    Ok(())
}

fn a_table_beyond_the_limit_bakes(gpu: &Gpu) -> Result<(), Failed> {
    // 16.8 million texels of 8 bytes: more than the 128 MiB that lavapipe and many devices allow
    // for a storage buffer.
    let grid = grid("nov", "roughness", 4100, 4096);
    let (rule, nodes) = RULES.iter().find_map(on_device).unwrap();
    let table = bake(gpu, GGX, &grid, &nodes, &|_| ())?.integrals;
    assert_eq!(table.len(), grid.len());
    cross_check(GGX.0, &grid, &rule, &table)?;
    Ok(())
}

/// On every device under the validation layers; and what they cannot see, by spirv-val.
pub fn validated() -> Vec<Trial> {
    let mut trials = vec![spirv_val()];
    let devices = list_devices().unwrap_or_default();
    if devices.is_empty() {
        trials.push(missing(
            VULKAN,
            "no device: the validation layers have nothing to say".into(),
            "there is no device".into(),
        ));
    }
    for device in devices {
        let name = format!("{}: the validation layers have nothing to say", device.name);
        let options = GpuOptions { device: Some(device.uuid), validate: true, tile: Some(100) };
        trials.push(match Gpu::open(&options) {
            Err(error) => missing(VULKAN, name, error.to_string()),
            Ok(gpu) => Trial::test(name, move || {
                let grid = grid("nov", "roughness", 32, 16);
                let (rule, nodes) = finest();
                let table = bake(&gpu, GGX, &grid, &nodes, &|_| ())?.integrals;
                cross_check(GGX.0, &grid, &rule, &table)?;
                // What compares methods, too.
                let points = PointSet::Hammersley.points(16, 0);
                bake_samples(&gpu, GGX.0, &grid, Sampler::SphericalCap, &points)?;
                splitsum::compare::study::stability::measure(
                    [4, 3],
                    std::slice::from_ref(&gpu),
                    &|_| (),
                )?;
                assert_eq!(gpu.validation_messages(), Vec::<String>::new());
                Ok(())
            }),
        });
    }
    trials
}

fn spirv_val() -> Trial {
    let name = "every shader passes spirv-val".to_owned();
    if Command::new("spirv-val").arg("--version").output().is_err() {
        return missing(VULKAN, name, "spirv-val is not installed".into());
    }
    Trial::test(name, || {
        for lobe in Microfacet::all() {
            let models = Fresnel::samples().into_iter().filter(|&fresnel| lobe.takes(fresnel));
            let bakes = models.flat_map(|fresnel| {
                [Power::Two, Power::Four].map(|power| bake_kernel(lobe, fresnel, power))
            });
            let samplers =
                Sampler::ALL.iter().copied().filter(|sampler| sampler.runs_on_device(lobe));
            let samples = samplers.map(|sampler| {
                let source = estimator_source(lobe, Fresnel::Schlick, sampler);
                kernel(&source, Fresnel::Schlick, "estimate")
            });
            for kernel in bakes.chain(samples) {
                let mut file = tempfile::NamedTempFile::new()?;
                let spirv = kernel?.spirv;
                std::io::Write::write_all(&mut file, bytemuck::cast_slice(&spirv))?;
                let output = Command::new("spirv-val")
                    .args(["--target-env", "vulkan1.1"])
                    .arg(file.path())
                    .output()?;
                if !output.status.success() {
                    return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
                }
            }
        }
        Ok(())
    })
}
