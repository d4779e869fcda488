//! The command `cognate`: its arguments, and nothing else.

fn main() -> std::process::ExitCode {
    cognate::cli::main()
}
