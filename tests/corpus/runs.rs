//! Whole models of other people, run and compared with what Adams computed for them: rest and motion, free runs, replays of recorded inputs;
//! and models that need programs which are not there, with what these would compute taken as zero.

use super::running::{Analysis, Options, Session, begin, go, obeys};
use cognate::dataset::command::{Command, Script, SimulationKind};
use cognate::model::{Model, Orientation};
use cognate::results::{self, Run};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use super::needs::corpus;

fn options(error: f64) -> Options {
    Options {
        error: Some(error),
        full: true,
        ..Options::default()
    }
}

/// Obeys a script on a model.
pub fn obeyed(model: &Path, script: &Script, options: Options) -> Session {
    let name = model.file_stem().unwrap().to_string_lossy().into_owned();
    let model = Model::read(model).unwrap_or_else(|e| panic!("{e}"));
    let mut session = begin(model, &name, options);
    obeys(&mut session, script);
    session
}

/// Columns of the position and the 3-1-3 angles of each part, by its number.
fn parts(run: &Run) -> BTreeMap<u64, [usize; 6]> {
    let mut found = BTreeMap::new();
    for entity in run.entities.iter().filter(|e| e.kind == "Part") {
        let column = |name: &str| {
            let c = entity.components.iter().find(|c| c.name == name);
            c.map(|c| c.column)
        };
        let all = ["X", "Y", "Z", "PSI", "THETA", "PHI"].map(column);
        if all.iter().all(Option::is_some) {
            found.insert(entity.id, all.map(Option::unwrap));
        }
    }
    found
}

/// Rz(ψ) Rx(θ) Rz(φ)
fn rotation([psi, theta, phi]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((s1, c1), (s2, c2), (s3, c3)) = (psi.sin_cos(), theta.sin_cos(), phi.sin_cos());
    [
        [c1 * c3 - s1 * c2 * s3, -c1 * s3 - s1 * c2 * c3, s1 * s2],
        [s1 * c3 + c1 * c2 * s3, -s1 * s3 + c1 * c2 * c3, -c1 * s2],
        [s2 * s3, s2 * c3, c2],
    ]
}

/// Largest distance of a part's frame, and largest element of the difference of its rotations, over all rows of theirs that have one of
/// ours at the same time; how many rows these are.
pub fn apart(ours: &Run, theirs: &Run) -> (f64, f64, usize) {
    let (a, b) = (parts(ours), parts(theirs));
    assert!(!b.is_empty() && b.keys().all(|id| a.contains_key(id)));
    let time = &ours.columns[0].values;
    let (mut place, mut turn, mut rows) = (0.0_f64, 0.0_f64, 0);
    for (row, &t) in theirs.columns[0].values.iter().enumerate() {
        // commands repeat the time at which they begin: the later row is the newer one
        let Some(own) = time
            .iter()
            .rposition(|x| (x - t).abs() <= 1e-6 * t.abs().max(1e-3))
        else {
            continue;
        };
        rows += 1;
        for (id, columns) in &b {
            let of = |run: &Run, columns: &[usize; 6], row: usize| {
                columns.map(|c| run.columns[c].values[row])
            };
            let (x, y) = (of(ours, &a[id], own), of(theirs, columns, row));
            for k in 0..3 {
                place = place.max((x[k] - y[k]).abs());
            }
            let (r, s) = (rotation([x[3], x[4], x[5]]), rotation([y[3], y[4], y[5]]));
            for i in 0..3 {
                for j in 0..3 {
                    turn = turn.max((r[i][j] - s[i][j]).abs());
                }
            }
        }
    }
    (place, turn, rows)
}

#[test]
fn a_pendulum_comes_to_rest_and_stays_there_as_in_adams() {
    let Some(root) = corpus() else { return };
    let file = root.join("bthornton191__adams_rescale/models/rescale_analysis.acf");
    let script = Script::read(&file).unwrap();
    let session = obeyed(&script.model_file().unwrap(), &script, options(1e-8));
    let theirs = results::read(&file.with_extension("res")).unwrap();
    let ours = &session.run;
    // the last row of statics, and the last of all
    let static_row = |run: &Run| {
        let all = run.sequences.iter().find(|s| s.name == "static_001");
        all.unwrap().rows.end - 1
    };
    for (a, b) in [
        (static_row(ours), static_row(&theirs)),
        (ours.rows() - 1, theirs.rows() - 1),
    ] {
        for name in [
            "PART_2_XFORM.X",
            "PART_2_XFORM.Y",
            "PART_2_XFORM.PSI",
            "PART_3_XFORM.X",
            "PART_3_XFORM.PSI",
            "JOINT_1.FX",
            "JOINT_1.FY",
            "JOINT_2.FY",
            "JOINT_2.TZ",
        ] {
            let (x, y) = (
                ours.column(name).unwrap()[a],
                theirs.column(name).unwrap()[b],
            );
            println!("{name} {x} {y}");
            // EQUILIBRIUM leaves an imbalance of 1e-4, here against weights of 67
            assert!(
                (x - y).abs() < 2e-6 * y.abs().max(10.0),
                "{name}: {x} and {y}"
            );
        }
    }
    // −0.43240777557 rad and the weights that the corpus describes
    let psi = ours.column("PART_2_XFORM.PSI").unwrap().last().unwrap();
    assert!((psi + 0.432_407_775_57).abs() < 1e-7, "{psi}");
}

#[test]
fn a_cart_with_a_pendulum_moves_by_itself_as_in_adams() {
    let Some(root) = corpus() else { return };
    let file = root.join("yriyazi__Adams_Simulink-Reverse_Pendulum/validation/Matlab.adm");
    let mut session = begin(Model::read(&file).unwrap(), "cart", options(1e-9));
    go(&mut session, Analysis::Dynamic, 10.0, 2000);
    let theirs = results::read(&file.with_extension("res")).unwrap();
    let (place, turn, rows) = apart(&session.run, &theirs);
    println!("cart and pendulum: {place:.2e} mm, {turn:.2e} over {rows} rows");
    // an independent integration found 2.8e-3 mm of a travel of 272 mm, and 2.1e-5 rad
    assert!(rows > 2000 && place < 5e-3 && turn < 5e-5);
}

/// A recorded run obeyed again up to a number of simulations: ours and theirs.
fn replay(log: &str, error: f64, until: usize) -> Option<(Run, Run)> {
    let log = corpus()?.join(log);
    let mut script = Script::from_message_log(&log).unwrap_or_else(|e| panic!("{e}"));
    let simulations =
        |s: &cognate::dataset::command::Step| matches!(s.command, Command::Simulate(_));
    let mut seen = 0;
    script.steps.retain(|s| {
        seen += usize::from(simulations(s));
        seen <= until
    });
    let clock = std::time::Instant::now();
    let session = obeyed(&log.with_extension("adm"), &script, options(error));
    let theirs = results::read(&log.with_extension("gra")).unwrap_or_else(|e| panic!("{e}"));
    println!("{}: {:.1} s", log.display(), clock.elapsed().as_secs_f64());
    Some((session.run, theirs))
}

#[test]
fn a_robot_arm_driven_by_recorded_torques_moves_as_in_adams() {
    let log = "zzy5510__adams_simulink_robotarm/Controls_Plant_1.msg";
    let Some((mut ours, theirs)) = replay(log, 1e-7, 302) else {
        return;
    };
    let (place, turn, rows) = apart(&ours, &theirs);
    println!("as it is: {place:.2e} m, {turn:.2e} over {rows} rows");
    assert!(rows > 300 && place < 1e-3 && turn < 1e-3);
    // Its log shows why: each exchange interval h is a single step of order 1, backward Euler, which under a constant acceleration a
    // arrives at a n (n + 1) h²/2, the mean of the exact places at its two ends less a h²/4 (a about 0.5 m/s², h = 5 ms: 3e-6 m)
    for column in &mut ours.columns[1..] {
        for k in 0..column.values.len() - 1 {
            column.values[k] = 0.5 * (column.values[k] + column.values[k + 1]);
        }
    }
    // the last row has no next one
    let last = ours.rows() - 1;
    ours.columns[0].values[last] = f64::INFINITY;
    let (place, turn, _) = apart(&ours, &theirs);
    println!("as backward Euler: {place:.2e} m, {turn:.2e}");
    assert!(place < 1e-5 && turn < 1e-5, "{place} {turn}");
}

/// A dataset with its parts where a row of somebody's results has them.
fn placed(file: &Path, theirs: &Run, row: usize) -> Model {
    let mut model = Model::read(file).unwrap_or_else(|e| panic!("{e}"));
    for (id, columns) in parts(theirs) {
        let at = columns.map(|c| theirs.columns[c].values[row]);
        let Some(part) = model.parts.get_mut(&(id as u32)) else {
            continue;
        };
        part.qg = [at[0], at[1], at[2]];
        part.orientation = Orientation::Euler([at[3], at[4], at[5]]);
    }
    model
}

/// Values of expressions in the state that a model begins with.
fn at_the_start(model: Model, columns: &[&str], full: bool) -> (Session, Vec<f64>) {
    let options = Options {
        full,
        columns: columns.iter().map(ToString::to_string).collect(),
        ..Options::default()
    };
    let mut session = begin(model, "start", options);
    go(&mut session, Analysis::InitialConditions, 0.0, 1);
    let last = |c: &&str| *session.run.column(c).unwrap().last().unwrap();
    let values = columns.iter().map(last).collect();
    (session, values)
}

const ROBOT: &str = "ssernap__T_MSC_ADAMS/RD3.msg";
/// Angular velocities and accelerations of the robot's three cranks, the names that Adams' results have for them, and the joints they turn in.
const CRANKS: [(&str, &str, &str, u32); 3] = [
    ("WZ(2,1,0)", "WDTZ(2,1,0)", "G", 17),
    ("WZ(4,3,0)", "WDTZ(4,3,0)", "Y", 11),
    ("WZ(6,5,0)", "WDTZ(6,5,0)", "R", 5),
];

/// Accelerations of the robot's cranks in the state of a row of Adams' results, under the torques of the `k`-th recorded simulation over time.
/// `along`: what WZ is, which is taken along the z axis of ground, where a joint turns at one.
fn accelerations(log: &Path, theirs: &Run, row: usize, k: usize, along: [f64; 3]) -> [f64; 3] {
    let mut model = placed(&log.with_extension("adm"), theirs, row);
    let mut seen = 0;
    for step in Script::from_message_log(log).unwrap().steps {
        match &step.command {
            Command::Simulate(s) if s.kind != SimulationKind::InitialConditions => seen += 1,
            Command::Change(_) => model.apply(&step.command).unwrap(),
            _ => {}
        }
        if seen == k {
            break;
        }
    }
    let speeds = CRANKS.map(|c| theirs.column(&format!("{}_Vel.Q", c.2)).unwrap()[row]);
    for c in 0..3 {
        let joint = model.joints.get_mut(&CRANKS[c].3).unwrap();
        joint.ic_rotation = [None, Some(speeds[c] / along[c])];
    }
    let columns: Vec<&str> = CRANKS.iter().flat_map(|c| [c.0, c.1]).collect();
    let (_, values) = at_the_start(model, &columns, false);
    for (pair, speed) in values.chunks(2).zip(speeds) {
        assert!((pair[0] - speed).abs() < 1e-9, "{} {speed}", pair[0]);
    }
    [values[1], values[3], values[5]]
}

#[test]
fn a_parallel_robot_with_friction_accelerates_as_in_adams_where_its_log_has_led_it() {
    let Some(root) = corpus() else { return };
    let log = root.join(ROBOT);
    let theirs = results::read(&log.with_extension("res")).unwrap();
    let time = &theirs.columns[0].values;
    // intervals of 5 ms
    let row = |k: usize| {
        let t = 0.005 * k as f64;
        let at = time.iter().rposition(|x| (x - t).abs() < 1e-9);
        at.unwrap()
    };
    let value = |name: &str, k: usize| theirs.column(name).unwrap()[row(k)];
    let mut model = placed(&log.with_extension("adm"), &theirs, row(0));
    for (_, _, _, joint) in CRANKS {
        model.joints.get_mut(&joint).unwrap().ic_rotation = [None, Some(1.0)];
    }
    let speeds = CRANKS.map(|c| c.0);
    let (_, along) = at_the_start(model, &speeds, false);
    let along = [along[0], along[1], along[2]];
    for k in [0, 1, 100] {
        let ours = accelerations(&log, &theirs, row(k), k, along);
        let adams = CRANKS.map(|c| value(&format!("{}_Ac.Q", c.2), k));
        println!("{ours:?} {adams:?}");
        let most = adams.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
        // at the start Adams solves for them; later they are differences of velocities, with an error of 1e-4 permitted in each step
        let permitted = if k == 0 { 1e-7 } else { 2e-3 };
        for (a, b) in ours.into_iter().zip(adams) {
            assert!((a - b).abs() < permitted * most, "{k}: {a} {b}");
        }
    }
    // Between two commands the torques stand still, and accelerations go smoothly from the one at the beginning to the one at the end. Velocities in
    // Adams gain more than either: its multi-step formula goes on over the jump of the torque, which it smears backwards. That is
    // why replays of its logs come near to what it wrote, and no nearer.
    let begin = accelerations(&log, &theirs, row(1), 2, along)[0];
    let end = value("G_Ac.Q", 2);
    let mean = (value("G_Vel.Q", 2) - value("G_Vel.Q", 1)) / 0.005;
    println!("{begin} {mean} {end}");
    assert!(begin > end && mean > 1.05 * begin);
}

#[test]
fn a_parallel_robot_obeys_its_log() {
    let Some((ours, theirs)) = replay(ROBOT, 1e-5, 3) else {
        return;
    };
    let (place, turn, rows) = apart(&ours, &theirs);
    println!("{place:.2e} m, {turn:.2e} over {rows} rows");
    // up to the first jump Adams' own error of 1e-4; after it 2 % of a velocity, for 5 ms (see the accelerations)
    assert!(rows > 2 && place < 5e-5 && turn < 4e-4);
}

#[test]
fn positions_that_a_wiper_passed_in_adams_fit_its_joints() {
    let Some(root) = corpus() else { return };
    let file =
        root.join("Dinh-Hao-Nguyen__MSCAdams_Wiper_Project/ControlSimulink/Controls_Plant_5.adm");
    let theirs = results::read(&file.with_extension("gra")).unwrap();
    // its log does not say which torques the motor was given: what can be compared is where everything is
    for row in [1, 150, 700] {
        let (session, _) = at_the_start(placed(&file, &theirs, row), &[], true);
        let (ours, columns) = (parts(&session.run), parts(&theirs));
        let last = session.run.rows() - 1;
        let mut moved = 0.0_f64;
        for (id, theirs_at) in &columns {
            for k in 0..3 {
                let a = session.run.columns[ours[id][k]].values[last];
                let b = theirs.columns[theirs_at[k]].values[row];
                moved = moved.max((a - b).abs());
            }
        }
        println!(
            "row {row}: freedom {}, {moved:.2e} mm",
            session.run.record.freedom
        );
        assert_eq!(session.run.record.freedom, 1);
        // six digits of up to 1000 mm, and of angles at as long levers
        assert!(moved < 0.02, "{moved}");
    }
}

/// Command files of wind turbines whose loads come from a program that is not there.
fn turbines() -> Option<Vec<PathBuf>> {
    let folder = corpus()?.join("old-NWTC__FAST/CertTest/Old_Adams_files");
    let entries = std::fs::read_dir(folder).expect("the corpus holds them");
    let mut all: Vec<PathBuf> = entries
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "acf"))
        .collect();
    all.sort();
    Some(all)
}

/// Obeys a turbine's commands with USER taken as zero, and its simulations over time replaced by their first instant.
fn released(file: &Path, statics: bool) -> Session {
    let mut script = Script::read(file).unwrap_or_else(|e| panic!("{e}"));
    script.steps.retain_mut(|step| match &mut step.command {
        Command::Simulate(s) => {
            let settles = s.kind == SimulationKind::Static;
            if !settles {
                s.kind = SimulationKind::InitialConditions;
            }
            statics || !settles
        }
        Command::Linear(_) => false,
        _ => true,
    });
    let options = Options {
        zero_user: true,
        ..options(1e-4)
    };
    obeyed(&script.model_file().unwrap(), &script, options)
}

#[test]
fn wind_turbines_assemble_and_count_their_freedom() {
    for file in turbines().unwrap_or_default() {
        let session = released(&file, false);
        let record = &session.run.record;
        let name = file.file_stem().unwrap().to_string_lossy();
        println!(
            "{name}: freedom {}, dependent {}",
            record.freedom,
            record.redundant.len()
        );
        assert!(record.redundant.is_empty(), "{:?}", record.redundant);
        if record.freedom == 0 {
            // one turbine is parked: nothing is switched off; one command file has but the statics that are left out here
            // and run by the next test
            assert!(
                ["Test10_ADAMS", "Test14_ADAMS_LIN"].contains(&&*name),
                "{name}"
            );
            continue;
        }
        // the joints that lock towers and blades have been switched off: six for each piece of them, and what turns or yaws
        let counted = [
            ("Test04_ADAMS", 266),
            ("Test05_ADAMS", 267),
            ("Test07_ADAMS", 272),
            ("Test08_ADAMS", 271),
            ("Test11_ADAMS", 342),
            ("Test13_ADAMS", 342),
            ("Test14_ADAMS", 338),
            ("Test15_ADAMS", 274),
        ];
        match counted.iter().find(|c| c.0 == name) {
            Some((_, freedom)) => assert_eq!(record.freedom, *freedom, "{name}"),
            None => assert!(record.freedom > 200, "{name}: {}", record.freedom),
        }
    }
}

#[test]
fn a_wind_turbine_settles_under_its_weight() {
    let Some(files) = turbines() else { return };
    let file = files.iter().find(|f| f.ends_with("Test14_ADAMS_LIN.acf"));
    let session = released(file.expect("it settles"), true);
    println!(
        "{:?} {}",
        session.run.record.counts, session.run.record.method
    );
    assert!(
        session.run.record.method.contains("stable"),
        "{}",
        session.run.record.method
    );
    assert!(session.run.sequences.iter().any(|s| s.name == "static_001"));
}

/// Their rotors are off balance by little and turn freely, their blades are stiff: what swings the rotor down is a millionth of what a straight step of
/// it would stretch a blade by.
#[test]
fn wind_turbines_whose_rotors_turn_freely_settle() {
    let Some(files) = turbines() else { return };
    for name in ["Test11_ADAMS.acf", "Test17_ADAMS.acf"] {
        let file = files
            .iter()
            .find(|f| f.ends_with(name))
            .expect("it is there");
        let mut script = Script::read(file).unwrap_or_else(|e| panic!("{e}"));
        // released as for its last simulation, but to come to rest; the simulations before are left out
        let is_simulation = |c: &Command| matches!(c, Command::Simulate(_));
        let last = script.steps.iter().rposition(|s| is_simulation(&s.command));
        let mut place = 0..;
        script.steps.retain_mut(|step| {
            let here = place.next();
            if let Command::Simulate(s) = &mut step.command {
                // one equilibrium; with an end it would be a sequence of four hundred
                s.kind = SimulationKind::Static;
                (s.end, s.duration, s.steps, s.dtout) = (None, None, None, None);
                return here == last;
            }
            true
        });
        let options = Options {
            zero_user: true,
            ..options(1e-4)
        };
        let session = obeyed(&script.model_file().unwrap(), &script, options);
        let record = &session.run.record;
        println!("{name}: {} {:?}", record.method, record.counts);
        assert!(record.method.contains("stable"), "{}", record.method);
        assert!(record.counts.steps < 300, "{name}: {:?}", record.counts);
    }
}

/// A gear selector of 140 parts, without the contacts of CAD solids: Adams takes 63, 11 and 11 iterations for three equilibria, each with tolerances of its own
/// that count: parts that rattle between kinks of their contacts never come to rest to the last digit.
#[test]
fn a_gear_selector_settles_as_well_as_it_is_asked_to() {
    let Some(root) = corpus() else { return };
    let folder = root.join("bthornton191__adamspy/test/files/real_analysis_with_spikes");
    let mut script = Script::read(folder.join("FRS5_doe_8_LAUL_analysis.acf")).unwrap();
    let moves = |c: &Command| match c {
        Command::Simulate(s) => s.kind != SimulationKind::Static,
        _ => false,
    };
    let until = script.steps.iter().position(|s| moves(&s.command));
    script
        .steps
        .truncate(until.expect("it moves after it has settled"));
    let options = Options {
        skip: [cognate::model::ElementKind::Contact].into(),
        ..options(1e-4)
    };
    let session = obeyed(&script.model_file().unwrap(), &script, options);
    let record = &session.run.record;
    println!("{} {:?}", record.method, record.counts);
    assert!(record.method.contains("stable"), "{}", record.method);
    let statics = session.run.sequences.iter();
    assert_eq!(statics.filter(|s| s.name.starts_with("static")).count(), 3);
    assert!(record.counts.steps < 300, "{:?}", record.counts);
}

/// Without their locks turbines are some fifty free parts tied by fields. Their Jacobian is sparse, and the angles of the fields pass zero all the time:
/// taking that for changes of branch once made 5700 steps of a tenth of a second, now 160.
#[test]
fn wind_turbines_swing_once_their_locks_are_off() {
    let Some(files) = turbines() else { return };
    for name in ["Test04_ADAMS.acf", "Test11_ADAMS.acf"] {
        let file = files
            .iter()
            .find(|f| f.ends_with(name))
            .expect("it is there");
        let mut script = Script::read(file).unwrap_or_else(|e| panic!("{e}"));
        for step in &mut script.steps {
            if let Command::Simulate(s) = &mut step.command {
                s.end = s.end.map(|end| end.min(0.05));
            }
        }
        let options = Options {
            zero_user: true,
            full: true,
            ..Options::default()
        };
        let session = obeyed(&script.model_file().unwrap(), &script, options);
        let record = &session.run.record;
        println!("{name}: {:?}", record.counts);
        assert!(record.counts.steps < 500, "{name}: {:?}", record.counts);
    }
}

/// Models that need nothing but what is here, or programs whose results are taken as zero, and run a little while.
#[test]
fn models_of_many_people_run() {
    let Some(root) = corpus() else { return };
    for (file, end, freedom) in [
        (
            "takuma1122__quarter-car-adams-simulink-cosim/adams/Controls_Plant.adm",
            0.1,
            None,
        ),
        (
            "Radka208677__RL_with_Continuous_Action_Space/pendulum.adm",
            0.5,
            Some(1),
        ),
        (
            "yriyazi__Adams_Simulink-Reverse_Pendulum/Simulink and adams/Controls_Plant_1.adm",
            0.5,
            Some(2),
        ),
        (
            "Dinh-Hao-Nguyen__MSCAdams_Wiper_Project/ControlSimulink/Controls_Plant_5.adm",
            0.05,
            None,
        ),
        (
            "bthornton191__adamspy/test/files/analysis_with_spikes/test_analysis_with_spikes.adm",
            0.1,
            None,
        ),
        (
            "bthornton191__aview_hpc/test/_test_installed/test.adm",
            1.0,
            Some(1),
        ),
        (
            "zzy5510__adams_simulink_robotarm/Controls_Plant_1.adm",
            0.05,
            Some(7),
        ),
    ] {
        let model = Model::read(root.join(file)).unwrap_or_else(|e| panic!("{e}"));
        let options = Options {
            zero_user: true,
            ..options(1e-6)
        };
        let mut session = begin(model, file, options);
        go(&mut session, Analysis::Transient, end, 5);
        let record = &session.run.record;
        println!(
            "{file}: freedom {}, {} steps",
            record.freedom, record.counts.steps
        );
        assert!(
            freedom.is_none_or(|f| f == record.freedom),
            "{file}: {}",
            record.freedom
        );
        let finite = |c: &results::Column| c.values.iter().all(|x| x.is_finite());
        let lost = session.run.columns.iter().find(|c| !finite(c));
        assert!(lost.is_none(), "{file}: {}", lost.unwrap().name);
    }
}

/// Models whose contacts are solids of a kernel, whose curves and forces are programs: without these they assemble, and say what is missing.
#[test]
fn models_that_lack_something_stand_without_it() {
    let Some(root) = corpus() else { return };
    for (file, gone, reader) in [
        (
            "bthornton191__adamspy/test/files/real_analysis_with_spikes/FRS5_doe_8_LAUL_analysis.adm",
            "CONTACT/57: is left out",
            "SENSOR/1000 FUNCTION: reads CONTACT of CONTACT/57",
        ),
        (
            "bthornton191__adamspy/test/existing_drillsim/test_analysis_1.adm",
            "PTCV/9000001: is left out: CURVE/9001",
            "",
        ),
    ] {
        let model = Model::read(root.join(file)).unwrap_or_else(|e| panic!("{e}"));
        let options = Options {
            zero_user: true,
            skip: [cognate::model::ElementKind::Contact].into(),
            ..Options::default()
        };
        let mut session = begin(model, file, options);
        go(&mut session, Analysis::InitialConditions, 0.0, 1);
        let unnamed = session.run.record.warnings.iter().map(|w| {
            let name = None;
            cognate::results::Warning { name, ..w.clone() }.sentence()
        });
        let warnings: Vec<String> = unnamed.collect();
        for said in [gone, reader] {
            assert!(warnings.iter().any(|w| w.contains(said)), "{file}: {said}");
        }
    }
}

/// The slide of this robot begins with `IC = -0.1815, -146.9925875`. In the commands of Adams View that made the dataset the first is `velocity_ic`, the second
/// `translational_ic`, and in Adams' results it stands at -146.992 and moves at -0.2. The statement is documented the other way round; here the name that
/// View gave the joint and the place where it drew the parts say how it is meant.
#[test]
fn a_planar_robot_is_put_together_as_in_adams_with_its_initial_condition_as_view_wrote_it() {
    let Some(root) = corpus() else { return };
    let folder = root.join("kiterunner347__3-RPR-parallel--robot/RPRAdams/fitestv1");
    let theirs = results::read(&folder.join("Fkinev1.gra")).unwrap();
    let model = Model::read(folder.join("Fkinev1.adm")).unwrap();
    assert_eq!(
        model.joints[&20].ic_translation,
        [Some(-146.9925875), Some(-0.1815)]
    );
    let (session, values) = at_the_start(model, &["DZ(3,4,4)", "VZ(3,4,4,4)"], true);
    let warnings = &session.run.record.warned();
    assert!(
        warnings
            .iter()
            .any(|w| w.starts_with("JOINT/20 'Tran3': its initial condition")
                && w.contains("as Adams View writes it")),
        "{warnings:?}"
    );
    // wishes weigh 1e5 times what parts weigh
    assert!((values[0] + 146.9925875).abs() < 1e-7, "{values:?}");
    assert!((values[1] + 0.1815).abs() < 1e-9, "{values:?}");
    let (ours, a, b) = (&session.run, parts(&session.run), parts(&theirs));
    for (id, columns) in &b {
        let of = |run: &Run, columns: &[usize; 6], row: usize| {
            columns.map(|c| run.columns[c].values[row])
        };
        // their second row is the first that is put together; its digits are those of 1e-3 mm and 1e-5 rad
        let (x, y) = (of(ours, &a[id], 0), of(&theirs, columns, 1));
        for k in 0..3 {
            assert!((x[k] - y[k]).abs() < 2e-3, "PART/{id}: {x:?} {y:?}");
        }
        let (r, s) = (rotation([x[3], x[4], x[5]]), rotation([y[3], y[4], y[5]]));
        for (p, q) in r.iter().flatten().zip(s.iter().flatten()) {
            assert!((p - q).abs() < 2e-5, "PART/{id}: {x:?} {y:?}");
        }
    }
}
