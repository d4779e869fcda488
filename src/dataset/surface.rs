//! Surfaces of the shells that GRAPHICS name by file, for pictures: points and polygons, in the
//! frame of their marker.
//!
//! ```text
//! .stl   three points a facet, one facet after the other
//! .obj   f 1 2 3 …      numbers of points from 1, or from the last backwards; 1/2/3 has others behind its slashes
//! .shl   n i j k …      behind the points: how many, then their numbers from 1
//! ```

use super::mesh::{self, MOST_BYTES};
use crate::disk;
use crate::model::{ElementId, ElementKind, Model, Shape};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A surface of polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// corners   (length)
    pub points: Vec<[f64; 3]>,
    /// indices of the corners of each polygon, at least three
    pub faces: Vec<Vec<u32>>,
}

/// The surfaces of a model, and the GRAPHICS whose files cannot be read, with the reason.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    /// by the numbers of their GRAPHICS
    pub known: BTreeMap<u32, Surface>,
    /// the others
    pub unread: Vec<(ElementId, String)>,
}

impl Surfaces {
    /// Reads the files of all GRAPHICS that name one, beside the dataset or as they are named.
    pub fn read(model: &Model, folders: &[PathBuf]) -> Self {
        let mut found = Self::default();
        for (&number, graphics) in &model.graphics {
            let (Shape::External { file, .. } | Shape::Shell { file, .. }) = &graphics.shape else {
                continue;
            };
            match of_file(file, folders) {
                Ok(surface) => drop(found.known.insert(number, surface)),
                Err(why) => {
                    let id = ElementKind::Graphics.id(number);
                    found.unread.push((id, format!("{file:?}: {why}")));
                }
            }
        }
        found
    }
}

fn of_file(name: &str, folders: &[PathBuf]) -> Result<Surface, String> {
    let path = mesh::find(name, folders).ok_or("there is no such file")?;
    let size = disk::metadata(&path).map_or(0, |m| m.len());
    if size > MOST_BYTES {
        return Err(format!("{size} bytes are too many"));
    }
    let bytes = disk::read(&path).map_err(|e| format!("it cannot be opened: {e}"))?;
    surface(name, &bytes)
}

/// Reads the surface of a shell.
///
/// # Errors
/// Mistakes in the file, with the line where there is one.
pub fn surface(name: &str, bytes: &[u8]) -> Result<Surface, String> {
    let points = mesh::points(name, bytes)?;
    let ends =
        |ending: &str| !mesh::is_binary(name, bytes) && name.to_ascii_lowercase().ends_with(ending);
    let text = || String::from_utf8_lossy(bytes);
    let faces = if ends(".obj") {
        of_obj(&text(), points.len())?
    } else if ends(".shl") {
        of_shl(&text(), points.len())?
    } else {
        let n = u32::try_from(points.len() / 3).unwrap_or(u32::MAX);
        (0..n).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect()
    };
    if faces.is_empty() {
        return Err("it holds no polygon".into());
    }
    Ok(Surface { points, faces })
}

/// Returns the index of a point from its number, which counts from 1, or from -1 backwards.
fn index(number: i64, n: usize) -> Option<u32> {
    let n = i64::try_from(n).ok()?;
    let index = if number < 0 { n + number } else { number - 1 };
    u32::try_from(index).ok().filter(|&k| i64::from(k) < n)
}

fn of_obj(text: &str, n: usize) -> Result<Vec<Vec<u32>>, String> {
    let mut faces = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        if words.next() != Some("f") {
            continue;
        }
        let number = |word: &str| word.split('/').next().and_then(|w| w.parse().ok());
        let corners: Option<Vec<u32>> = words.map(|w| index(number(w)?, n)).collect();
        match corners {
            Some(corners) if corners.len() > 2 => faces.push(corners),
            Some(_) => {}
            None => {
                return Err(format!(
                    "line {}: a polygon names points that there are",
                    k + 1
                ));
            }
        }
    }
    Ok(faces)
}

fn of_shl(text: &str, n: usize) -> Result<Vec<Vec<u32>>, String> {
    let mut faces = Vec::new();
    for (line, words) in mesh::rows_of_shl(text).skip(1 + n) {
        let numbers: Option<Vec<i64>> = words.iter().map(|w| w.parse().ok()).collect();
        let corners = numbers.as_deref().and_then(|all| {
            let (&count, corners) = all.split_first()?;
            let corners = corners.get(..usize::try_from(count).ok()?)?;
            corners
                .iter()
                .map(|&c| index(c, n))
                .collect::<Option<Vec<u32>>>()
        });
        match corners {
            Some(corners) if corners.len() > 2 => faces.push(corners),
            Some(_) => {}
            None => {
                return Err(format!(
                    "line {line}: a polygon names points that there are"
                ));
            }
        }
    }
    Ok(faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_of_every_format_are_those_of_the_solid() {
        let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3 -1\n";
        let shl = "4 1\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 1 2 3 4\n";
        for (name, text) in [("a.obj", obj), ("a.shl", shl)] {
            let found = surface(name, text.as_bytes()).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(
                (found.points.len(), found.faces),
                (4, vec![vec![0, 1, 2, 3]]),
                "{name}"
            );
        }
        let stl = "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n";
        assert_eq!(
            surface("a.stl", stl.as_bytes()).unwrap().faces,
            [vec![0, 1, 2]]
        );
        for (name, text) in [
            ("a.obj", "v 0 0 0\nf 1 2 3\n"),
            ("a.shl", "1 1\n0 0 0\n3 1 1 2\n"),
            ("a.obj", "v 0 0 0\n"),
        ] {
            assert!(surface(name, text.as_bytes()).is_err(), "{text}");
        }
    }
}
