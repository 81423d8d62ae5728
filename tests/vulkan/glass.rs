//! Rough interfaces on a device: whole tables beside f64.

use crate::DeviceTest;
use crate::common::{Random, ggx};
use libtest_mimic::Failed;
use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Backend, BackendChoice, Gpu, bake_glass, cpu};
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::certify::deviation::cross_check;
use splitsum::error::ExitCode;
use splitsum::integrate::Integrand;
use splitsum::integrate::rule::Method;
use splitsum::integrate::rules::{G560, G904, G2240};
use splitsum::table::grid::Grid;
use splitsum::{Glass, GlassChannels, Lut, Precision, Request};

pub const TESTS: &[DeviceTest] = &[
    ("glass is within 1e-6 of f64 at every texel", within_1e_6),
    ("certified glass has the CPU's bytes", certified),
];

const IOR: f64 = 1.5;

pub fn interface(lobe: Microfacet, ior: f64, side: Side) -> Result<Interface, Failed> {
    let transmission = match lobe.masking {
        Masking::Separable => TransmissionMasking::Separable,
        _ => TransmissionMasking::Correlated,
    };
    Ok(Interface::new(lobe, ior, side, transmission)?)
}

/// Interfaces that differ in all that a kernel is put together from, and in the index of
/// refraction.
fn interfaces() -> Result<Vec<Interface>, Failed> {
    let lobes = [
        ggx(Masking::HeightCorrelated),
        ggx(Masking::Separable),
        Microfacet { ndf: Ndf::Beckmann, masking: Masking::HeightCorrelated },
    ];
    let mut list = Vec::new();
    for (lobe, iors) in
        lobes.into_iter().zip([&[1.0, 1.000_001, 1.05, 1.5, 4.0][..], &[1.5], &[1.5]])
    {
        for &ior in iors {
            for side in [Side::Outside, Side::Inside] {
                list.push(interface(lobe, ior, side)?);
            }
        }
    }
    Ok(list)
}

/// The closed domain, crowded at its edges and at the critical angle; n·v in f32's numbers, so that
/// device and CPU mean the same.
fn grid(interface: Interface, count: usize) -> Grid {
    let mut random = Random(20261127);
    let critical = interface.critical();
    let mut mus: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
    mus.extend([1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1.0 - 1e-4, 1.0 - 1e-6]);
    for i in 0..count {
        let near = if i % 2 == 0 { critical } else { 2.0 * critical };
        mus.push(
            (near * (1.0 + (random.next() - 0.5) * 10f64.powf(-6.0 * random.next()))).min(1.0),
        );
    }
    let mut roughnesses: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
    roughnesses.extend([5e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 2e-3, 5e-3, 0.999]);
    let single = |x: f64| f64::from(x as f32);
    Grid::of(
        mus.into_iter().map(single).collect(),
        roughnesses.into_iter().map(|r| single(r * r)).collect(),
    )
}

fn within_1e_6(gpu: &Gpu) -> Result<(), Failed> {
    for interface in interfaces()? {
        let grid = grid(interface, 24);
        for rule in [G560, G904, G2240] {
            let Method::Glass(nodes) = rule.method else { return Err(rule.name.into()) };
            let device = bake_glass(gpu, interface, &grid, &nodes, &|_| ())?.integrals;
            let truth = cpu::bake(Integrand::Glass(interface), &grid, &rule, &|_| ());
            for (i, (got, truth)) in device.iter().zip(truth.iter()).enumerate() {
                // Written so that NaN fails.
                let close = got.iter().zip(truth).all(|(got, truth)| (got - truth).abs() <= 1e-6);
                if !close {
                    let (mu, alpha) = grid.point(i);
                    let which = format!("{} of {interface:?} at ({mu}, {alpha})", rule.name);
                    return Err(format!("{which}: {got:?} for {truth:?}").into());
                }
            }
            cross_check(Integrand::Glass(interface), &grid, &rule, &device)?;
        }
    }
    Ok(())
}

fn certified(gpu: &Gpu) -> Result<(), Failed> {
    let options = GpuOptions { device: Some(gpu.info().uuid.clone()), ..GpuOptions::default() };
    let device = Backend::open(BackendChoice::Vulkan, &options)?;
    for interface in interfaces()?.into_iter().filter(|interface| interface.ior() == IOR) {
        for precision in [Precision::F16, Precision::Unorm16] {
            let lut = Lut::Glass(Glass::new(interface, GlassChannels::Rt));
            let request = Request::with_default_axes(lut, (24, 24), precision)?;
            let by_device = splitsum::bake(&request, &device)?.table;
            if by_device != splitsum::bake(&request, &Backend::cpu())?.table {
                return Err(format!("{interface:?} in {precision}: other bytes").into());
            }
        }
    }
    // Heitz's term is a difference of logarithms that f32 does not hold.
    let lobe = ggx(Masking::HeightCorrelated);
    let beta = Interface::new(lobe, IOR, Side::Outside, TransmissionMasking::Beta)?;
    let lut = Lut::Glass(Glass::new(beta, GlassChannels::Rt));
    let request = Request::with_default_axes(lut, (4, 4), Precision::F16)?;
    let refused = splitsum::bake(&request, &device);
    match refused.is_err_and(|error| error.exit_code() == ExitCode::BadInput) {
        true => Ok(()),
        false => Err("beta on a device".into()),
    }
}
