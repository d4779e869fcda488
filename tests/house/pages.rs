//! Programs of the pages: their pieces, one after the other, are an example, which the compiler reads and people run.

use super::source::root;

/// Pages with pieces in Rust, and the example that each of them is. (The pieces of the README are doc tests.)
const PROGRAMS: [(&str, &str); 1] = [("docs/rust.md", "examples/rust_page.rs")];

fn read(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// The pieces of a page in Rust.
fn pieces(page: &str) -> Vec<&str> {
    let starts = page.split("```rust\n").skip(1);
    let pieces = starts.filter_map(|rest| rest.split("```").next());
    pieces.collect()
}

/// A program without comments, blanks and line ends.
fn bare(program: &str) -> String {
    let lines = program
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    lines.flat_map(str::split_whitespace).collect()
}

#[test]
fn the_pieces_of_a_page_are_one_program() {
    for (page, example) in PROGRAMS {
        let (text, example_text) = (read(page), read(example));
        let program: String = pieces(&text).into_iter().map(bare).collect();
        assert!(!program.is_empty(), "{page} has a program");
        assert!(
            bare(&example_text).contains(&program),
            "{example} must hold the pieces of {page}, in order, with nothing between"
        );
    }
    for page in std::fs::read_dir(root().join("docs"))
        .expect("the pages")
        .flatten()
    {
        let name = format!("docs/{}", page.file_name().to_string_lossy());
        let has_program = name.ends_with(".md") && !pieces(&read(&name)).is_empty();
        let is_known = PROGRAMS.iter().any(|(page, _)| *page == name);
        assert_eq!(has_program, is_known, "{name}");
    }
}
