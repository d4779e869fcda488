//! Reactions that redundant rows leave open: of all sets that do the same to the parts the one in which forces and torques
//! are least, beside that set found by brute force.

use crate::running::whole;

use crate::constraints::Draw;

use cognate::internals::numeric::rank::{Dependence, Rank};
use cognate::internals::physics::action::Action;
use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::equations::Equations;
use cognate::internals::scene::{Scene, build::Options};
use cognate::internals::space::{Frame, Mat3, Vec3, rotation};
use cognate::internals::start::{assemble, velocities};
use cognate::model::ElementId;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Reactions of all ways to compute them agree to this part of the largest: rounding times the square of the condition of
/// structures drawn at random.
const AGREE: f64 = 1e-7;
/// Part of a row outside the others below which it depends on them: rounding.
const DEPENDENT: f64 = 1e-9;

/// Points of a statement that place a frame.
fn placed(frame: &Frame<f64>, [point, z, x]: [&str; 3]) -> String {
    let numbers = |v: Vec3<f64>| format!("{:?},{:?},{:?}", v.0[0], v.0[1], v.0[2]);
    let tip = |k: usize| frame.position + frame.rotation.column(k);
    format!(
        "{point}={}\n, {z}={}\n, {x}={}\n",
        numbers(frame.position),
        numbers(tip(2)),
        numbers(tip(0))
    )
}

/// A mechanism whose joints fit as it is drawn.
struct Drawn {
    /// part frames in ground; the first is ground
    parts: Vec<Frame<f64>>,
    markers: Vec<String>,
    /// constraints, in any order
    ties: Vec<String>,
    others: String,
}

impl Drawn {
    /// Parts with inertia at these frames.
    fn new(frames: impl IntoIterator<Item = Frame<f64>>) -> Self {
        let mut parts = vec![Frame::identity()];
        parts.extend(frames);
        let statement = |(k, frame): (usize, &Frame<f64>)| {
            let (id, cm) = (k + 1, 1000 + k);
            let place = placed(frame, ["QG", "ZG", "XG"]);
            format!(
                "PART/{id}, MASS={id}, CM={cm}, IP=0.3,0.4,0.5, {place}MARKER/{cm}, PART={id}, QP=0.1,-0.2,0\n"
            )
        };
        let others = (parts.iter().enumerate().skip(1))
            .map(statement)
            .collect::<String>()
            + "PART/1, GROUND\nACCGRAV/IGRAV=1.3, JGRAV=-9.1, KGRAV=2.7\n";
        Self {
            parts,
            markers: Vec::new(),
            ties: Vec::new(),
            others,
        }
    }

    /// Adds a marker of a part (0: ground) where a frame stands in ground.
    fn marker(&mut self, part: usize, at: &Frame<f64>) -> usize {
        let id = 10 + self.markers.len();
        let own = self.parts[part].inverse().compose(at);
        let place = placed(&own, ["QP", "ZP", "XP"]);
        let part = part + 1;
        (self.markers).push(format!("MARKER/{id}, PART={part}, {place}"));
        id
    }

    /// Adds a constraint between two parts at a place, I turned by `relative` in J; `#` is its number.
    fn tie(&mut self, text: &str, [i, j]: [usize; 2], at: &Frame<f64>, relative: Mat3<f64>) {
        let position = Vec3::zero();
        let turned = at.compose(&Frame {
            rotation: relative,
            position,
        });
        let (i, j) = (self.marker(i, &turned), self.marker(j, at));
        (self.ties).push(
            text.replace("%I", &i.to_string())
                .replace("%J", &j.to_string()),
        );
    }

    /// Its dataset, constraints numbered from 1 in order, or in the contrary order from the last.
    fn text(&self, reversed: bool) -> String {
        let n = self.ties.len();
        let number = |k: usize| if reversed { n - k } else { k + 1 };
        let ties = self.ties.iter().enumerate();
        let ties = ties.map(|(k, t)| t.replace('#', &number(k).to_string()) + "\n");
        let mut ties: String = ties.collect();
        // constraints name others by their place
        (0..n).for_each(|k| ties = ties.replace(&format!("@{k};"), &number(k).to_string()));
        format!("DRAWN\n{}{}{ties}END\n", self.others, self.markers.concat())
    }
}

/// Assembles it; returns its scene with what was decided, and its numbers.
fn assembled(text: &str, cut_all: bool) -> (Arc<Scene>, Configuration, Vec<f64>) {
    let model = whole(text);
    let options = Options {
        cut_all,
        mode: 4,
        ..Options::default()
    };
    let scene = Scene::compile(&model, &options).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[])
        .unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    let here = scene.within(&configuration);
    let v = velocities::velocities(here, &model, 0.0, &q, &[])
        .unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    let mut numbers = vec![0.0];
    numbers.extend(q);
    numbers.extend(v);
    numbers.resize(scene.layout.len(), 0.0);
    (scene, configuration, numbers)
}

/// Six numbers of each constraint.
type Set = BTreeMap<ElementId, [f64; 6]>;

fn six(a: &Action<f64>) -> [f64; 6] {
    std::array::from_fn(|k| [a.force.0, a.torque.0][k / 3][k % 3])
}

fn reactions(text: &str, cut_all: bool) -> Set {
    let (scene, configuration, numbers) = assembled(text, cut_all);
    let at = Equations::<f64>::new(scene.within(&configuration), &numbers);
    let all = scene.constraints.iter().enumerate();
    all.map(|(c, e)| (e.id, six(&at.reaction(c)))).collect()
}

/// The least set by brute force: with all constraints as rows, over all multipliers that do the same to the parts; and how
/// many rows are redundant, and how many are left out.
fn least(text: &str) -> (Set, [usize; 2]) {
    let (scene, configuration, numbers) = assembled(text, true);
    let at = Equations::<f64>::new(scene.within(&configuration), &numbers);
    let (n, n_v) = (scene.rows.len(), scene.layout.n_v);
    let gradient = |r: usize| {
        let mut dense = vec![0.0; n_v];
        (at.row(r).gradient.iter()).for_each(|&(v, g)| dense[v] += g);
        dense
    };
    let gradients: Vec<Vec<f64>> = (0..n).map(gradient).collect();
    let dependent = Rank::of(gradients.iter().map(Vec::as_slice), n_v, DEPENDENT).dependent();
    // multipliers that do nothing to the parts
    let state = |d: &Dependence| {
        let mut lambda = vec![0.0; n];
        lambda[d.row] = 1.0;
        (d.combination.iter()).for_each(|&(r, factor)| lambda[r] = -factor);
        lambda
    };
    let states: Vec<Vec<f64>> = dependent.iter().map(state).collect();
    assert!(!states.is_empty(), "nothing is redundant\n{text}");
    let unit = |r: usize| {
        let mut lambda = vec![0.0; n];
        lambda[r] = 1.0;
        at.stress(&lambda)
    };
    let exerted: Vec<Vec<Action<f64>>> = (0..n).map(unit).collect();
    let arm = |c: usize| match (scene.constraints[c].about, scene.constraints[c].markers) {
        (Some(about), Some((i, j))) if about == i => {
            (at.marker(i).p_GM - at.marker(j).p_GM).times(0.5)
        }
        _ => Vec3::zero(),
    };
    let m = scene.constraints.len();
    let weighed = |lambda: &[f64]| -> Vec<f64> {
        let mut all = vec![0.0; 6 * m];
        for (actions, l) in exerted.iter().zip(lambda) {
            for (c, a) in actions.iter().enumerate() {
                let torque = (a.torque + arm(c).cross(a.force)).times(1.0 / scene.span);
                let action = six(&Action { torque, ..*a });
                (0..6).for_each(|k| all[6 * c + k] += action[k] * l);
            }
        }
        all
    };
    let base = at.solved().lambda.clone();
    let (right, columns) = (weighed(&base), states.iter().map(|s| weighed(s)));
    let columns: Vec<Vec<f64>> = columns.collect();
    let row = |k: usize| -> Vec<f64> { columns.iter().map(|c| c[k]).collect() };
    let size = |row: &Vec<f64>| row.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let rows: Vec<Vec<f64>> = (0..6 * m).map(row).collect();
    let largest = rows.iter().map(size).fold(0.0, f64::max);
    let stressed: Vec<usize> = (0..6 * m)
        .filter(|&k| size(&rows[k]) > DEPENDENT * largest)
        .collect();
    let right: Vec<f64> = stressed.iter().map(|&k| -right[k]).collect();
    let rows = stressed.iter().map(|&k| rows[k].as_slice());
    let mut shares = vec![0.0; states.len()];
    Rank::of(rows, states.len(), DEPENDENT).least_squares(&right, &mut shares);
    let mut lambda = base;
    for (state, share) in states.iter().zip(shares) {
        (lambda.iter_mut().zip(state)).for_each(|(l, s)| *l += s * share);
    }
    let sum = |c: usize| {
        let mut all = [0.0; 6];
        for (r, actions) in exerted.iter().enumerate() {
            let own = six(&actions[c]);
            (0..6).for_each(|k| all[k] += own[k] * lambda[r]);
        }
        all
    };
    let set = (0..m).map(|c| (scene.constraints[c].id, sum(c))).collect();
    let left_out = configuration.active.iter().filter(|a| !**a).count();
    (set, [states.len(), left_out])
}

/// The reactions of a mechanism are least, whatever carries what and in which order; at least so many rows are redundant.
fn is_least(drawn: &Drawn, redundant: usize) {
    let text = drawn.text(false);
    let (least, [n, left_out]) = least(&text);
    assert!(n >= redundant, "{n} redundant rows\n{text}");
    assert_eq!(n, left_out, "all that are redundant are left out\n{text}");
    let largest = (least.values().flatten()).fold(0.0, |m: f64, x| m.max(x.abs()));
    let agree = |set: &Set, name: &dyn Fn(ElementId) -> ElementId, how: &str| {
        for (id, exact) in &least {
            let found = set[&name(*id)];
            for (x, y) in found.iter().zip(exact) {
                let off = (x - y).abs() / largest;
                assert!(off < AGREE, "{how}: {id} {found:?} {exact:?}\n{text}");
            }
        }
    };
    let same = |id: ElementId| id;
    agree(&reactions(&text, false), &same, "on a forest");
    agree(&reactions(&text, true), &same, "as rows");
    let count = drawn.ties.len() as u32 + 1;
    let turned = |id: ElementId| ElementId {
        number: count - id.number,
        ..id
    };
    let reversed = reactions(&drawn.text(true), false);
    agree(&reversed, &turned, "in the contrary order");
}

/// Ties at which markers coincide, with the rotation of I in J at which they hold.
fn ties() -> Vec<(String, Mat3<f64>)> {
    let same = Mat3::identity();
    let quarter = rotation::snapped(&rotation::about_axis(0, FRAC_PI_2));
    let mut all: Vec<_> = [
        "JOINT/#, FIXED",
        "JOINT/#, REVOLUTE",
        "JOINT/#, TRANSLATIONAL",
        "JOINT/#, CYLINDRICAL",
        "JOINT/#, SPHERICAL",
        "JOINT/#, PLANAR",
        "JOINT/#, HOOKE",
        "JOINT/#, CONVEL",
        "JOINT/#, SCREW, PITCH=0.4",
        "JPRIM/#, ATPOINT",
        "JPRIM/#, INLINE",
        "JPRIM/#, INPLANE",
        "JPRIM/#, ORIENTATION",
        "JPRIM/#, PARALLEL_AXES",
    ]
    .map(|kind| (format!("{kind}, I=%I, J=%J"), same))
    .to_vec();
    for kind in ["JOINT/#, UNIVERSAL", "JPRIM/#, PERPENDICULAR"] {
        all.push((format!("{kind}, I=%I, J=%J"), quarter));
    }
    // the reaction of the second cannot be asked for, and costs nothing
    for text in [
        "GCON/#, I=%I, FUNCTION=DX(%I,%J,%J)+0.3*DZ(%I,%J,%J)-0.1*AY(%I,%J)",
        "GCON/#, FUNCTION=DX(%I,%J,%J)+0.3*DZ(%I,%J,%J)-0.1*AY(%I,%J)",
        "MOTION/#, I=%I, J=%J, X, FUNCTION=0.2*TIME**3",
        "MOTION/#, I=%I, J=%J, B2, FUNCTION=0.3*TIME**3",
    ] {
        all.push((text.into(), same));
    }
    all
}

/// Parts in space that more ties hold than need be.
#[test]
fn ties_of_all_kinds_in_space_bear_as_little_as_they_can() {
    let mut draw = Draw(1);
    let all = ties();
    for round in 0..40 {
        let n = 2 + round % 3;
        let mut drawn = Drawn::new((0..n).map(|_| draw.frame()));
        for k in 0..4 * n {
            let i = 1 + k % n;
            let j = (i + 1 + k / n) % (n + 1);
            let j = if i == j { 0 } else { j };
            // what carries comes first
            let (text, relative) = if k < n {
                &all[round % 7]
            } else {
                draw.one_of(&all)
            };
            drawn.tie(text, [i, j], &draw.frame(), *relative);
        }
        is_least(&drawn, 1);
    }
}

/// Bars crossed and pinned in a plane, driven and coupled: `[n, m]` of them. `off`: how far pins are out of the plane.
fn lattice([n, m]: [usize; 2], off: f64, draw: &mut Draw) -> Drawn {
    let along = |k: usize, side: f64| Vec3([k as f64 * 0.8, side * k as f64 * 0.6, 0.0]);
    let upright = |position: Vec3<f64>| Frame {
        rotation: Mat3::identity(),
        position,
    };
    let bars = (0..n)
        .map(|j| along(j, -1.0))
        .chain((0..m).map(|i| along(i, 1.0)));
    let mut drawn = Drawn::new(bars.map(upright));
    let revolute = "JOINT/#, REVOLUTE, I=%I, J=%J";
    for j in 0..n {
        for i in 0..m {
            let height = Vec3([0.0, 0.0, off * draw.next()]);
            let at = upright(along(i, 1.0) + along(j, -1.0) + height);
            drawn.tie(revolute, [1 + j, 1 + n + i], &at, Mat3::identity());
        }
    }
    drawn.tie(revolute, [1, 0], &upright(Vec3::zero()), Mat3::identity());
    drawn
}

/// Flat lattices of pinned bars, alone, driven, and with angles coupled; and a point mass held twice.
#[test]
fn pins_of_flat_lattices_bear_as_little_as_they_can() {
    let mut draw = Draw(2);
    for (size, off) in [([2, 2], 0.0), ([2, 3], 0.3), ([3, 4], 0.0), ([5, 2], 0.7)] {
        let rows = 3 * (size[0] - 1) * (size[1] - 1);
        let drawn = lattice(size, off, &mut draw);
        is_least(&drawn, rows);
        let n = drawn.ties.len() - 1;
        let driven = |more: &[String]| {
            let mut drawn = lattice(size, off, &mut Draw(3));
            drawn.ties.extend(more.iter().cloned());
            drawn
        };
        let drive =
            |joint: usize| format!("MOTION/#, JOINT=@{joint};, ROTATION, FUNCTION=0.3*TIME**2");
        let couple =
            |a: usize, b: usize| format!("COUPLER/#, JOINTS=@{a};,@{b};, TYPE=R:R, SCALES=1,-0.7");
        let alike = format!("COUPLER/#, JOINTS=@0;,@{};, TYPE=R:R, SCALES=1,-1", n - 1);
        is_least(&driven(&[drive(n)]), rows);
        is_least(&driven(&[drive(0), couple(n, 0)]), rows);
        is_least(&driven(&[alike, drive(1)]), rows + 1);
    }
}

/// A point mass held to two bars by more than it needs, which carries no torque at all.
#[test]
fn what_holds_a_point_mass_bears_as_little_as_it_can() {
    let mut draw = Draw(4);
    for kinds in [["ATPOINT", "ATPOINT"], ["INLINE", "ATPOINT"]] {
        let mut drawn = Drawn::new((0..2).map(|_| draw.frame()));
        let position = draw.vector();
        let [x, y, z] = position.0;
        drawn.parts.push(Frame {
            rotation: Mat3::identity(),
            position,
        });
        drawn.others += &format!("POINT_MASS/4, MASS=2, CM=1003, QG={x:?},{y:?},{z:?}\n");
        drawn.others += "MARKER/1003, POINT_MASS=4\n";
        let at = Frame {
            rotation: draw.frame().rotation,
            position,
        };
        for (k, kind) in kinds.into_iter().enumerate() {
            let own = draw.frame();
            drawn.tie(
                "JOINT/#, HOOKE, I=%I, J=%J",
                [1 + k, 0],
                &own,
                Mat3::identity(),
            );
            drawn.tie(
                &format!("JPRIM/#, {kind}, I=%I, J=%J"),
                [3, 1 + k],
                &at,
                Mat3::identity(),
            );
        }
        drawn.tie(
            "JOINT/#, SPHERICAL, I=%I, J=%J",
            [1, 2],
            &draw.frame(),
            Mat3::identity(),
        );
        let own = drawn.markers.iter_mut().filter(|m| m.contains("PART=4"));
        own.for_each(|m| *m = m.replace("PART=4", "POINT_MASS=4"));
        is_least(&drawn, 1);
    }
}
