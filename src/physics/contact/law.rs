//! The laws of a contact: a force along the normal, and friction across it.
//!
//! With g the depth, ġ its rate, v the velocity of I's solid against J's at the touch, v_t its part
//! across the normal n:
//!
//! ```text
//! IMPACT     N = max(0, k gᵉ + STEP(g, 0, 0, d, c) ġ)                                   g > 0
//! POISSON    N = p g · STEP(ġ, −v₀, r², v₀, 1)                                          g > 0
//! friction   F = −µ(|v_t|) N v_t/|v_t|
//!            µ(v) = STEP(v, −v_s, −µ_s, v_s, µ_s)      v ≤ v_s
//!                   STEP(v, v_s, µ_s, v_d, µ_d)        v_s < v < v_d,   µ_d beyond
//! ```
//!
//! POISSON: the spring of compression is r² times softer in restitution, so that the impulse of
//! restitution is r times that of compression (Poisson's hypothesis) and a single impact leaves
//! with r times the speed it came with. v₀, a small speed, makes it smooth. Adams documents a law
//! of its own with the same two parameters, whose details are not public: the forces during the
//! impact are approximate, the motion after it is not.
//!
//! Friction is smooth: below v_s it is a steep damper, so that what should stick creeps.

use crate::expr::functions::contact::impact;
use crate::expr::functions::step::{cubic, step};
use crate::scalar::Scalar;
use crate::space::Vec3;

/// The law of the force along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normal {
    /// IMPACT
    Impact {
        /// k
        stiffness: f64,
        /// e
        exponent: f64,
        /// c
        damping: f64,
        /// d
        full_damping_depth: f64,
    },
    /// POISSON
    Poisson {
        /// p
        penalty: f64,
        /// r
        restitution: f64,
        /// v₀
        smoothing: f64,
    },
}

/// Coulomb's law of friction, made smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// µ_s
    pub mu_static: f64,
    /// µ_d
    pub mu_dynamic: f64,
    /// v_s
    pub stiction_velocity: f64,
    /// v_d
    pub friction_velocity: f64,
}

/// The law of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// force along the normal
    pub normal: Normal,
    /// friction across it
    pub friction: Option<Coulomb>,
}

impl Normal {
    /// Returns N at a depth and its rate.
    pub fn force<S: Scalar>(&self, depth: S, rate: S) -> S {
        let c = S::constant;
        match *self {
            Normal::Impact {
                stiffness,
                exponent,
                damping,
                full_damping_depth: d,
            } => {
                let (k, cmax) = (c(stiffness), c(damping));
                // x = −g, below 0 in contact
                impact(
                    -depth,
                    -rate,
                    S::zero(),
                    k,
                    cmax,
                    c(d),
                    c(1.0 / d),
                    |p: S| {
                        if exponent == 1.0 {
                            p
                        } else {
                            p.powf(c(exponent))
                        }
                    },
                )
            }
            Normal::Poisson {
                penalty,
                restitution: r,
                smoothing: v,
            } => {
                let touching = S::zero().lt(depth);
                // while the solids are apart no branch of the rate matters
                let rate = S::select(touching, rate, S::zero());
                let factor = step(rate, c(-v), c(r * r), c(v), S::one(), cubic);
                S::select(touching, depth.scale(penalty) * factor, S::zero())
            }
        }
    }
}

impl Coulomb {
    /// Returns µ(v)/v, a smooth function of v².
    pub fn per_speed<S: Scalar>(&self, speed2: S) -> S {
        let (vs, vd) = (self.stiction_velocity, self.friction_velocity);
        // STEP(v, −v_s, −µ_s, v_s, µ_s) = µ_s (3 s − s³)/2 with s = v/v_s
        let s2 = speed2.scale(1.0 / (vs * vs));
        let sticking = (S::constant(3.0) - s2).scale(self.mu_static / (2.0 * vs));
        let sticks = speed2.le(S::constant(vs * vs));
        let v = S::select(sticks, S::constant(vs), speed2)
            .max(S::constant(f64::MIN_POSITIVE))
            .sqrt();
        let v = S::select(sticks, S::constant(vs), v);
        let c = S::constant;
        let mu = step(
            v,
            c(vs),
            c(self.mu_static),
            c(vd),
            c(self.mu_dynamic),
            cubic,
        );
        S::select(sticks, sticking, mu / v)
    }
}

/// Forces at a touch that a routine computes, which hold where the solids touch.
#[derive(Clone, Copy, Debug)]
pub struct Given<S> {
    /// along the normal
    pub normal: Option<S>,
    /// across it, on I's solid, in ground axes
    pub friction: Option<Vec3<S>>,
}

impl Law {
    /// Returns the force on I's solid at a touch, in ground axes.
    pub fn force<S: Scalar>(
        &self,
        depth: S,
        normal: Vec3<S>,
        velocity: Vec3<S>,
        given: Given<S>,
    ) -> Vec3<S> {
        let along = velocity.dot(normal);
        let touching = S::zero().lt(depth);
        let n = match given.normal {
            Some(n) => S::select(touching, n, S::zero()),
            None => self.normal.force(depth, -along),
        };
        let force = normal.times(n);
        if let Some(friction) = given.friction {
            return force + Vec3(friction.0.map(|f| S::select(touching, f, S::zero())));
        }
        match &self.friction {
            None => force,
            Some(coulomb) => {
                let slip = velocity - normal.times(along);
                // while the solids are apart no branch of the slip matters
                let speed2 = S::select(S::zero().lt(depth), slip.norm2(), S::zero());
                force - slip.times(coulomb.per_speed(speed2) * n)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COULOMB: Coulomb = Coulomb {
        mu_static: 0.3,
        mu_dynamic: 0.1,
        stiction_velocity: 0.5,
        friction_velocity: 2.0,
    };

    #[test]
    fn friction_follows_its_three_branches() {
        let mu = |v: f64| COULOMB.per_speed(v * v) * v;
        assert_eq!(mu(0.0), 0.0);
        // STEP(0.25, −0.5, −0.3, 0.5, 0.3): u = 0.75, u² (3 − 2u) = 0.84375
        assert!((mu(0.25) - (-0.3 + 0.6 * 0.84375)).abs() < 1e-15);
        assert!((mu(0.5) - 0.3).abs() < 1e-15 && (mu(0.5 + 1e-9) - 0.3).abs() < 1e-8);
        assert!((mu(1.25) - 0.2).abs() < 1e-15);
        assert!((mu(2.0) - 0.1).abs() < 1e-15 && (mu(50.0) - 0.1).abs() < 1e-15);
    }

    #[test]
    fn nothing_pulls_and_nothing_acts_at_a_distance() {
        let law = Normal::Impact {
            stiffness: 10.0,
            exponent: 1.5,
            damping: 3.0,
            full_damping_depth: 0.1,
        };
        assert_eq!(law.force(-0.1, 5.0), 0.0);
        assert_eq!(law.force(0.01, -100.0), 0.0);
        assert!((law.force(0.2, 1.0) - (10.0 * 0.2f64.powf(1.5) + 3.0)).abs() < 1e-14);
        let law = Normal::Poisson {
            penalty: 10.0,
            restitution: 0.5,
            smoothing: 1e-3,
        };
        assert_eq!(
            [
                law.force(-0.1, 5.0),
                law.force(0.1, 5.0),
                law.force(0.1, -5.0)
            ],
            [0.0, 1.0, 0.25]
        );
    }
}
