//! Too little memory and refused threads: a clear error with its own exit code, and the old file
//! stays.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{VULKAN, missing};
use libtest_mimic::{Arguments, Failed, Trial};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

/// A user who owns nothing: limits on threads do not hold for root.
const NOBODY: [&str; 4] = ["--reuid=65534", "--regid=65534", "--clear-groups", "--"];

fn main() {
    let there = |program: &str| Command::new(program).arg("--version").output().is_ok();
    let tools = there("setpriv") && there("prlimit");
    let mut trials = vec![
        Trial::test("whatever the limit of addresses, a bake is refused or done", refused_or_done),
        Trial::test("a bake takes the table's bytes and at most 64 MiB", a_table_and_little_more),
        Trial::test("a table too large for memory is refused before any work", refused_before_work),
    ];
    let name = "refused threads are no fault of the program";
    trials.push(match tools && root() {
        true => Trial::test(name, refused_threads),
        false => missing(
            VULKAN,
            name.into(),
            "the test is not run by root, or there is no setpriv or no prlimit".into(),
        ),
    });
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn root() -> bool {
    fs::read_to_string("/proc/self/status").is_ok_and(|status| status.contains("\nUid:\t0\t"))
}

/// Runs the program in a folder below limits of the shell.
fn limited(folder: &Path, limit: &str, arguments: &str) -> Result<Output, Failed> {
    let script = format!("{limit}; exec '{}' {arguments}", env!("CARGO_BIN_EXE_splitsum"));
    Ok(Command::new("sh").args(["-c", &script]).current_dir(folder).output()?)
}

fn refused_or_done() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let commands = [
        "bake --backend cpu -q --size 16 --threads 1 -o a.exr",
        "bake --backend cpu -q --size 600 --threads 2 -o a.exr",
        "bake --backend cpu -q --size 600 --threads 1 --precision unorm16 -o a.png",
        "bake --backend cpu -q --lut energy --size 200x900 --precision f32 --threads 1 -o a.exr",
        "furnace --size 300 -o f.png",
        "preview --backend cpu --scene punctual --size 64 -o p.png",
        "chart table --size 700 -o t.png",
    ];
    for command in commands {
        let code = |kib: usize| -> Result<Option<i32>, Failed> {
            let output = limited(folder.path(), &format!("ulimit -v {kib}"), command)?;
            Ok(output.status.code())
        };
        // From where the program starts to where it has plenty.
        let codes =
            (0..20).map(|i| code(20_000 + 45_000 * i)).collect::<Result<Vec<_>, Failed>>()?;
        let refused = codes.iter().take_while(|code| **code == Some(8)).count();
        let done = codes[refused..].iter().all(|code| *code == Some(0));
        if !done || refused == 0 || refused == codes.len() {
            return Err(format!("{command}: {codes:?}").into());
        }
    }
    Ok(())
}

/// 4096 x 4096 halves are 64 MiB. With 64 MiB more, and 32 MiB of the program's own addresses,
/// they are baked.
fn a_table_and_little_more() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let limit = format!("ulimit -v {}", (64 + 64 + 32) << 10);
    let output = limited(folder.path(), &limit, "bake --size 4096 --threads 1 -q -o a.exr")?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    Ok(())
}

fn refused_before_work() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("a.exr");
    fs::write(&file, "the old file")?;
    for arguments in
        ["bake --size 16384 -o a.exr", "bake --size 16384 --precision f32 --threads 1 -o a.exr"]
    {
        let output = limited(folder.path(), "ulimit -v 900000", arguments)?;
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        let said = ["memory: expected", "MiB", "left of the address space", "--size"];
        if output.status.code() != Some(8) || said.iter().any(|words| !text.contains(words)) {
            return Err(format!("{arguments}: {:?}, {text}", output.status.code()).into());
        }
    }
    if fs::read(&file)? != b"the old file" || fs::read_dir(folder.path())?.count() != 1 {
        return Err("the old file has gone".into());
    }
    Ok(())
}

fn refused_threads() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    fs::copy(env!("CARGO_BIN_EXE_splitsum"), folder.path().join("splitsum"))?;
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o777))?;
    for (arguments, expected) in [
        ("bake --size 16 -o a.exr", 8),
        ("bake --size 16 --threads 4 -o a.exr", 8),
        ("furnace --size 4", 8),
        ("bake --size 16 --threads 1 -o a.exr", 0),
    ] {
        let program = ["prlimit", "--nproc=1", "./splitsum"];
        let mut command = Command::new("setpriv");
        command.args(NOBODY).args(program).args(arguments.split(' '));
        let output = command.current_dir(folder.path()).output()?;
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        let said = expected == 0
            || text.contains("threads: expected") && text.contains("allow more of them");
        if output.status.code() != Some(expected) || !said {
            return Err(format!("{arguments}: {:?}, {text}", output.status.code()).into());
        }
    }
    Ok(())
}
