//! What is passed in less than a step acts for as long as it is passed, whatever the method, its request and the outputs.

use crate::running;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use running::{Analysis, begin, go, last, model, options_by, try_to};

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

/// A gate on a way: the function that is positive in it, and the times at which it begins and ends.
struct Gate {
    function: String,
    passed: [f64; 2],
}

/// The ways of a free part along x and y: places at 0, velocities, acceleration along y.
#[derive(Clone, Copy, Debug)]
struct Way {
    at: [f64; 2],
    velocity: [f64; 2],
    fall: f64,
}

impl Way {
    fn place(&self, t: f64) -> [f64; 2] {
        let [x, y] = self.at;
        let [v, u] = self.velocity;
        [x + v * t, y + u * t - 0.5 * self.fall * t * t]
    }

    /// A part of one kilogram, free, that goes this way.
    fn part(&self) -> String {
        let ([x, y], [v, u]) = (self.at, self.velocity);
        let g = match self.fall {
            0.0 => String::new(),
            g => format!("ACCGRAV/JGRAV={:?}\n", -g),
        };
        format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1, QG={x:?},{y:?},0, VX={v:?}, VY={u:?}\nMARKER/2, PART=2\n{g}"
        )
    }

    /// A gate that is passed around `t` with a half width `w`, of one of six forms.
    fn gate(&self, form: usize, t: f64, w: f64) -> Gate {
        let [a, b] = self.place(t);
        let [v, u] = self.velocity;
        let (along, speed) = (v.abs(), v.hypot(u));
        let (x, y) = (format!("(DX(2,1)-({a:?}))"), format!("(DY(2,1)-({b:?}))"));
        // past the centre of a circle by 0.6 of its radius
        let (dx, dy) = (-0.6 * w * u / speed, 0.6 * w * v / speed);
        let squares = format!("({x}-({dx:?}))**2+({y}-({dy:?}))**2");
        let (function, half) = match form {
            0 => (format!("{w:?}-ABS{x}"), w / along),
            1 => (
                format!("MIN({w:?}-ABS{x},{w:?}-ABS{y})"),
                w / along.max(u.abs()),
            ),
            2 => (format!("{:?}-({squares})", w * w), 0.8 * w / speed),
            3 => (format!("{w:?}-SQRT({squares})"), 0.8 * w / speed),
            4 => (format!("({w:?}-{x})*({x}+{w:?})"), w / along),
            _ => (format!("IF({x}+{w:?}:-1,0,{w:?}-{x})"), w / along),
        };
        Gate {
            function,
            passed: [t - half, t + half],
        }
    }

    /// A gate at the highest place, open for a time of 2 `half`.
    fn top(&self, half: f64) -> Gate {
        let t = self.velocity[1] / self.fall;
        let height = self.place(t - half)[1];
        Gate {
            function: format!("DY(2,1)-({height:?})"),
            passed: [t - half, t + half],
        }
    }
}

/// How far off the impulse of what acts in a gate is, which is one; for a sensor, its time over how
/// long the gate is.
fn off(
    way: Way,
    gate: &Gate,
    door: usize,
    method: &str,
    error: f64,
    steps: usize,
    end: f64,
) -> f64 {
    let Gate { function, passed } = gate;
    let long = passed[1] - passed[0];
    let force = 1.0 / long;
    let along_z = "SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=";
    let (acts, column) = match door {
        0 => (
            format!("{along_z}IF({function}: 0,0,{force:?})\n"),
            "VZ(2,1)",
        ),
        1 => (
            format!("{along_z}{:?}*(1+SIGN(1,{function}))\n", 0.5 * force),
            "VZ(2,1)",
        ),
        2 => (
            format!("DIFF/1, IC=0, FUNCTION=IF({function}: 0,0,{force:?})\n"),
            "DIF(1)",
        ),
        3 => (
            format!("VARIABLE/1, FUNCTION=IF({function}: 0,0,1)\n{along_z}{force:?}*VARVAL(1)\n"),
            "VZ(2,1)",
        ),
        4 => (
            format!("SENSOR/1, FUNCTION={function}\\, VALUE=0, GE, ERROR=0, HALT\n"),
            "DZ(2,1)",
        ),
        // by unknowns of loops, which are the displacements
        _ => {
            let function = function
                .replace("DX(2,1)", "VARVAL(5)")
                .replace("DY(2,1)", "VARVAL(6)");
            let loops = "VARIABLE/5, FUNCTION=1.5*DX(2,1)-0.5*VARVAL(5)\nVARIABLE/6, FUNCTION=1.5*DY(2,1)-0.5*VARVAL(6)\n";
            (
                format!("{loops}{along_z}IF({function}: 0,0,{force:?})\n"),
                "VZ(2,1)",
            )
        }
    };
    let text = format!("{}{acts}", way.part());
    let mut s = begin(model(&text), "gate", options_by(&[column], method, error));
    if door == 4 {
        let _ = try_to(&mut s, Analysis::Dynamic, end, steps);
        return (s.time() - passed[0]).abs() / long;
    }
    go(&mut s, Analysis::Dynamic, end, steps);
    (last(&s, column) - 1.0).abs()
}

/// A bump of half a width `w` around a place on x, and its integral over x, of one of nine shapes; the last has two.
fn bump(shape: usize, a: f64, w: f64) -> (String, f64) {
    use std::f64::consts::PI;
    let x = format!("(DX(2,1)-({a:?}))");
    let sides = |name: &str| {
        let (before, behind) = (-w, w);
        format!("{name}({x},{before:?},0,0,1)*{name}({x},0,1,{behind:?},0)")
    };
    match shape {
        0 => (sides("STEP"), w),
        1 => (sides("STEP5"), w),
        2 => (sides("HAVSIN"), w),
        3 => (format!("MAX(0,1-({x}/{w:?})**2)"), 4.0 / 3.0 * w),
        4 => (format!("MAX(0,1-ABS({x}/{w:?}))"), w),
        5 => (format!("EXP(-({x}/{w:?})**2)"), PI.sqrt() * w),
        6 => (format!("1/(1+({x}/{w:?})**4)"), PI / 2f64.sqrt() * w),
        7 => {
            let flank = |at: f64| format!("TANH(({x}+({at:?}))/{:?})", 0.1 * w);
            (format!("0.5*({}-{})", flank(w), flank(-w)), 2.0 * w)
        }
        _ => {
            let further = 20.0 * w;
            let both = format!("EXP(-({x}/{w:?})**2)+EXP(-(({x}-{further:?})/{w:?})**2)");
            (format!("({both})"), 2.0 * PI.sqrt() * w)
        }
    }
}

fn way() -> impl Strategy<Value = Way> {
    let speed = prop_oneof![-1.0f64..-0.1, 0.1f64..1.0];
    ((-1.0f64..1.0, -1.0f64..1.0), (speed.clone(), speed)).prop_map(|(at, velocity)| Way {
        at: at.into(),
        velocity: velocity.into(),
        fall: 0.0,
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 180,
        rng_seed: RngSeed::Fixed(33),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Gates down to some millionths of the way, by every method.
    #[test]
    fn a_gate_acts_for_as_long_as_it_is_passed(
        way in way(),
        form in 0usize..6,
        door in 0usize..6,
        at in 0.1f64..0.9,
        decades in -5.0f64..-1.5,
        end in 1.0f64..10.0,
        method in prop::sample::select(&METHODS[..]),
        digits in 3i32..9,
        steps in prop::sample::select(&[1usize, 7, 60][..]),
    ) {
        let gate = way.gate(form, at * end, end * 10f64.powf(decades) * 0.1);
        let off = off(way, &gate, door, method, 10f64.powi(-digits), steps, end);
        prop_assert!(off < 1e-4, "{method} 1e-{digits} {steps} {door}: {off:e}: {}, {:?}", gate.function, gate.passed);
    }

    /// What is thrown up reaches a gate at its highest place, down to 1e-9 of its way.
    #[test]
    fn a_gate_that_is_reached_from_one_side_acts_for_as_long(
        way in way(),
        fall in 1.0f64..10.0,
        up in 1.0f64..4.0,
        door in 0usize..6,
        decades in -4.0f64..-1.0,
        method in prop::sample::select(&["AUTO", "DOP853", "RADAU5"][..]),
        digits in 3i32..9,
        steps in prop::sample::select(&[1usize, 7, 60][..]),
    ) {
        let way = Way { velocity: [way.velocity[0], up], fall, ..way };
        let end = 2.0 * up / fall;
        let gate = way.top(end * 10f64.powf(decades));
        let off = off(way, &gate, door, method, 10f64.powi(-digits), steps, end);
        prop_assert!(off < 1e-4, "{method} 1e-{digits} {steps} {door}: {off:e}: {}, {:?}", gate.function, gate.passed);
    }

    /// What is smooth but narrow is felt as a whole, down to some millionths of the way.
    #[test]
    fn a_narrow_bump_acts_with_all_of_its_impulse(
        way in way(),
        shape in 0usize..9,
        door in 0usize..3,
        at in 0.2f64..0.8,
        decades in -5.0f64..-2.0,
        end in 1.0f64..10.0,
        method in prop::sample::select(&["AUTO", "DOP853", "RADAU5"][..]),
        digits in 4i32..8,
        steps in prop::sample::select(&[1usize, 7, 60][..]),
    ) {
        let [place, _] = way.place(at * end);
        let (function, integral) = bump(shape, place, end * 10f64.powf(decades) * 0.1);
        let force = way.velocity[0].abs() / integral;
        let along_z = "SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=";
        let (acts, column) = match door {
            0 => (format!("{along_z}{force:?}*{function}\n"), "VZ(2,1)"),
            1 => (format!("DIFF/1, IC=0, FUNCTION={force:?}*{function}\n"), "DIF(1)"),
            _ => (format!("VARIABLE/1, FUNCTION={function}\n{along_z}{force:?}*VARVAL(1)\n"), "VZ(2,1)"),
        };
        let text = format!("{}{acts}", way.part());
        let mut s = begin(model(&text), "bump", options_by(&[column], method, 10f64.powi(-digits)));
        go(&mut s, Analysis::Dynamic, end, steps);
        let off = (last(&s, column) - 1.0).abs();
        prop_assert!(off < 0.01, "{method} 1e-{digits} {steps} {door}: {off:e}: {function}");
    }
}
