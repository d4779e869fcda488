//! Makes the gallery: runs every model in `examples/gallery`, draws its picture, and writes the page.
//!
//! ```sh
//! cargo run --example gallery
//! ```
//!
//! A dataset says in comments what the page shows of it:
//!
//! ```text
//! ! look: what to look at                  the paragraph
//! ! draw: --at 0.1 --pale 5 --paths        options of `cognate draw` for the picture
//! ! expect: until 1: LEFT = RIGHT +- TOL   what is known of it; tests/program/gallery.rs checks it
//! ```

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Width of a picture, in px.
const WIDTH: &str = "560";

/// A mechanism of the gallery.
struct Mechanism {
    /// base of the names of its files
    name: String,
    title: String,
    look: String,
    draw: Vec<String>,
}

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    match make(root) {
        Ok(n) => {
            println!("{n} mechanisms: docs/gallery.md");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn make(root: &Path) -> Result<usize, String> {
    let all = mechanisms(&root.join("examples/gallery"))?;
    let program = program()?;
    let pictures = root.join("docs/gallery");
    std::fs::create_dir_all(&pictures).map_err(|e| e.to_string())?;
    for mechanism in &all {
        let model = root
            .join("examples/gallery")
            .join(format!("{}.acf", mechanism.name));
        let picture = pictures.join(format!("{}.svg", mechanism.name));
        let mut draw = Command::new(&program);
        draw.arg("draw").arg(&model).args(&mechanism.draw);
        draw.args(["--width", WIDTH, "--out"]).arg(&picture);
        let done = draw.output().map_err(|e| e.to_string())?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            return Err(format!("{}: {said}", mechanism.name));
        }
    }
    std::fs::write(root.join("docs/gallery.md"), page(&all)).map_err(|e| e.to_string())?;
    Ok(all.len())
}

/// Returns the program that draws, which stands above the examples.
fn program() -> Result<PathBuf, String> {
    let this = std::env::current_exe().map_err(|e| e.to_string())?;
    let folder = this.parent().and_then(Path::parent);
    let program = folder.map(|f| f.join(format!("cognate{}", std::env::consts::EXE_SUFFIX)));
    program
        .filter(|p| p.is_file())
        .ok_or_else(|| "build the program first: cargo build".into())
}

/// Reads what the datasets of a folder say of themselves, in the order of their names.
fn mechanisms(folder: &Path) -> Result<Vec<Mechanism>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| e.to_string())?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "adm"));
    files.sort();
    files.iter().map(|file| mechanism(file)).collect()
}

fn mechanism(file: &Path) -> Result<Mechanism, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let said = |word: &str| {
        let lines = text.lines().filter_map(|line| line.strip_prefix(word));
        lines.map(str::trim).collect::<Vec<_>>().join(" ")
    };
    Ok(Mechanism {
        name: file
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default(),
        title: text.lines().next().unwrap_or_default().to_owned(),
        look: said("! look: "),
        draw: said("! draw: ")
            .split_whitespace()
            .map(str::to_owned)
            .collect(),
    })
}

/// Returns the page.
fn page(all: &[Mechanism]) -> String {
    let mut text = "# Gallery\n\n\
        Each of these is a dataset and a command file in `examples/gallery`, with what is known of it in closed form; tests check\n\
        it. This page and its pictures are made by `cargo run --example gallery`.\n"
        .to_owned();
    for Mechanism {
        name,
        title,
        look,
        draw,
    } in all
    {
        text += &format!(
            "\n## {title}\n\n![{title}](gallery/{name}.svg)\n\n{look}\n\n```sh\n\
             cognate animate examples/gallery/{name}.acf --open\n\
             cognate draw examples/gallery/{name}.acf {} -o {name}.svg\n```\n",
            draw.join(" ")
        );
    }
    text
}
