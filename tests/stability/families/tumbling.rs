//! Free bodies that tumble.

use crate::laws::{free_body, jacobi};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn tumbling() -> Vec<Scene> {
    let f = "tumbling";
    let mut all = Vec::new();
    for (a, c, spin) in [(1.0f64, 2.0, 3.0), (1.0, 0.01, 50.0), (1.0, 1.999, 0.1)] {
        // symmetric: ω about the figure axis stays, the rest turns at (C − A)/A ω₃
        let rate = (c - a) / a * spin;
        let text = free_body(1.0, [a, a, c], [0.0; 3], [0.5, 0.0, spin]);
        all.push(
            scene(f, format!("symmetric top {a}:{c} at {spin}"), text)
                .end(5.0)
                .follows("WX(20,1,20)", move |t| 0.5 * (rate * t).cos(), 1e-5)
                .follows("WY(20,1,20)", move |t| 0.5 * (rate * t).sin(), 1e-5)
                .follows("WZ(20,1,20)", move |_| spin, 1e-6 * spin),
        );
    }
    // asymmetric: A ω₁ ω₁' …: with A > B > C and energy beyond the separatrix about the largest axis
    let inertia = [3.0f64, 2.0, 1.0];
    for (k, w) in [[1.0, 0.0, 0.2], [1.0, 0.0, 0.9], [0.3, 0.0, 2.0]]
        .into_iter()
        .enumerate()
    {
        let [a, b, c] = inertia;
        let energy = a * w[0] * w[0] + c * w[2] * w[2];
        let momentum = a * a * w[0] * w[0] + c * c * w[2] * w[2];
        // L² > 2 T B: the body turns round its axis of largest inertia
        let about_largest = momentum > energy * b;
        let (i, k1) = if about_largest { (0, 2) } else { (2, 0) };
        let (p, q) = (inertia[i], inertia[k1]);
        let w1 = w[i];
        let w3 = w[k1];
        let m = (momentum - energy * q).abs();
        let n = (energy * p - momentum).abs();
        let rate = (m * (p - b).abs() / (a * b * c)).sqrt();
        let parameter = n * (b - q).abs() / (m * (p - b).abs());
        let text = free_body(1.0, inertia, [0.0; 3], w);
        let columns = ["WX(20,1,20)", "WY(20,1,20)", "WZ(20,1,20)"];
        all.push(
            scene(f, format!("asymmetric body {k}"), text)
                .end(10.0)
                .error(1e-10)
                .follows(
                    columns[i],
                    move |t| w1 * jacobi(rate * t, parameter)[2],
                    1e-6,
                )
                .follows(
                    columns[k1],
                    move |t| w3 * jacobi(rate * t, parameter)[1],
                    1e-6,
                ),
        );
    }
    all
}
