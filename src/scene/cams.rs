//! PTCV and CVCV: their rows, where their contacts begin, and how these are followed while parts
//! are put together. Their ends stand in `broken.rs`.
//!
//! The parameter of a contact is a state: its rate is that of the point which the rows hold, so
//! that any method predicts it with the accuracy of all else, and Newton's iteration inside the
//! equations has next to nothing to do. Where no time passes (assembly, equilibrium) it is followed
//! from one position to the next; where nothing is known yet the whole curve is searched.

use super::build::Builder;
use super::compile::Compiler;
use super::configuration::{Configuration, Configured, ContactStart};
use super::equations::Equations;
use super::unknown::{Side, UnknownId};
use super::{ConstraintElement, Row, RowKind, Scene};
use crate::diagnostic::Diagnostic;
use crate::model::{CurveSide, ElementId, ElementKind};
use crate::physics::cam::{Contact, Path, ROWS, samples};
use crate::space::{Frame, Vec3};

/// A PTCV or CVCV.
#[derive(Clone, Debug)]
pub struct Cam {
    /// which PTCV or CVCV it is
    pub id: ElementId,
    /// the curves
    pub contact: Contact,
    /// I marker, or the marker in whose coordinates the curve of I is
    pub i: usize,
    /// the marker in whose coordinates the curve (of J) is
    pub j: usize,
    /// users' numbers of the curves
    pub curves: Vec<u32>,
    /// users' numbers of the markers between which the reaction is asked for: floating ones where
    /// there are
    pub between: (u32, u32),
    /// first place of its parameters in x
    pub state: usize,
    /// where it is to touch first: a point in the coordinates of a marker, per curve
    pub start: Vec<Option<(Vec3<f64>, usize)>>,
    /// velocity along each curve at the start
    pub velocity: Vec<Option<f64>>,
}

/// Conditions of a contact hold below this, relative to the length of its curve.
const CONTACT_GAP_TOLERANCE: f64 = 1e-9;
/// Largest change of a parameter from one iterate to the next; a whole curve is 2.
const MAX_PARAMETER_STEP: f64 = 0.1;
/// Planes count as one below this sine of the angle between them.
pub(super) const COPLANAR_SINE: f64 = 1e-6;

impl Builder<'_> {
    /// Two rows for each PTCV and CVCV.
    pub(super) fn cams(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, p) in model.active(ElementKind::Ptcv, &model.points_on_curves) {
            let name = ElementKind::Ptcv.id(id);
            let (i, j) = (c.marker(p.i, name), c.marker(p.rm, name));
            let side = CurveSide {
                curve: p.curve,
                rm: p.rm,
                float: p.jfloat,
                start: p.start,
                start_marker: p.start_marker,
                velocity: p.velocity,
            };
            let path = self.path(c, p.curve);
            if let (Some(i), Some(j), Some(path)) = (i, j, path) {
                let between = (p.i, p.jfloat.unwrap_or(p.rm));
                self.cam(c, name, Contact::Point(path), (i, j), between, &[&side]);
            }
        }
        for (id, cc) in model.active(ElementKind::Cvcv, &model.curves_on_curves) {
            let name = ElementKind::Cvcv.id(id);
            let (i, j) = (c.marker(cc.i.rm, name), c.marker(cc.j.rm, name));
            let (path_i, path_j) = (self.path(c, cc.i.curve), self.path(c, cc.j.curve));
            let (Some(i), Some(j), Some(path_i), Some(path_j)) = (i, j, path_i, path_j) else {
                continue;
            };
            let mut planar = true;
            for (path, curve) in [(&path_i, cc.i.curve), (&path_j, cc.j.curve)] {
                if path.height > 1e-9 * path.length {
                    planar = false;
                    let what = format!(
                        "{} leaves the x-y plane of its marker by {:.4} along z",
                        ElementKind::Curve.id(curve),
                        path.height
                    );
                    c.errors.push(not_coplanar(name, what));
                }
            }
            if planar {
                let float = |s: &CurveSide| s.float.unwrap_or(s.rm);
                let between = (float(&cc.i), float(&cc.j));
                let contact = Contact::Curves(path_i, path_j);
                self.cam(c, name, contact, (i, j), between, &[&cc.i, &cc.j]);
            }
        }
    }

    pub(super) fn path(&self, c: &mut Compiler, curve: u32) -> Option<Path> {
        match super::formula::curve(self.model, self.hooks, curve) {
            Ok(curve) => Some(Path::new(&curve)),
            Err(why) => {
                if !c.errors.contains(&why) {
                    c.errors.push(why);
                }
                None
            }
        }
    }

    fn cam(
        &mut self,
        c: &mut Compiler,
        id: ElementId,
        contact: Contact,
        (i, j): (usize, usize),
        between: (u32, u32),
        sides: &[&CurveSide],
    ) {
        let mut start = Vec::new();
        for side in sides {
            let marker = c.marker(side.start_marker.unwrap_or(side.rm), id);
            start.push(side.start.zip(marker).map(|(p, m)| (Vec3(p), m)));
        }
        let equations = ROWS[contact.n_parameters() - 1];
        let state = self.scene.layout.n_x;
        for (side, data) in [Side::I, Side::J].into_iter().zip(sides) {
            self.add_state(UnknownId::ContactPlace {
                contact: id,
                curve: data.curve,
                side,
            });
        }
        let (cam, first) = (self.scene.cams.len(), self.scene.rows.len());
        for (k, side) in sides.iter().enumerate() {
            let floating = |m: &u32| self.model.markers.get(m).is_some_and(|m| m.floating);
            if let Some(marker) = side.float.filter(floating) {
                self.scene.floating.insert(marker, (cam, k));
            }
        }
        self.scene.cams.push(Cam {
            id,
            contact,
            i,
            j,
            curves: sides.iter().map(|s| s.curve).collect(),
            between,
            state,
            start,
            velocity: sides.iter().map(|s| s.velocity).collect(),
        });
        for (component, equation) in equations.iter().enumerate() {
            self.scene.rows.push(Row {
                element: id,
                equation: (*equation).into(),
                kind: RowKind::Cam { cam, component },
            });
        }
        self.scene.constraints.push(ConstraintElement {
            id,
            markers: Some((i, j)),
            acts_on: vec![i],
            joins: Vec::new(),
            about: Some(i),
            carries: None,
            laws: &[],
            rows: first..first + 2,
            coordinate: None,
        });
    }
}

fn not_coplanar(name: ElementId, what: String) -> Diagnostic {
    Diagnostic::error("curves_not_coplanar", what)
        .element(name)
        .help("the curves of a CVCV must lie in the x-y planes of IRM and JRM, which joints hold together")
}

/// Returns the parameters of a contact from its states.
pub(super) fn parameters(cam: &Cam, start: &ContactStart, x: &[f64]) -> [f64; 2] {
    let mut s = start.offset;
    for (k, s) in s.iter_mut().enumerate().take(cam.contact.n_parameters()) {
        *s += x.get(cam.state + k).copied().unwrap_or(0.0);
    }
    s
}

/// Lets a contact begin with these parameters where its states are `x`.
fn begin(cam: &Cam, start: &mut ContactStart, parameters: [f64; 2], x: &[f64]) {
    for (k, s) in (parameters.iter().enumerate()).take(cam.contact.n_parameters()) {
        start.offset[k] = s - x.get(cam.state + k).copied().unwrap_or(0.0);
    }
    start.begun = true;
}

/// Brings the parameters of all contacts to where the numbers of an instant have them.
pub fn track(scene: &Scene, configuration: &mut Configuration, numbers: &[f64]) {
    if scene.cams.is_empty() {
        return;
    }
    let x = numbers[scene.layout.x()].to_vec();
    let at = Equations::<f64>::new(scene.within(configuration), numbers);
    let contacts = scene.cams.iter().zip(&configuration.contacts);
    let found: Vec<[f64; 2]> = contacts
        .map(|(cam, start)| {
            let (i, j) = (at.frame(cam.i), at.frame(cam.j));
            let own = parameters(cam, start, &x);
            let near = start.begun.then(|| follow(&cam.contact, &i, &j, own));
            match near.flatten() {
                Some(s) => s,
                None => search(cam, &i, &j, &at).unwrap_or(own),
            }
        })
        .collect();
    let contacts = scene.cams.iter().zip(&mut configuration.contacts);
    for ((cam, start), s) in contacts.zip(found) {
        begin(cam, start, s, &x);
    }
}

/// Where a contact is asked to begin: of which, and the parameter on each curve that has a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// index in [`Scene::cams`]
    pub cam: usize,
    /// parameters of the points next to DISP, or to IDISP and JDISP
    pub given: [Option<f64>; 2],
}

/// All contacts that are asked to begin somewhere. ICM markers count where they are at this
/// instant.
pub fn starts(scene: Configured<'_>, numbers: &[f64]) -> Vec<Start> {
    if scene
        .cams
        .iter()
        .all(|c| c.start.iter().all(Option::is_none))
    {
        return Vec::new();
    }
    let at = Equations::<f64>::new(scene, numbers);
    let mut found = Vec::new();
    for (c, cam) in scene.cams.iter().enumerate() {
        let frames = match cam.contact {
            Contact::Point(_) => vec![at.frame(cam.j)],
            Contact::Curves(..) => vec![at.frame(cam.i), at.frame(cam.j)],
        };
        let mut given = [None; 2];
        for (k, path) in cam.contact.paths().iter().enumerate() {
            given[k] = cam.start[k].map(|(point, marker)| {
                let ground = at.frame(marker).point(point);
                path.foot(frames[k].inverse().point(ground))
            });
        }
        if given != [None; 2] {
            found.push(Start { cam: c, given });
        }
    }
    found
}

/// Takes contacts to be where they are asked to begin; where one curve has no place, with its point
/// next to that of the other.
pub fn place(scene: &Scene, configuration: &mut Configuration, starts: &[Start], numbers: &[f64]) {
    if starts.is_empty() {
        return;
    }
    let x = numbers[scene.layout.x()].to_vec();
    let at = Equations::<f64>::new(scene.within(configuration), numbers);
    let found: Vec<[f64; 2]> = (starts.iter())
        .map(|start| {
            let cam = &scene.cams[start.cam];
            let (i, j) = (at.frame(cam.i), at.frame(cam.j));
            let own = parameters(cam, &configuration.contacts[start.cam], &x);
            match (&cam.contact, start.given) {
                (Contact::Curves(path_i, path_j), [Some(s), None]) => {
                    let ground = i.point(path_i.at(s, 0));
                    [s, path_j.foot(j.inverse().point(ground))]
                }
                (Contact::Curves(path_i, path_j), [None, Some(s)]) => {
                    let ground = j.point(path_j.at(s, 0));
                    [path_i.foot(i.inverse().point(ground)), s]
                }
                (_, [a, b]) => [a.unwrap_or(own[0]), b.unwrap_or(own[1])],
            }
        })
        .collect();
    for (start, s) in starts.iter().zip(found) {
        let (c, contacts) = (start.cam, &mut configuration.contacts);
        begin(&scene.cams[c], &mut contacts[c], s, &x);
    }
}

/// Newton's iteration from parameters near; `None`: it does not converge.
fn follow(contact: &Contact, i: &Frame<f64>, j: &Frame<f64>, s: [f64; 2]) -> Option<[f64; 2]> {
    let mut s = s;
    for _ in 0..60 {
        let next = contact.refined(i, j, s, 1);
        let step = [next[0] - s[0], next[1] - s[1]];
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() {
            return None;
        }
        let shorter = (MAX_PARAMETER_STEP / longest).min(1.0);
        s = [s[0] + shorter * step[0], s[1] + shorter * step[1]];
        if longest < 1e-14 {
            break;
        }
    }
    (contact.missing(i, j, s) < CONTACT_GAP_TOLERANCE).then_some(s)
}

/// The contact among all: where it is asked for, else where the gap is smallest.
fn search(cam: &Cam, i: &Frame<f64>, j: &Frame<f64>, at: &Equations<'_, f64>) -> Option<[f64; 2]> {
    let asked = |k: usize, frame: &Frame<f64>, path: &Path| {
        let (point, marker) = (*cam.start.get(k)?)?;
        let ground = at.frame(marker).point(point);
        Some(path.nearest(frame.inverse().point(ground)))
    };
    match &cam.contact {
        Contact::Point(path) => {
            let near = asked(0, j, path);
            let near = near.unwrap_or_else(|| path.nearest(j.inverse().point(i.position)));
            follow(&cam.contact, i, j, [near, 0.0]).or(Some([near, 0.0]))
        }
        Contact::Curves(path_i, path_j) => {
            let (near_i, near_j) = (asked(0, i, path_i), asked(1, j, path_j));
            if let (Some(a), Some(b)) = (near_i, near_j)
                && let Some(s) = follow(&cam.contact, i, j, [a, b])
            {
                return Some(s);
            }
            let (a, b) = ((path_i, near_i), (path_j, near_j));
            closest_pair(&cam.contact, a, b, i, j)
        }
    }
}

/// Of all pairs of places with parallel tangents the one with the smallest gap.
fn closest_pair(
    contact: &Contact,
    (path_i, near_i): (&Path, Option<f64>),
    (path_j, near_j): (&Path, Option<f64>),
    i: &Frame<f64>,
    j: &Frame<f64>,
) -> Option<[f64; 2]> {
    let size2 = path_i.length.max(path_j.length).powi(2);
    let look =
        |path: &Path, frame: &Frame<f64>, near: Option<f64>| -> Vec<(f64, Vec3<f64>, Vec3<f64>)> {
            let all: Vec<f64> = near.map_or_else(|| samples().step_by(2).collect(), |s| vec![s]);
            all.into_iter()
                .map(|s| {
                    let tangent = frame.rotation.apply(path.at(s, 1));
                    let n = tangent.norm().max(f64::MIN_POSITIVE);
                    (s, frame.point(path.at(s, 0)), tangent.times(1.0 / n))
                })
                .collect()
        };
    let (all_i, all_j) = (look(path_i, i, near_i), look(path_j, j, near_j));
    let mut pairs: Vec<(f64, [f64; 2])> = Vec::new();
    for (s_i, p_i, t_i) in &all_i {
        for (s_j, p_j, t_j) in &all_j {
            let cost = (*p_i - *p_j).norm2() + size2 * t_i.cross(*t_j).norm2();
            pairs.push((cost, [*s_i, *s_j]));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, [f64; 2])> = None;
    let mut tried: Vec<[f64; 2]> = Vec::new();
    for (_, s) in pairs {
        // one start for each region
        if (tried.iter()).any(|t| (t[0] - s[0]).abs() < 0.06 && (t[1] - s[1]).abs() < 0.06) {
            continue;
        }
        tried.push(s);
        if let Some(found) = follow(contact, i, j, s) {
            let inside = path_i.beyond(found[0]) <= 0.0 && path_j.beyond(found[1]) <= 0.0;
            let outside = if inside { 0.0 } else { size2.sqrt() };
            let gap = contact.gaps(i, j, found)[0].abs() + outside;
            if best.is_none_or(|b| gap < b.0) {
                best = Some((gap, found));
            }
        }
        if tried.len() >= 60 {
            break;
        }
    }
    best.map(|b| b.1)
}
