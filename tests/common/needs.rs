//! What tests need and a machine may lack: they are left out there, and the last test target says how many and why.
//!
//! A test that is left out leaves a line in `target/tmp/left_out`, one file a test; one that runs takes it away. Where `CI` is `true` leaving out is
//! a failure, but for what `COGNATE_LACKS` names: what is knowingly not there.

use std::path::{Path, PathBuf};

/// The folder of the lines.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("left_out")
}

/// Returns whether a test can run, for which `what` must be there; notes that it is left out where it is not.
#[track_caller]
pub fn has(what: &str, is_there: bool) -> bool {
    let program = std::env::current_exe().unwrap_or_default();
    let program = program.file_stem().unwrap_or_default().to_string_lossy();
    // cargo adds a hash
    let program = program.rsplit_once('-').map_or(&*program, |(name, _)| name);
    let place = std::panic::Location::caller();
    let thread = std::thread::current();
    let test = match thread.name() {
        Some(name) if name != "main" => format!("{program} {name}"),
        _ => format!("{program} {}:{}", place.file(), place.line()),
    };
    let file = test.replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "-");
    let file = folder().join(file);
    if is_there {
        let _ = std::fs::remove_file(file);
        return true;
    }
    let lacks = std::env::var("COGNATE_LACKS").unwrap_or_default();
    let is_known = lacks.split(',').any(|name| name.trim() == what);
    let is_ci = std::env::var("CI").is_ok_and(|ci| ci == "true");
    assert!(
        is_known || !is_ci,
        "CI lacks {what}, and this test needs it"
    );
    println!("left out: {what} is not here");
    std::fs::create_dir_all(folder()).expect("a folder of this build");
    std::fs::write(file, format!("{what}\t{test}\n")).expect("a file of this build");
    false
}

/// Returns the folder of other people's files, where COGNATE_CORPUS names it.
#[allow(dead_code, reason = "not every binary reads the corpus")]
#[track_caller]
pub fn corpus() -> Option<PathBuf> {
    let root = std::env::var_os("COGNATE_CORPUS");
    has("corpus", root.is_some()).then(|| PathBuf::from(root.unwrap_or_default()))
}

/// Returns whether a command succeeds: the need of a test for a program, and for what the program needs.
#[allow(dead_code, reason = "not every binary runs programs")]
#[track_caller]
pub fn runs(what: &str, program: &str, arguments: &[&str]) -> bool {
    let done = std::process::Command::new(program).args(arguments).output();
    has(what, done.is_ok_and(|done| done.status.success()))
}
