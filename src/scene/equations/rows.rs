//! The rows of G: values, gradients along the freedoms, rates, and what a unit multiplier exerts.

use super::Equations;
use crate::arrange::Arrange;
use crate::diagnostic::Subject;
use crate::physics::action::Action;
use crate::physics::row::{Drive, Law};
use crate::scalar::{Dual, Jet, Scalar};
use crate::scene::coupled::Coupled;
use crate::scene::{CoordinateSum, Displacement, Row, RowKind, Source, Sum};
use crate::space::{Frame, MarkerState, Mat3, Vec3};
use std::rc::Rc;

impl<S: Scalar> Equations<'_, S> {
    /// A row with its gradient and right sides: evaluated once, but for formulas, which may ask for
    /// what is not known while the accelerations are being solved for.
    pub fn row(&self, r: usize) -> Rc<RowValue<S>> {
        if let Some(row) = &self.scratch.rows.borrow()[r] {
            return Rc::clone(row);
        }
        let row = Rc::new(self.row_value(r));
        if !matches!(self.scene.rows[r].kind, RowKind::Formula { .. }) {
            self.scratch.rows.borrow_mut()[r] = Some(Rc::clone(&row));
        }
        row
    }

    fn row_value(&self, r: usize) -> RowValue<S> {
        match &self.scene.rows[r].kind {
            RowKind::Markers { law, i, j, motion } => {
                let drive = motion.map(|m| self.row_drive(m));
                self.marker_row(*law, (*i, *j), drive)
            }
            RowKind::Displacements(sum) => self.sum_row(sum, self.configuration.sums[r]),
            RowKind::Formula {
                formula,
                of_velocities,
                ..
            } => self.formula_row(*formula, *of_velocities),
            RowKind::Cam { cam, component } => self.cam_row(*cam, *component),
        }
    }

    /// Returns what the law of a motion reads: the motion itself, and the one beside it.
    pub fn row_drive(&self, m: usize) -> Drive<Jet<S>> {
        let beside = self.scene.motions[m].beside;
        Drive {
            value: self.driven[m],
            beside: beside.map_or_else(Jet::zero, |b| self.driven[b]),
            reference: self.configuration.motions[m].reference,
        }
    }

    /// Returns the row that a law between markers I and J is, driven or not; it need not stand
    /// among the rows of the scene.
    pub fn marker_row(
        &self,
        law: Law,
        (i, j): (usize, usize),
        drive: Option<Drive<Jet<S>>>,
    ) -> RowValue<S> {
        let seeded = self.along_twists(law, (i, j), drive);
        let [i_in_time, j_in_time] = self.both_in_time([i, j]);
        let rates = law.value(&i_in_time, &j_in_time, drive);
        self.row_of((i, j), &seeded, rates)
    }

    /// Returns a law between markers I and J over duals along the twists of I (0–5: rotation,
    /// translation) and J (6–11).
    pub(super) fn along_twists(
        &self,
        law: Law,
        (i, j): (usize, usize),
        drive: Option<Drive<Jet<S>>>,
    ) -> Dual<12, S> {
        let (I, J) = (self.marker(i), self.marker(j));
        law.value(
            &seed::<12, S>(&I, 0),
            &seed::<12, S>(&J, 6),
            drive.map(|d| {
                d.map(|x| Dual {
                    re: x.value,
                    eps: [S::zero(); 12],
                })
            }),
        )
    }

    /// Returns value and gradient of a row, without its rates where these can be left out.
    pub(crate) fn row_at_rest(&self, r: usize) -> (S, Vec<(usize, S)>) {
        if let RowKind::Markers { law, i, j, motion } = self.scene.rows[r].kind {
            let drive = motion.map(|m| self.row_drive(m));
            let seeded = self.along_twists(law, (i, j), drive);
            let actions = [(i, twist(&seeded, 0)), (j, twist(&seeded, 6))];
            return (seeded.re, self.gradient_between((i, j), &actions));
        }
        let row = self.row(r);
        (row.value, row.gradient.clone())
    }

    /// Returns the rate of a row.
    ///
    /// ```text
    /// ġ = gradient · v + ġ₀
    /// ```
    pub fn row_rate(&self, row: &RowValue<S>) -> S {
        let along = row.gradient.iter();
        along.fold(row.drift, |sum, &(v, g)| sum + g * self.now.v[v])
    }

    /// Returns two markers as they move in time.
    fn both_in_time(&self, markers: [usize; 2]) -> [Frame<Jet<S>>; 2] {
        let mut last = self.scratch.in_time.borrow_mut();
        if let Some((_, frames)) = last.as_ref().filter(|(of, _)| *of == markers) {
            return *frames;
        }
        let frames = markers.map(|m| self.marker(m).in_time());
        *last = Some((markers, frames));
        frames
    }

    /// Returns the row between two markers from its value over duals along their twists (0–5 of I,
    /// 6–11 of J), and from its jet in time along the motion with v̇ = 0.
    pub(super) fn row_of(
        &self,
        (i, j): (usize, usize),
        seeded: &Dual<12, S>,
        rates: Jet<S>,
    ) -> RowValue<S> {
        let actions = vec![(i, twist(seeded, 0)), (j, twist(seeded, 6))];
        let gradient = self.gradient_between((i, j), &actions);
        RowValue {
            value: seeded.re,
            drift: rates.first - self.along(&gradient),
            gradient,
            gamma: -rates.second,
            actions,
        }
    }

    /// The gradient of what acts with a unit multiplier, by places.
    pub fn gradient_of(&self, actions: &[(usize, Action<S>)]) -> Vec<(usize, S)> {
        let mut gradient: Vec<(usize, S)> = Vec::new();
        for (m, action) in actions {
            self.gradient(*m, action, None, &mut gradient);
        }
        gradient.arrange_by_key(|g| g.0);
        gradient
    }

    /// As [`Equations::gradient_of`], of something that depends on how I stands to J alone: its
    /// actions are opposite, and freedoms that carry both markers do not feel them.
    fn gradient_between(
        &self,
        (i, j): (usize, usize),
        actions: &[(usize, Action<S>)],
    ) -> Vec<(usize, S)> {
        let carriers = [i, j].map(|m| {
            let link = self.scene.markers[m].link;
            link.and_then(|l| self.scene.last_freedom[l])
        });
        let both = self.scene.common_carrier(carriers);
        let mut gradient: Vec<(usize, S)> = Vec::new();
        for (m, action) in actions {
            self.gradient(*m, action, both, &mut gradient);
        }
        gradient.arrange_by_key(|g| g.0);
        gradient
    }

    /// `gradient · v`
    pub(super) fn along(&self, gradient: &[(usize, S)]) -> S {
        gradient
            .iter()
            .fold(S::zero(), |s, &(v, g)| s + g * self.now.v[v])
    }

    /// A sum of displacements: each a sum of coordinates where it can be, else by duals along
    /// twists and jets in time.
    pub(super) fn sum_row(&self, sum: &Sum, constant: f64) -> RowValue<S> {
        if let Some(coupled) = &sum.coupled {
            return self.coupled_row(coupled);
        }
        let mut value = S::constant(-constant);
        let (mut drift, mut second) = (S::zero(), S::zero());
        let mut gradient: Vec<(usize, S)> = Vec::new();
        let mut actions = Vec::with_capacity(2 * sum.terms.len());
        let mut linear = true;
        for (factor, d) in &sum.terms {
            let own = self.displacement(d);
            value += own.value.scale(*factor);
            actions.extend(times(&own.actions, S::constant(*factor)));
            linear &= d.coordinates.is_some();
            drift += own.drift.scale(*factor);
            second -= own.gamma.scale(*factor);
            for &(v, g) in &own.gradient {
                add_to(&mut gradient, v, g.scale(*factor));
            }
        }
        if let Some(contact) = sum.contact {
            actions = self.contact(contact);
            if !linear {
                // the same rate on all motions that the joints permit, by forces that act where the
                // bodies touch
                let rate = self.contact_rate(contact);
                gradient = self.gradient_of(&actions);
                drift = rate.value - self.along(&gradient);
                second = rate.first;
            }
        }
        gradient.arrange_by_key(|g| g.0);
        gradient.retain(|g| !g.1.is_known_zero());
        RowValue {
            value,
            gradient,
            drift,
            gamma: -second,
            actions,
        }
    }

    /// The partial derivative of a constraint that a closure computes along one of its
    /// displacements.
    pub fn coupled_slope(&self, coupled: &Coupled, k: usize) -> S {
        let own = self.coupled_displacements(coupled);
        let (away, partials) = self.expansion(coupled, &own);
        let (places, mut slope) = (coupled.partials(), S::zero());
        for (l, away) in away.iter().enumerate() {
            slope += partials[places.second(k, l)] * *away;
        }
        partials[places.first(k)] + slope
    }

    fn coupled_displacements(&self, coupled: &Coupled) -> Vec<RowValue<S>> {
        let all = coupled.displacements.iter();
        all.map(|d| self.displacement(d)).collect()
    }

    /// Displacements and time from where a closure expands its constraint, and the numbers of the
    /// expansion.
    fn expansion(&self, coupled: &Coupled, own: &[RowValue<S>]) -> (Vec<S>, Vec<S>) {
        let mut x: Vec<S> = own.iter().map(|d| d.value).collect();
        x.push(self.now.t);
        let numbers = match x.iter().map(Scalar::known).collect::<Option<Vec<f64>>>() {
            Some(x) => {
                let mut numbers = vec![0.0; coupled.numbers()];
                coupled.expand(&x, &mut numbers);
                numbers.into_iter().map(S::constant).collect()
            }
            None => self.external(coupled.places.clone()).to_vec(),
        };
        let (x0, partials) = numbers.split_at(coupled.n());
        let away = x.iter().zip(x0).map(|(x, x0)| *x - *x0).collect();
        (away, partials.to_vec())
    }

    /// A constraint of displacements that a closure computes, by its expansion about where they are
    /// (1).
    fn coupled_row(&self, coupled: &Coupled) -> RowValue<S> {
        let own = self.coupled_displacements(coupled);
        let (away, partials) = self.expansion(coupled, &own);
        let (n, places) = (coupled.n(), coupled.partials());
        let rate = |k: usize| own.get(k).map_or(S::one(), |d| self.row_rate(d));
        let rates: Vec<S> = (0..n).map(rate).collect();
        let mut row = RowValue {
            value: partials[0],
            gradient: Vec::new(),
            drift: S::zero(),
            gamma: S::zero(),
            actions: Vec::new(),
        };
        for k in 0..n {
            let (mut slope, g) = (partials[places.first(k)], partials[places.first(k)]);
            for l in 0..n {
                let h = partials[places.second(k, l)];
                slope += h * away[l];
                row.gamma -= h * rates[k] * rates[l];
            }
            row.value += (g + slope).scale(0.5) * away[k];
            let Some(d) = own.get(k) else {
                row.drift += slope;
                continue;
            };
            row.drift += slope * d.drift;
            row.gamma += slope * d.gamma;
            d.gradient
                .iter()
                .for_each(|&(v, g)| add_to(&mut row.gradient, v, slope * g));
            row.actions.extend(times(&d.actions, slope));
        }
        row.gradient.arrange_by_key(|g| g.0);
        row
    }

    /// A distance or an angle with its gradient and rates.
    pub fn displacement(&self, d: &Displacement) -> RowValue<S> {
        let (I, J) = (self.marker(d.i), self.marker(d.j));
        let seeded = d.gauge.value(&seed::<12, S>(&I, 0), &seed::<12, S>(&J, 6));
        let actions = vec![(d.i, twist(&seeded, 0)), (d.j, twist(&seeded, 6))];
        if let Some(CoordinateSum { terms, constant }) = &d.coordinates {
            let mut value = S::constant(*constant);
            let (mut drift, mut second) = (S::zero(), S::zero());
            let mut gradient = Vec::new();
            for &(c, factor) in terms {
                let x = self.coordinate(c);
                value += x.value.scale(factor);
                match self.scene.coordinates[c].source {
                    Source::Free { v, .. } => gradient.push((v, S::constant(factor))),
                    Source::Driven(_) => {
                        drift += x.first.scale(factor);
                        second += x.second.scale(factor);
                    }
                }
            }
            return RowValue {
                value,
                gradient,
                drift,
                gamma: -second,
                actions,
            };
        }
        let rates = d.gauge.value(&I.in_time(), &J.in_time());
        let gradient = self.gradient_between((d.i, d.j), &actions);
        let value = if d.gauge.is_angle() {
            self.turned(self.scene.angle_id(d), seeded.re)
        } else {
            seeded.re
        };
        RowValue {
            value,
            drift: rates.first - self.along(&gradient),
            gradient,
            gamma: -rates.second,
            actions,
        }
    }

    /// A unit force along z of CV on the first body at the origin of CV, and its opposite on the
    /// second.
    pub(super) fn contact(&self, (cv, bodies): (usize, [usize; 2])) -> Vec<(usize, Action<S>)> {
        let cv = self.marker(cv);
        let line = cv.R_GM.column(2);
        bodies
            .iter()
            .zip([line, -line])
            .map(|(&m, force)| {
                let torque = (cv.p_GM - self.marker(m).p_GM).cross(force);
                (m, Action { force, torque })
            })
            .collect()
    }

    /// Returns how fast the second body recedes from the first at CV along its z axis, and the rate
    /// of that with v̇ = 0.
    pub(super) fn contact_rate(&self, (cv, bodies): (usize, [usize; 2])) -> Jet<S> {
        let rate = |x: S, first: S| Jet::new(x, first, S::zero());
        let pair =
            |x: Vec3<S>, first: Vec3<S>| Vec3(std::array::from_fn(|k| rate(x.0[k], first.0[k])));
        let cv = self.marker(cv);
        let (point, line) = (pair(cv.p_GM, cv.v_GM), cv.R_GM.column(2));
        let line = pair(line, cv.w_GM.cross(line));
        let [first, second] = bodies.map(|m| {
            let m = self.marker(m);
            let arm = point - pair(m.p_GM, m.v_GM);
            pair(m.v_GM, m.a_GM) + pair(m.w_GM, m.alpha_GM).cross(arm)
        });
        (first - second).dot(line)
    }

    /// Adds the components of an action on a marker along the free coordinates that move it, from
    /// the nearest to the one before the freedom `until`; `None`: along all.
    fn gradient(
        &self,
        m: usize,
        action: &Action<S>,
        until: Option<usize>,
        sum: &mut Vec<(usize, S)>,
    ) {
        let scene = self.scene;
        let point = self.marker(m).p_GM;
        let mut next = scene.markers[m].link.and_then(|l| scene.last_freedom[l]);
        while let Some(k) = next.filter(|_| next != until) {
            let f = &scene.freedoms[k];
            next = scene.carrier[k];
            let Some(v) = f.v else { continue };
            let X = &self.links()[f.link].X_GL;
            let e = X.rotation.column(f.axis).times(S::constant(f.sign));
            let component = if f.turn {
                e.dot(action.torque + (point - X.position).cross(action.force))
            } else {
                e.dot(action.force)
            };
            if component.is_known_zero() {
                continue;
            }
            add_to(sum, v, component);
        }
    }
}

/// Adds a component to that along a velocity.
fn add_to<S: Scalar>(gradient: &mut Vec<(usize, S)>, v: usize, component: S) {
    match gradient.iter_mut().find(|entry| entry.0 == v) {
        Some(entry) => entry.1 += component,
        None => gradient.push((v, component)),
    }
}

/// Returns actions, each so many times.
fn times<S: Scalar>(
    actions: &[(usize, Action<S>)],
    factor: S,
) -> impl Iterator<Item = (usize, Action<S>)> {
    actions.iter().map(move |(m, a)| {
        let (force, torque) = (a.force.times(factor), a.torque.times(factor));
        (*m, Action { force, torque })
    })
}

/// A row of G with its right sides. An equation of velocities stands at the level of ġ: its value
/// is zero wherever the mechanism is.
pub struct RowValue<S> {
    /// g
    pub value: S,
    /// gradient along the velocities of free coordinates: (place in v, ∂ġ/∂v)
    pub gradient: Vec<(usize, S)>,
    /// ġ = gradient · v + this (driven coordinates and functions of time; of an equation that is
    /// not linear in v, what the tangent leaves)
    pub drift: S,
    /// g̈ = gradient · v̇ − gamma
    pub gamma: S,
    /// force and torque of a unit multiplier on markers about their origins, ground axes
    pub actions: Vec<(usize, Action<S>)>,
}

/// Returns the action of a unit multiplier: what a dual along twists says of the twist whose
/// directions begin at `k`.
pub(super) fn twist<const N: usize, S: Scalar>(x: &Dual<N, S>, k: usize) -> Action<S> {
    Action {
        torque: Vec3([x.eps[k], x.eps[k + 1], x.eps[k + 2]]),
        force: Vec3([x.eps[k + 3], x.eps[k + 4], x.eps[k + 5]]),
    }
}

/// A marker's frame as it turns and moves along six directions, the first of which is direction
/// `first`.
pub(super) fn seed<const N: usize, S: Scalar>(
    m: &MarkerState<S>,
    first: usize,
) -> Frame<Dual<N, S>> {
    let lift = |x: S| Dual {
        re: x,
        eps: [S::zero(); N],
    };
    let mut frame = Frame {
        rotation: Mat3(m.R_GM.0.map(|r| r.map(lift))),
        position: Vec3(m.p_GM.0.map(lift)),
    };
    for k in 0..3 {
        let e = Vec3::axis(k);
        for column in 0..3 {
            let moved = e.cross(m.R_GM.column(column));
            for row in 0..3 {
                frame.rotation.0[row][column].eps[first + k] = moved.0[row];
            }
        }
        frame.position.0[k].eps[first + 3 + k] = S::one();
    }
    frame
}

impl From<&Row> for Subject {
    fn from(row: &Row) -> Self {
        Self::part_of(row.element, row.equation.clone())
    }
}

/// The name of a row: "JOINT/7 Zi.Xj".
pub fn row_name(row: &Row) -> String {
    Subject::from(row).to_string()
}
