//! The commands of pages of the manual run as they stand, one after another.
#![cfg(unix)]

use crate::repository::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The lines of the blocks of commands of a page.
fn commands(page: &str) -> String {
    let blocks = page.split("```sh\n").skip(1);
    let inside = blocks.map(|b| b.split("```").next().unwrap_or_default());
    inside.collect()
}

/// Runs the commands of a page in a folder of its own, with the slider-crank; each must succeed.
fn runs_as_it_stands(name: &str) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("page_{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for file in ["slider_crank.adm", "slider_crank.acf"] {
        std::fs::copy(root("examples").join(file), folder.join(file)).unwrap();
    }
    runs_in(&folder, name);
}

/// Runs the commands of a page in a folder; each must succeed.
pub fn runs_in(folder: &Path, name: &str) {
    let page = std::fs::read_to_string(root("docs").join(name)).unwrap();
    let text = commands(&page);
    assert!(text.lines().count() > 5, "{text}");
    let program = Path::new(env!("CARGO_BIN_EXE_cognate")).parent().unwrap();
    let mut places = vec![program.to_owned()];
    places.extend(std::env::split_paths(
        &std::env::var_os("PATH").unwrap_or_default(),
    ));
    let done = Command::new("sh")
        .args(["-e", "-x", "-c", &text])
        .env("PATH", std::env::join_paths(places).unwrap())
        .current_dir(folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{name}: {said}");
    assert!(!said.contains("error["), "{name}: {said}");
}

#[test]
fn commands_about_loads_run() {
    runs_as_it_stands("loads.md");
}

#[test]
fn commands_about_exchange_run() {
    runs_as_it_stands("exchange.md");
}
