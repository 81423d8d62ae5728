//! The flags that choose a backend.

use super::choices;
use crate::backend::BackendChoice;

/// The backend of a command.
#[derive(clap::Args)]
pub struct DeviceArgs {
    /// Backend
    #[arg(
        long, value_name = "NAME", default_value = "auto",
        value_parser = choices::of::<BackendChoice>()
    )]
    pub backend: BackendChoice,
    /// Vulkan device, by UUID or a part of its name that no other has [default: discrete,
    /// integrated, virtual, software]
    #[arg(long, value_name = "NAME|UUID")]
    pub device: Option<String>,
}
