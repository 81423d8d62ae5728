//! Previews on a device against the CPU's.

use crate::DeviceTest;
use libtest_mimic::Failed;
use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Backend, BackendChoice, Gpu};
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::preview::{Row, Scene, render};

pub const TESTS: &[DeviceTest] = &[("previews are the CPU's within 1/255", previews_are_the_cpus)];

fn previews_are_the_cpus(gpu: &Gpu) -> Result<(), Failed> {
    let options = GpuOptions { device: Some(gpu.info().uuid.clone()), ..GpuOptions::default() };
    let (device, cpu) = (Backend::open(BackendChoice::Vulkan, &options)?, Backend::cpu());
    for ndf in [Ndf::BlinnPhong, Ndf::Beckmann, Ndf::Ggx] {
        let lobe = Microfacet { ndf, masking: ndf.default_masking() };
        let scenes = [
            Scene::Punctual,
            Scene::FurnaceTable,
            Scene::FurnaceIntegral,
            Scene::FurnaceDifference,
            Scene::Sky,
        ];
        for scene in scenes {
            let rows = [Row::new(lobe, scene)?];
            let (ours, theirs) =
                (render(&rows, 48, &cpu, &|_| ())?, render(&rows, 48, &device, &|_| ())?);
            assert_eq!((ours.width, ours.height), (theirs.width, theirs.height));
            assert!(ours.rgb.iter().any(|&byte| byte > 100), "{ndf:?} {scene:?} is all dark");
            let difference =
                ours.rgb.iter().zip(&theirs.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert!(difference <= 1, "{ndf:?} {scene:?}: {difference}/255");
        }
    }
    Ok(())
}
