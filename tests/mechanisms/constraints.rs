//! Constraints: motions against rows, rows against their gradients, one formulation against the other.

use cognate::internals::scene::broken::broken;
use cognate::internals::scene::cams;
use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::equations::Equations;
use cognate::internals::scene::{LinkMotion, RowKind, Scene, Source, build::Options};
use cognate::internals::space::{Frame, Mat3, Vec3, rotation};
use cognate::internals::start::{assemble, velocities};
use cognate::model::{ElementId, ElementKind, Model};
use std::sync::Arc;

/// Numbers in (−1, 1), the same on every run.
pub struct Draw(pub u64);
impl Draw {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn vector(&mut self) -> Vec3<f64> {
        Vec3([self.next(), self.next(), self.next()])
    }
    fn rotation(&mut self) -> Mat3<f64> {
        rotation::from_313(3.0 * self.next(), 1.2 * self.next(), 3.0 * self.next())
    }
    pub fn frame(&mut self) -> Frame<f64> {
        Frame {
            rotation: self.rotation(),
            position: self.vector(),
        }
    }
    pub fn one_of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[(self.next().abs() * all.len() as f64) as usize % all.len()]
    }
}

fn numbers(v: Vec3<f64>) -> String {
    format!("{:?},{:?},{:?}", v.0[0], v.0[1], v.0[2])
}

/// A marker statement by points.
fn marker(id: u32, part: u32, frame: &Frame<f64>) -> String {
    let tip = |k: usize| frame.position + frame.rotation.column(k);
    format!(
        "MARKER/{id}, PART={part}, QP={}\n, ZP={}\n, XP={}\n",
        numbers(frame.position),
        numbers(tip(2)),
        numbers(tip(0))
    )
}

/// A part statement with a centre of mass marker `10 id` and inertia.
fn part(id: u32, frame: &Frame<f64>) -> String {
    let tip = |k: usize| frame.position + frame.rotation.column(k);
    format!(
        "PART/{id}, MASS=2, CM={}, IP=0.3,0.4,0.5\n, QG={}\n, ZG={}\n, XG={}\nMARKER/{}, PART={id}, QP=0.1,-0.2,0.3\n",
        10 * id,
        numbers(frame.position),
        numbers(tip(2)),
        numbers(tip(0)),
        10 * id,
    )
}

/// All ties that carry a part, with the rotation of I in J at which they hold.
fn carrying() -> Vec<(&'static str, Mat3<f64>)> {
    let same = Mat3::identity();
    let quarter = rotation::snapped(&rotation::about_axis(0, std::f64::consts::FRAC_PI_2));
    let mut all: Vec<_> = [
        "FIXED",
        "REVOLUTE",
        "TRANSLATIONAL",
        "CYLINDRICAL",
        "SPHERICAL",
        "PLANAR",
        "HOOKE",
    ]
    .map(|kind| (kind, same))
    .to_vec();
    all.push(("UNIVERSAL", quarter));
    all.extend(
        [
            "ATPOINT",
            "INLINE",
            "INPLANE",
            "ORIENTATION",
            "PARALLEL_AXES",
        ]
        .map(|kind| (kind, same)),
    );
    all.push(("PERPENDICULAR", quarter));
    all
}

/// The same with I on either part: kind, orientation of I against J, and the numbers of I and J.
fn carrying_both_ways() -> Vec<(&'static str, Mat3<f64>, u32, u32)> {
    let both = |(kind, relative): (&'static str, Mat3<f64>)| {
        [(kind, relative, 5, 4), (kind, relative.transpose(), 4, 5)]
    };
    carrying().into_iter().flat_map(both).collect()
}

fn keyword(kind: &str) -> &'static str {
    match kind {
        "ATPOINT" | "INLINE" | "INPLANE" | "ORIENTATION" | "PARALLEL_AXES" | "PERPENDICULAR" => {
            "JPRIM"
        }
        _ => "JOINT",
    }
}

/// Two parts, 2 free and 3 tied to it between markers 5 (on 3) and 4 (on 2), which stand as `relative` says.
fn pair(draw: &mut Draw, relative: &Mat3<f64>, ties: &str) -> String {
    let (two, three) = (draw.frame(), draw.frame());
    let j = draw.frame();
    let in_ground = two.compose(&j).compose(&Frame {
        rotation: *relative,
        position: Vec3::zero(),
    });
    let i = three.inverse().compose(&in_ground);
    format!(
        "PAIR\nPART/1, GROUND\n{}{}{}{}ACCGRAV/IGRAV=1,JGRAV=-2,KGRAV=-9.81\n{ties}END\n",
        part(2, &two),
        part(3, &three),
        marker(4, 2, &j),
        marker(5, 3, &i),
    )
}

fn compiled(text: &str, cut_all: bool) -> (Model, Arc<Scene>, Configuration) {
    // rows are evaluated anywhere, also where a check would refuse how the parts are placed
    let model: Model = cognate::dataset::read_text(text).model;
    let options = Options {
        cut_all,
        mode: 4,
        ..Options::default()
    };
    let scene = Scene::compile(&model, &options).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    let configuration = Configuration::new(&scene);
    (model, scene, configuration)
}

/// Any positions and velocities.
fn anywhere(scene: &Scene, draw: &mut Draw) -> (Vec<f64>, Vec<f64>) {
    let mut q: Vec<f64> = (0..scene.layout.n_q).map(|_| draw.next()).collect();
    for link in &scene.links {
        if let LinkMotion::Ball { quaternion, .. } = link.motion {
            let part = &mut q[quaternion..quaternion + 4];
            let n = part.iter().map(|x| x * x).sum::<f64>().sqrt();
            part.iter_mut().for_each(|x| *x /= n);
        }
    }
    let v = (0..scene.layout.n_v).map(|_| draw.next()).collect();
    (q, v)
}

fn all_numbers(scene: &Scene, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut n = vec![t];
    n.extend_from_slice(q);
    n.extend_from_slice(v);
    n.resize(scene.layout.len(), 0.0);
    n
}

/// Positions after a time during which the velocities do not change.
fn after(scene: &Scene, q: &[f64], v: &[f64], h: f64) -> Vec<f64> {
    let mut q = q.to_vec();
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let (Source::Free { q: place, v: k }, false) = (c.source, f.in_ball) {
            q[place] += h * v[k];
        }
    }
    for link in &scene.links {
        let LinkMotion::Ball {
            coordinate,
            quaternion,
        } = link.motion
        else {
            continue;
        };
        let first = scene.freedoms[coordinate].v.unwrap();
        let w: Vec<f64> = v[first..first + 3].iter().map(|x| 0.5 * h * x).collect();
        let angle = w.iter().map(|x| x * x).sum::<f64>().sqrt();
        let s = if angle > 0.0 {
            angle.sin() / angle
        } else {
            1.0
        };
        let [b0, b1, b2, b3] = [angle.cos(), s * w[0], s * w[1], s * w[2]];
        let p = &mut q[quaternion..quaternion + 4];
        let [a0, a1, a2, a3] = [p[0], p[1], p[2], p[3]];
        p[0] = a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3;
        p[1] = a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2;
        p[2] = a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1;
        p[3] = a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0;
    }
    q
}

/// A tie that carries a part, passed both ways, beside the same tie as rows: the rows vanish in every configuration the
/// motions reach, and no wrench of theirs does work on any of the motions.
#[test]
fn motions_and_rows_of_every_tie_agree() {
    let mut draw = Draw(1);
    for (kind, relative, i, j) in carrying_both_ways() {
        let k = keyword(kind);
        let ties = format!("{k}/1, {kind}, I={i}, J={j}\n{k}/2, {kind}, I={i}, J={j}\n");
        // FIXED and ORIENTATION relate J to I; markers of a universal joint are square to each other either way
        let (_, scene, configuration) = compiled(&pair(&mut draw, &relative, &ties), false);
        let rows = scene.rows.len();
        assert!(
            scene
                .rows
                .iter()
                .all(|r| r.element.to_string() == format!("{k}/2")),
            "{kind}: the first carries, the second closes"
        );
        assert_eq!(
            scene.layout.n_v,
            12 - rows,
            "{kind}: motions and rows add up to six"
        );
        for _ in 0..10 {
            let (q, v) = anywhere(&scene, &mut draw);
            let n = all_numbers(&scene, 0.0, &q, &v);
            let at = Equations::<f64>::new(scene.within(&configuration), &n);
            for r in 0..rows {
                let row = at.row(r);
                let name = format!("{kind} {}", scene.rows[r].equation);
                assert!(row.value.abs() < 1e-13, "{name}: {}", row.value);
                assert!(row.drift.abs() < 1e-12, "{name} drifts");
                assert!(row.gamma.abs() < 1e-11, "{name}: γ {}", row.gamma);
                for &(_, g) in &row.gradient {
                    assert!(g.abs() < 1e-12, "{name}: works on its own motion, {g}");
                }
            }
        }
    }
}

/// All that makes rows between two markers.
fn all_rows() -> Vec<String> {
    let mut all: Vec<String> = carrying()
        .into_iter()
        .map(|(kind, _)| format!("{}/1, {kind}, I=5, J=4\n", keyword(kind)))
        .collect();
    all.push("JOINT/1, CONVEL, I=5, J=4\n".into());
    all.push("JOINT/1, SCREW, I=5, J=4, PITCH=0.7\n".into());
    all.push("JOINT/1, RACKPIN, I=5, J=4, PD=-0.6\n".into());
    for function in [
        "DM(5,4)-0.7",
        "DX(5,4,4)+0.2*SIN(3*TIME)*DZ(5,4,4)",
        "AY(5,4)**2-VARVAL(1)\\\nVARIABLE/1, FUNCTION=EXP(TIME)*DY(4,5,5)+PSI(5,4)",
    ] {
        all.push(format!("GCON/1, I=5, FUNCTION={function}\n"));
    }
    let wave: String = (0..13)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k % 12) / 12.0;
            let (x, y) = (1.5 * angle.cos(), angle.sin() - 0.2 * (2.0 * angle).cos());
            format!("\n, {x:.9},{y:.9}")
        })
        .collect();
    let rows = |z: fn(f64) -> f64, scale: f64| -> String {
        let numbers: Vec<Vec<f64>> = (wave.split("\n, ").skip(1))
            .map(|p| p.split(',').map(|x| x.parse().unwrap()).collect())
            .collect();
        (numbers.iter())
            .map(|p| format!("\n, {},{},{}", scale * p[0], scale * p[1], z(p[0])))
            .collect::<String>()
            .replacen("\n, ", "", 1)
    };
    let matrix = |id: u32, numbers: String| {
        format!("MATRIX/{id}, FULL=RORDER, ROWS=13, COLUMNS=3\n, VALUES={numbers}\n")
    };
    let space = matrix(1, rows(|x| x * x - 0.3 * x, 1.0));
    let plane = matrix(2, rows(|_| 0.0, 1.0)) + &matrix(3, rows(|_| 0.0, 0.2));
    for (kind, points) in [
        ("OPEN", "CURVE_POINTS"),
        ("CLOSED", "CURVE_POINTS"),
        ("CLOSED", "CONTROL_POINTS, ORDER=5"),
    ] {
        all.push(format!(
            "PTCV/1, CURVE=1, I=5, RM=4\nCURVE/1, {kind}, MATRIX=1, {points}\n{space}"
        ));
        all.push(format!(
            "CVCV/1, ICURVE=2, IRM=5, JCURVE=3, JRM=4\nCURVE/2, {kind}, MATRIX=2, {points}\nCURVE/3, {kind}, MATRIX=3, {points}\n{plane}"
        ));
    }
    for component in ["X", "Y", "Z", "B1", "B2", "B3"] {
        all.push(format!(
            "MOTION/1, I=5, J=4, {component}, FUNCTION=0.3*SIN(2*TIME)+0.1\n"
        ));
    }
    all
}

/// Away from where the rows hold: value, gradient and γ are those of one and the same function, and what acts on I is what
/// acts on J reversed.
#[test]
fn gradients_and_rates_are_those_of_the_value() {
    let mut draw = Draw(2);
    let h = 1e-4;
    for tie in all_rows() {
        let text = pair(&mut draw, &Mat3::identity(), &tie);
        let (_, scene, mut configuration) = compiled(&text, true);
        assert!(!scene.rows.is_empty(), "{tie}");
        let mut looked = 0;
        for _ in 0..5 {
            let (q, v) = anywhere(&scene, &mut draw);
            let t = draw.next();
            let here = all_numbers(&scene, t, &q, &v);
            cams::track(&scene, &mut configuration, &here);
            let configured = scene.within(&configuration);
            // in a configuration drawn at random curves need not have a common tangent
            let code = broken(configured, &here, None).map(|b| b.code());
            if code == Some("no_common_tangent") {
                continue;
            }
            looked += 1;
            let at_time = |dt: f64| {
                let n = all_numbers(&scene, t + dt, &after(&scene, &q, &v, dt), &v);
                let at = Equations::<f64>::new(configured, &n);
                (0..scene.rows.len())
                    .map(|r| at.row(r).value)
                    .collect::<Vec<_>>()
            };
            let samples = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at_time(k * h));
            let n = all_numbers(&scene, t, &q, &v);
            let at = Equations::<f64>::new(configured, &n);
            for (r, scene_row) in scene.rows.iter().enumerate() {
                let row = at.row(r);
                let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k: usize| samples[k][r]);
                if [a, b, c, d, e].iter().any(|x: &f64| (x - c).abs() > 0.5) {
                    continue; // an angle passes its cut
                }
                let rate = (a - 8.0 * b + 8.0 * d - e) / (12.0 * h);
                let second = (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * h * h);
                let along: f64 = row.gradient.iter().map(|&(k, g)| g * v[k]).sum();
                let size = 1.0 + rate.abs() + second.abs();
                assert!((along + row.drift - rate).abs() < 1e-9 * size, "{tie} rate");
                assert!(
                    (-row.gamma - second).abs() < 2e-6 * size,
                    "{tie} γ: {} {second}",
                    -row.gamma
                );
                let [(i, on_i), (j, on_j)] = [0, 1].map(|k| row.actions[k]);
                let arm = at.marker(i).p_GM - at.marker(j).p_GM;
                let force = on_i.force + on_j.force;
                let torque = on_i.torque + on_j.torque + arm.cross(on_i.force);
                // offsets along ground axes act at either origin: only where these coincide is that the same
                let ground = scene_row.equation.ends_with('g');
                let torque = if ground { Vec3::zero() } else { torque };
                assert!(force.norm() < 1e-12, "{tie}: action is not reaction");
                assert!(
                    torque.norm() < 1e-11 * (1.0 + on_i.torque.norm()),
                    "{tie}: torques"
                );
            }
        }
        assert!(looked > 1, "{tie}");
    }
}

/// Numbers that do not depend on how a model is formulated: acceleration of part 3 and the reaction of an element on I.
fn answers(text: &str, cut_all: bool, element: ElementId) -> [Vec3<f64>; 4] {
    let (model, scene, mut configuration) = compiled(text, cut_all);
    let mut q = scene.initial_q.clone();
    let found = assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[]).unwrap();
    let configured = scene.within(&configuration);
    assert!(found.redundant.is_empty(), "{:?}\n{text}", found.redundant);
    let v = velocities::velocities(configured, &model, 0.0, &q, &[]).unwrap();
    let n = all_numbers(&scene, 0.0, &q, &v);
    let at = Equations::<f64>::new(configured, &n);
    let three = scene.parts.iter().position(|p| p.id.number == 3).unwrap();
    let state = at.part(three, true);
    let reaction = at.action_of(element).unwrap();
    [state.a_GM, state.alpha_GM, reaction.force, reaction.torque]
}

fn close(a: &[Vec3<f64>; 4], b: &[Vec3<f64>; 4], what: &str) {
    for (k, (x, y)) in a.iter().zip(b).enumerate() {
        let difference = (*x - *y).norm();
        let scale = 1.0 + x.norm();
        assert!(
            difference < 1e-9 * scale,
            "{what}: quantity {k}, {x:?} {y:?}"
        );
    }
}

/// Velocities for part 3 that any tie permits after projection.
fn spinning(text: &str) -> String {
    text.replace(
        "PART/3, ",
        "PART/3, VX=0.3, VY=-0.2, VZ=0.5, WX=0.7, WY=-0.4, WZ=0.9, ",
    )
    .replace("PART/2, ", "PART/2, WX=-0.3, WY=0.8, WZ=0.2, ")
}

#[test]
fn a_forest_and_the_same_joints_cut_give_the_same_motion_and_reactions() {
    let mut draw = Draw(3);
    for (kind, relative, i, j) in carrying_both_ways() {
        let k = keyword(kind);
        let text = spinning(&pair(
            &mut draw,
            &relative,
            &format!("{k}/1, {kind}, I={i}, J={j}\n"),
        ));
        close(
            &answers(&text, false, k.parse::<ElementKind>().unwrap().id(1)),
            &answers(&text, true, k.parse::<ElementKind>().unwrap().id(1)),
            &format!("{kind} {i}-{j}"),
        );
    }
}

#[test]
fn joints_are_what_their_primitives_make() {
    let mut draw = Draw(4);
    let quarter = rotation::about_axis(0, std::f64::consts::FRAC_PI_2);
    for (kind, primitives) in [
        ("FIXED", &["ATPOINT", "ORIENTATION"][..]),
        ("REVOLUTE", &["ATPOINT", "PARALLEL_AXES"]),
        ("TRANSLATIONAL", &["INLINE", "ORIENTATION"]),
        ("CYLINDRICAL", &["INLINE", "PARALLEL_AXES"]),
        ("SPHERICAL", &["ATPOINT"]),
        ("PLANAR", &["INPLANE", "PARALLEL_AXES"]),
        ("UNIVERSAL", &["ATPOINT", "PERPENDICULAR"]),
    ] {
        let relative = if kind == "UNIVERSAL" {
            quarter
        } else {
            Mat3::identity()
        };
        let base = spinning(&pair(&mut draw, &relative, "@"));
        let joint = base.replace('@', &format!("JOINT/1, {kind}, I=5, J=4\n"));
        let split: String = primitives
            .iter()
            .enumerate()
            .map(|(k, p)| format!("JPRIM/{}, {p}, I=5, J=4\n", k + 1))
            .collect();
        let split = base.replace('@', &split);
        let joint = answers(&joint, true, ElementKind::Joint.id(1));
        let mut whole = answers(&split, true, ElementKind::Jprim.id(1));
        for k in 2..=primitives.len() {
            let more = answers(&split, true, ElementKind::Jprim.id(k as u32));
            whole[2] += more[2];
            whole[3] += more[3];
        }
        close(&joint, &whole, kind);
    }
}

/// Exchanging I and J names the same joint (where its law is symmetric) and reverses what it reports.
#[test]
fn exchanging_i_and_j_reverses_the_reaction() {
    let mut draw = Draw(5);
    let quarter = rotation::about_axis(0, std::f64::consts::FRAC_PI_2);
    for kind in [
        "FIXED",
        "REVOLUTE",
        "TRANSLATIONAL",
        "CYLINDRICAL",
        "SPHERICAL",
        "UNIVERSAL",
        "CONVEL",
        "SCREW",
    ] {
        let relative = if kind == "UNIVERSAL" {
            quarter
        } else {
            Mat3::identity()
        };
        // a screw leaves it to another joint to keep the axes together
        let pitch = if kind == "SCREW" {
            ", PITCH=0.5\nJOINT/2, CYLINDRICAL, I=5, J=4"
        } else {
            ""
        };
        let base = spinning(&pair(&mut draw, &relative, "@"));
        let one = base.replace('@', &format!("JOINT/1, {kind}, I=5, J=4{pitch}\n"));
        let other = base.replace('@', &format!("JOINT/1, {kind}, I=4, J=5{pitch}\n"));
        let (one, mut other) = (
            answers(&one, true, ElementKind::Joint.id(1)),
            answers(&other, true, ElementKind::Joint.id(1)),
        );
        // the origins coincide: no transfer moment
        other[2] = -other[2];
        other[3] = -other[3];
        close(&one, &other, kind);
    }
}

/// A body on a screw: rises by PITCH per turn with a right-hand thread.
#[test]
fn a_screw_falls_slowly() {
    for (pitch, tie) in [(0.01, "I=5, J=6"), (-0.2, "I=5, J=6"), (0.3, "I=6, J=5")] {
        let text = format!(
            "SCREW\nPART/1, GROUND\nPART/3, MASS=2, CM=30, IP=0.004,0.004,0.004\nMARKER/30, PART=3\n\
             MARKER/3, PART=3\nMARKER/4, PART=1\nMARKER/5, PART=3\nMARKER/6, PART=1\n\
             JOINT/1, CYLINDRICAL, I=3, J=4\nJOINT/2, SCREW, {tie}, PITCH={pitch}\nACCGRAV/KGRAV=-9.81\nEND\n"
        );
        let per_radian: f64 = pitch / std::f64::consts::TAU;
        let effective = 2.0 + 0.004 / (per_radian * per_radian);
        let fall = -2.0 * 9.81 / effective;
        for cut_all in [false, true] {
            let [a, alpha, force, torque] = answers(&text, cut_all, ElementKind::Joint.id(2));
            approx::assert_relative_eq!(a.0[2], fall, max_relative = 1e-11);
            approx::assert_relative_eq!(alpha.0[2], fall / per_radian, max_relative = 1e-11);
            // the thread holds what gravity pulls beyond that, and turns the body
            let side = if tie.starts_with("I=5") { 1.0 } else { -1.0 };
            approx::assert_relative_eq!(
                side * force.0[2],
                2.0 * (fall + 9.81),
                max_relative = 1e-10
            );
            approx::assert_relative_eq!(
                side * torque.0[2],
                0.004 * fall / per_radian,
                max_relative = 1e-10
            );
        }
    }
}

/// The datasets of the references without their forces, but with the velocities that make the constraint show.
fn wheels(second_x: f64, cv: &str, ties: &str) -> String {
    format!(
        "GEARS\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=0.01,0.01,0.01\nMARKER/20, PART=2\n\
         PART/3, MASS=4, CM=30, IP=0.08,0.08,0.08, QG={second_x},0,0\nMARKER/30, PART=3\n\
         MARKER/5, PART=1\nMARKER/7, PART=1, QP={second_x},0,0\nMARKER/8, PART=1, {cv}\n\
         JOINT/1, REVOLUTE, I=20, J=5\nJOINT/2, REVOLUTE, I=30, J=7\n{ties}\
         SFORCE/1, ROTATIONAL, ACTIONONLY, I=20, J=5, FUNCTION=1\nEND\n"
    )
}

#[test]
fn gears_turn_by_the_ratio_of_their_radii_and_load_their_bearings() {
    let tangent = "REULER=0,-90D,0"; // z along y
    for (x, contact, ratio) in [(0.15, 0.05, -0.5), (-0.1, 0.05, 1.0 / 3.0)] {
        let text = wheels(
            x,
            &format!("QP={contact},0,0, {tangent}"),
            "GEAR/1, JOINTS=1,2, CV=8\n",
        );
        for cut_all in [false, true] {
            // T = (I₁ + I₂ ratio²) α₁
            let alpha1 = 1.0 / (0.01 + 0.08 * ratio * ratio);
            let [_, alpha, force, torque] = answers(&text, cut_all, ElementKind::Gear.id(1));
            approx::assert_relative_eq!(alpha.0[2], ratio * alpha1, max_relative = 1e-11);
            // I₁ α₁ = 1 + arm × force
            let pressure = (0.01 * alpha1 - 1.0) / contact;
            approx::assert_relative_eq!(force.0[1], pressure, max_relative = 1e-10);
            approx::assert_relative_eq!(torque.0[2], contact * pressure, max_relative = 1e-10);
            assert!(force.0[0].abs() < 1e-12 && force.0[2].abs() < 1e-12);
            // the bearing of the first wheel takes the force of the teeth and nothing about its axis
            let [_, _, bearing, about] = answers(&text, cut_all, ElementKind::Joint.id(1));
            approx::assert_relative_eq!(bearing.0[1], -pressure, max_relative = 1e-10);
            assert!(about.0[2].abs() < 1e-12);
        }
    }
}

#[test]
fn a_coupler_is_a_gear_without_teeth() {
    let text = wheels(
        0.15,
        "QP=0,0,0",
        "COUPLER/1, JOINTS=1,2, TYPE=R:R, SCALES=1,2\n",
    );
    for cut_all in [false, true] {
        // θ₁ + 2 θ₂ = 0
        let alpha1 = 1.0 / (0.01 + 0.08 / 4.0);
        let [_, alpha, force, torque] = answers(&text, cut_all, ElementKind::Coupler.id(1));
        approx::assert_relative_eq!(alpha.0[2], -alpha1 / 2.0, max_relative = 1e-11);
        assert!(force.norm() < 1e-12);
        approx::assert_relative_eq!(torque.0[2], 0.01 * alpha1 - 1.0, max_relative = 1e-10);
    }
}

/// The pinion's centre on the +y_J side: a positive PD, rolling along +z_J when it turns about +x_J.
#[test]
fn a_rack_moves_as_its_pinion_rolls() {
    let rack = |pd: f64| {
        format!(
            "RACK\nPART/1, GROUND\nPART/2, MASS=0.5, CM=20, IP=0.001,0.001,0.001, QG=0,0.05,0\nMARKER/20, PART=2\n\
             PART/3, MASS=3, CM=30, IP=0.01,0.01,0.01\nMARKER/30, PART=3\nMARKER/5, PART=1, QP=0,0.05,0\n\
             MARKER/6, PART=3, REULER=90D,90D,0\nMARKER/7, PART=1, REULER=90D,90D,0\n\
             MARKER/9, PART=3, REULER=90D,90D,90D\n\
             JOINT/1, REVOLUTE, I=20, J=5\nJOINT/2, TRANSLATIONAL, I=6, J=7\nJOINT/3, RACKPIN, I=20, J=9, PD={pd}\n\
             SFORCE/1, ROTATIONAL, ACTIONONLY, I=20, J=5, FUNCTION=1\nEND\n"
        )
    };
    for pd in [-0.1, 0.1, 0.25] {
        for cut_all in [false, true] {
            let r: f64 = pd / 2.0;
            // the rack under a pinion on ground moves against the travel of a rolling pinion: ẋ = −r θ̇
            let alpha = 1.0 / (0.001 + 3.0 * r * r);
            let [a, _, force, torque] = answers(&rack(pd), cut_all, ElementKind::Joint.id(3));
            approx::assert_relative_eq!(a.0[0], -r * alpha, max_relative = 1e-10);
            approx::assert_relative_eq!(force.0[0], 3.0 * r * alpha, max_relative = 1e-10);
            approx::assert_relative_eq!(torque.0[2], 0.001 * alpha - 1.0, max_relative = 1e-10);
        }
    }
}

/// Joint variables of a forest make the rows of couplers constant: no sines, no counted turns.
#[test]
fn displacements_of_the_forest_are_sums_of_coordinates() {
    let text = wheels(
        0.15,
        "QP=0.05,0,0, REULER=0,-90D,0",
        "GEAR/1, JOINTS=1,2, CV=8\n",
    );
    let (_, scene, _) = compiled(&text, false);
    let RowKind::Displacements(sum) = &scene.rows[0].kind else {
        panic!("a gear is a sum of displacements")
    };
    assert!(sum.terms.iter().all(|(_, d)| d.coordinates.is_some()));
    assert!(scene.counted.is_empty());
    let (_, cut, _) = compiled(&text, true);
    assert_eq!(cut.counted.len(), 2);
}
