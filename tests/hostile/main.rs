//! Readers against hostile bytes: files of a corpus, wrong in many ways. Each reader runs in a
//! process of its own with 512 MiB of memory, and may neither panic, nor abort, nor take 5 s for an
//! input. tests/fuzz searches the same readers by coverage, and its findings are in the corpus.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod mutation;
mod targets;

use libtest_mimic::{Arguments, Failed, Trial};
use mutation::Mutator;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use targets::{TARGETS, Target};

/// KiB of memory that a reader may take, the program and its threads among them.
const MEMORY: u64 = 512 << 10;

/// The longest time for an input.
const PATIENCE: Duration = Duration::from_secs(5);

/// The longest time for 100,000 inputs of a reader, or fewer.
const BUDGET: Duration = Duration::from_secs(60);

/// Inputs of a reader; SPLITSUM_HOSTILE names another number.
const INPUTS: u64 = 3000;

/// The variable that tells a process which reader is its own.
const READER: &str = "SPLITSUM_HOSTILE_READER";

fn main() {
    if let Ok(name) = std::env::var(READER) {
        let target = TARGETS.iter().find(|target| target.name == name).unwrap();
        return run(target);
    }
    let trials = TARGETS.iter().map(|target| Trial::test(target.name, || supervise(target)));
    libtest_mimic::run(&Arguments::from_args(), trials.collect()).exit();
}

/// Runs a reader in a process with limits; of memory where the system's shell has them.
fn supervise(target: &'static Target) -> Result<(), Failed> {
    let program = std::env::current_exe()?;
    let mut command = match cfg!(unix) {
        true => {
            let mut shell = Command::new("sh");
            shell.args(["-c", &format!("ulimit -v {MEMORY} 2>/dev/null; exec \"$0\"")]);
            shell.arg(program);
            shell
        }
        false => Command::new(program),
    };
    let output = command.env(READER, target.name).env("RAYON_NUM_THREADS", "2").output()?;
    let said = String::from_utf8_lossy(&output.stdout);
    print!("{said}");
    if output.status.success() && said.contains("inputs") {
        return Ok(());
    }
    let why = String::from_utf8_lossy(&output.stderr);
    let input = input_file(target);
    Err(format!("{}: {why}; the input is {}", output.status, input.display()).into())
}

/// The file of the input under way, which is left where a reader fails.
fn input_file(target: &Target) -> PathBuf {
    std::env::temp_dir().join(format!("splitsum-hostile-{}", target.name))
}

fn run(target: &'static Target) {
    let corpus = corpus(target.name);
    assert!(!corpus.is_empty(), "no corpus of {}", target.name);
    let count = std::env::var("SPLITSUM_HOSTILE").ok().and_then(|count| count.parse().ok());
    let count = count.unwrap_or(INPUTS);
    let budget = BUDGET * count.div_ceil(100_000).max(1) as u32;
    let watched = Watch::start(target);
    let began = Instant::now();
    for file in &corpus {
        watched.read(target, file);
    }
    let mut mutator = Mutator::new(&corpus, target.name);
    let (mut inputs, mut slowest) = (0u64, Duration::ZERO);
    while inputs < count && began.elapsed() < budget {
        let input = mutator.next();
        slowest = slowest.max(watched.read(target, &input));
        inputs += 1;
    }
    println!("{}: {inputs} inputs, the slowest {slowest:.1?}, {}", target.name, peak_memory());
}

/// The files of a reader's corpus.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hostile/corpus").join(name);
    let mut files: Vec<PathBuf> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

/// The most memory that this process has had.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.map_or("memory unknown".into(), |line| format!("at most {} of memory", line.trim()))
}

/// A watch over the input under way: a reader that takes too long ends the process.
struct Watch {
    /// Milliseconds since the start at which the input began; the largest number between inputs.
    since: Arc<AtomicU64>,
    input: Arc<Mutex<Vec<u8>>>,
    start: Instant,
}

impl Watch {
    fn start(target: &'static Target) -> Self {
        let watch = Watch {
            since: Arc::new(AtomicU64::new(u64::MAX)),
            input: Arc::new(Mutex::new(Vec::new())),
            start: Instant::now(),
        };
        let (since, input, start) = (watch.since.clone(), watch.input.clone(), watch.start);
        let keep = move || std::fs::write(input_file(target), &*input.lock().unwrap()).unwrap();
        let keep_at_panic = keep.clone();
        let say = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            keep_at_panic();
            say(panic);
            std::process::exit(101);
        }));
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_millis(100));
                let began = Duration::from_millis(since.load(Ordering::SeqCst));
                if start.elapsed().checked_sub(began).is_some_and(|time| time > PATIENCE) {
                    keep();
                    eprintln!("an input takes more than {PATIENCE:?}");
                    std::process::exit(102);
                }
            }
        });
        watch
    }

    /// Reads an input, and tells how long that takes.
    fn read(&self, target: &Target, input: &[u8]) -> Duration {
        input.clone_into(&mut self.input.lock().unwrap());
        let began = Instant::now();
        self.since.store(self.start.elapsed().as_millis() as u64, Ordering::SeqCst);
        (target.read)(input);
        self.since.store(u64::MAX, Ordering::SeqCst);
        began.elapsed()
    }
}
