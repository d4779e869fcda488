//! `docs/first-hour.md`, typed word by word: files are written and changed as it says, commands are given in its order, and every
//! answer and every picture is compared. With BLESS=1 the answers and pictures are written, to be read.

use super::command::scratch;
use crate::repository::root;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn docs() -> PathBuf {
    root("docs")
}

/// Words of a line as a shell takes them apart: blanks part them but between quotes.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_quoted = false;
    for c in line.chars() {
        match c {
            '\'' => is_quoted = !is_quoted,
            ' ' if !is_quoted => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|w| !w.is_empty());
    words
}

/// What a command prints, results and remarks in their order.
fn printed(folder: &Path, arguments: &[String], input: &str) -> String {
    let file = folder.join(".printed");
    let both = std::fs::File::create(&file).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_cognate"))
        .args(arguments)
        .current_dir(folder)
        .env_remove("COLUMNS")
        .stdin(Stdio::piped())
        .stdout(both.try_clone().unwrap())
        .stderr(both)
        .spawn()
        .unwrap();
    let _ = std::io::Write::write_all(&mut child.stdin.take().unwrap(), input.as_bytes());
    child.wait().unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(file).unwrap();
    let line = |line: &str| match line.split_once("solved in ") {
        Some((before, _)) => format!("{before}solved in …\n"),
        None => format!("{}\n", line.trim_end()),
    };
    text.lines().map(line).collect()
}

/// A block of the page as it is after all that it says was done in a folder.
fn done(folder: &Path, head: &str, body: &str) -> String {
    let (kind, file) = head.split_once(' ').unwrap_or((head, ""));
    match kind {
        "adams" => {
            std::fs::write(folder.join(file), body).unwrap();
            body.to_owned()
        }
        // the first line becomes the others
        "edit" => {
            let (old, new) = body.split_once('\n').unwrap();
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            let old = format!("{old}\n");
            assert_eq!(text.matches(&old).count(), 1, "{file}: {old}");
            std::fs::write(folder.join(file), text.replace(&old, new)).unwrap();
            body.to_owned()
        }
        "sh" => {
            let commands = body.lines().filter(|l| l.starts_with("$ "));
            let answered = commands.map(|line| {
                let words = words(&line[2..]);
                assert_eq!(words[0], "cognate", "{line}");
                format!("{line}\n{}", printed(folder, &words[1..], ""))
            });
            answered.collect()
        }
        "repl" => {
            let lines: Vec<&str> = body.lines().filter(|l| l.starts_with("> ")).collect();
            // a number behind each line shows where its answer ends
            let mark = |k: usize| format!("{}\n", 770_000_000 + k);
            let numbered = lines.iter().enumerate();
            let input = numbered.map(|(k, line)| format!("{}\n{}", &line[2..], mark(k)));
            let mut rest = printed(folder, &["repl".to_owned()], &input.collect::<String>());
            let mut text = String::new();
            for (k, line) in lines.iter().enumerate() {
                let (answer, others) = rest.split_once(&mark(k)).unwrap_or((&rest, ""));
                text += &format!("{line}\n{answer}");
                rest = others.to_owned();
            }
            text
        }
        _ => body.to_owned(),
    }
}

#[test]
fn the_first_hour_goes_as_it_says() {
    let folder = scratch("first_hour", "x", "").with_file_name("folder");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let page = docs().join("first-hour.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let mut now = String::new();
    for (k, part) in text.split("```").enumerate() {
        match part.split_once('\n') {
            Some((head, body)) if k % 2 == 1 => {
                now += &format!("```{head}\n{}```", done(&folder, head, body));
            }
            _ => now += part,
        }
    }
    let pictures: Vec<&str> = text
        .split("](first-hour/")
        .skip(1)
        .filter_map(|rest| Some(rest.split_once(')')?.0))
        .collect();
    assert!(pictures.len() > 1, "{pictures:?}");
    let blessed = std::env::var_os("BLESS").is_some();
    if blessed {
        std::fs::write(&page, &now).unwrap();
    }
    for (is, was) in now.lines().zip(text.lines()).filter(|_| !blessed) {
        assert_eq!(
            is, was,
            "docs/first-hour.md: BLESS=1 cargo test --test program first_hour:: writes it"
        );
    }
    assert!(blessed || now == text, "the page ends otherwise");
    for picture in pictures {
        let kept = docs().join("first-hour").join(picture);
        let drawn = std::fs::read(folder.join(picture)).unwrap();
        if blessed {
            std::fs::create_dir_all(kept.parent().unwrap()).unwrap();
            std::fs::write(&kept, &drawn).unwrap();
        }
        assert!(
            std::fs::read(&kept).unwrap() == drawn,
            "docs/first-hour/{picture} is another picture"
        );
    }
    for file in ["bar.html", "drawing.png", "sure.pdf", "half.svg"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
}
