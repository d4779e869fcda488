//! BEAM: the stiffness of a slender straight beam with uniform section between two markers
//! (Timoshenko's element).
//!
//! J is the root, I the tip; x of J runs along the undeflected beam, so that I is at (L, 0, 0)
//! there.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | length | L | LENGTH | length | – |
//! | area | A | AREA | length² | – |
//! | torsion constant, second moments of area | Jₓ, I_yy, I_zz | IXX, IYY, IZZ | length⁴ | – |
//! | moduli | E, G | EMODULUS, GMODULUS | force/length² | – |
//! | shear factors | a_y, a_z | ASY, ASZ | 1 | 0: no shear deformation |
//! | damping | C | CRATIO · K, or CMATRIX | | 0.01 K |
//!
//! ```text
//! P_y = 12 E I_zz a_y/(G A L²)      P_z = 12 E I_yy a_z/(G A L²)
//! K₁₁ = E A/L                       K₄₄ = G Jₓ/L
//! K₂₂ = 12 E I_zz/(L³ (1 + P_y))    K₃₃ = 12 E I_yy/(L³ (1 + P_z))
//! K₂₆ = −6 E I_zz/(L² (1 + P_y))    K₃₅ = +6 E I_yy/(L² (1 + P_z))
//! K₅₅ = (4 + P_z) E I_yy/(L (1 + P_z))    K₆₆ = (4 + P_y) E I_zz/(L (1 + P_y))
//! ```
//!
//! These are the rows of the tip; the forces at the root follow from equilibrium, which yields the
//! other half of the 12 × 12 matrix. Deflections and rotations of the tip against the root must be
//! small. FORMULATION=STRING and NONLINEAR, which stiffen under tension, are not solved: the linear
//! law stands for them, with a warning.

/// The section, length and material of a beam.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// L, in length units
    pub length: f64,
    /// A, in length²
    pub area: f64,
    /// Jₓ, I_yy, I_zz, in length⁴
    pub second_moments: [f64; 3],
    /// a_y, a_z, pure numbers
    pub shear: [f64; 2],
    /// E, in force/length²
    pub youngs_modulus: f64,
    /// G, in force/length²
    pub shear_modulus: f64,
}

impl Section {
    /// Returns K by rows: forces and torques at the tip from its displacements, in the axes of the
    /// root.
    pub fn stiffness(&self) -> [[f64; 6]; 6] {
        let (l, e, g) = (self.length, self.youngs_modulus, self.shear_modulus);
        let [jx, iyy, izz] = self.second_moments;
        let softening = |factor: f64, moment: f64| {
            if factor == 0.0 {
                0.0
            } else {
                12.0 * e * moment * factor / (g * self.area * l * l)
            }
        };
        let (py, pz) = (softening(self.shear[0], izz), softening(self.shear[1], iyy));
        let (by, bz) = (e * izz / (1.0 + py), e * iyy / (1.0 + pz));
        let mut k = [[0.0; 6]; 6];
        k[0][0] = e * self.area / l;
        k[1][1] = 12.0 * by / (l * l * l);
        k[2][2] = 12.0 * bz / (l * l * l);
        k[3][3] = g * jx / l;
        k[4][4] = (4.0 + pz) * bz / l;
        k[5][5] = (4.0 + py) * by / l;
        (k[1][5], k[5][1]) = (-6.0 * by / (l * l), -6.0 * by / (l * l));
        (k[2][4], k[4][2]) = (6.0 * bz / (l * l), 6.0 * bz / (l * l));
        k
    }
}
