//! The program as somebody has it who installed it: a copy of the file that the linker wrote.
//!
//! A process of the linker's own file takes 1 to 1.5 ms more than one of a copy, as the pages of that file came into
//! memory one by one; nobody who works with the program runs that file.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A copy of the program, removed in the end.
pub struct Installed {
    folder: PathBuf,
    file: PathBuf,
}

impl Installed {
    /// Copies the program into a folder of its own, named after `what` runs it.
    pub fn new(what: &str) -> Self {
        let folder =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{what}-{}", std::process::id()));
        let program = Path::new(env!("CARGO_BIN_EXE_cognate"));
        let file = folder.join(program.file_name().expect("the program has a name"));
        std::fs::create_dir_all(&folder).expect("a folder for the program");
        std::fs::copy(program, &file).expect("the program is copied");
        Self { folder, file }
    }

    /// Returns a command that runs the copy.
    pub fn command(&self) -> Command {
        Command::new(&self.file)
    }
}

impl Drop for Installed {
    fn drop(&mut self) {
        // one that stays is in the folder for what is temporary
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}
