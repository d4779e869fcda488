//! What is recorded: every element that is solved has its set, requests and selections are obeyed, files hold what is
//! asked for.

use super::command::{cognate, path, scratch};
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Chosen, Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::internals::dataset::manual;
use cognate::model::{ElementKind, Model};
use cognate::results::{self, Kind, Run, Status};
use std::collections::BTreeSet;

/// Steps after which a run of a test ends.
const MAX_STEPS: usize = 20_000;

fn all_sets() -> Options {
    Options {
        full: true,
        zero_user: true,
        max_steps: Some(MAX_STEPS),
        ..Options::default()
    }
}

/// The run of a dataset that is simulated to a time.
fn simulated(text: &str, options: Options, end: f64) -> Run {
    let model = Model::from_text(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let mut session = Session::new(model, "test", options);
    let status = session.simulate(Analysis::Transient, end, 10, &mut Unwatched);
    assert_eq!(
        status.unwrap_or_else(|e| panic!("{e:?}")),
        Status::Completed
    );
    session.run
}

#[test]
fn every_element_of_the_manual_that_is_solved_has_its_set_with_finite_values() {
    let mut met = BTreeSet::new();
    for example in manual::examples() {
        let model = Model::from_text(example.dataset).unwrap();
        let mut session = Session::new(model.clone(), example.name, all_sets());
        let script = Script::from_text(example.commands).unwrap();
        obey(&mut session, &script.steps, |_, _| (), &mut Unwatched)
            .unwrap_or_else(|e| panic!("{}: {e:?}", example.name));
        let run = &session.run;
        let warned: Vec<&str> = run.record.warnings.iter().map(|w| w.code).collect();
        assert!(
            !warned.contains(&"no_finite_value"),
            "{}: {warned:?}",
            example.name
        );
        for (id, element) in model.elements() {
            let place = element.place();
            let ground = model.parts.get(&id.number).is_some_and(|p| p.ground);
            let chosen: Result<Chosen, String> = id.to_string().parse();
            if chosen.is_err() || !id.kind.is_solved() || ground && id.kind == ElementKind::Part {
                continue;
            }
            let name = place.name.clone();
            let name = name.unwrap_or_else(|| format!("{}_{}", id.kind, id.number));
            let set = run.entities.iter().find(|e| e.entity == name);
            let set = set.unwrap_or_else(|| panic!("{}: {id} has no set", example.name));
            for component in &set.components {
                let column = &run.columns[component.column];
                // commands may have switched it off
                let n = match session.model.is_active(id) {
                    true => column.values.len(),
                    false => 1,
                };
                let finite = column.values[..n].iter().all(|x| x.is_finite());
                assert!(finite, "{}: {}", example.name, column.name);
            }
            met.insert(id.kind);
        }
    }
    for &kind in ElementKind::ALL {
        let is_asked = kind.is_solved() && kind.to_string().parse::<Chosen>().is_ok();
        assert!(!is_asked || met.contains(&kind), "no example has {kind}");
    }
}

/// A cylinder on a slope of part 3 that part 2 slides along and pushes, with a coupler and requests.
const LIFT: &str = "\
LIFT
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
MARKER/2, PART=1, REULER=90D,90D,90D
PART/2, QG=1,2,0, MASS=2, CM=20, IP=.1,.1,.1
MARKER/20, PART=2, QP=.5,0,0
MARKER/21, PART=2, QP=-1,-2,0
PART/3, MASS=3, CM=30, IP=.1,.1,.1
MARKER/30, PART=3
MARKER/31, PART=3, REULER=90D,90D,90D
JOINT/1, REVOLUTE, I=21, J=1
JOINT/2, TRANSLATIONAL, I=31, J=2
COUPLER/1, JOINTS=1,2, TYPE=R:T, SCALES=-.5,1
SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=30, J=2, FUNCTION=12
MREQUEST/1, DISPLACEMENT, PARTS=ALL
MREQUEST/2, FORCE, JOINTS=2, APPFORS=SFORCE/1
REQUEST/3, D, I=20, J=1
RESULTS/XRF
END
";

#[test]
fn a_coupler_exerts_forces_that_do_no_work_together() {
    let run = simulated(LIFT, all_sets(), 1.0);
    let at = |name: &str| run.column(name).unwrap_or_else(|| panic!("{name}"));
    let (turning, sliding) = (at("COUPLER_1.F1"), at("COUPLER_1.F2"));
    let (angle, distance) = (
        at("JOINT_1_VARIABLES.ANGLE"),
        at("JOINT_2_VARIABLES.DISTANCE"),
    );
    for k in 1..run.rows() {
        // φ̇ F1 + ẋ F2 = 0 where −½ φ + x stays constant
        assert!((0.5 * sliding[k] + turning[k]).abs() < 1e-9 * sliding[k].abs());
        let moved = [angle[k] - angle[0], distance[k] - distance[0]];
        assert!(
            (0.5 * moved[0].to_radians() - moved[1]).abs() < 1e-9,
            "{moved:?}"
        );
        // M ẍ = 12 + F2
        let pull = 3.0 * at("PART_3_XFORM.ACCX")[k];
        assert!(
            (pull - 12.0 - sliding[k]).abs() < 1e-8,
            "{pull} {}",
            sliding[k]
        );
    }
}

#[test]
fn the_motion_of_a_body_is_the_change_of_its_centre_of_mass_in_ground_axes() {
    let options = Options {
        body_rates: true,
        ..all_sets()
    };
    let run = simulated(LIFT, options, 1.0);
    let at = |name: &str| run.column(name).unwrap_or_else(|| panic!("{name}"));
    let last = run.rows() - 1;
    let angle = at("JOINT_1_VARIABLES.ANGLE");
    let turned = (angle[last] - angle[0]).to_radians();
    let (sin, cos) = turned.sin_cos();
    // the centre of mass begins at (1.5, 2)
    let moved = [1.5 * cos - 2.0 * sin - 1.5, 1.5 * sin + 2.0 * cos - 2.0];
    let expected = [
        ("DISPLACEMENT.X", moved[0]),
        ("DISPLACEMENT.Y", moved[1]),
        ("DISPLACEMENT.MAG", moved[0].hypot(moved[1])),
        ("DISPLACEMENT.RZ", turned),
        ("DISPLACEMENT.RMAG", turned.abs()),
        ("VELOCITY.VM", 2.5 * at("PART_2_XFORM.WZ")[last].abs()),
        ("VELOCITY.WM", at("PART_2_XFORM.WZ")[last].abs()),
        ("ACCELERATION.WDTZ", at("PART_2_XFORM.WDZ")[last]),
    ];
    for (name, expected) in expected {
        let found = at(&format!("PART_2_{name}"));
        assert!(
            (found[last] - expected).abs() < 1e-8,
            "{name}: {} {expected}",
            found[last]
        );
    }
    assert_eq!(at("PART_2_DISPLACEMENT.MAG")[0], 0.0);
}

#[test]
fn tables_show_the_elements_that_somebody_has_chosen_beside_requests() {
    let shown = |options: Options| -> Vec<String> {
        let run = simulated(LIFT, options, 0.1);
        let columns = run.table_columns().into_iter();
        columns.map(|c| run.columns[c].name.clone()).collect()
    };
    let requests = shown(all_sets());
    assert!(
        requests
            .iter()
            .all(|name| name == "time" || name.contains("REQUEST_"))
    );
    let only = |what: &str| Options {
        only: vec![what.parse().unwrap()],
        ..all_sets()
    };
    let joint = shown(only("JOINT/1"));
    assert_eq!(joint[..requests.len()], requests);
    assert!(
        joint.contains(&"JOINT_1.FX".into()) && joint.contains(&"JOINT_1_VARIABLES.ANGLE".into())
    );
    assert!(
        !joint
            .iter()
            .any(|name| name.starts_with("PART_") || name.starts_with("JOINT_2"))
    );
    // positions that an animation needs are recorded, not shown
    let frames = Options {
        frames: true,
        ..only("1-JOINT1")
    };
    assert_eq!(shown(frames), joint);
    let part = shown(only("PART/2"));
    assert!(part.contains(&"PART_2_XFORM.X".into()) && !part.contains(&"PART_3_XFORM.X".into()));
    let bodies = shown(Options {
        body_rates: true,
        ..all_sets()
    });
    assert!(
        bodies.contains(&"PART_3_VELOCITY.VM".into()) && !bodies.contains(&"JOINT_1.FX".into())
    );
}

#[test]
fn elements_are_chosen_by_their_names_and_unknown_ones_are_told_before_a_file_is_touched() {
    let folder = scratch("chosen_by_name", "note", "").with_file_name("out");
    let model = "examples/slider_crank.acf";
    let run = |only: &str, folder: &str| {
        let said = ["run", model, "--quiet", "--only", only, "--out", folder];
        cognate(&said)
    };
    let table = |what: &str| {
        let inner = folder.join(what.replace('/', "_"));
        let done = run(what, path(&inner));
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read(inner.join("slider_crank.csv")).unwrap()
    };
    let by_number = table("JOINT/1");
    assert_eq!(table("crank_bearing"), by_number);
    assert_eq!(table("1-JOINT1"), by_number);
    for (only, said) in [
        ("crank_bering", "did you mean crank_bearing"),
        ("JOINT/99", "JOINT/99 does not exist"),
    ] {
        let told = run(only, path(&folder));
        assert_eq!(told.code, 3, "{}", told.err);
        assert!(told.err.contains(said), "{}", told.err);
        assert!(!folder.join("slider_crank.csv").exists());
    }
    // a session of a program says the same
    let options = Options {
        only: vec!["JOINT/99".parse().unwrap()],
        ..all_sets()
    };
    let mut session = Session::new(Model::from_text(LIFT).unwrap(), "test", options);
    let refused = session.simulate(Analysis::Transient, 0.1, 1, &mut Unwatched);
    assert!(refused.unwrap_err().to_string().contains("JOINT/99"));
}

#[test]
fn many_requests_are_the_requests_of_their_elements() {
    let run = simulated(LIFT, all_sets(), 1.0);
    let same = |a: &str, b: &str| {
        let [a, b] = [a, b].map(|name| run.column(name).unwrap_or_else(|| panic!("{name}")));
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12));
    };
    // no two have one number in a .req file
    let mut numbers: Vec<u32> = run.requests.iter().map(|r| r.id).collect();
    numbers.sort_unstable();
    assert!(numbers.windows(2).all(|n| n[0] < n[1]), "{numbers:?}");
    same("MREQUEST_1.PART_2.DX", "REQUEST_3.DX");
    same("MREQUEST_1.PART_3.DX", "PART_3_XFORM.X");
    same("MREQUEST_2.JOINT_2.FY", "JOINT_2.FY");
    same("MREQUEST_2.SFORCE_1.FX", "SFORCE_1.FX");
    assert!(
        run.column("MREQUEST_1.PART_1.DX").is_none(),
        "ground does not move"
    );
}

#[test]
fn what_results_leave_out_and_what_is_switched_off_has_no_columns() {
    let names = |text: &str, options: Options| -> Vec<String> {
        let run = simulated(text, options, 0.1);
        run.columns.into_iter().map(|c| c.name).collect()
    };
    let every = names(LIFT, all_sets());
    for (word, gone) in [
        ("NODISPLACEMENTS", "PART_2_XFORM.X"),
        ("NODISPLACEMENTS", "JOINT_1_VARIABLES.ANGLE"),
        ("NOVELOCITIES", "PART_2_XFORM.VX"),
        ("NOACCEL", "PART_2_XFORM.ACCX"),
        ("NOREACTIONFORCES", "JOINT_1.FX"),
        ("NOAPPLIEDFORCES", "SFORCE_1.FX"),
        ("NOREQUESTS", "REQUEST_3.DX"),
    ] {
        assert!(every.iter().any(|name| name == gone), "{gone}");
        let left = names(&LIFT.replace("XRF", &format!("XRF, {word}")), all_sets());
        assert!(!left.iter().any(|name| name == gone), "{word}: {gone}");
        assert!(left.iter().any(|name| name == "ENERGY.KINETIC"), "{word}");
    }
    let only = Options {
        only: vec!["JOINT/2".parse().unwrap(), "SFORCE".parse().unwrap()],
        ..all_sets()
    };
    let left = names(LIFT, only);
    assert!(
        left.iter().any(|name| name == "JOINT_2.FX")
            && left.iter().any(|name| name == "SFORCE_1.FX")
    );
    assert!(
        !left
            .iter()
            .any(|name| name.starts_with("JOINT_1") || name.starts_with("PART_"))
    );
    assert!(
        "MARKER"
            .parse::<Chosen>()
            .unwrap_err()
            .contains("cognate motion")
    );
}

#[test]
fn a_request_that_commands_switch_off_has_no_column_or_no_value_from_there_on() {
    let commands = |first: &str, then: &str| {
        let text = format!(
            "{first}SIMULATE/DYNAMIC, END=0.1, STEPS=2\n{then}SIMULATE/DYNAMIC, END=0.2, STEPS=2\nSTOP\n"
        );
        let mut session = Session::new(Model::from_text(LIFT).unwrap(), "test", all_sets());
        let script = Script::from_text(&text).unwrap();
        obey(&mut session, &script.steps, |_, _| (), &mut Unwatched).unwrap();
        session.run
    };
    let off = "DEACTIVATE/REQUEST, ID=3\n";
    assert!(commands(off, "").column("REQUEST_3.DX").is_none());
    let run = commands("", off);
    let values = run.column("REQUEST_3.DX").unwrap();
    assert!(
        values[1].is_finite() && values[values.len() - 1].is_nan(),
        "{values:?}"
    );
}

#[test]
fn output_asks_for_its_files_and_they_hold_the_run() {
    let text = LIFT.replace("RESULTS/XRF", "OUTPUT/REQSAVE, GRSAVE, YPR");
    let model = scratch("recorded_files", "lift.adm", &text);
    let out = model.with_file_name("results");
    let done = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "4",
        "--out",
        path(&out),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let csv = results::read(&out.join("lift.csv")).unwrap();
    let gra = results::read(&out.join("lift.gra")).unwrap();
    assert!(csv.column("REQUEST_3.YAW").is_some() && csv.column("PART_2_XFORM.X").is_none());
    let (x, x_gra) = (
        csv.column("MREQUEST_1.PART_3.DX").unwrap(),
        gra.column("PART_3_XFORM.X").unwrap(),
    );
    // the model as it was read comes first
    assert_eq!(gra.sequences[0].kind, Kind::Input);
    assert_eq!(x.len() + 1, x_gra.len());
    assert!(
        x.iter()
            .zip(&x_gra[1..])
            .all(|(a, b)| (a - b).abs() < 1e-5 * (1.0 + a.abs()))
    );
    let req = std::fs::read_to_string(out.join("lift.req")).unwrap();
    let n_requests = 5;
    assert_eq!(
        req.lines().count(),
        3 + n_requests + x.len() * (1 + n_requests),
        "{req}"
    );
    assert!(!out.join("lift.res").exists());
}

#[test]
fn what_is_doubted_in_a_dataset_stands_in_the_record_and_the_log_with_its_place() {
    let dataset = "soft at the touch\nUNITS/SYSTEM=MKS\nPART/1, GROUND\nMARKER/1, PART=1\n\
        ! adams_view_name='ball'\nPART/2, MASS=1, CM=20, IP=0.1,0.1,0.1, QG=0,0,1.5\nMARKER/20, PART=2\n\
        MARKER/3, PART=1, QP=-1,-1,-1\nACCGRAV/KGRAV=-9.81\nGRAPHICS/1, BOX, CORNER=3, X=2, Y=2, Z=1\n\
        GRAPHICS/2, ELLIPSOID, CM=20, XSCALE=0.5, YSCALE=0.5, ZSCALE=0.5\n\
        CONTACT/7, IGEOM=2, JGEOM=1, STIFFNESS=1E4, EXPONENT=0.5, DAMPING=1, DMAX=0.1\n\
        REQUEST/1, DISPLACEMENT, I=20, J=1\nEND\n";
    let model = scratch("doubts", "ball.adm", dataset);
    let out = model.with_file_name("results");
    let asked = ["run", path(&model), "--end", "2", "--out", path(&out)];
    let done = cognate(&[&asked[..], &["--quiet"]].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let record = std::fs::read_to_string(out.join("ball.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let findings = record["findings"].as_array().unwrap();
    let told = |code: &str| findings.iter().find(|f| f["code"] == code);
    let exponent = told("unlikely_magnitude").unwrap_or_else(|| panic!("{findings:?}"));
    assert_eq!(
        (&exponent["element"], &exponent["line"]),
        (&"CONTACT/7".into(), &12.into())
    );
    // the sentences of the run's own warnings are there, too, in the same form
    let sentences = record["warnings"].as_array().unwrap();
    assert_eq!(findings.len(), 1 + sentences.len(), "{findings:?}");
    if let Some(rounding) = told("below_rounding") {
        // the few steps at the touch are no matter of the request
        let sentence = rounding["message"].as_str().unwrap();
        assert!(!sentence.contains("below rounding"), "{sentence}");
    }
    let log = std::fs::read_to_string(out.join("ball.msg")).unwrap();
    assert!(
        log.contains("CONTACT/7: warning[unlikely_magnitude]"),
        "{log}"
    );
}

/// A model of pendulums, joints, motions, springs and requests whose names are drawn from a few, so that many clash.
fn clashing(seed: u64) -> String {
    const NAMES: [&str; 10] = [
        "rod",
        "Rod",
        "rod_2",
        "rod_2_2",
        "JOINT_1",
        "a.b",
        "a",
        "PART_3_XFORM",
        "ENERGY",
        "über x",
    ];
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(99);
    let mut name = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let k = (state >> 33) as usize % (NAMES.len() + 2);
        let name = NAMES.get(k);
        name.map_or_else(String::new, |name| format!("!  adams_view_name='{name}'\n"))
    };
    let mut text =
        "clashing names\nACCGRAV/JGRAV=-9.81\nPART/1, GROUND\nMARKER/1, PART=1\nRESULTS/XRF\n"
            .to_owned();
    for n in 2..7 {
        text += &format!(
            "{}PART/{n}, MASS=1, CM={n}0, IP=1,1,1\nMARKER/{n}0, PART={n}, QP=1,0,0\nMARKER/{n}1, PART={n}\n",
            name()
        );
        text += &format!("{}JOINT/{n}, REVOLUTE, I={n}1, J=1\n", name());
    }
    text += &format!("{}MOTION/1, JOINT=2, ROTATION, FUNCTION=TIME\n", name());
    text += &format!("{}SPRINGDAMPER/1, ROTATION, I=31, J=1, KT=1\n", name());
    text += &format!("{}VARIABLE/7, FUNCTION=TIME\n", name());
    for n in 1..4 {
        text += &format!(
            "{}REQUEST/{n}, F2=DX({}0)\\F3=DY({}0)\\CNAMES=\"\",\"X\",\"X\"\n",
            name(),
            n + 1,
            n + 1
        );
    }
    text += "REQUEST/9, F2=TIME, RESULTS_NAME=rod\nMREQUEST/1, FORCE, JOINTS=2\nEND\n";
    text
}

#[test]
fn no_column_and_no_set_ever_has_the_name_of_another_and_all_are_read_back() {
    let folder = scratch("clashing", "note", "");
    let mut n_numbered = 0;
    for seed in 0..24 {
        let reading = cognate::dataset::read_text(&clashing(seed));
        assert!(
            !reading.failed(),
            "{:?}\n{}",
            reading.diagnostics,
            clashing(seed)
        );
        let told = reading
            .diagnostics
            .iter()
            .filter(|d| d.code == "name_twice")
            .count();
        let options = Options {
            body_rates: true,
            columns: vec!["rod.VX".into(), "2*TIME".into(), "2*TIME".into()],
            ..all_sets()
        };
        let mut session = Session::new(reading.model.clone(), "test", options);
        // that of several parts is a mistake
        let is_one = cognate::analysis::session::check_column(&reading.model, "rod.VX").is_empty();
        if !is_one {
            session = Session::new(
                reading.model.clone(),
                "test",
                Options {
                    body_rates: true,
                    ..all_sets()
                },
            );
        }
        session
            .simulate(Analysis::Transient, 0.1, 2, &mut Unwatched)
            .unwrap();
        let run = session.run;
        let unique = |names: &[&str]| names.iter().collect::<BTreeSet<_>>().len() == names.len();
        let names: Vec<&str> = run.columns.iter().map(|c| c.name.as_str()).collect();
        let sets: Vec<&str> = run.entities.iter().map(|e| e.name.as_str()).collect();
        assert!(
            unique(&names) && unique(&sets),
            "{seed}: {names:?} {sets:?}"
        );
        for set in &run.entities {
            let components: Vec<&str> = set.components.iter().map(|c| c.name.as_str()).collect();
            assert!(unique(&components), "{}: {components:?}", set.name);
        }
        n_numbered += usize::from(told > 0);
        // each part is found by the name that its set has
        for (id, _) in reading.model.bodies().filter(|(_, p)| !p.ground) {
            let label = reading.model.labels().name(&reading.model, id);
            let found = reading.model.find_of(&[ElementKind::Part], &label);
            let is_ambiguous = || found.as_ref().unwrap_err().to_string().contains("several");
            assert!(found == Ok(id) || is_ambiguous(), "{label}: {found:?}");
            assert!(
                names.contains(&&*format!("{label}_XFORM.X")),
                "{label}: {names:?}"
            );
        }
        let mut shown = run.clone();
        shown.table = Vec::new();
        for format in results::format::Format::names(true) {
            let file = folder.with_file_name(format!("{seed}.{format}"));
            results::write(
                &shown,
                &file,
                results::format::Style {
                    units: true,
                    decimal_comma: false,
                },
            )
            .unwrap();
            let back = results::read(&file).unwrap_or_else(|d| panic!("{format}: {d}"));
            let read: Vec<&str> = back.columns.iter().map(|c| c.name.as_str()).collect();
            assert!(unique(&read), "{format}: {read:?}");
            if !["gra", "req"].contains(&format) {
                assert_eq!(read, names, "{format}");
            }
            if format == "res" {
                let read: Vec<&str> = back.entities.iter().map(|e| e.name.as_str()).collect();
                assert_eq!(read, sets);
            }
        }
    }
    assert!(n_numbered > 12, "{n_numbered}");
}

#[test]
fn a_run_that_is_asked_for_nothing_has_every_body_and_joint() {
    let text = LIFT.replace("RESULTS/XRF\n", "");
    let model = Model::from_text(&text).unwrap();
    let without_requests = Model {
        requests: Default::default(),
        many_requests: Default::default(),
        ..model
    };
    let columns = |options: Options, more: &[&str]| -> Vec<String> {
        let mut session = Session::new(without_requests.clone(), "test", options);
        for column in more {
            session.add_column(column).unwrap();
        }
        session
            .simulate(Analysis::Transient, 0.1, 2, &mut Unwatched)
            .unwrap();
        let run = &session.run;
        run.table_columns()
            .iter()
            .map(|&c| run.columns[c].name.clone())
            .collect()
    };
    let everything = columns(Options::default(), &[]);
    assert_eq!(
        everything,
        columns(
            Options {
                full: true,
                ..Options::default()
            },
            &[]
        )
    );
    for (id, body) in without_requests.bodies() {
        let set = format!(
            "{}_XFORM.X",
            without_requests.labels().name(&without_requests, id)
        );
        assert!(
            body.ground || everything.contains(&set),
            "{set}: {everything:?}"
        );
    }
    for number in without_requests.joints.keys() {
        let id = ElementKind::Joint.id(*number);
        let set = format!(
            "{}.FX",
            without_requests.labels().name(&without_requests, id)
        );
        assert!(everything.contains(&set), "{set}");
    }
    // who names columns has these alone, and who wants none has none
    assert_eq!(columns(Options::default(), &["TIME*2"]), ["time", "TIME*2"]);
    let part = &everything[1];
    assert_eq!(
        columns(Options::default(), &[part]),
        ["time", part.as_str()]
    );
    let options = Options {
        named_only: true,
        ..Options::default()
    };
    assert_eq!(columns(options, &[]), ["time"]);
}
