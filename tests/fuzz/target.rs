//! The reader of tests/hostile/targets.rs whose name this program has.
#![no_main]

#[path = "../hostile/targets.rs"]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let own = targets::TARGETS.iter().find(|target| target.name == env!("CARGO_BIN_NAME"));
    (own.expect("a target of this name").read)(bytes);
});
