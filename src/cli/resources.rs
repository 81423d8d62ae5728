//! Memory and threads: what a bake takes is compared with what the system gives, before any work is done.

use super::table_args::Job;
use crate::bake::working_bytes;
use crate::error::{Complaint, Error, Result};
use crate::request::Request;
use std::fs;
use std::path::Path;

/// Bytes besides tables and bands: the program itself, fits and nodes, the lines that an encoder holds.
const BASE: u64 = 32 << 20;

/// Bytes of addresses that the C library sets aside for each thread that allocates (glibc's arenas), beside its stack
/// of 2 MiB.
const ADDRESSES_OF_A_THREAD: u64 = 66 << 20;

/// Starts so many threads, or one for each core. A single one is the one that runs already.
pub fn start_threads(threads: Option<usize>) -> Result<()> {
    if let Some(threads) = threads.filter(|threads| !(1..=1024).contains(threads)) {
        return Err(Error::bad_input("threads", "1 to 1024", threads.to_string(), "give a number in that range"));
    }
    let builder = rayon::ThreadPoolBuilder::new();
    let builder = match threads {
        Some(1) => builder.num_threads(1).use_current_thread(),
        Some(threads) => builder.num_threads(threads),
        None => builder,
    };
    builder.build_global().map_err(|error| {
        let expected = threads.map_or("a thread for each core".into(), |threads| format!("{threads} threads"));
        let cure = "bake with --threads 1, or allow more of them (ulimit -u)";
        Error::Resources(Complaint::new("threads", expected, error.to_string(), cure))
    })
}

/// Refuses bakes, one after the other, that take more memory than there is.
pub fn check_bakes(jobs: &[Job]) -> Result<()> {
    check_memory(jobs.iter().map(|job| need(&job.requests)).max().unwrap_or(0))
}

/// Refuses work that takes more memory than so many bytes and the program itself.
pub fn check_memory(bytes: u64) -> Result<()> {
    let need = bytes + BASE;
    // Two pools: ours, and that of the encoder of EXR; none where there is one thread, which ran before.
    let threads = match rayon::current_num_threads() as u64 {
        1 => 0,
        threads => 2 * threads,
    };
    for Limit { what, left, counts_addresses } in limits() {
        let need = if counts_addresses { need + threads * ADDRESSES_OF_A_THREAD } else { need };
        if need > left {
            let cure = "give a smaller --size or fewer --threads, or free or allow more memory";
            let (expected, got) = (need.div_ceil(1 << 20), left >> 20);
            let got = format!("{got} MiB left of {what}");
            return Err(Error::Resources(Complaint::new("memory", format!("{expected} MiB"), got, cure)));
        }
    }
    Ok(())
}

/// Bytes that the layers of a file take while they are baked one after the other.
fn need(layers: &[Request]) -> u64 {
    let texels = |request: &Request| request.x.size * request.y.size;
    let table = |request: &Request| texels(request) * request.lut.channels().len() * request.precision.bytes();
    let working = layers.iter().map(|layer| working_bytes(texels(layer))).max().unwrap_or(0);
    (working + layers.iter().map(table).sum::<usize>()) as u64
}

/// A limit of the system, and how much of it is left.
struct Limit {
    what: &'static str,
    left: u64,
    /// Whether addresses count that no memory stands behind.
    counts_addresses: bool,
}

/// The limits that this system tells of.
fn limits() -> Vec<Limit> {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let (limits, status, memory) = (read("/proc/self/limits"), read("/proc/self/status"), read("/proc/meminfo"));
    let used = |name: &str| kib_in(&status, name).unwrap_or(0);
    let of_process = |what, name: &str, used: u64| {
        // "Max address space     2048000000           unlimited            bytes"
        let line = limits.lines().find(|line| line.starts_with(name))?;
        let soft: u64 = line[name.len()..].split_whitespace().next()?.parse().ok()?;
        Some(Limit { what, left: soft.saturating_sub(used), counts_addresses: true })
    };
    let addresses = of_process("the address space (ulimit -v)", "Max address space", used("VmSize"));
    let data = of_process("the data size (ulimit -d)", "Max data size", used("VmData"));
    let group = group_left().map(|left| Limit { what: "the control group's memory", left, counts_addresses: false });
    let free = kib_in(&memory, "MemAvailable").map(|free| Limit {
        what: "the memory and the swap space",
        left: free + kib_in(&memory, "SwapFree").unwrap_or(0),
        counts_addresses: false,
    });
    [addresses, data, group, free].into_iter().flatten().collect()
}

/// The number of bytes in a line such as `VmSize:    2044 kB`.
fn kib_in(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib << 10)
}

/// What is left to the control group of this process, and to those above it.
fn group_left() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    groups.lines().filter_map(left_of_group).min()
}

/// The same by a line of `/proc/self/cgroup`: `0::/path` in version 2, `4:memory:/path` in version 1.
fn left_of_group(line: &str) -> Option<u64> {
    let mut parts = line.splitn(3, ':').skip(1);
    let (controllers, own) = (parts.next()?, parts.next()?.trim_start_matches('/'));
    let (root, most, used, cache) = match controllers {
        "" => ("/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file "),
        "memory" => ("/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "),
        _ => return None,
    };
    let left = |group: &Path| {
        let folder = Path::new(root).join(group);
        let read = |file: &str| fs::read_to_string(folder.join(file)).ok();
        let most: u64 = read(most)?.trim().parse().ok()?;
        let used: u64 = read(used)?.trim().parse().ok()?;
        // What files are cached in is given back when it is wanted.
        let stat = read("memory.stat").unwrap_or_default();
        let cached = stat.lines().find_map(|line| line.strip_prefix(cache)?.trim().parse().ok()).unwrap_or(0);
        Some(most.saturating_sub(used.saturating_sub(cached)))
    };
    Path::new(own).ancestors().filter_map(left).min()
}
