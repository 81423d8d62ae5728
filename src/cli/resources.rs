//! Memory and threads: what work takes is compared with what the system gives, before any work is
//! done.

use super::table_args::Job;
use crate::backend::device::GpuOptions;
use crate::backend::{Backend, BackendChoice};
use crate::bake::plan::working_bytes;
use crate::error::{Complaint, Error, Result};
use std::fs;
use std::path::Path;

/// Bytes besides tables and bands: the program itself, fits and nodes, the lines that an encoder
/// holds.
const BASE: u64 = 32 << 20;

/// Bytes of addresses that a thread takes: its stack, and what the C library sets aside for what it
/// allocates (glibc's arenas).
const ADDRESSES_OF_A_THREAD: u64 = 66 << 20;

/// Bytes of data that a thread takes: its stack, and what of its arena it uses.
const DATA_OF_A_THREAD: u64 = 4 << 20;

/// Bytes of addresses and of data that a software driver takes, with its compiler: lavapipe needs
/// 350 MiB.
const DRIVER: u64 = 512 << 20;

/// Pools of threads: ours, and that of the encoder of EXR.
const POOLS: u64 = 2;

/// The cure of refused threads for a bake.
pub const FEWER: &str = "bake with --threads 1, or allow more of them (ulimit -u)";

/// The cure for another command.
pub const ALLOW: &str = "allow more of them (ulimit -u)";

/// Starts threads for work that takes `bytes`: as many as are asked for, or one for each
/// core, but no more than limits of memory leave room for. An error where a thread is refused, with
/// this cure, or where there is less memory than the work takes.
pub fn start(bytes: u64, threads: Option<usize>, cure: &str) -> Result<()> {
    let (need, limits) = (bytes + BASE, limits());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let count = threads
        .unwrap_or_else(|| limits.iter().map(|limit| limit.threads(need)).fold(cores, usize::min));
    limits.iter().try_for_each(|limit| limit.check(need, count))?;
    let builder = rayon::ThreadPoolBuilder::new();
    let builder = match count {
        // A single thread is the one that runs already.
        1 => builder.num_threads(1).use_current_thread(),
        // Where nobody says how many, the library's own variable may.
        _ if threads.is_none() && count == cores => builder,
        _ => builder.num_threads(count),
    };
    builder.build_global().map_err(|error| {
        Error::Resources(Complaint::new(
            "threads",
            format!("{count} threads"),
            error.to_string(),
            cure,
        ))
    })
}

/// Opens a backend for work that takes `bytes`. A driver below a limit that is too small for
/// it fails as it likes: it is refused where one is asked for, and left alone where there is a
/// choice.
pub fn open_backend(choice: BackendChoice, options: &GpuOptions, bytes: u64) -> Result<Backend> {
    let fits = || {
        limits()
            .iter()
            .filter(|limit| limit.of_a_thread > 0)
            .try_for_each(|limit| limit.check(bytes + DRIVER, 1))
    };
    let wanted = choice == BackendChoice::Vulkan || options.device.is_some();
    match choice {
        BackendChoice::Cpu => Backend::open(choice, options),
        _ if wanted => fits().and_then(|()| Backend::open(choice, options)),
        _ if fits().is_err() => Ok(Backend::cpu()),
        _ => Backend::open(choice, options),
    }
}

/// Bytes that bakes take, one after the other.
pub fn of_bakes(jobs: &[Job]) -> u64 {
    let need = |job: &Job| working_bytes(&job.request) + job.request.bytes();
    jobs.iter().map(need).max().unwrap_or(0) as u64
}

/// A limit of the system, and how much of it is left.
struct Limit {
    what: &'static str,
    left: u64,
    /// The part that a thread takes of it, in each pool.
    of_a_thread: u64,
}

impl Limit {
    /// The number of threads that fit beside `need` bytes: one at the least, which takes
    /// nothing.
    fn threads(&self, need: u64) -> usize {
        let room = self.left.saturating_sub(need);
        let threads = room.checked_div(POOLS * self.of_a_thread).unwrap_or(u64::MAX);
        usize::try_from(threads).unwrap_or(usize::MAX).max(1)
    }

    /// Refuses work that takes `need` bytes on so many `threads` where there is less.
    fn check(&self, need: u64, threads: usize) -> Result<()> {
        let need =
            if threads == 1 { need } else { need + POOLS * threads as u64 * self.of_a_thread };
        if need <= self.left {
            return Ok(());
        }
        let cure = match threads {
            1 => "give a smaller --size, or free or allow more memory",
            _ => "give a smaller --size or fewer --threads, or free or allow more memory",
        };
        let (expected, got) = (need.div_ceil(1 << 20), self.left >> 20);
        let got = format!("{got} MiB left of {}", self.what);
        Err(Error::Resources(Complaint::new("memory", format!("{expected} MiB"), got, cure)))
    }
}

/// The limits that this system tells of.
fn limits() -> Vec<Limit> {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let (limits, status, memory) =
        (read("/proc/self/limits"), read("/proc/self/status"), read("/proc/meminfo"));
    let of_process = |what, name: &str, used: &str, of_a_thread| {
        // "Max address space     2048000000           unlimited            bytes"
        let line = limits.lines().find(|line| line.starts_with(name))?;
        let soft: u64 = line[name.len()..].split_whitespace().next()?.parse().ok()?;
        Some(Limit {
            what,
            left: soft.saturating_sub(kib_in(&status, used).unwrap_or(0)),
            of_a_thread,
        })
    };
    let addresses = of_process(
        "the address space (ulimit -v)",
        "Max address space",
        "VmSize",
        ADDRESSES_OF_A_THREAD,
    );
    let data = of_process("the data size (ulimit -d)", "Max data size", "VmData", DATA_OF_A_THREAD);
    let group =
        group_left().map(|left| Limit { what: "the control group's memory", left, of_a_thread: 0 });
    let free = kib_in(&memory, "MemAvailable").map(|free| Limit {
        what: "the memory and the swap space",
        left: free + kib_in(&memory, "SwapFree").unwrap_or(0),
        of_a_thread: 0,
    });
    [addresses, data, group, free].into_iter().flatten().collect()
}

/// The number of bytes in a line such as `VmSize:    2044 kB`.
fn kib_in(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib << 10)
}

/// Bytes left to the control group of this process, and to those above it.
fn group_left() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    groups.lines().filter_map(left_of_group).min()
}

/// The same by a line of `/proc/self/cgroup`: `0::/path` in version 2, `4:memory:/path` in version
/// 1.
fn left_of_group(line: &str) -> Option<u64> {
    let mut parts = line.splitn(3, ':').skip(1);
    let (controllers, own) = (parts.next()?, parts.next()?.trim_start_matches('/'));
    let (root, most, used, cache) = match controllers {
        "" => ("/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file "),
        "memory" => (
            "/sys/fs/cgroup/memory",
            "memory.limit_in_bytes",
            "memory.usage_in_bytes",
            "total_inactive_file ",
        ),
        _ => return None,
    };
    let left = |group: &Path| {
        let folder = Path::new(root).join(group);
        let read = |file: &str| fs::read_to_string(folder.join(file)).ok();
        let most: u64 = read(most)?.trim().parse().ok()?;
        let used: u64 = read(used)?.trim().parse().ok()?;
        // What files are cached in is given back when it is wanted.
        let stat = read("memory.stat").unwrap_or_default();
        let cached = stat
            .lines()
            .find_map(|line| line.strip_prefix(cache)?.trim().parse().ok())
            .unwrap_or(0);
        Some(most.saturating_sub(used.saturating_sub(cached)))
    };
    Path::new(own).ancestors().filter_map(left).min()
}
