//! SAVE and RELOAD: a run goes on from a saved state as if nothing had happened, to the last bit; what is no such state is refused.

use crate::running;

use cognate::analysis::session::state::{Saved, file_name};
use cognate::dataset::command::Script;
use cognate::model::{ElementKind, Model};
use running::{Analysis, Session, begin, mistakes_of, obeys, options, whole};

/// A pendulum with everything that is carried from one simulation to the next: turns, states, sensors, samples and a past.
const MODEL: &str = "everything that is carried
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=2, CM=20, IP=0.1,0.1,0.1
MARKER/20, PART=2, QP=1,0,0
MARKER/21, PART=2
JOINT/1, REVOLUTE, I=21, J=1, IC=0.3,5
JOINT/2, REVOLUTE, I=21, J=1
ACCGRAV/JGRAV=-9.81
DIFF/1, IC=1, FUNCTION=-DIF(1)+AZ(21,1)
VARIABLE/1, FUNCTION=AZ(21,1)
VARIABLE/2, FUNCTION=DELAY(VARVAL(1), 0.13, 0)
SENSOR/1, FUNCTION=AZ(21,1)\\, VALUE=0.5, GE, EVALUATE=TIME
ARRAY/1, U, VARIABLES=1
ARRAY/2, X
GSE/1, NO=0, U=1, ND=1, XD=2, SAMPLE_PERIOD=0.07, FUNCTION=USER(1)
SFORCE/1, ROTATION, I=21, J=1, FUNCTION=-0.2*VARVAL(2)-0.1*ARYVAL(2,1)+SENVAL(1)
REQUEST/1, DISPLACEMENT, I=20, J=1
END
";

const COLUMNS: [&str; 5] = ["AZ(21,1)", "WZ(21,1)", "DIF(1)", "ARYVAL(2,1)", "VARVAL(2)"];

fn session(model: Model) -> Session {
    let mut s = begin(model, "saved", options(&COLUMNS, 1e-7));
    s.register("1", &[], |call, out| {
        let [u, d] = call.values else { return };
        out[0] = 0.5 * d + u;
    });
    s
}

fn go(s: &mut Session, end: f64) {
    running::go(s, Analysis::Dynamic, end, 5);
}

fn last(s: &Session) -> [u64; 5] {
    COLUMNS.map(|c| s.run.column(c).unwrap().last().unwrap().to_bits())
}

#[test]
fn a_run_goes_on_from_a_saved_state_to_the_last_bit() {
    let mut all = session(whole(MODEL));
    go(&mut all, 0.5);
    all.model.inactive.insert(ElementKind::Joint.id(2));
    let text = all.save();
    go(&mut all, 1.5);
    let saved = Saved::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let mut other = session(whole("nothing\nPART/1, GROUND\nMARKER/1, PART=1\nEND\n"));
    other.reload(saved).unwrap();
    assert_eq!(other.time(), 0.5);
    assert_eq!(other.save(), text, "a state is saved as it was read");
    go(&mut other, 1.5);
    assert_eq!(last(&other), last(&all));
    assert!(
        other.run.column("REQUEST_1.MAG").is_some(),
        "its requests come with it"
    );
}

#[test]
fn commands_save_and_go_back() {
    let mut s = session(whole(MODEL));
    let script = "\nsim/dyn, end=0.4, steps=4\nsave/system=here\nsim/dyn, end=0.8, steps=4\nreload/system=here\n\
        sim/dyn, end=0.8, steps=4\nstop\n";
    let script = Script::from_text(script).unwrap();
    obeys(&mut s, &script);
    let time = s.run.column("TIME").unwrap();
    let ends: Vec<usize> = (0..time.len()).filter(|&k| time[k] == 0.8).collect();
    assert_eq!(ends.len(), 2);
    for c in COLUMNS {
        let column = s.run.column(c).unwrap();
        assert_eq!(column[ends[0]].to_bits(), column[ends[1]].to_bits(), "{c}");
    }
    assert!(s.saved.contains_key("here.state.json"));
}

#[test]
fn a_state_is_found_in_the_folders_of_the_run() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("saved");
    std::fs::create_dir_all(&folder).unwrap();
    let mut s = session(whole(MODEL));
    go(&mut s, 0.2);
    std::fs::write(folder.join(file_name("a")), s.save()).unwrap();
    std::fs::write(folder.join("adams.sav"), [0u8, 159, 3, 255, 10]).unwrap();
    let mut other = session(whole(MODEL));
    other.folders = vec![folder];
    let script = |text: &str| Script::from_text(text).unwrap();
    obeys(&mut other, &script("\nreload/system=a\n"));
    assert_eq!(other.time(), 0.2);
    let errors = mistakes_of(&mut other, &script("\nreload/system=adams.sav\n"));
    assert_eq!(errors[0].code, "not_a_state");
    assert!(
        errors[0].help.iter().any(|h| h.contains("Adams")),
        "{errors:?}"
    );
    let errors = mistakes_of(&mut other, &script("\nreload/system=nowhere\n"));
    assert_eq!(errors[0].code, "cannot_open");
    let refused = Script::from_text("\nsave\n").unwrap_err();
    assert_eq!(refused.first().code, "missing_argument");
}

#[test]
fn damaged_states_are_refused() {
    let mut s = session(whole(MODEL));
    go(&mut s, 0.2);
    let text = s.save();
    for (from, to) in [
        ("\"cognate_state\": 1", "\"cognate_state\": 2"),
        ("\"cognate_state\"", "\"other\""),
        ("\"at_rest\": false", "\"at_rest\": 3"),
        ("\"time\": \"0.2\"", "\"time\": \"soon\""),
        ("GROUND", "GRND"),
    ] {
        assert!(text.contains(from), "{from}");
        assert!(
            Saved::read(text.replacen(from, to, 1).as_bytes()).is_err(),
            "{from}"
        );
    }
    for bytes in [&b""[..], b"{}", b"[1,2", b"\xff\xfe"] {
        assert!(Saved::read(bytes).is_err());
    }
}

/// Two joints turned by MOTIONs that give accelerations, each with a velocity of its own at the start.
const ACCELERATED: &str = "two accelerations
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
JOINT/1, REVOLUTE, I=20, J=1
MOTION/1, JOINT=1, ROTATION, ACCELERATION, ICDISP=0.1, ICVEL=1, FUNCTION=2
PART/3, MASS=1, CM=30, IP=1,1,1
MARKER/30, PART=3
JOINT/2, REVOLUTE, I=30, J=1
MOTION/2, JOINT=2, ROTATION, ACCELERATION, ICDISP=0.2, ICVEL=-3, FUNCTION=0.5
VARIABLE/1, FUNCTION=0
END
";

#[test]
fn each_acceleration_motion_goes_on_with_its_own_velocity() {
    let columns = ["AZ(20,1)", "WZ(20,1)", "AZ(30,1)", "WZ(30,1)"];
    let new = || {
        begin(
            whole(ACCELERATED),
            "two accelerations",
            options(&columns, 1e-9),
        )
    };
    let arrived = |mut s: Session| {
        go(&mut s, 1.0);
        columns.map(|c| *s.run.column(c).unwrap().last().unwrap())
    };
    let at_once = arrived(new());
    for (found, exact) in at_once.iter().zip([2.1, 3.0, -2.55, -2.5]) {
        assert!((found - exact).abs() < 1e-6, "{at_once:?}");
    }
    // a change of the model between two simulations, then a state that is saved and read
    let mut changed = new();
    go(&mut changed, 0.5);
    let text = changed.save();
    changed.model.inactive.insert(ElementKind::Variable.id(1));
    // the form of before, which did not name the velocities
    let unnamed = text
        .replace("\"MOTION/1 velocity\"", "\"\"")
        .replace("\"MOTION/2 velocity\"", "\"\"");
    assert_ne!(unnamed, text);
    let reloaded = |text: &str| {
        let mut other = new();
        let saved = Saved::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
        other.reload(saved).unwrap();
        other
    };
    for (way, s) in [
        ("changed", changed),
        ("saved", reloaded(&text)),
        ("saved before", reloaded(&unnamed)),
    ] {
        let in_two = arrived(s);
        for (one, two) in at_once.iter().zip(in_two) {
            assert!((one - two).abs() < 1e-6, "{way}: {at_once:?} {in_two:?}");
        }
    }
}

/// Methods of one step leave their step, RADAU5 its Jacobian too, to a simulation that goes on;
/// several states between are as good as none.
#[test]
fn what_a_method_leaves_is_saved_with_the_state() {
    let model = "what a method leaves\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=2, CM=20, IP=0.1,0.1,0.1\nMARKER/20, PART=2, QP=1,0,0\n\
        MARKER/21, PART=2\nJOINT/1, REVOLUTE, I=21, J=1, IC=0.3,5\nACCGRAV/JGRAV=-9.81\nDIFF/1, IC=1, FUNCTION=2E3*(AZ(21,1)-DIF(1))\n\
        SFORCE/1, ROTATION, I=21, J=1, FUNCTION=-300*DIF(1)-IMPACT(AZ(21,1),WZ(21,1),0.1,1E3,1.5,1,0.1)\nEND\n";
    for method in ["RADAU5", "DOP853", "AUTO"] {
        let with = |text: &str| {
            let mut options = options(&["AZ(21,1)", "WZ(21,1)", "DIF(1)"], 1e-6);
            options.method = Some(method.into());
            begin(whole(text), "saved", options)
        };
        let mut all = with(model);
        let mut other = with(model);
        for k in 1..=8 {
            let end = 0.05 * f64::from(k);
            go(&mut all, end);
            go(&mut other, end);
            let bits = |s: &Session| {
                ["AZ(21,1)", "WZ(21,1)", "DIF(1)"]
                    .map(|c| s.run.column(c).unwrap().last().unwrap().to_bits())
            };
            assert_eq!(bits(&other), bits(&all), "{method} at {end}");
            let text = other.save();
            let saved = Saved::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
            other = with(model);
            other.reload(saved).unwrap();
            assert_eq!(
                other.save(),
                text,
                "{method}: a state is saved as it was read"
            );
        }
    }
}
