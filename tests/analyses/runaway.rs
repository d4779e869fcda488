//! Motions that grow without bound: a run whose steps get ever shorter thereby ends with the reason
//! and the force that feeds it, whatever the method.

use crate::running::{Analysis, Options, Session, begin, model};
use cognate::analysis::watch::Unwatched;
use cognate::results::Status;

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];
/// Those by which models of several freedoms are run.
const FEW: [&str; 1] = ["AUTO"];

/// Attempted steps in which such a run must have ended: seconds.
const MOST_STEPS: u64 = 600_000;

fn run(text: &str, method: &str, end: f64) -> Session {
    let options = Options {
        method: Some(method.to_string()),
        columns: vec!["TIME".into()],
        // an assertion that fails, and not a test without end
        max_steps: Some(3 * MOST_STEPS as usize),
        ..Options::default()
    };
    let mut session = begin(model(text), "runaway", options);
    (session.simulate(Analysis::Dynamic, end, 100, &mut Unwatched)).expect("a run");
    session
}

/// Models whose motion is fed by a damper of the wrong sign, with the name of that damper.
fn fed() -> Vec<(&'static str, &'static str, String)> {
    let pendulum = "ACCGRAV/JGRAV=-9.81\nPART/2, MASS=1, CM=2, IP=1,1,1\n\
        MARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\n";
    let crane = "ACCGRAV/KGRAV=-9.81\nPART/2, MASS=120, CM=20, IP=2,80,80\n\
        MARKER/20, PART=2, QP=0.7,0,0\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=1.5,0,0\n\
        PART/3, QG=1.5,0,-0.8, MASS=50, CM=30, IP=0.4,0.4,0.3\nMARKER/30, PART=3\n\
        MARKER/31, PART=3, QP=0,0,0.8, REULER=0,90D,0\nMARKER/32, PART=3, QP=0,0,0.8\n\
        JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, SPHERICAL, I=32, J=22\n\
        MOTION/1, ROTATION, JOINT=1, FUNCTION=STEP(TIME,0,0,2,60D)\n";
    let free = "PART/2, MASS=1, CM=2, IP=1,2,3, WX=0.1, WY=0.2, WZ=1\nMARKER/2, PART=2\n\
        MARKER/9, PART=1, FLOATING\n";
    let walls = "PART/2, MASS=1, CM=2, IP=1,1,1, VX=1\nMARKER/2, PART=2\n\
        JOINT/1, TRANSLATIONAL, I=3, J=4\nMARKER/3, PART=2, REULER=90D,90D,0\n\
        MARKER/4, PART=1, REULER=90D,90D,0\n\
        SFORCE/2, TRANSLATION, I=2, J=1, ACTIONONLY, FUNCTION=BISTOP(DX(2,1),VX(2,1),-1,1,1E5,1.5,0,0.1)\n";
    vec![
        (
            "a pendulum",
            "SFORCE/1",
            format!("{pendulum}SFORCE/1, ROTATION, I=3, J=1, FUNCTION=5*WZ(3,1)\n"),
        ),
        (
            "a load on a hook",
            "SFORCE/1",
            format!("{crane}SFORCE/1, ROTATION, I=31, J=22, FUNCTION=2*WZ(31,22,22)\n"),
        ),
        (
            "a body that tumbles",
            "VTORQUE/1",
            format!(
                "{free}VTORQUE/1, I=2, JFLOAT=9, RM=1, TX=8*WX(2,1)\\TY=8*WY(2,1)\\TZ=8*WZ(2,1)\n"
            ),
        ),
        (
            "a ball between walls",
            "SFORCE/3",
            format!("{walls}SFORCE/3, TRANSLATION, I=3, J=4, FUNCTION=3*VZ(3,4,4)\n"),
        ),
        (
            "a pendulum whose spring is far stiffer than its damper is strong",
            "SFORCE/1",
            format!(
                "{pendulum}SFORCE/1, ROTATION, I=3, J=1, FUNCTION=3*WZ(3,1)\n\
                SFORCE/2, ROTATION, I=3, J=1, FUNCTION=-500*AZ(3,1)\n"
            ),
        ),
    ]
}

#[test]
fn a_motion_that_runs_away_ends_and_its_feeder_is_named_by_every_method() {
    for (what, damper, text) in fed() {
        let methods: &[&str] = match what {
            "a pendulum" | "a ball between walls" => &METHODS,
            _ => &FEW,
        };
        for method in methods {
            let session = run(&text, method, 40.0);
            let record = &session.run.record;
            let simulation = record.simulations.last().expect("a simulation");
            let c = &simulation.counts;
            let name = format!(
                "{what} by {method}: {:?} at {} after {} steps: {}",
                record.status, simulation.end, c.steps, record.stop_reason
            );
            println!("{name}");
            assert!(c.steps + c.rejected_steps < MOST_STEPS, "{name}");
            // where steps do not get shorter it goes on to its end, with a warning
            let told = record.warnings.iter().filter(|w| w.code == "energy_grows");
            let told = told.filter_map(|w| w.subject.as_ref().map(|s| s.element.clone()));
            let (named, fed_by): (_, Vec<String>) = match record.status {
                Status::Completed => ("energy_grows", told.collect()),
                _ => (record.stop_code, simulation.worst.clone()),
            };
            assert_eq!(named, "energy_grows", "{name}");
            assert_eq!(fed_by, [damper], "{name}");
        }
    }
}

#[test]
fn what_is_driven_for_long_goes_on_however_far_its_end() {
    // a rotor that a torque turns ever faster: hundreds of millions of steps would be left
    const MOST: usize = 100_000;
    let rotor = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
        JOINT/1, REVOLUTE, I=2, J=1\nSFORCE/1, ROTATION, I=2, J=1, FUNCTION=1+SIN(AZ(2,1))\n";
    let options = Options {
        method: Some("DOP853".into()),
        columns: vec!["TIME".into()],
        max_steps: Some(MOST),
        ..Options::default()
    };
    let mut session = begin(model(rotor), "rotor", options);
    (session.simulate(Analysis::Dynamic, 1e6, 100, &mut Unwatched)).expect("a run");
    let record = &session.run.record;
    assert_eq!(record.stop_code, "too_many_steps", "{}", record.stop_reason);
}
