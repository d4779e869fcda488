//! The repository, whose files tests of both packages read.

use std::path::{Path, PathBuf};

/// Returns the place of a file of the repository; the package of a test is the repository or lies in it.
pub fn root(file: &str) -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut above = package.ancestors();
    let root = above.find(|folder| folder.join("ARCHITECTURE.md").is_file());
    root.unwrap_or(package).join(file)
}
