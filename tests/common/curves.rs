//! Curves as datasets write them.
#![allow(dead_code)] // each test binary uses its own part

/// A MATRIX and a CURVE through its points.
pub fn curve(id: u32, kind: &str, points: &[[f64; 2]]) -> String {
    let mut text = format!(
        "MATRIX/{id}, FULL=RORDER, ROWS={}, COLUMNS=3, VALUES=",
        points.len()
    );
    for (k, p) in points.iter().enumerate() {
        let comma = if k == 0 { "" } else { "," };
        text += &format!("{comma}\n, {:.17},{:.17},0", p[0], p[1]);
    }
    text + &format!("\nCURVE/{id}, {kind}, MATRIX={id}, CURVE_POINTS\n")
}

/// Points of a circle, the last like the first. The spline through n of them is off by R (2π/n)⁴/384: 2e-9 R for 200.
pub fn circle(radius: f64, n: usize) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    points.push(points[0]);
    points
}

/// Points of a straight line along x.
pub fn line(from: f64, to: f64) -> Vec<[f64; 2]> {
    (0..5)
        .map(|k| [from + (to - from) * f64::from(k) / 4.0, 0.0])
        .collect()
}
