//! The number of outputs changes nothing but the number of rows: the same steps, and the same bits at times that all runs have, with every method.

use crate::running;
use cognate::results::Run;
use running::{Analysis, Options, begin, try_to, whole};

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];
/// Powers of two, so that the same times have the same bits.
const OUTPUTS: [usize; 3] = [8, 64, 1024];

const SLIDER: &str = "PART/2, MASS=1, CM=20, VX=1\nMARKER/20, PART=2, REULER=90D,90D,0\n\
                      MARKER/11, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=20, J=11\n";

fn with_ground(statements: &str) -> String {
    format!("{}{statements}END\n", running::GROUND)
}

/// The slider under a force.
fn pushed(function: &str) -> String {
    with_ground(&format!(
        "{SLIDER}SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION={function}\n"
    ))
}

/// A rotor whose friction reads the reaction of its own bearing, which gravity and speed load: an algebraic loop.
fn loaded_by_itself() -> String {
    with_ground(
        "ACCGRAV/JGRAV=-9.81\nPART/2, MASS=2, CM=20, IP=0.1,0.1,0.2, WZ=9\nMARKER/20, PART=2, QP=0.3,0,0\nMARKER/21, PART=2\n\
         JOINT/1, REVOLUTE, I=21, J=1\n\
         SFORCE/1, ROTATION, I=21, J=1, FUNCTION=-0.02*TANH(WZ(21,1)/0.01)*(1+FM(21,1)+TM(21,1))\n",
    )
}

/// Models that have all that steps and outputs share: stiff modes, switches, sliding, loops, closures, a past, turns, rows.
fn models() -> Vec<(String, String, f64)> {
    let mut all = vec![
        (
            "a stiff force",
            pushed("-1E4*DX(20,11)-2E4*VX(20,11)+1E4*SIN(3*TIME)"),
            0.5,
        ),
        (
            "friction by SIGN",
            pushed("-2*SIGN(1,VX(20,11))+3*SIN(4*TIME)"),
            2.0,
        ),
        (
            "a stop",
            pushed("-10+MAX(0,1E4*(0.1-DX(20,11))-5*VX(20,11))"),
            1.0,
        ),
        ("a delay", pushed("-4*DELAY(DX(20,11),0.3,0)"), 2.0),
        ("turns", pushed("-SIN(DX(20,11))*AZ(20,11)-DX(20,11)"), 2.0),
        ("a loop", loaded_by_itself(), 1.0),
        (
            "filters of friction that holds",
            with_ground(&format!(
                "{SLIDER}SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-2*SIGN(1,VX(20,11))+3*SIN(4*TIME)\n\
                 DIFF/1, IC=0, FUNCTION=1E4*(ACCX(20)-DIF(1))\nDIFF/2, IC=0, FUNCTION=DIF(1)+SFORCE(1,0,2,0)\n"
            )),
            2.0,
        ),
    ]
    .into_iter()
    .map(|(name, text, end)| (name.to_string(), text, end))
    .collect::<Vec<_>>();
    for (name, end) in [
        ("a02_nfourbar_2", 2.0),
        ("bistop_slot", 0.5),
        ("bounce_k1e6", 1.0),
        ("dzhanibekov", 2.0),
        ("rack_pinion", 1.0),
        ("settle_sphere", 0.5),
        ("stiff_bushing", 0.5),
    ] {
        let file = format!(
            "{}/tests/data/references/{name}.adm",
            env!("CARGO_MANIFEST_DIR")
        );
        let text = std::fs::read_to_string(&file).expect("it is there");
        all.push((name.to_string(), text, end));
    }
    all
}

/// Bits of all columns at the rows of the first number of outputs, for a run that has `every` times as many; and at the last row, which is
/// where a run stops that does not arrive.
fn bits(run: &Run, every: usize) -> Vec<(String, Vec<u64>)> {
    let shared = |values: &[f64]| {
        let (last, before) = values.split_last().expect("rows");
        let shared = before.iter().step_by(every).chain([last]);
        shared.map(|x| x.to_bits()).collect()
    };
    let columns = run.columns.iter();
    columns
        .map(|c| (c.name.clone(), shared(&c.values)))
        .collect()
}

#[test]
fn steps_and_values_do_not_depend_on_the_number_of_outputs() {
    let mut wrong = Vec::new();
    for (name, text, end) in models() {
        for method in METHODS {
            let runs = OUTPUTS.map(|outputs| {
                let options = Options {
                    method: Some(method.into()),
                    error: Some(1e-5),
                    full: true,
                    max_steps: Some(20_000),
                    ..Options::default()
                };
                let mut s = begin(whole(&text), &name, options);
                try_to(&mut s, Analysis::Dynamic, end, outputs);
                s
            });
            let [few, more @ ..] = &runs;
            for (s, outputs) in more.iter().zip(&OUTPUTS[1..]) {
                let (a, b) = (&few.run.record, &s.run.record);
                let steps = [a, b].map(|r| (r.counts.steps, r.counts.rejected_steps));
                if steps[0] != steps[1] {
                    wrong.push(format!(
                        "{name} by {method}: steps {steps:?} with {outputs} outputs"
                    ));
                    continue;
                }
                let (one, other) = (bits(&few.run, 1), bits(&s.run, outputs / OUTPUTS[0]));
                let different = one.iter().zip(&other).find(|(a, b)| a != b);
                if let Some(((column, a), (_, b))) = different {
                    let row = a.iter().zip(b).position(|(a, b)| a != b);
                    wrong.push(format!(
                        "{name} by {method}: {column} with {outputs} outputs at row {row:?}"
                    ));
                }
                if format!("{:?}", a.energy) != format!("{:?}", b.energy) {
                    wrong.push(format!(
                        "{name} by {method}: the account of energy with {outputs} outputs"
                    ));
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} differ:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn zeros_have_no_sign() {
    let mut s = running::session(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n",
        &["-DX(2,1)"],
        1e-6,
    );
    try_to(&mut s, Analysis::Dynamic, 1.0, 4);
    for column in &s.run.columns {
        let signs = column
            .values
            .iter()
            .filter(|x| **x == 0.0 && x.is_sign_negative());
        assert_eq!(signs.count(), 0, "{}", column.name);
    }
}

#[test]
fn a_sensor_changes_the_distance_of_outputs_in_kinematic_and_dynamic_runs_alike() {
    let rotor = "PART/2, MASS=1, CM=20, IP=1,1,1, WZ=1\nMARKER/20, PART=2\nJOINT/1, REVOLUTE, I=20, J=1\n\
                 SENSOR/1, FUNCTION=AZ(20,1), VALUE=0.3, GE, ERROR=1E-6, DT=0.125\n";
    let drive = "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n";
    for (analysis, drive) in [(Analysis::Dynamic, ""), (Analysis::Kinematic, drive)] {
        let mut s = running::session(&format!("{rotor}{drive}"), &["AZ(20,1)"], 1e-10);
        running::go(&mut s, analysis, 1.0, 2);
        let times = running::values(&s, "time");
        let expected = [0.0, 0.425, 0.55, 0.675, 0.8, 0.925, 1.0];
        let off = times.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(
            times.len() == expected.len() && off.fold(0.0, f64::max) < 1e-6,
            "{analysis:?}: {times:?}"
        );
        let angles = running::values(&s, "AZ(20,1)");
        assert!(
            angles.iter().zip(times).all(|(a, t)| (a - t).abs() < 1e-6),
            "{angles:?}"
        );
    }
}

#[test]
fn a_spline_read_outside_its_data_is_told_however_few_outputs_there_are() {
    // x = SIN(TIME), of which outputs at multiples of half a turn show nothing
    let text = format!(
        "{SLIDER}SPLINE/1, X=-0.9,-0.4,0,0.4,0.9, Y=-0.9,-0.4,0,0.4,0.9\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-AKISPL(DX(20,1),0,1)\n"
    );
    for method in METHODS {
        for outputs in [2, 100] {
            let mut s = running::session_by(&text, &["DX(20,1)"], method, 1e-6);
            running::go(&mut s, Analysis::Dynamic, std::f64::consts::TAU, outputs);
            let told = s.run.record.warned();
            assert!(
                told.iter().any(|w| w.contains("SPLINE/1")),
                "{method} {outputs}: {told:?}"
            );
        }
    }
}

/// What a spline reads may be a value of the past: of time, or of where something is.
#[test]
fn a_spline_read_at_a_delayed_value_outside_its_data_is_told() {
    for (at, last) in [
        ("DELAY(2*TIME,0.25,0)", 3.5),
        ("DELAY(DX(20,1),0.25,0)", 1.75),
    ] {
        for part in [0.8, 1.2] {
            let text = format!(
                "{SLIDER}SPLINE/1, X=-9,-1,0,{}, Y=0,0,0,0\n\
                 SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-CUBSPL({at},0,1)\n",
                part * last
            );
            for method in METHODS {
                let mut s = running::session_by(&text, &["DX(20,1)"], method, 1e-6);
                running::go(&mut s, Analysis::Dynamic, 2.0, 2);
                let told = s.run.record.warned().iter().any(|w| w.contains("SPLINE/1"));
                assert_eq!(told, part < 1.0, "{at} {method} {part}");
            }
        }
    }
}

/// A rotor that a motion turns by `drive`, another one on it by half of that, about an axis at `tilt` degrees, and a slider
/// whose force reads a spline over an angle between 0 and `last` rad.
fn read_over(angle: &str, drive: &str, tilt: f64, last: f64) -> String {
    format!(
        "{SLIDER}MARKER/3, PART=1, QP=9,0,0\nPART/3, MASS=1, CM=30, IP=1,1,1, QG=9,0,0\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, REULER=0,{tilt}D,0\nJOINT/3, REVOLUTE, I=30, J=3\n\
         MOTION/3, ROTATIONAL, JOINT=3, FUNCTION={drive}\n\
         PART/4, MASS=1, CM=40, IP=1,1,1, QG=9,0,0\nMARKER/40, PART=4, REULER=0,{tilt}D,0\n\
         JOINT/4, REVOLUTE, I=40, J=31\nMOTION/4, ROTATIONAL, JOINT=4, FUNCTION=0.5*({drive})\n\
         SPLINE/1, X=0,{},{},{last}, Y=0,0.1,0.2,0.3\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-CUBSPL({angle},0,1)\n",
        0.3 * last,
        0.6 * last
    )
}

#[test]
fn a_spline_over_an_angle_that_motions_turn_is_told_before_a_run_and_in_it() {
    let drives: [(&str, f64); 3] = [
        ("TIME", 2.0),
        ("30*TIME", 60.0),
        ("20*SIN(0.5*PI*TIME)", 20.0),
    ];
    let angles: [(&str, f64, f64); 4] = [
        ("AZ(30,3)", 0.0, 1.0),
        ("-AZ(3,30)", 0.0, 1.0),
        ("AZ(40,3)", 0.0, 1.5),
        // about an axis that turns, an angle that no coordinate knows: as many turns but for a bit of one
        ("AZ(40,3)", 10.0, 1.5),
    ];
    for (drive, most) in drives {
        for (angle, tilt, factor) in angles {
            for part in [0.8, 1.2] {
                let text = read_over(angle, drive, tilt, part * factor * most);
                let s = running::session(&text, &["DX(20,1)"], 1e-6);
                let is_said = |said: &str| said.contains("SPLINE/1");
                let before = s.preview(Analysis::Dynamic, 2.0);
                let before = before.iter().any(|d| is_said(&d.to_string()));
                let mut s = running::session(&text, &["DX(20,1)"], 1e-6);
                running::go(&mut s, Analysis::Dynamic, 2.0, 2);
                let after = s.run.record.warned().iter().any(|w| is_said(w));
                assert_eq!(
                    [before, after],
                    [part < 1.0; 2],
                    "{angle} at {tilt}, {drive}, {part} of the range"
                );
            }
        }
    }
}
