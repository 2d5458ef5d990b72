//! The binary `rc`.

use std::process::ExitCode;

fn main() -> ExitCode {
    rc_cli::main()
}
