//! Closed forms: elliptic functions, pendulums, bodies that tumble, and the parts that scenes are made of.

/// Jacobi's sn, cn, dn of `u` with parameter `m` = k², by descending Landen transformations.
pub fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut a, mut b, mut ratios) = (1.0, (1.0 - m).sqrt(), Vec::new());
    let mut c = m.sqrt();
    while c > 1e-17 {
        ratios.push((a, c));
        (a, b, c) = ((a + b) / 2.0, (a * b).sqrt(), (a - b) / 2.0);
        if ratios.len() > 30 {
            break;
        }
    }
    let mut phi = a * u * 2f64.powi(ratios.len() as i32);
    // each step uses c of the level it comes from and a of that level
    let mut levels = ratios.clone();
    levels.push((a, c));
    for k in (1..levels.len()).rev() {
        let (a, c) = levels[k];
        phi = (phi + (c / a * phi.sin()).clamp(-1.0, 1.0).asin()) / 2.0;
    }
    let (s, cn) = phi.sin_cos();
    [s, cn, (1.0 - m * s * s).sqrt()]
}

/// Complete elliptic integral of the first kind.
pub fn elliptic_k(m: f64) -> f64 {
    let (mut a, mut b) = (1.0f64, (1.0 - m).sqrt());
    // converges quadratically
    for _ in 0..10 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

/// Angle from the lowest position of a pendulum released at rest from `amplitude`; `omega` = √(g/l).
pub fn pendulum(t: f64, omega: f64, amplitude: f64) -> f64 {
    let k = (amplitude / 2.0).sin();
    let [sn, ..] = jacobi(elliptic_k(k * k) - omega * t, k * k);
    2.0 * (k * sn).asin()
}

/// A slider along the x axis of ground: part 2 with MARKER/20, guided by JOINT/1 against MARKER/11.
pub fn slider(mass: f64, x: f64, speed: f64) -> String {
    format!(
        "PART/2, MASS={mass:e}, CM=20, QG={x:e},0,0, VX={speed:e}\n\
         MARKER/20, PART=2, REULER=90D,90D,0\n\
         MARKER/11, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=20, J=11\n"
    )
}

/// A force on the slider along x.
pub fn push(function: &str) -> String {
    format!("SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION={function}\n")
}

/// A rotor about the z axis of ground: part 2 with MARKER/20 at its centre and MARKER/21 at radius 1, on JOINT/1.
pub fn rotor(inertia: f64, speed: f64) -> String {
    format!(
        "PART/2, MASS=1, CM=20, IP={inertia:e},{inertia:e},{inertia:e}, WZ={speed:e}\n\
         MARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\n"
    )
}

/// A free body with MARKER/20 at its centre and MARKER/21, 22, 23 one length along its axes.
pub fn free_body(mass: f64, inertia: [f64; 3], v: [f64; 3], w: [f64; 3]) -> String {
    format!(
        "PART/2, MASS={mass:e}, CM=20, IP={:e},{:e},{:e}, VX={:e}, VY={:e}, VZ={:e}, WX={:e}, WY={:e}, WZ={:e}\n\
         MARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\nMARKER/22, PART=2, QP=0,1,0\nMARKER/23, PART=2, QP=0,0,1\n",
        inertia[0], inertia[1], inertia[2], v[0], v[1], v[2], w[0], w[1], w[2]
    )
}
