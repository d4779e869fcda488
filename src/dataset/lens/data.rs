//! Data elements: rows of a spline, the order of a matrix.

use super::*;

/// A row of a SPLINE: the values, preceded by z in a surface.
pub fn put_spline_row(spline: &mut SplineData, value: Value) -> Done {
    spline.y.push(list(value)?);
    Ok(())
}

/// See [`put_spline_row`].
pub fn spline_rows(spline: &SplineData) -> Vec<Value> {
    let row = |(k, y): (usize, &Vec<f64>)| {
        let z = spline.z.get(k).into_iter();
        Value::Reals(z.chain(y).copied().map(Number::plain).collect())
    };
    spline.y.iter().enumerate().map(row).collect()
}

/// Several rows, each one longer than X, are a surface: their first numbers are z.
pub fn spline_surface(spline: &mut SplineData) -> Done {
    let n = spline.x.len();
    if spline.z.is_empty() && spline.y.len() > 1 && spline.y.iter().all(|y| y.len() == n + 1) {
        spline.z = spline.y.iter_mut().map(|y| y.remove(0)).collect();
    }
    Ok(())
}

/// FULL=RORDER or CORDER.
pub fn put_matrix_order(matrix: &mut Matrix, value: Value) -> Done {
    matrix.layout = match value == Value::Word("CORDER".into()) {
        true => MatrixLayout::ByColumns,
        false => MatrixLayout::ByRows,
    };
    Ok(())
}

/// See [`put_matrix_order`].
pub fn matrix_order(matrix: &Matrix) -> Option<Value> {
    let word = match matrix.layout {
        MatrixLayout::ByRows => "RORDER",
        MatrixLayout::ByColumns => "CORDER",
        MatrixLayout::Sparse { .. } => return None,
    };
    let told = matrix.file.is_none() || matrix.layout == MatrixLayout::ByColumns;
    told.then(|| Value::Word(word.into()))
}
