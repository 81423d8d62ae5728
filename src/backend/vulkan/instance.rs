//! The Vulkan loader and an instance, freed when dropped; and the validation layers' messages,
//! where they are on.

use crate::error::{Complaint, Error, Result};
use ash::{ext, vk};
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The loader and an instance.
pub struct Instance {
    pub(super) raw: ash::Instance,
    debug: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
    _entry: ash::Entry,
}

impl Instance {
    pub(super) fn new(validate: bool) -> Result<Self> {
        // SAFETY: the loader's initialisers are trusted, as they are by every Vulkan program.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| no_driver(error.to_string()))?;
        // SAFETY: `entry` is alive, here and below.
        let version = unsafe { entry.try_enumerate_instance_version() }.map_err(refused)?;
        if version.is_none_or(|version| version < vk::API_VERSION_1_1) {
            return Err(no_driver("a loader of Vulkan 1.0".into()));
        }
        let (layers, extensions) = if validate {
            require_validation_layer(&entry)?;
            (vec![VALIDATION.as_ptr()], vec![ext::debug_utils::NAME.as_ptr()])
        } else {
            (Vec::new(), Vec::new())
        };
        let application = vk::ApplicationInfo::default()
            .application_name(c"splitsum")
            .api_version(vk::API_VERSION_1_2);
        let mut create = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        let synchronization = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronization);
        let messages = Box::new(Mutex::new(Vec::new()));
        let mut messenger = messenger_info(&messages);
        if validate {
            create = create.push_next(&mut features).push_next(&mut messenger);
        }
        // SAFETY: everything `create` points to lives to the end of this function; the messages
        // live as long as the instance.
        let raw = unsafe { entry.create_instance(&create, None) }.map_err(refused)?;
        let mut instance = Instance { raw, debug: None, messages, _entry: entry };
        if validate {
            let debug = ext::debug_utils::Instance::new(&instance._entry, &instance.raw);
            // SAFETY: as above.
            let messenger = unsafe {
                debug.create_debug_utils_messenger(&messenger_info(&instance.messages), None)
            }
            .map_err(refused)?;
            instance.debug = Some((debug, messenger));
        }
        Ok(instance)
    }

    /// The messages of the validation layers so far.
    pub(super) fn messages(&self) -> Vec<String> {
        self.messages.lock().map(|messages| messages.clone()).unwrap_or_default()
    }
}

fn no_driver(got: String) -> Error {
    let cure = "install a Vulkan loader and driver, or use --backend cpu";
    Error::NoDevice(Complaint::new("Vulkan", "a loader with a driver", got, cure))
}

/// The error of a loader that refuses before any device is reached.
fn refused(result: vk::Result) -> Error {
    if result != vk::Result::ERROR_OUT_OF_HOST_MEMORY {
        return no_driver(format!("{result:?}"));
    }
    // So the loader calls a manifest that is no JSON; memory itself has not been seen to run out
    // there.
    let got = "ERROR_OUT_OF_HOST_MEMORY, which is what the loader makes of a broken one";
    let cure = "mend the file that VK_LOADER_DEBUG=all names, name sound drivers in \
                VK_DRIVER_FILES, or use --backend cpu";
    Error::NoDevice(Complaint::new(
        "Vulkan",
        "sound JSON manifests of drivers and layers",
        got,
        cure,
    ))
}

fn require_validation_layer(entry: &ash::Entry) -> Result<()> {
    // SAFETY: `entry` is alive.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.map_err(refused)?;
    let present = layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION));
    if present {
        return Ok(());
    }
    let cure = "install the Vulkan validation layers, or leave out --validate";
    Err(Error::NoDevice(Complaint::new(
        "validation",
        "VK_LAYER_KHRONOS_validation",
        "no such layer",
        cure,
    )))
}

fn messenger_info(messages: &Mutex<Vec<String>>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::{
        DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
    };
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(record_message))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

unsafe extern "system" fn record_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: `messages` is the mutex given to messenger_info, which outlives the instance; `data`
    // is valid for the call.
    let (messages, text) = unsafe {
        let text = (*data).message_as_c_str().map(CStr::to_string_lossy).unwrap_or_default();
        (&*messages.cast::<Mutex<Vec<String>>>(), text)
    };
    if let Ok(mut messages) = messages.lock() {
        messages.push(text.into_owned());
    }
    vk::FALSE
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: nothing made from the instance is alive.
        unsafe {
            if let Some((debug, messenger)) = &self.debug {
                debug.destroy_debug_utils_messenger(*messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}
