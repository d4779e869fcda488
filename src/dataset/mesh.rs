//! Points of the shells that GRAPHICS name by file: Adams shell (`.shl`), STL (text and binary),
//! Wavefront (`.obj`).
//!
//! ```text
//! .shl   n_points n_polygons [scale]      then n_points lines x y z, then the polygons, which are not needed here
//! .stl   solid … facet normal … vertex x y z …      or 80 bytes, u32 n, n times 12 f32 (normal, three corners) and u16
//! .obj   v x y z …
//! ```
//!
//! The solid that touches is the convex hull of the points (`physics/contact/query/hull.rs`), so
//! that polygons are of no use. Lengths are in the units of the model. A file is taken as what it
//! is, whatever its name ends with. Nothing is reserved on the word of a file: there are never more
//! points than bytes.

use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Largest file that is read, in bytes.
pub const MOST_BYTES: u64 = 1 << 28;

/// Finds the file of this name, as given or beside the dataset; of a path of another machine its
/// last part.
pub fn find(name: &str, folders: &[PathBuf]) -> Option<PathBuf> {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let here = [PathBuf::new()];
    let all = folders.iter().chain(&here);
    let mut named = all.flat_map(|folder| [folder.join(name), folder.join(last)]);
    named.find(|p: &PathBuf| Path::is_file(p))
}

/// Returns whether a file is a binary STL.
pub(super) fn is_binary(name: &str, bytes: &[u8]) -> bool {
    let is_stl = name.to_ascii_lowercase().ends_with(".stl");
    binary_facets(bytes).is_some_and(|n| 84 + 50 * n == bytes.len() || is_stl && !is_text(bytes))
}

/// The points of a shell.
///
/// # Errors
/// Mistakes in the file, with the line where there is one.
pub fn points(name: &str, bytes: &[u8]) -> Result<Vec<[f64; 3]>, String> {
    let ends = |ending: &str| name.to_ascii_lowercase().ends_with(ending);
    if let Some(n) = binary_facets(bytes).filter(|_| is_binary(name, bytes)) {
        return binary(bytes, n);
    }
    let text = String::from_utf8_lossy(bytes);
    let says = |word: &str| {
        text.split_ascii_whitespace()
            .any(|w| w.eq_ignore_ascii_case(word))
    };
    let points = if ends(".obj") {
        lines(&text, "v")?
    } else if ends(".shl") {
        shell(&text)?
    } else if ends(".stl") || says("facet") && says("vertex") {
        lines(&text, "vertex")?
    } else {
        return Err("it is no shell that can be read: STL, OBJ and SHL are".into());
    };
    if points.is_empty() {
        return Err("it holds no point".into());
    }
    Ok(points)
}

/// Returns true if the beginning of a file is text.
fn is_text(bytes: &[u8]) -> bool {
    bytes.starts_with(b"solid") && !bytes.iter().take(1000).any(|&b| b == 0)
}

/// Returns the number of facets that a binary STL announces.
fn binary_facets(bytes: &[u8]) -> Option<usize> {
    let n = bytes.get(80..84)?.try_into().ok()?;
    Some(u32::from_le_bytes(n) as usize)
}

fn binary(bytes: &[u8], n: usize) -> Result<Vec<[f64; 3]>, String> {
    let facets = bytes.get(84..).unwrap_or_default();
    let there = facets.len() / 50;
    if there < n {
        return Err(format!("it ends early: {there} facets of {n}"));
    }
    let mut out = Vec::with_capacity(3 * n);
    for (k, facet) in facets.chunks_exact(50).take(n).enumerate() {
        let (numbers, _) = facet[12..].as_chunks::<4>();
        for corner in numbers.chunks_exact(3).take(3) {
            let p = [0, 1, 2].map(|k| f64::from(f32::from_le_bytes(corner[k])));
            if !p.iter().all(|x| x.is_finite()) {
                return Err(format!("facet {} has a corner that is no number", k + 1));
            }
            out.push(p);
        }
    }
    Ok(out)
}

/// A number of a word, with the exponents of FORTRAN.
fn number(word: &str) -> Option<f64> {
    let x = f64::from_str(word).or_else(|_| f64::from_str(&word.replace(['d', 'D'], "e")));
    x.ok().filter(|x| x.is_finite())
}

/// The points of the lines that begin with a word.
fn lines(text: &str, begins: &str) -> Result<Vec<[f64; 3]>, String> {
    let mut out = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        if !words.next().is_some_and(|w| w.eq_ignore_ascii_case(begins)) {
            continue;
        }
        let mut next = || words.next().and_then(number);
        match (next(), next(), next()) {
            (Some(x), Some(y), Some(z)) => out.push([x, y, z]),
            _ => return Err(format!("line {}: a point has three numbers", k + 1)),
        }
    }
    Ok(out)
}

/// Returns the words of each line of a shell with its number: blank lines and remarks are none.
pub(super) fn rows_of_shl(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    text.lines().enumerate().filter_map(|(k, line)| {
        let line = line.split(['!', '#']).next().unwrap_or_default();
        let words = line.split(|c: char| c.is_whitespace() || c == ',');
        let words: Vec<&str> = words.filter(|w| !w.is_empty()).collect();
        (!words.is_empty()).then_some((k + 1, words))
    })
}

/// Line by line, as the lines of a shell count its points.
fn shell(text: &str) -> Result<Vec<[f64; 3]>, String> {
    let mut rows = rows_of_shl(text);
    let Some((_, head)) = rows.next() else {
        return Ok(Vec::new());
    };
    let count = |k: usize| head.get(k).and_then(|w| w.parse::<usize>().ok());
    let (Some(n), Some(_)) = (count(0), count(1)) else {
        return Err("its first line is not the number of points and of polygons".into());
    };
    let scale = head
        .get(2)
        .and_then(|w| number(w))
        .filter(|&s| s != 0.0)
        .unwrap_or(1.0);
    let mut out = Vec::new();
    for _ in 0..n {
        let Some((line, words)) = rows.next() else {
            return Err(format!("it ends early, after {} of {n} points", out.len()));
        };
        let numbers: Option<Vec<f64>> = words.iter().map(|w| number(w)).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) => out.push([x, y, z].map(|x| x * scale)),
            _ => return Err(format!("line {line}: a point has three numbers")),
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[f64; 3]; 4] =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];

    fn stl() -> String {
        let mut text = String::from("solid t\n");
        for f in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
            text += "facet normal 0 0 0\n outer loop\n";
            for k in f {
                let [x, y, z] = TETRAHEDRON[k];
                text += &format!("  vertex {x:e} {y} {z}\n");
            }
            text += " endloop\nendfacet\n";
        }
        text + "endsolid t\n"
    }

    fn binary_stl() -> Vec<u8> {
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(4_u32.to_le_bytes());
        for f in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
            bytes.extend([0; 12]);
            for k in f {
                bytes.extend(
                    TETRAHEDRON[k]
                        .iter()
                        .flat_map(|&x| (x as f32).to_le_bytes()),
                );
            }
            bytes.extend([0, 0]);
        }
        bytes
    }

    const SHL: &str =
        "4 4 0.5\n0 0 0\n2 0 0 ! remark\n\n0, 4D0, 0\n0 0 6\n3 1 3 2\n3 1 2 4\n3 1 4 3\n3 2 3 4\n";

    fn distinct(mut p: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
        p.sort_by(|a, b| a.partial_cmp(b).unwrap());
        p.dedup();
        p
    }

    #[test]
    fn every_format_gives_the_same_points() {
        let expected = distinct(TETRAHEDRON.to_vec());
        let obj = "# t\nv 0 0 0\nv 1 0 0 1.0\nvn 0 0 1\nv 0 2 0\nv 0 0 3\nf 1 2 3\n";
        for (name, bytes) in [
            ("a.STL", stl().as_bytes()),
            ("a.stl", &binary_stl()),
            ("a.bin", &binary_stl()),
            ("a.txt", stl().as_bytes()),
            ("a.obj", obj.as_bytes()),
            ("A.SHL", SHL.as_bytes()),
        ] {
            let found = points(name, bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(distinct(found), expected, "{name}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (name, text, said) in [
            ("a.shl", "4 4\n0 0 0\n1 0 0\n", "2 of 4 points"),
            ("a.shl", "99999999999 4\n0 0 0\n", "1 of 99999999999 points"),
            ("a.shl", "4 4\n0 0 0\n1 0\n", "line 3"),
            ("a.shl", "tetrahedron\n", "first line"),
            ("a.shl", "", "no point"),
            ("a.stl", "solid\nvertex 1 2\n", "line 2"),
            ("a.stl", "solid\nvertex 1 2 nan\n", "line 2"),
            ("a.stl", "solid\nendsolid\n", "no point"),
            ("a.obj", "v 1 2 x\n", "line 1"),
            (
                "a.x_t",
                "**ABCDEFGHIJKLMNOPQRSTUVWXYZ\n",
                "STL, OBJ and SHL",
            ),
        ] {
            let found = points(name, text.as_bytes()).expect_err(text);
            assert!(found.contains(said), "{text}: {found}");
        }
        let short = &binary_stl()[..200];
        assert!(
            points("a.stl", short)
                .unwrap_err()
                .contains("2 facets of 4")
        );
    }

    #[test]
    fn no_bytes_are_too_odd() {
        let (text, bytes) = (stl(), binary_stl());
        for name in ["a.stl", "a.obj", "a.shl", "a"] {
            for source in [text.as_bytes(), &bytes, SHL.as_bytes()] {
                let mut state = 12345_u64;
                for cut in 0..300.min(source.len()) {
                    let mut odd = source[..source.len() - cut].to_vec();
                    for _ in 0..3 {
                        // any generator would do
                        state = state
                            .wrapping_mul(6_364_136_223_846_793_005)
                            .wrapping_add(1);
                        let at = (state >> 33) as usize % odd.len().max(1);
                        if let Some(b) = odd.get_mut(at) {
                            *b = (state >> 56) as u8;
                        }
                    }
                    if let Ok(found) = points(name, &odd) {
                        assert!(found.len() <= odd.len());
                        assert!(found.iter().flatten().all(|x| x.is_finite()));
                    }
                }
            }
        }
    }
}
