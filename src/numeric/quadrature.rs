//! Quadrature over an accepted step: integrals along a motion, with nodes of the method.

use super::{Failure, Method};

/// A node of a quadrature over a step.
#[derive(Clone, Copy, Debug)]
pub struct Node<'a> {
    /// weight, in s: those of a step add up to its length
    pub weight: f64,
    /// time, in s
    pub t: f64,
    /// solution   (n)
    pub y: &'a [f64],
    /// its rate   (n)
    pub ydot: &'a [f64],
}

/// Abscissa and weight of each node of a rule over [0, 1].
pub type Rule = [(f64, f64)];

/// Gauss' rule of seven nodes, exact to degree 13, and that of Kronrod with eight more, exact to
/// degree 22: half the distance from the middle, the weight of Kronrod's rule and that of Gauss', 0
/// where it has no node. But for the first each stands for two nodes, one on either side.
pub const GAUSS_KRONROD_15: [(f64, f64, f64); 8] = [
    (0.0, 0.10474107054236391, 0.2089795918367347),
    (0.10389247750394923, 0.10221647003764945, 0.0),
    (0.2029225756886986, 0.0951752890323927, 0.19091502525255947),
    (0.2930436177338456, 0.08450236331963395, 0.0),
    (0.3707655927996972, 0.07032662985776296, 0.13985269574463833),
    (0.43243221167988453, 0.05239500516112509, 0.0),
    (
        0.47455395617137926,
        0.03154604631498928,
        0.06474248308443485,
    ),
    (0.4957276855604063, 0.011467661005264612, 0.0),
];

/// Radau IIA, exact to degree 4: where that method is as good at its nodes as at the end.
pub const RADAU_3: [(f64, f64); 3] = [
    (0.1550510257216822, 0.376403062700467),
    (0.644948974278318, 0.512485826188422),
    (1.0, 1.0 / 9.0),
];

/// Visits the nodes of a rule on the interpolant of the last accepted step, which has these `ends`.
///
/// # Errors
/// When a further evaluation that the interpolant needs fails.
pub fn over_interpolant<P: ?Sized, M: Method<P> + ?Sized>(
    method: &mut M,
    problem: &mut P,
    [t0, t1]: [f64; 2],
    rule: &Rule,
    work: &mut [Vec<f64>; 2],
    visit: &mut dyn FnMut(&mut P, Node<'_>),
) -> Result<(), Failure> {
    let n = method.y().len();
    let [y, ydot] = work;
    y.resize(n, 0.0);
    ydot.resize(n, 0.0);
    for &(place, weight) in rule {
        let t = t0 + place * (t1 - t0);
        method.interpolate(problem, t, y)?;
        method.interpolate_rate(problem, t, ydot)?;
        let weight = weight * (t1 - t0);
        visit(problem, Node { weight, t, y, ydot });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_of_radau_is_exact_to_its_degree() {
        for power in 0..=4 {
            let sum: f64 = RADAU_3.iter().map(|(x, w)| w * x.powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14, "{power}");
        }
    }

    #[test]
    fn the_pair_of_gauss_and_kronrod_is_exact_to_its_degrees_and_no_further() {
        let (mut kronrod, mut gauss) = (Vec::new(), Vec::new());
        for (half, k, g) in GAUSS_KRONROD_15 {
            let both: [f64; 2] = [0.5 - half, 0.5 + half];
            for place in both.into_iter().skip(usize::from(half == 0.0)) {
                kronrod.push((place, k));
                gauss.push((place, g));
            }
        }
        for (rule, degree) in [(&kronrod, 22), (&gauss, 13)] {
            let off = |power: i32| {
                // over [-1, 1], where powers do not crowd at one end
                let sum: f64 = rule
                    .iter()
                    .map(|(x, w)| w * f64::powi(2.0 * x - 1.0, power))
                    .sum();
                let exact = if power % 2 == 0 {
                    1.0 / f64::from(power + 1)
                } else {
                    0.0
                };
                (sum - exact).abs()
            };
            for power in 0..=degree {
                assert!(off(power) < 1e-15, "{power}: {:e}", off(power));
            }
            assert!(off(degree + 2 - degree % 2) > 1e-9, "{degree}");
        }
    }
}
