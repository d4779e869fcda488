//! The binary as tests run it: arguments and input in, exit code and texts out.

use crate::repository::root;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// What a command did: exit code, standard output, standard error.
pub struct Done {
    pub code: i32,
    pub out: String,
    pub err: String,
}

pub fn cognate_with(args: &[&str], input: &str) -> Done {
    let mut child = Command::new(env!("CARGO_BIN_EXE_cognate"))
        .args(args)
        .current_dir(root(""))
        .env_remove("COLUMNS")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that does not read its input may end before all of it is written.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Done {
        code: output.status.code().unwrap(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

pub fn cognate(args: &[&str]) -> Done {
    cognate_with(args, "")
}

/// What a command did that must succeed.
pub fn ok(args: &[&str]) -> Done {
    let done = cognate(args);
    assert_eq!(done.code, 0, "{args:?}: {}", done.err);
    done
}

/// A file of this name in a folder of this test's own.
pub fn scratch(test: &str, name: &str, contents: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join(name);
    std::fs::write(&file, contents).unwrap();
    file
}

pub fn path(file: &std::path::Path) -> &str {
    file.to_str().unwrap()
}

/// What a piped session prints, results and mistakes in the order in which they come, and its exit code.
#[allow(dead_code, reason = "not every test talks to the prompt")]
pub fn session(lines: &str, name: &str) -> (String, i32) {
    let file = scratch("session", name, "");
    let both = std::fs::File::create(&file).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_cognate"))
        .arg("repl")
        .current_dir(root(""))
        .env_remove("COLUMNS")
        .stdin(Stdio::piped())
        .stdout(both.try_clone().unwrap())
        .stderr(both)
        .spawn()
        .unwrap();
    let _ = child.stdin.take().unwrap().write_all(lines.as_bytes());
    let code = child.wait().unwrap().code().unwrap();
    (std::fs::read_to_string(file).unwrap(), code)
}
