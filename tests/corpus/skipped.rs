//! Models whose contacts are between solids of a CAD kernel: without these contacts they run, and do what mechanics says of the first instants.

use super::running::{Analysis, Options, Session, begin, go};
use super::runs::{apart, corpus, obeyed};
use cognate::dataset::command::{Command, Script};
use cognate::model::Model;
use cognate::results;
use std::path::PathBuf;

fn options(error: f64, columns: Vec<String>) -> Options {
    Options {
        error: Some(error),
        full: true,
        columns,
        skip: [cognate::model::ElementKind::Contact].into(),
        ..Options::default()
    }
}

/// A model that runs for a while, with the time that took in bounds.
fn run(path: &PathBuf, columns: Vec<String>, end: f64) -> Session {
    let model = Model::read(path).unwrap_or_else(|e| panic!("{e}"));
    let mut s = begin(model, "skipped", options(1e-9, columns));
    let clock = std::time::Instant::now();
    go(&mut s, Analysis::Dynamic, end, 10);
    // unoptimized, beside other tests; it takes a second
    assert!(clock.elapsed().as_secs() < 60, "{:?}", clock.elapsed());
    let said = |w: &&String| {
        w.contains("CONTACT/") && w.contains("is left out") && w.contains("CAD kernel")
    };
    let n = s.run.record.warned().iter().filter(said).count();
    assert_eq!(n, s.model.contacts.len(), "every contact is told");
    s
}

/// Mass and centre-of-mass marker of every part that has both.
fn masses(path: &PathBuf) -> (Vec<(f64, u32)>, [f64; 3]) {
    let model = Model::read(path).unwrap_or_else(|e| panic!("{e}"));
    let all = model.parts.values().filter(|p| p.mass > 0.0);
    (
        all.filter_map(|p| Some((p.mass, p.cm?))).collect(),
        model.gravity,
    )
}

/// Place of the centre of mass of all parts that move, row by row.
fn centre(s: &Session, masses: &[(f64, u32)]) -> Vec<[f64; 3]> {
    let moves = |cm: u32| {
        let heights = s.run.column(&format!("DZ({cm})")).unwrap();
        heights.iter().any(|z| *z != heights[0])
    };
    let masses: Vec<(f64, u32)> = masses.iter().copied().filter(|m| moves(m.1)).collect();
    assert!(masses.len() > 5);
    let total: f64 = masses.iter().map(|m| m.0).sum();
    let mean = |row: usize, axis: &str| {
        let place = |cm: u32| s.run.column(&format!("D{axis}({cm})")).unwrap()[row];
        masses.iter().map(|&(m, cm)| m * place(cm)).sum::<f64>() / total
    };
    (0..s.run.rows())
        .map(|row| ["X", "Y", "Z"].map(|axis| mean(row, axis)))
        .collect()
}

#[test]
fn a_robot_falls_as_in_adams_until_it_touches_the_floor() {
    let Some(root) = corpus() else { return };
    let log = root.join("alino93__HandspringRobot/matlab & adams/Controls_Plant_10.msg");
    let mut script = Script::from_message_log(&log).unwrap_or_else(|e| panic!("{e}"));
    let mut seen = 0;
    script.steps.retain(|s| {
        seen += usize::from(matches!(s.command, Command::Simulate(_)));
        seen <= 27
    });
    let session = obeyed(
        &log.with_extension("adm"),
        &script,
        options(1e-9, Vec::new()),
    );
    let time = *session.run.columns[0].values.last().unwrap();
    assert!((time - 0.13).abs() < 1e-9, "{time}");
    let theirs = results::read(&log.with_extension("gra")).unwrap_or_else(|e| panic!("{e}"));
    let (place, turn, rows) = apart(&session.run, &theirs);
    println!("{place:.2e} m, {turn:.2e} over {rows} rows");
    // six digits of metres and radians; single steps of order one cost a h²/4 = 6e-7 m
    assert!(
        rows > 25 && place < 2e-6 && turn < 5e-6,
        "{place} {turn} {rows}"
    );
}

#[test]
fn the_legs_of_an_exoskeleton_without_torque_keep_their_energy() {
    let Some(root) = corpus() else { return };
    let file = root.join("aniket0112__exoskeleton/load-analysis/pd-control/Controls_Plant_1.adm");
    let (masses, g) = masses(&file);
    let model = Model::read(&file).unwrap();
    // all turn about the X of ground, which is the x of their inertia
    let inertia: Vec<f64> = (model.parts.values().filter(|p| p.mass > 0.0))
        .map(|p| p.ip[0])
        .collect();
    let about = |what: &str, cm: u32| format!("{what}({cm})");
    let columns = masses
        .iter()
        .flat_map(|m| ["DY", "VM", "WX", "WM"].map(|what| about(what, m.1)));
    let s = run(&file, columns.collect(), 0.2);
    let energy = |row: usize| -> [f64; 2] {
        let of = |what: &str, cm: u32| s.run.column(&about(what, cm)).unwrap()[row];
        let mut sum = [0.0; 2];
        for (&(m, cm), i) in masses.iter().zip(&inertia) {
            assert!((of("WX", cm).abs() - of("WM", cm)).abs() < 1e-9 * (1.0 + of("WM", cm)));
            sum[0] += 0.5 * m * of("VM", cm).powi(2) + 0.5 * i * of("WX", cm).powi(2);
            sum[1] -= m * g[1] * of("DY", cm);
        }
        sum
    };
    let begin = energy(0);
    assert_eq!(begin[0], 0.0);
    let mut moved = 0.0_f64;
    for row in 0..s.run.rows() {
        let now = energy(row);
        moved = moved.max(now[0]);
        // the run asks for 1e-9
        assert!(
            (now[0] + now[1] - begin[1]).abs() < 1e-6 * begin[1].abs(),
            "{now:?} {begin:?}"
        );
    }
    assert!(moved > 0.01 * begin[1].abs(), "{moved} of {begin:?}");
}

/// Its replay leaves Adams from the first interval of 5 ms on, and this is why: the solids of its thigh and hip, shin and thigh lie in each other where they
/// are hinged, and their contacts rub. Friction of a CONTACT grows with the sliding speed up to STICTION_TRANSITION_VELOCITY, here 100 mm/s: what
/// Adams' motion lacks of our accelerations grows as the speed of each leg.
#[test]
fn the_legs_of_an_exoskeleton_are_held_back_in_adams_by_contacts_in_proportion_to_their_speeds() {
    let Some(root) = corpus() else { return };
    let log = root.join("aniket0112__exoskeleton/load-analysis/pd-control/Controls_Plant_1.msg");
    let mut script = Script::from_message_log(&log).unwrap_or_else(|e| panic!("{e}"));
    let mut seen = 0;
    script.steps.retain(|s| {
        seen += usize::from(matches!(s.command, Command::Simulate(_)));
        seen <= 9
    });
    let columns = ["THETA(22)", "THETA(25)"];
    let asked = options(1e-8, columns.map(String::from).to_vec());
    let ours = obeyed(&log.with_extension("adm"), &script, asked).run;
    let theirs = results::read(&log.with_extension("gra")).unwrap_or_else(|e| panic!("{e}"));
    const H: f64 = 5e-3;
    let angle = |run: &results::Run, name: &str, k: usize| {
        let time = &run.columns[0].values;
        let near = |x: &f64| (x - H * k as f64).abs() < 1e-6;
        run.column(name).unwrap()[time.iter().rposition(near).unwrap()]
    };
    // thigh, shin: the resolution of six digits in an angle; rate of the resistance
    for (own, name, digit, resistance) in [
        (columns[0], "PART_5_XFORM.THETA", 1e-5, 9.9),
        (columns[1], "PART_8_XFORM.THETA", 1e-6, 12.9),
    ] {
        let a = |k| angle(&ours, own, k);
        let b = |k| angle(&theirs, name, k);
        // from rest, before anything rubs: fifty steps of backward Euler arrive at a n (n + 1) h²/2 where we arrive at a (n h)²/2
        let (one, other) = (1.02 * (a(1) - a(0)), b(1) - b(0));
        assert!(
            (one - other).abs() < 0.01 * other.abs() + digit,
            "{name}: {one} {other}"
        );
        for k in 2..5 {
            let second = |f: &dyn Fn(usize) -> f64| (f(k + 1) - 2.0 * f(k) + f(k - 1)) / (H * H);
            let lacks = second(&b) - second(&a);
            let speed = (b(k + 1) - b(k - 1)) / (2.0 * H);
            println!(
                "{name}: lacks {lacks:.1} at {speed:.3} rad/s: {:.1}",
                -lacks / speed
            );
            // second differences of rounded angles are off by up to two digits / h²
            let off = 2.0 * digit / (H * H) / speed.abs();
            assert!(
                (-lacks / speed - resistance).abs() < 0.06 * resistance + off,
                "{name}: {lacks} at {speed}"
            );
        }
    }
}

#[test]
fn a_vehicle_without_floor_falls_with_its_centre_of_mass() {
    let Some(root) = corpus() else { return };
    for name in ["Only_AGV.adm", "Only_AGV_3.adm"] {
        let file = root.join("NastiaCandor__bachelor-diploma").join(name);
        let (masses, g) = masses(&file);
        let axes = ["X", "Y", "Z"];
        let columns = masses
            .iter()
            .flat_map(|m| axes.map(|a| format!("D{a}({})", m.1)));
        let s = run(&file, columns.collect(), 0.1);
        let places = centre(&s, &masses);
        let time = &s.run.columns[0].values;
        for (&t, place) in time.iter().zip(&places) {
            for k in 0..3 {
                let expected = places[0][k] + 0.5 * g[k] * t * t;
                // places of some hundred, request 1e-9
                assert!(
                    (place[k] - expected).abs() < 1e-6,
                    "{name} at {t}: {place:?}"
                );
            }
        }
        assert!((places[10][2] - places[0][2] + 0.5 * 980.665 * 0.01).abs() < 1e-6);
    }
}
