//! Models of many parts: what makes them quick changes nothing of what comes out.

use crate::running;

use cognate::expr::program::Engine;
use cognate::internals::scene::Scene;
use cognate::internals::scene::build;
use cognate::internals::scene::configuration::{Configuration, Way};
use cognate::internals::scene::equations::Equations;
use cognate::internals::scene::programs;
use cognate::internals::scene::recorder::{self, Recorder};
use cognate::internals::start::assemble;
use cognate::internals::verify::outline::outline;
use cognate::model::Model;
use running::{Analysis, Options, Session, begin, go, values, whole};
use std::fmt::Write;

/// A cantilever of `n` free parts in a row along x, each tied to the one before by a BEAM, under its weight and a spin about its axis.
fn cantilever(n: usize) -> Model {
    let mut text =
        "CANTILEVER\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/KGRAV=-9.81\n".to_string();
    for k in 0..n {
        let (part, left, right, before) = (2 + k, 100 + k, 300 + k, 299 + k);
        let before = if k == 0 { 1 } else { before };
        writeln!(
            text,
            "PART/{part}, QG={:?},0,0, MASS=1.5, CM={left}, IP=0.01,0.02,0.02, WX={:?}\n\
             MARKER/{left}, PART={part}\nMARKER/{right}, PART={part}\n\
             BEAM/{part}, I={left}, J={before}, LENGTH=0.5, IXX=2E-7, IYY=1E-7, IZZ=1E-7, AREA=1E-4, EMODULUS=2E10, GMODULUS=8E9, CRATIO=2E-4",
            0.5 * (k + 1) as f64,
            0.3 * (k + 1) as f64,
        )
        .unwrap();
    }
    whole(&format!("{text}END\n"))
}

fn run(model: &Model, method: &str, error: f64, columns: &[String]) -> Session {
    let options = Options {
        columns: columns.to_vec(),
        error: Some(error),
        method: Some(method.into()),
        ..Options::default()
    };
    let mut s = begin(model.clone(), "large", options);
    go(&mut s, Analysis::Dynamic, 0.1, 10);
    s
}

/// The implicit method factors sparse matrices whose entries were found by groups of columns; the explicit one knows of no Jacobian.
#[test]
fn a_cantilever_of_twelve_parts_swings_alike_by_both_methods() {
    let model = cantilever(12);
    let columns: Vec<String> = ["DZ(311,1)", "AX(311,1)", "VZ(305,1)", "FZ(100,1)"]
        .map(String::from)
        .to_vec();
    let explicit = run(&model, "DOP853", 1e-8, &columns);
    let implicit = run(&model, "RADAU5", 1e-7, &columns);
    for column in &columns {
        let (a, b) = (values(&explicit, column), values(&implicit, column));
        let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max) / size;
        println!("{column}: {off:.1e}");
        assert!(off < 1e-5, "{column}: {off:.1e}");
    }
}

/// The angles of a bushing, a field or a beam pass zero with every swing; their half turn alone is a place where something changes.
#[test]
fn angles_that_pass_zero_are_no_switches() {
    assert_eq!(outline(&cantilever(3)).unwrap().switches, 0);
}

/// A scissor lift of `n` cells in an inclined plane, on a base that is part of ground, which closes a loop with every cell.
fn scissor_lift(n: usize) -> Model {
    scissor_lift_with(n, "")
}

/// The same with further statements.
fn scissor_lift_with(n: usize, more: &str) -> Model {
    let mut text = "LIFT\nPART/1, GROUND\nACCGRAV/JGRAV=-9.81, IGRAV=2\nPART/2, REULER=0.3,0.7,-0.4\n\
                    MARKER/1, PART=1, REULER=0.3,0.7,-0.4\nMARKER/2, PART=2\nJOINT/1, FIXED, I=2, J=1\n"
        .to_string();
    // all parts begin in the frame of the base, so that markers may stand where they are in it
    let (mut marker, mut joint) = (10, 1);
    let mut hinge = |text: &mut String, i: usize, j: usize, [x, y]: [f64; 2]| {
        (marker, joint) = (marker + 2, joint + 1);
        writeln!(
            text,
            "MARKER/{marker}, PART={i}, QP={x:?},{y:?},0\nMARKER/{}, PART={j}, QP={x:?},{y:?},0\nJOINT/{joint}, REVOLUTE, I={marker}, J={}",
            marker + 1,
            marker + 1
        )
        .unwrap();
    };
    for k in 0..n {
        let (a, b, y) = (10 + 2 * k, 11 + 2 * k, 0.8 * k as f64);
        for part in [a, b] {
            writeln!(
                text,
                "PART/{part}, REULER=0.3,0.7,-0.4, MASS=1.5, CM={}, IP=0.1,0.2,0.3\nMARKER/{}, PART={part}, QP=0.5,{:?},0",
                10_000 + part,
                10_000 + part,
                y + 0.4
            )
            .unwrap();
        }
        hinge(&mut text, a, b, [0.5, y + 0.4]);
        if k == 0 {
            hinge(&mut text, a, 2, [0.0, 0.0]);
            text.push_str(
                "MARKER/5, PART=11, QP=1,0,0\nMARKER/6, PART=2, QP=1,0,0, REULER=0,90D,0\nJPRIM/1, INPLANE, I=5, J=6\n",
            );
        } else {
            hinge(&mut text, a, b - 2, [0.0, y]);
            hinge(&mut text, b, a - 2, [1.0, y]);
        }
    }
    whole(&format!("{text}{more}END\n"))
}

/// The lift in motion, with freedoms and rows eliminated in one way: the least changes that put velocities on the rows, then
/// accelerations and multipliers there.
fn eliminated(model: &Model, way: Way) -> [Vec<f64>; 3] {
    let scene = Scene::compile(model, &build::Options::default()).expect("a scene");
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    let found = assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[]).unwrap();
    assert_eq!(found.freedom, 1);
    configuration.elimination.way = way;
    let here = scene.within(&configuration);
    let l = scene.layout;
    let mut numbers = vec![0.0; l.len()];
    numbers[l.q()].copy_from_slice(&q);
    numbers[l.v()].fill(0.4);
    let at = Equations::<f64>::new(here, &numbers);
    let changes = programs::projection(&scene, &at, at.velocities());
    for (v, change) in numbers[l.v()].iter_mut().zip(&changes[l.n_v..]) {
        *v += change;
    }
    let at = Equations::<f64>::new(here, &numbers);
    let solved = at.solved();
    [changes, solved.vdot.clone(), solved.lambda.clone()]
}

/// Rows whose multipliers are eliminated as soon as their loops close: on the forest that is nearest to ground, where all close at one
/// link, and on a deep one.
#[test]
fn accelerations_and_multipliers_are_the_same_however_they_are_eliminated() {
    for n in [3, 24] {
        let model = scissor_lift(n);
        let [usual, closing] =
            [Way::ArticulatedBodies, Way::RowsWhereLoopsClose].map(|way| eliminated(&model, way));
        for (k, (a, b)) in usual.iter().zip(&closing).enumerate() {
            let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let off = a
                .iter()
                .zip(b)
                .fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
            assert!(
                size > 0.1 && off < 1e-9 * size,
                "{n} cells, {k}: {off:.1e} of {size:.1e}"
            );
        }
    }
}

/// Whatever else is recorded at the same instant, before or after, in one order of elimination or the other.
#[test]
fn programs_recorded_together_compute_the_bits_that_each_computes_alone() {
    let model = scissor_lift_with(
        3,
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=10011, J=1, FUNCTION=IF(DX(10011):1,2,VX(10011)*3)+DIF(1)\n\
         DIFF/1, IC=1, FUNCTION=-DIF(1)+IMPACT(DY(10012),VY(10012),0.3,1E3,1.5,1,0.1)\n",
    );
    let scene = Scene::compile(&model, &build::Options::default()).expect("a scene");
    let with = |way: Way| {
        let mut configuration = Configuration::new(&scene);
        let mut q = scene.initial_q.clone();
        assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[1.0]).unwrap();
        configuration.elimination.way = way;
        configuration
    };
    let ways = [with(Way::ArticulatedBodies), with(Way::MassMatrix)];
    let builder = recorder::builder();
    let first = Recorder::new(scene.within(&ways[0]), &builder);
    let second = first.eliminating(&ways[1]);
    let numbers: Vec<f64> = (0..scene.layout.len())
        .map(|k| (1.7 * k as f64).sin())
        .collect();
    let run = |program: &cognate::expr::program::Program| {
        let mut out = vec![0.0; program.n_outputs()];
        program.run(&numbers, &mut Default::default(), &mut out);
        out.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    };
    assert!(programs::switching(&first).unwrap().is_some());
    for (recorder, way) in [(&first, &ways[0]), (&second, &ways[1])] {
        let here = scene.within(way);
        let at = recorder.at();
        let rate = programs::rate(at);
        let changes = programs::projection(&scene, at, at.velocities());
        let together = [&changes, &rate].map(|values| recorder.program(values).unwrap());
        let counted = [&changes, &rate].map(|values| recorder.count_operations(values).unwrap());
        assert_eq!(counted, [0, 1].map(|k: usize| together[k].n_operations()));
        let alone = [
            programs::record(here, |at| programs::projection(&here, at, at.velocities())).unwrap(),
            programs::record(here, |at| programs::rate(at).to_vec()).unwrap(),
        ];
        for (together, alone) in together.iter().zip(&alone) {
            assert_eq!(together.n_operations(), alone.n_operations());
            assert_eq!(run(together), run(alone));
        }
        // the held rate, on the sides that the numbers say
        let switching = programs::switching(recorder).unwrap().expect("switches");
        let held = switching.held.expect("a held rate");
        let mut row = numbers.clone();
        row.resize(held.inputs().len(), 0.0);
        let mut sides = vec![0.0; switching.switches.n_outputs()];
        switching
            .switches
            .run(&row, &mut Default::default(), &mut sides);
        row[numbers.len()..]
            .iter_mut()
            .zip(&sides)
            .for_each(|(side, x)| *side = x.signum());
        let mut out = vec![0.0; held.n_outputs()];
        held.run(&row, &mut Default::default(), &mut out);
        let mut plain = vec![0.0; together[1].n_outputs()];
        together[1].run(&numbers, &mut Default::default(), &mut plain);
        for (a, b) in out.iter().zip(&plain) {
            assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} {b}");
        }
    }
}

/// Every cell closes a loop with parts of its neighbours alone; counted from ground, each loop would be as long as the lift.
#[test]
fn what_a_scissor_lift_computes_grows_with_its_cells() {
    let outlines = [30, 60].map(|n| outline(&scissor_lift(n)).unwrap());
    let [one, two] = [0, 1].map(|k: usize| outlines[k].operations);
    println!("{one:?} {two:?}");
    assert!(two.0 as f64 <= 2.1 * one.0 as f64, "rate: {one:?} {two:?}");
    assert!(
        two.1 as f64 <= 2.1 * one.1 as f64,
        "projection: {one:?} {two:?}"
    );
}

/// Four-bars of other sizes and masses, one with a spring and one that stands elsewhere in the dataset.
fn several_four_bars(n: usize) -> Model {
    let mut text = "SEVERAL\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/JGRAV=-9.81\n".to_string();
    let mut add = |k: usize| {
        let (first, z, size) = (100 * (k + 1), k as f64, 1.0 + 0.03 * k as f64);
        let places =
            [[0.0, 0.0], [0.0, 1.0], [2.0, 1.5], [2.0, 0.0]].map(|[x, y]| [x * size, y * size]);
        for bar in 0..3 {
            let [a, b] = [places[bar], places[bar + 1]];
            let (part, middle) = (first + bar, [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]);
            writeln!(
                text,
                "PART/{part}, QG={:?},{:?},{z:?}, MASS={:?}, CM={part}0, IP=0.1,0.1,0.2\nMARKER/{part}0, PART={part}",
                middle[0], middle[1], 1.0 + 0.1 * k as f64,
            )
            .unwrap();
        }
        for (joint, [x, y]) in places.into_iter().enumerate() {
            let sides = [
                joint.checked_sub(1).map(|b| first + b),
                (joint < 3).then_some(first + joint),
            ];
            let [i, j] = [1, 2].map(|side| 10 * (first + 10 * side + joint));
            for (marker, part) in [i, j].into_iter().zip(sides) {
                let center = part.map_or([0.0; 3], |p| {
                    let [a, b] = [places[p - first], places[p - first + 1]];
                    [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, z]
                });
                writeln!(
                    text,
                    "MARKER/{marker}, PART={}, QP={:?},{:?},{:?}",
                    part.unwrap_or(1),
                    x - center[0],
                    y - center[1],
                    z - center[2],
                )
                .unwrap();
            }
            writeln!(text, "JOINT/{}, REVOLUTE, I={i}, J={j}", first + joint).unwrap();
        }
        if k == 2 {
            writeln!(
                text,
                "SPRINGDAMPER/1, TRANSLATION, I={first}0, J=1, K=30, C=1, LENGTH=0.5"
            )
            .unwrap();
        }
    };
    (0..n).rev().for_each(&mut add);
    whole(&format!("{text}END\n"))
}

/// What has a companion runs through one piece of code with other constants; straight code is what it must equal.
#[test]
fn equal_mechanisms_share_their_code_and_keep_every_bit() {
    let model = several_four_bars(9);
    let scene = Scene::compile(&model, &build::Options::default()).expect("a scene");
    assert_eq!(scene.n_mechanisms(), 9);
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[1.0]).unwrap();
    let builder = recorder::builder();
    let recorder = Recorder::new(scene.within(&configuration), &builder);
    let at = recorder.at();
    let rows: Vec<_> = (0..scene.rows.len()).map(|r| at.row(r).value).collect();
    let all = [
        programs::rate(at),
        programs::projection(&scene, at, at.velocities()),
        rows,
    ];
    for (k, values) in all.iter().enumerate() {
        let program = recorder.program(values).unwrap();
        let straight = program.with_engine(Engine::Interpreter).unwrap();
        let (mut work, mut other) = Default::default();
        for run in 0..60 {
            let numbers: Vec<f64> = (0..scene.layout.len())
                .map(|i| (1.7 * i as f64 + 0.3 * run as f64).sin())
                .collect();
            let [mut here, mut there] = [0, 1].map(|_| vec![0.0; program.n_outputs()]);
            program.run(&numbers, &mut work, &mut here);
            straight.run(&numbers, &mut other, &mut there);
            let bits = |out: &[f64]| out.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&here), bits(&there), "program {k}, run {run}");
        }
        let [shared, written] = [&program, &straight].map(|p| p.n_steps_of_code());
        assert!(2 * shared < written, "program {k}: {shared} of {written}");
    }
}
