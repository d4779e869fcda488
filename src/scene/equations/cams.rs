//! Rows of contacts of curves, and the rates of their parameters.

use super::rows::{seed, twist};
use super::{Equations, RowValue};
use crate::physics::cam::Path;
use crate::scalar::{Dual, Jet, Scalar};
use crate::scene::ConstraintElement;
use crate::space::{Frame, MarkerState, Mat3, Vec3};

/// Newton's steps that bring a parameter from its state to where it is: from 1e-4 beyond rounding.
const NEWTON_STEPS: usize = 2;

impl<S: Scalar> Equations<'_, S> {
    /// Pose of a marker.
    pub(in crate::scene) fn frame(&self, m: usize) -> Frame<S> {
        let state = self.marker(m);
        Frame {
            rotation: state.R_GM,
            position: state.p_GM,
        }
    }

    /// Parameters of a contact as its states have them.
    fn cam_states(&self, c: usize) -> [S; 2] {
        let cam = &self.scene.cams[c];
        let mut s = [S::zero(); 2];
        for (k, s) in s.iter_mut().enumerate().take(cam.contact.n_parameters()) {
            *s = self.now.x[cam.state + k] + S::constant(self.configuration.contacts[c].offset[k]);
        }
        s
    }

    /// Parameters of a contact.
    pub fn cam_parameters(&self, c: usize) -> [S; 2] {
        let cam = &self.scene.cams[c];
        let (i, j) = (self.frame(cam.i), self.frame(cam.j));
        cam.contact
            .refined(&i, &j, self.cam_states(c), NEWTON_STEPS)
    }

    /// Parameters with their rates; v̇ = 0.
    pub(in crate::scene) fn cam_jets(&self, c: usize) -> [Jet<S>; 2] {
        let cam = &self.scene.cams[c];
        let (i, j) = (self.marker(cam.i).in_time(), self.marker(cam.j).in_time());
        let still = |x: S| Jet::new(x, S::zero(), S::zero());
        // each step of Newton's iteration makes one more derivative right
        let s = self.cam_parameters(c).map(still);
        cam.contact.refined(&i, &j, s, 2)
    }

    /// The floating marker of a contact on its curve `side`, as it moves along: with accelerations
    /// when asked for.
    pub(super) fn floating_marker(
        &self,
        (c, side): (usize, usize),
        accelerated: bool,
    ) -> MarkerState<S> {
        let cam = &self.scene.cams[c];
        let state = |m: usize| {
            if accelerated {
                self.accelerated_marker(m)
            } else {
                self.marker(m)
            }
        };
        let (i, j) = (state(cam.i).in_time(), state(cam.j).in_time());
        let still = |x: S| Jet::new(x, S::zero(), S::zero());
        let s = cam
            .contact
            .refined(&i, &j, self.cam_parameters(c).map(still), 2);
        let frame = cam.contact.floating(side, &i, &j, s);
        let point =
            |part: fn(&Jet<S>) -> S| Vec3(std::array::from_fn(|k| part(&frame.position.0[k])));
        let axes = |part: fn(&Jet<S>) -> S| {
            Mat3(std::array::from_fn(|r| {
                std::array::from_fn(|k| part(&frame.rotation.0[r][k]))
            }))
        };
        let (R, R1, R2) = (axes(|x| x.value), axes(|x| x.first), axes(|x| x.second));
        // Ṙ Rᵀ is ω as a matrix; R̈ Rᵀ is that of α with ω ω, which is symmetric
        let skew = |m: Mat3<S>| {
            let entry = |a: usize, b: usize| (m.0[b][a] - m.0[a][b]).scale(0.5);
            Vec3([entry(1, 2), entry(2, 0), entry(0, 1)])
        };
        MarkerState {
            R_GM: R,
            p_GM: point(|x| x.value),
            w_GM: skew(R1 * R.transpose()),
            v_GM: point(|x| x.first),
            alpha_GM: skew(R2 * R.transpose()),
            a_GM: point(|x| x.second),
        }
    }

    /// Returns what must vanish for a contact to be where it is asked to begin, with gradients.
    pub fn cam_start(&self, c: usize, given: [Option<f64>; 2]) -> Vec<(S, Vec<(usize, S)>)> {
        let cam = &self.scene.cams[c];
        let (I, J) = (self.marker(cam.i), self.marker(cam.j));
        let seeded = (cam.contact).placed(
            &seed::<12, S>(&I, 0),
            &seed::<12, S>(&J, 6),
            given,
            self.configuration.contacts[c].offset,
        );
        (seeded.iter())
            .map(|e| {
                let actions = [(cam.i, twist(e, 0)), (cam.j, twist(e, 6))];
                (e.re, self.gradient_of(&actions))
            })
            .collect()
    }

    /// Returns how fast a contact moves along its curves, by curves.
    pub fn cam_speeds(&self, c: usize) -> Vec<S> {
        let paths = self.scene.cams[c].contact.paths();
        let speed = |(path, s): (&&Path, Jet<S>)| {
            let tangent: Vec3<S> = path.at(s.value, 1);
            s.first * tangent.norm2().sqrt()
        };
        paths.iter().zip(self.cam_jets(c)).map(speed).collect()
    }

    /// Where a contact is, in ground.
    pub fn cam_place(&self, c: usize) -> Vec3<S> {
        let cam = &self.scene.cams[c];
        let (i, j) = (self.frame(cam.i), self.frame(cam.j));
        cam.contact.place(&i, &j, self.cam_parameters(c))
    }

    /// The contact that a constraint is.
    pub(super) fn cam_of(&self, element: &ConstraintElement) -> Option<usize> {
        let mut cams = self.scene.cams.iter();
        cams.position(|c| c.id == element.id)
    }

    /// Returns how far states of contacts are from where the contacts are, in the order of the
    /// contacts.
    pub(in crate::scene) fn cam_corrections(&self) -> Vec<S> {
        let mut out = Vec::new();
        for (c, cam) in self.scene.cams.iter().enumerate() {
            let (from, to) = (self.cam_states(c), self.cam_parameters(c));
            out.extend((0..cam.contact.n_parameters()).map(|k| to[k] - from[k]));
        }
        out
    }

    /// One of the two rows of a contact.
    pub(super) fn cam_row(&self, c: usize, component: usize) -> RowValue<S> {
        let cam = &self.scene.cams[c];
        let (I, J) = (self.marker(cam.i), self.marker(cam.j));
        let (i, j) = (seed::<12, S>(&I, 0), seed::<12, S>(&J, 6));
        let fixed = |re: S| Dual {
            re,
            eps: [S::zero(); 12],
        };
        let s = cam
            .contact
            .refined(&i, &j, self.cam_parameters(c).map(fixed), 1);
        let seeded = cam.contact.gaps(&i, &j, s)[component];
        let rates = cam
            .contact
            .gaps(&I.in_time(), &J.in_time(), self.cam_jets(c))[component];
        self.row_of((cam.i, cam.j), &seeded, rates)
    }
}
