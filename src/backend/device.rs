//! A Vulkan device in words and numbers: its description, the options with which it is opened, the
//! result of its work.

use crate::choice::choice;
use crate::integrate::Field;

/// The kind of a device; the preferred kinds come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// A card of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// Lent by a hypervisor.
    Virtual,
    /// Software.
    Cpu,
    /// Something else.
    Other,
}

choice!(DeviceKind, "kind of device", {
    Discrete = "discrete", "a card of its own";
    Integrated = "integrated", "part of the processor";
    Virtual = "virtual", "lent by a hypervisor";
    Cpu = "cpu", "software";
    Other = "other", "something else";
});

/// A Vulkan device as it describes itself.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DeviceInfo {
    /// Its name.
    pub name: String,
    /// Its kind; the default device is the first in the order of kinds.
    pub kind: DeviceKind,
    /// Its UUID, which stays the same from run to run.
    pub uuid: String,
    /// The driver's name and version.
    pub driver: String,
    /// The version of Vulkan.
    pub api: String,
    /// Why it cannot bake, if it cannot.
    pub unusable: Option<String>,
}

/// The device to open, and how to use it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GpuOptions {
    /// A UUID or a part of a name; none takes the preferred device.
    pub device: Option<String>,
    /// Work under the validation layers (core and synchronization).
    pub validate: bool,
    /// Texels for each dispatch; none measures and adapts.
    pub tile: Option<usize>,
}

/// The result of a device's work.
#[derive(Clone, Debug)]
pub struct DeviceBake {
    /// The integrals at every point of the grid, in its order.
    pub integrals: Field,
    /// Seconds that the dispatches took by the device's own clock, without start, compilation and
    /// transfer; none where it has no clock.
    pub device_seconds: Option<f64>,
}
