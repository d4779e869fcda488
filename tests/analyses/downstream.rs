//! States downstream of a mechanism, which read it and are not read by it: the mechanism moves to the bit as if they were not
//! there, and they are as exact as asked for, however stiff, by every method. What is read, or breaks, stays with the mechanism.

use crate::running;

use cognate::analysis::linear::Wanted;
use cognate::analysis::session::state::Saved;
use cognate::internals::verify::outline::outline;
use cognate::model::ElementKind;
use cognate::results::{Counts, Event, Status};
use running::{
    Analysis, Options, Session, begin, go, last, model, off, options, options_by, rest, session_by,
    try_to, values, whole,
};

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

/// A mass of one on a spring, at 1 and at rest: it is at cos ωt along the z axis of MARKER/11.
fn oscillator(omega: f64, more: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=20, QG=1,0,0\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/11, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=20, J=11\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-{:?}*DZ(20,11,11)\n{more}",
        omega * omega
    )
}

/// Filters, an integral and a transfer function of the motion of a marker.
fn readers(marker: u32) -> String {
    format!(
        "DIFF/9001, IC=0, FUNCTION=1E5*(ACCX({marker})-DIF(9001))\nDIFF/9002, IC=0, FUNCTION=VX({marker})\n\
         DIFF/9003, IC=0, FUNCTION=10*(DIF(9001)-DIF(9003))\nVARIABLE/9004, FUNCTION=DX({marker})\n\
         ARRAY/9005, U, VARIABLES=9004\nARRAY/9006, X\nARRAY/9007, Y\n\
         TFSISO/9008, U=9005, X=9006, Y=9007, NUMERATOR=1, DENOMINATOR=1,1E-4\n"
    )
}

/// A dataset with more statements before its end.
fn with(text: &str, more: &str) -> String {
    let (before, _) = text.rsplit_once("END").expect("a dataset ends");
    format!("{before}{more}END\n")
}

/// Mechanisms with stops, friction that holds, loops of functions and of bodies, turns and a past: name, dataset, marker of a
/// body that moves, end.
fn mechanisms() -> Vec<(String, String, u32, f64)> {
    let pushed = |function: &str| {
        format!(
            "{}PART/2, MASS=1, CM=20, VX=1\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/11, PART=1, REULER=90D,90D,0\n\
             JOINT/1, TRANSLATIONAL, I=20, J=11\n\
             SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION={function}\nEND\n",
            running::GROUND
        )
    };
    let of_functions = [
        ("stiff", "-1E4*DX(20,11)-2E4*VX(20,11)+1E4*SIN(3*TIME)", 0.5),
        (
            "friction by SIGN",
            "-2*SIGN(1,VX(20,11))+3*SIN(4*TIME)",
            2.0,
        ),
        ("stop", "-10+MAX(0,1E4*(0.1-DX(20,11))-5*VX(20,11))", 1.0),
        ("delay", "-4*DELAY(DX(20,11),0.3,0)", 2.0),
        ("turns", "-SIN(DX(20,11))*AZ(20,11)-DX(20,11)", 2.0),
        ("loop", "-DX(20,11)-0.3*TANH(ACCX(20))", 1.0),
    ];
    let of_functions =
        of_functions.map(|(name, function, end)| (name.to_string(), pushed(function), 20, end));
    let references = [
        ("a02_nfourbar_2", 4, 1.0),
        ("bistop_slot", 0, 0.5),
        ("bounce_k1e6", 0, 1.0),
        ("settle_sphere", 0, 0.3),
    ];
    let references = references.map(|(name, marker, end)| {
        let file = format!(
            "{}/tests/data/references/{name}.adm",
            env!("CARGO_MANIFEST_DIR")
        );
        let text = std::fs::read_to_string(&file).expect("it is there");
        let parts = whole(&text).parts;
        let centre = parts
            .values()
            .find_map(|part| part.cm.filter(|_| !part.ground));
        let marker = if marker > 0 {
            marker
        } else {
            centre.expect("a centre of mass")
        };
        (name.to_string(), text, marker, end)
    });
    of_functions.into_iter().chain(references).collect()
}

/// What the log tells of the states beside the mechanism: the steps and the method.
fn beside(s: &Session) -> (usize, String) {
    let told = s.run.log.iter().find_map(|event| match event {
        Event::Info(text) => text.split_once(" steps of ").map(|(before, method)| {
            let steps = before.rsplit(' ').next().and_then(|n| n.parse().ok());
            (steps.expect("a number of steps"), method.to_owned())
        }),
        _ => None,
    });
    told.expect("states beside the mechanism")
}

#[test]
fn stiff_filters_begin_by_the_implicit_method_however_many_they_are() {
    let filters = |n: usize| -> String {
        let one = |k| {
            format!(
                "DIFF/{k}, IC=0, FUNCTION=1E{}*(DZ(20,11,11)-DIF({k}))\n",
                3 + k % 4
            )
        };
        (1..=n).map(one).collect()
    };
    let steps = [4, 400].map(|n| {
        let text = oscillator(3.0, &filters(n));
        let text = format!("{}{text}END\n", running::GROUND);
        let s = dynamics(&text, "AUTO", 1.0, false);
        assert_eq!(s.run.record.status, Status::Completed);
        let (steps, method) = beside(&s);
        assert_eq!(method, "RADAU5", "{n} filters");
        steps
    });
    assert!(steps[1] <= steps[0] + steps[0] / 10, "{steps:?}");
}

/// The work of the mechanism's method, without the evaluations that interpolants take.
fn steps(s: &Session) -> Counts {
    Counts {
        evaluations: 0,
        ..s.run.record.counts
    }
}

fn dynamics(text: &str, method: &str, end: f64, full: bool) -> Session {
    let options = Options {
        method: Some(method.into()),
        error: Some(1e-5),
        full,
        max_steps: Some(20_000),
        ..Options::default()
    };
    let mut s = begin(whole(text), "test", options);
    try_to(&mut s, Analysis::Dynamic, end, 8);
    s
}

#[test]
fn a_mechanism_keeps_its_bits_whatever_is_downstream() {
    let mut wrong = Vec::new();
    for (name, text, marker, end) in mechanisms() {
        let more = with(&text, &readers(marker));
        let told = outline(&whole(&more)).unwrap_or_else(|e| panic!("{e}"));
        let stay: &[&str] = &["DIFF/9001", "DIFF/9002", "DIFF/9003", "TFSISO/9008 state 1"];
        assert_eq!(told.downstream, stay, "{name}");
        for method in METHODS {
            let [alone, read] = [&text, &more].map(|text| dynamics(text, method, end, true));
            let worked = [&alone, &read].map(|s| (steps(s), s.run.record.status));
            if worked[0] != worked[1] {
                wrong.push(format!("{name} by {method}: {worked:?}"));
            }
            for column in &alone.run.columns {
                let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                if bits(&column.values) != bits(values(&read, &column.name)) {
                    wrong.push(format!("{name} by {method}: {}", column.name));
                }
            }
            let energies = [&alone, &read].map(|s| format!("{:?}", s.run.record.energy));
            if energies[0] != energies[1] {
                wrong.push(format!("{name} by {method}: energy"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn integrals_of_a_speed_are_displacements_through_stops_and_loops() {
    for (name, text, marker, end) in mechanisms() {
        let text = with(&text, &format!("DIFF/9002, IC=0, FUNCTION=VX({marker})\n"));
        for method in ["AUTO", "DOP853", "RADAU5"] {
            let wanted = ["DIF(9002)".to_string(), format!("DX({marker})")];
            let options = Options {
                method: Some(method.into()),
                error: Some(1e-6),
                max_steps: Some(50_000),
                columns: wanted.to_vec(),
                ..Options::default()
            };
            let mut s = begin(whole(&text), &name, options);
            try_to(&mut s, Analysis::Dynamic, end, 16);
            let [integral, place] = wanted.each_ref().map(|column| values(&s, column));
            let worst = integral
                .iter()
                .zip(place)
                .map(|(i, x)| (i - (x - place[0])).abs())
                .fold(0.0, f64::max);
            assert!(worst < 2e-4, "{name} by {method}: {worst:e}");
        }
    }
}

#[test]
fn the_impulse_of_a_force_that_jumps_and_holds_is_the_change_of_momentum() {
    let text = "PART/2, MASS=1, CM=20, VX=1\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/11, PART=1, REULER=90D,90D,0\n\
                JOINT/1, TRANSLATIONAL, I=20, J=11\n\
                SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-2*SIGN(1,VX(20,11))+3*SIN(4*TIME)\n\
                DIFF/1, IC=1, FUNCTION=SFORCE(1,0,2,0)\n";
    for method in ["AUTO", "RADAU5"] {
        for error in [1e-4, 1e-6, 1e-8] {
            let mut s = session_by(text, &["DIF(1)", "VX(20)"], method, error);
            go(&mut s, Analysis::Dynamic, 2.0, 40);
            let momenta = values(&s, "DIF(1)").iter().zip(values(&s, "VX(20)"));
            let worst = momenta.map(|(i, v)| (i - v).abs()).fold(0.0, f64::max);
            assert!(worst < 100.0 * error, "{method} at {error:e}: {worst:e}");
        }
    }
}

/// The low-pass `ẋ = k (u − x)` of u = cos ωt from x₀, and its integral from 0.
fn filtered(omega: f64, k: f64, x0: f64, t: f64) -> [f64; 2] {
    let scale = k / (k * k + omega * omega);
    let (sin, cos) = (omega * t).sin_cos();
    let steady = scale * (k * cos + omega * sin);
    let x = steady + (x0 - scale * k) * (-k * t).exp();
    [x, sin / omega - (x - x0) / k]
}

#[test]
fn filters_and_filters_behind_filters_are_as_exact_as_asked_for() {
    let omega = 7.0;
    for k in [1.0, 50.0, 1e3, 1e6] {
        let more = format!(
            "DIFF/1, IC=0.5, FUNCTION={k:?}*(DZ(20,11,11)-DIF(1))\nDIFF/2, IC=0, FUNCTION=DIF(1)\n\
             VARIABLE/1, FUNCTION=DZ(20,11,11)\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/13, Y\n\
             ARRAY/14, IC, NUMBERS=0.5\nMATRIX/1, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=-{k:?}\n\
             MATRIX/2, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES={k:?}\nMATRIX/3, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=1\n\
             LSE/1, X=11, U=10, Y=13, IC=14, A=1, B=2, C=3\n"
        );
        for method in ["AUTO", "DOP853", "RADAU5"] {
            for error in [1e-4, 1e-6, 1e-9] {
                let columns = ["DIF(1)", "DIF(2)", "ARYVAL(13,1)"];
                let mut s = session_by(&oscillator(omega, &more), &columns, method, error);
                go(&mut s, Analysis::Dynamic, 2.0, 40);
                let [of_filter, of_integral, of_lse] =
                    [(0, 0), (1, 1), (2, 0)].map(|(column, k_th): (usize, usize)| {
                        off(&s, columns[column], |t| filtered(omega, k, 0.5, t)[k_th])
                    });
                // errors of two revolutions of the mechanism are among them
                let permitted = 3e2 * error;
                let worst = of_filter.max(of_integral).max(of_lse);
                assert!(
                    worst < permitted,
                    "k = {k:e} by {method} at {error:e}: {worst:e}"
                );
            }
        }
    }
}

#[test]
fn stiff_filters_cost_the_mechanism_no_steps() {
    let more: String = (1..=300)
        .map(|k| format!("DIFF/{k}, IC=1, FUNCTION={k}E4*(ACCX(20)-DIF({k}))\n"))
        .collect();
    let runs = ["", &more].map(|more| {
        let mut s = session_by(&oscillator(3.0, more), &["DX(20)"], "AUTO", 1e-6);
        go(&mut s, Analysis::Dynamic, 1.0, 4);
        let told = outline(&model(&oscillator(3.0, more))).unwrap_or_else(|e| panic!("{e}"));
        (
            steps(&s),
            told.operations,
            told.costs.len(),
            told.unknowns.len(),
        )
    });
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn what_the_mechanism_reads_or_what_breaks_stays_with_it() {
    let filter = "DIFF/1, IC=0, FUNCTION=DX(20)-DIF(1)\n";
    let torque = "SFORCE/2, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=";
    let sensor = "SENSOR/1, GE, VALUE=9, HALT, FUNCTION=DIF(1)\\\n";
    let array = "ARRAY/10, U, VARIABLES=1\nVARIABLE/1, FUNCTION=DIF(1)\n";
    for (more, downstream) in [
        (filter.to_string(), 1),
        (
            format!("{filter}DIFF/2, IC=0, FUNCTION=DIF(1)\nREQUEST/1, F2=DIF(2)\n"),
            2,
        ),
        (format!("{filter}{torque}DIF(1)\n"), 0),
        (
            format!("{filter}{torque}VARVAL(1)\nVARIABLE/1, FUNCTION=DIF(1)\n"),
            0,
        ),
        (format!("{filter}{torque}ARYVAL(10,1)\n{array}"), 0),
        (
            format!("{filter}{torque}DIF(2)\nDIFF/2, IC=0, FUNCTION=DIF(1)\n"),
            0,
        ),
        (format!("{filter}{torque}DIF1(1)\n"), 0),
        (format!("{filter}{sensor}"), 0),
        (format!("{filter}REQUEST/1, F2=DELAY(DIF(1),0.1,0)\n"), 1),
        (format!("{filter}{torque}DELAY(DIF(1),0.1,0)\n"), 0),
        // branches, peaks, turns, equations without a rate of their own
        ("DIFF/1, IC=0, FUNCTION=IF(DX(20)-0.5:0,1,1)\n".into(), 0),
        ("DIFF/1, IC=0, FUNCTION=STEP(TIME,0.2,0,0.3,1)\n".into(), 0),
        (
            "DIFF/1, IC=0, FUNCTION=ABS(VARVAL(1))\nVARIABLE/1, FUNCTION=VX(20)\n".into(),
            0,
        ),
        (
            "DIFF/1, IC=0, FUNCTION=EXP(-((DX(20)-0.5)/1E-6)**2)\n".into(),
            0,
        ),
        ("DIFF/1, IC=0, FUNCTION=AZ(20,11)\n".into(), 0),
        (
            "DIFF/1, IC=1,0, IMPLICIT, FUNCTION=DIF1(1)+DIF(1)\n".into(),
            0,
        ),
        // the one that breaks stays, the one that reads it goes
        (
            "DIFF/2, IC=0, FUNCTION=ABS(VX(20))\nDIFF/1, IC=0, FUNCTION=DIF(2)\n".into(),
            1,
        ),
    ] {
        let told =
            outline(&model(&oscillator(3.0, &more))).unwrap_or_else(|e| panic!("{more}: {e}"));
        assert_eq!(
            told.downstream.len(),
            downstream,
            "{more}{:?}",
            told.downstream
        );
    }
    // without a mechanism the equations are all there is
    let told =
        outline(&model("DIFF/1, IC=1, FUNCTION=-DIF(1)\n")).unwrap_or_else(|e| panic!("{e}"));
    assert!(told.downstream.is_empty());
}

#[test]
fn a_pulse_of_time_is_not_passed_over() {
    // ∫ e^(−((t−0.5)/s)²) dt = s √π
    let width = 1e-3;
    let more = format!(
        "DIFF/1, IC=0, FUNCTION=VARVAL(1)\nVARIABLE/1, FUNCTION=1/COSH((TIME-0.5)/{width:?})\n"
    );
    let mut s = session_by(&oscillator(0.1, &more), &["DIF(1)"], "AUTO", 1e-6);
    go(&mut s, Analysis::Dynamic, 1.0, 4);
    // ∫ sech = π
    let exact = width * std::f64::consts::PI;
    assert!(
        (last(&s, "DIF(1)") - exact).abs() < 1e-3 * exact,
        "{}",
        last(&s, "DIF(1)")
    );
}

#[test]
fn the_order_of_statements_changes_no_bits() {
    let more = readers(20);
    let mut lines: Vec<&str> = more.lines().collect();
    lines.reverse();
    let turned = lines.join("\n") + "\n";
    let columns = ["DIF(9001)", "DIF(9002)", "DIF(9003)", "ARYVAL(9007,1)"];
    let runs = [more, turned].map(|more| {
        let mut s = session_by(&oscillator(5.0, &more), &columns, "AUTO", 1e-6);
        go(&mut s, Analysis::Dynamic, 1.0, 8);
        columns.map(|column| values(&s, column).to_vec())
    });
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn they_are_states_of_linear_systems_and_rest_where_statics_finds_them() {
    let filter =
        "DIFF/1, IC=0.25, FUNCTION=40*(DZ(20,11,11)-DIF(1))\nDIFF/2, IC=3, FUNCTION=1-5*DIF(2)\n";
    let mut s = begin(
        model(&oscillator(3.0, filter)),
        "test",
        options(&["DIF(1)", "DIF(2)"], 1e-8),
    );
    go(&mut s, Analysis::Dynamic, 1.0, 2);
    let found = s
        .linearize(&Wanted::default())
        .unwrap_or_else(|e| panic!("{e:?}"));
    let mut rates: Vec<f64> = found
        .modes
        .iter()
        .filter(|mode| mode.im == 0.0)
        .map(|mode| mode.re)
        .collect();
    rates.sort_by(f64::total_cmp);
    assert!(
        (rates[0] + 40.0).abs() < 1e-9 && (rates[1] + 5.0).abs() < 1e-9,
        "{rates:?}"
    );
    rest(&mut s);
    assert!(last(&s, "DIF(1)").abs() < 1e-8 && (last(&s, "DIF(2)") - 0.2).abs() < 1e-8);
}

#[test]
fn simulations_and_saved_states_go_on_with_them() {
    let omega = 4.0;
    let text = oscillator(
        omega,
        "DIFF/1, IC=0, FUNCTION=30*(DZ(20,11,11)-DIF(1))\nSFORCE/2, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=5*DIF(1)\n",
    );
    let begun = || {
        let mut s = begin(
            model(&text),
            "test",
            options_by(&["DIF(1)", "DX(20)"], "AUTO", 1e-9),
        );
        s.model.inactive.insert(ElementKind::Sforce.id(2));
        go(&mut s, Analysis::Dynamic, 0.5, 3);
        s
    };
    let mut s = begun();
    assert!((last(&s, "DIF(1)") - filtered(omega, 30.0, 0.0, 0.5)[0]).abs() < 1e-7);
    go(&mut s, Analysis::Dynamic, 1.0, 3);
    let exact = filtered(omega, 30.0, 0.0, 1.0)[0];
    assert!(
        (last(&s, "DIF(1)") - exact).abs() < 1e-7,
        "a second simulation goes on"
    );
    let mut reloaded = begin(
        model(""),
        "other",
        options_by(&["DIF(1)", "DX(20)"], "AUTO", 1e-9),
    );
    let saved = Saved::read(begun().save().as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    reloaded.reload(saved).unwrap_or_else(|e| panic!("{e}"));
    go(&mut reloaded, Analysis::Dynamic, 1.0, 3);
    assert_eq!(
        last(&reloaded, "DIF(1)").to_bits(),
        last(&s, "DIF(1)").to_bits()
    );
    // a force that reads it, switched on: it is part of the mechanism from then on
    s.model.inactive.clear();
    let before = last(&s, "DIF(1)");
    go(&mut s, Analysis::Dynamic, 1.0 + 1e-6, 1);
    assert!((last(&s, "DIF(1)") - before).abs() < 1e-3);
    let place = last(&s, "DX(20)");
    go(&mut s, Analysis::Dynamic, 2.0, 4);
    assert!((last(&s, "DX(20)") - place).abs() > 1e-3);
}

#[test]
fn one_that_grows_without_bound_ends_the_run_by_its_name() {
    // x = 1/(1 − t)
    let text = oscillator(3.0, "DIFF/7, IC=1, FUNCTION=DIF(7)**2\n");
    for method in ["AUTO", "RADAU5"] {
        let mut s = session_by(&text, &["DIF(7)"], method, 1e-6);
        let status = try_to(&mut s, Analysis::Dynamic, 2.0, 20);
        assert_eq!(status, Status::Stopped, "{method}");
        let reason = &s.run.record.stop_reason;
        assert!(reason.contains("DIFF/7"), "{method}: {reason}");
        // at 0.9, the last output but one before
        let row = values(&s, "time")
            .iter()
            .position(|t| *t == 0.9)
            .expect("an output");
        assert!((values(&s, "DIF(7)")[row] - 10.0).abs() < 1e-2, "{method}");
    }
}

#[test]
fn one_that_loses_its_value_ends_the_run_by_the_operation() {
    // the first by time alone, the second by its own state, the third by what it reads
    let functions = [
        ("SQRT(0.5-TIME)", "SQRT of -"),
        ("-1/SQRT(DIF(1))", "SQRT of -"),
        ("SQRT(DX(20,1)-0.2)", "SQRT of -"),
        ("LOG(DIF(1)-TIME)", "LOG of -"),
    ];
    for (function, operation) in functions {
        let text = oscillator(2.0, &format!("DIFF/1, IC=1, FUNCTION={function}\n"));
        for method in METHODS {
            let mut s = session_by(&text, &["DIF(1)"], method, 1e-6);
            try_to(&mut s, Analysis::Dynamic, 2.0, 20);
            let record = &s.run.record;
            let what = format!("{function} by {method}: {}", record.stop_reason);
            assert_eq!(record.stop_code, "no_finite_value", "{what}");
            let named = ["DIFF/1 FUNCTION", operation];
            assert!(
                named.iter().all(|n| record.stop_reason.contains(n)),
                "{what}"
            );
        }
    }
}

#[test]
fn errors_lie_within_their_bars() {
    let (omega, k) = (7.0, 20.0);
    let text = oscillator(
        omega,
        &format!("DIFF/1, IC=0.5, FUNCTION={k:?}*(DZ(20,11,11)-DIF(1))\n"),
    );
    let options = Options {
        accuracy: cognate::analysis::session::Accuracy::Bars,
        ..options(&["DIF(1)"], 1e-5)
    };
    let mut s = begin(model(&text), "test", options);
    go(&mut s, Analysis::Dynamic, 2.0, 50);
    let rows = values(&s, "time")
        .iter()
        .zip(values(&s, "DIF(1)"))
        .zip(values(&s, "DIF(1)±"));
    let outside =
        rows.filter(|((t, x), bar)| (**x - filtered(omega, k, 0.5, **t)[0]).abs() > **bar);
    assert!(outside.count() <= 1);
}
