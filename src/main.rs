//! The program: its arguments in, its exit code out.

fn main() -> std::process::ExitCode {
    splitsum::cli::run(std::env::args_os()).into()
}
