//! A library that poses as libvulkan.so.1, hands every call on to the real one, and makes one
//! function fail.
//!
//! SPLITSUM_REAL_LOADER is the path of the real loader. SPLITSUM_FAULT is `FUNCTION=RESULT@CALL`,
//! the VkResult that the call of that number returns instead of being made; or
//! `vkCmdDispatch=drop`, which leaves out the last workgroup.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(unsafe_code, reason = "it stands between two C interfaces")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

unsafe extern "C" {
    fn dlopen(file: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
}

type GetProcAddr = unsafe extern "C" fn(*mut c_void, *const c_char) -> *mut c_void;

/// Any Vulkan function: those that are made to fail have at most six arguments, all of them
/// integers or pointers, which the System V convention passes in registers whatever their number.
type Any = unsafe extern "C" fn(usize, usize, usize, usize, usize, usize) -> i32;

struct Fault {
    function: String,
    /// `None` drops a workgroup.
    result: Option<i32>,
    call: usize,
}

fn fault() -> &'static Fault {
    static FAULT: OnceLock<Fault> = OnceLock::new();
    FAULT.get_or_init(|| {
        let text = std::env::var("SPLITSUM_FAULT").unwrap_or_default();
        let (function, what) = text.split_once('=').unwrap_or(("", "drop"));
        let (result, call) = what.split_once('@').unwrap_or((what, "1"));
        Fault {
            function: function.into(),
            result: result.parse().ok(),
            call: call.parse().unwrap(),
        }
    })
}

static REAL: AtomicUsize = AtomicUsize::new(0);
static REAL_DEVICE: AtomicUsize = AtomicUsize::new(0);
static CALLS: AtomicUsize = AtomicUsize::new(0);

unsafe extern "C" fn failing(a: usize, b: usize, c: usize, d: usize, e: usize, f: usize) -> i32 {
    // SAFETY: REAL was set before this function was handed out, to the function that it stands for.
    let real: Any = unsafe { std::mem::transmute(REAL.load(Ordering::SeqCst)) };
    let call = CALLS.fetch_add(1, Ordering::SeqCst) + 1;
    match fault().result {
        Some(result) if call == fault().call => result,
        // SAFETY: the arguments are those of the caller.
        Some(_) => unsafe { real(a, b, c, d, e, f) },
        // SAFETY: as above; b is the number of workgroups.
        None => unsafe { real(a, b - 1, c, d, e, f) },
    }
}

fn replaced(name: &CStr, real: *mut c_void) -> *mut c_void {
    if real.is_null() || name.to_str() != Ok(&fault().function) {
        return real;
    }
    REAL.store(real as usize, Ordering::SeqCst);
    failing as *mut c_void
}

unsafe extern "C" fn device_proc_addr(device: *mut c_void, name: *const c_char) -> *mut c_void {
    // SAFETY: the caller's arguments; REAL_DEVICE was set before this function was handed out.
    unsafe {
        let real: GetProcAddr = std::mem::transmute(REAL_DEVICE.load(Ordering::SeqCst));
        replaced(CStr::from_ptr(name), real(device, name))
    }
}

/// The one function that a loader has to export.
///
/// # Safety
/// As Vulkan says of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn vkGetInstanceProcAddr(
    instance: *mut c_void,
    name: *const c_char,
) -> *mut c_void {
    static LOADER: OnceLock<usize> = OnceLock::new();
    let loader = *LOADER.get_or_init(|| {
        let path = CString::new(std::env::var("SPLITSUM_REAL_LOADER").unwrap()).unwrap();
        // SAFETY: the path names a Vulkan loader; 2 is RTLD_NOW.
        unsafe { dlsym(dlopen(path.as_ptr(), 2), c"vkGetInstanceProcAddr".as_ptr()) as usize }
    });
    // SAFETY: the caller's arguments, handed on to the function of that name.
    unsafe {
        let real: GetProcAddr = std::mem::transmute(loader);
        let found = real(instance, name);
        if CStr::from_ptr(name) == c"vkGetDeviceProcAddr" && !found.is_null() {
            REAL_DEVICE.store(found as usize, Ordering::SeqCst);
            return device_proc_addr as *mut c_void;
        }
        replaced(CStr::from_ptr(name), found)
    }
}
