//! The Vulkan devices of the machine: their descriptions, and the choice of one.

use super::instance::Instance;
use crate::backend::device::{DeviceInfo, DeviceKind};
use crate::error::{Complaint, Error, Result};
use ash::vk;

/// A device and the handle behind the description.
pub(super) struct Found {
    pub info: DeviceInfo,
    pub physical: vk::PhysicalDevice,
    pub queue_family: u32,
    pub timestamp_bits: u32,
}

/// All devices, the preferred ones first.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    let instance = Instance::new(false)?;
    Ok(find(&instance)?.into_iter().map(|found| found.info).collect())
}

/// The device called `wanted` (a UUID, or a part of the name that no other device shares), or the
/// preferred one.
pub(super) fn choose(instance: &Instance, wanted: Option<&str>) -> Result<Found> {
    let mut all = find(instance)?;
    let names = all
        .iter()
        .map(|found| format!("{} ({})", found.info.name, found.info.uuid))
        .collect::<Vec<_>>()
        .join(", ");
    let complain = |expected: String, got: String, cure: &str| {
        Err(Error::NoDevice(Complaint::new("Vulkan device", expected, got, cure)))
    };
    let list = "run 'splitsum devices' and name one of them";
    if let Some(wanted) = wanted {
        let wanted = wanted.to_lowercase();
        let exact = all.iter().any(|found| found.info.uuid == wanted);
        all.retain(|found| {
            if exact {
                found.info.uuid == wanted
            } else {
                found.info.name.to_lowercase().contains(&wanted)
            }
        });
        if all.len() > 1 {
            return complain(
                "one device of that name".into(),
                format!("{} of {names}", all.len()),
                "name it by its UUID",
            );
        }
        if all.is_empty() {
            return complain(format!("one of {names}"), format!("'{wanted}'"), list);
        }
    }
    match all.iter().position(|found| found.info.unusable.is_none()) {
        Some(index) => Ok(all.swap_remove(index)),
        None => {
            let reason = all.first().and_then(|found| found.info.unusable.clone());
            let got = reason.unwrap_or_else(|| "no device at all".into());
            complain("one that can bake".into(), got, "install a driver, or use --backend cpu")
        }
    }
}

/// Every device, in order of preference.
fn find(instance: &Instance) -> Result<Vec<Found>> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }.map_err(|result| {
        Error::NoDevice(Complaint::new(
            "Vulkan devices",
            "a list of them",
            format!("{result:?}"),
            "check the driver",
        ))
    })?;
    let mut all: Vec<Found> =
        devices.into_iter().map(|physical| describe(instance, physical)).collect();
    all.sort_by_cached_key(|Found { info, .. }| {
        (info.kind, info.name.to_lowercase(), info.uuid.clone())
    });
    Ok(all)
}

fn describe(instance: &Instance, physical: vk::PhysicalDevice) -> Found {
    // SAFETY: `physical` comes from this instance; the first call only asks for what Vulkan 1.0
    // has.
    let basic = unsafe { instance.raw.get_physical_device_properties(physical) };
    let version = |v: u32| {
        format!(
            "{}.{}.{}",
            vk::api_version_major(v),
            vk::api_version_minor(v),
            vk::api_version_patch(v)
        )
    };
    let mut id = vk::PhysicalDeviceIDProperties::default();
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default();
    if basic.api_version >= vk::API_VERSION_1_1 {
        properties = properties.push_next(&mut id);
        if basic.api_version >= vk::API_VERSION_1_2 {
            properties = properties.push_next(&mut driver);
        }
        // SAFETY: Vulkan 1.1 has this call and the ID structure, 1.2 the driver structure.
        unsafe { instance.raw.get_physical_device_properties2(physical, &mut properties) };
    }
    let kind = match basic.device_type {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
        vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
        vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
        _ => DeviceKind::Other,
    };
    let text = |name: &[std::ffi::c_char]| {
        let bytes = name.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect::<Vec<_>>();
        String::from_utf8_lossy(&bytes).trim().to_owned()
    };
    let driver =
        format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)).trim().to_owned();
    // SAFETY: as above.
    let families = unsafe { instance.raw.get_physical_device_queue_family_properties(physical) };
    let family =
        families.iter().position(|family| family.queue_flags.contains(vk::QueueFlags::COMPUTE));
    let limits = &basic.limits;
    let unusable = if basic.api_version < vk::API_VERSION_1_1 {
        Some(format!("Vulkan {} where 1.1 is needed", version(basic.api_version)))
    } else if family.is_none() {
        Some("no queue with compute".into())
    } else if limits.max_compute_work_group_invocations < 64
        || limits.max_per_stage_descriptor_storage_buffers < 4
    {
        Some("less than 64 invocations in a workgroup or 4 storage buffers".into())
    } else {
        None
    };
    let info = DeviceInfo {
        name: text(&basic.device_name),
        kind,
        uuid: id.device_uuid.iter().map(|byte| format!("{byte:02x}")).collect(),
        driver: if driver.is_empty() { version(basic.driver_version) } else { driver },
        api: version(basic.api_version),
        unusable,
    };
    let timestamp_bits = family.map_or(0, |family| families[family].timestamp_valid_bits);
    Found { info, physical, queue_family: family.unwrap_or(0) as u32, timestamp_bits }
}
