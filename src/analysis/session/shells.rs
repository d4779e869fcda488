//! The shells of contacts that stand in files: found beside the dataset, read, and made into the
//! corners of their convex hulls.

use crate::dataset::mesh;
use crate::disk;
use crate::model::{Model, Shape};
use crate::scene::contacts::Shell;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Advice about a shell that cannot be used.
const ADVICE: &str = "export it as STL, OBJ or SHL in the units of the model, beside the dataset";

/// Reads the shells of all GRAPHICS that contacts name, by the numbers of these; or the reason why
/// there is none.
pub fn load(model: &Model, folders: &[PathBuf]) -> BTreeMap<u32, Result<Shell, String>> {
    let sides = |c: &crate::model::Contact| [c.i_geometry.clone(), c.j_geometry.clone()].concat();
    let mut out = BTreeMap::new();
    for id in model.contacts.values().flat_map(sides) {
        let Some(Shape::External { file, .. } | Shape::Shell { file, .. }) =
            model.graphics.get(&id).map(|g| &g.shape)
        else {
            continue;
        };
        out.entry(id).or_insert_with(|| shell_of(file, folders));
    }
    out
}

/// Reads the shell in a file; or the reason why there is none.
pub fn shell_of(name: &str, folders: &[PathBuf]) -> Result<Shell, String> {
    let refuse = |why: String| format!("stands in {name:?}: {why}; {ADVICE}");
    let kernel = [
        ".x_t", ".x_b", ".xmt_txt", ".xmt_bin", ".xmt", ".step", ".stp", ".igs", ".iges", ".sat",
    ];
    if kernel
        .iter()
        .any(|e| name.to_ascii_lowercase().ends_with(e))
    {
        return Err(refuse(
            "a solid of a CAD kernel, which cannot be read".into(),
        ));
    }
    let Some(path) = mesh::find(name, folders) else {
        return Err(refuse("there is no such file".into()));
    };
    let size = disk::metadata(&path).map_or(0, |m| m.len());
    if size > mesh::MOST_BYTES {
        return Err(refuse(format!("{size} bytes are too many")));
    }
    let bytes = disk::read(&path).map_err(|e| refuse(format!("it cannot be opened: {e}")))?;
    let points = mesh::points(name, &bytes).map_err(refuse)?;
    let n = points.len();
    let (corners, outside) = hull(&points).map_err(refuse)?;
    Ok(Shell {
        file: name.to_owned(),
        points: n,
        corners,
        outside,
    })
}

#[cfg(feature = "geometry")]
fn hull(points: &[[f64; 3]]) -> Result<(Vec<[f64; 3]>, f64), String> {
    match crate::physics::contact::query::hull::corners(points) {
        Some(found) => Ok((found.corners, found.outside)),
        None => Err("its points span no volume; what is flat is a GRAPHICS PLANE".into()),
    }
}

#[cfg(not(feature = "geometry"))]
fn hull(_: &[[f64; 3]]) -> Result<(Vec<[f64; 3]>, f64), String> {
    Err("this program was built without the feature geometry".into())
}
