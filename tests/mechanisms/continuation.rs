//! Kinematics stays on its branch: linkages driven through many turns, near and through the positions where branches meet.
//!
//! The closed form of a linkage has a sign for the branch. It stays what it was at the start, however near the branches come to each
//! other, and changes where they meet, because the smooth way goes on there. The number of outputs changes nothing.

use crate::running;

use cognate::results::Status;
use proptest::prelude::*;
use running::{Analysis, Session, begin, model, options, try_to};
use std::f64::consts::TAU;

/// Numbers of outputs with which everything is run.
const OUTPUTS: [usize; 4] = [1, 2, 7, 100];

/// A linkage driven by its crank, which begins at `start` and turns by `turn` in `duration`.
#[derive(Clone, Copy, Debug)]
struct Drive {
    start: f64,
    turn: f64,
    duration: f64,
}

impl Drive {
    fn angle(&self, t: f64) -> f64 {
        self.start + self.turn * t / self.duration
    }

    /// The first time at which the crank comes to one of some angles.
    fn reaches(&self, angles: impl IntoIterator<Item = f64>) -> Option<f64> {
        let times = angles
            .into_iter()
            .map(|a| (a - self.start).rem_euclid(TAU) / self.turn * self.duration);
        times.filter(|t| *t < self.duration).min_by(f64::total_cmp)
    }

    fn motion(&self) -> String {
        format!(
            "MOTION/1, JOINT=1, ROTATION, FUNCTION={:e}*TIME\n",
            self.turn / self.duration
        )
    }
}

/// Where circles about two points meet, on a side of the line from the first to the second.
fn circles(a: [f64; 2], r: f64, b: [f64; 2], s: f64, side: f64) -> Option<[f64; 2]> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let d2 = d[0] * d[0] + d[1] * d[1];
    let along = (r * r - s * s + d2) / (2.0 * d2);
    let aside = r * r / d2 - along * along;
    (aside >= 0.0).then(|| {
        let aside = side * aside.sqrt();
        [
            a[0] + along * d[0] - aside * d[1],
            a[1] + along * d[1] + aside * d[0],
        ]
    })
}

/// Crank, coupler, rocker and base of a four-bar, and the side of its coupler point.
#[derive(Clone, Copy, Debug)]
struct FourBar {
    crank: f64,
    coupler: f64,
    rocker: f64,
    base: f64,
    side: f64,
}

impl FourBar {
    fn end(&self, angle: f64, side: f64) -> Option<[f64; 2]> {
        let a = [self.crank * angle.cos(), self.crank * angle.sin()];
        circles(a, self.coupler, [self.base, 0.0], self.rocker, side)
    }

    /// The angles of the crank beyond which it does not reach.
    fn limits(&self) -> Vec<f64> {
        let (a, d) = (self.crank, self.base);
        let reach = [
            self.coupler + self.rocker,
            (self.coupler - self.rocker).abs(),
        ];
        let cosines = reach.map(|r| (a * a + d * d - r * r) / (2.0 * a * d));
        let inside = cosines.into_iter().filter(|c| c.abs() < 1.0);
        inside.flat_map(|c| [c.acos(), TAU - c.acos()]).collect()
    }

    fn text(&self, drive: &Drive) -> Option<String> {
        let [ax, ay] = [
            self.crank * drive.start.cos(),
            self.crank * drive.start.sin(),
        ];
        let [px, py] = self.end(drive.start, self.side)?;
        Some(format!(
            "MARKER/12, PART=1, QP={d:e},0,0\n\
             PART/2, MASS=1, CM=21, IP=1,1,1\nMARKER/21, PART=2\nMARKER/22, PART=2, QP={ax:e},{ay:e},0\n\
             PART/3, MASS=1, CM=31, IP=1,1,1\nMARKER/31, PART=3, QP={ax:e},{ay:e},0\nMARKER/32, PART=3, QP={px:e},{py:e},0\n\
             PART/4, MASS=1, CM=41, IP=1,1,1\nMARKER/41, PART=4, QP={d:e},0,0\nMARKER/42, PART=4, QP={px:e},{py:e},0\n\
             JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=32, J=42\nJOINT/4, REVOLUTE, I=41, J=12\n{}",
            drive.motion(),
            d = self.base,
        ))
    }
}

/// Crank and rod of a slider-crank, the height of its guide, and the side of the slider.
#[derive(Clone, Copy, Debug)]
struct SliderCrank {
    crank: f64,
    rod: f64,
    height: f64,
    side: f64,
}

impl SliderCrank {
    fn slider(&self, angle: f64, side: f64) -> Option<f64> {
        let aside = self.rod.powi(2) - (self.crank * angle.sin() - self.height).powi(2);
        (aside >= 0.0).then(|| self.crank * angle.cos() + side * aside.sqrt())
    }

    fn limits(&self) -> Vec<f64> {
        let sines = [self.height + self.rod, self.height - self.rod].map(|y| y / self.crank);
        let inside = sines.into_iter().filter(|s| s.abs() < 1.0);
        inside
            .flat_map(|s| [s.asin(), 0.5 * TAU - s.asin()])
            .collect()
    }

    fn text(&self, drive: &Drive) -> Option<String> {
        let [ax, ay] = [
            self.crank * drive.start.cos(),
            self.crank * drive.start.sin(),
        ];
        let (x, y) = (self.slider(drive.start, self.side)?, self.height);
        Some(format!(
            "MARKER/5, PART=1, QP=0,{y:e},0, REULER=90D,90D,0\n\
             PART/2, MASS=1, CM=21, IP=1,1,1\nMARKER/21, PART=2\nMARKER/22, PART=2, QP={ax:e},{ay:e},0\n\
             PART/3, MASS=1, CM=31, IP=1,1,1\nMARKER/31, PART=3, QP={ax:e},{ay:e},0\nMARKER/32, PART=3, QP={x:e},{y:e},0\n\
             PART/4, MASS=1, CM=41, IP=1,1,1\nMARKER/41, PART=4, QP={x:e},{y:e},0\nMARKER/42, PART=4, QP={x:e},{y:e},0, REULER=90D,90D,0\n\
             JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=32, J=41\nJOINT/4, TRANSLATIONAL, I=42, J=5\n{}",
            drive.motion(),
        ))
    }
}

/// Runs a linkage with every number of outputs and compares a column with its closed form (`None`: beyond the limit, by rounding); up to
/// `limit`, where it must stop by name.
fn agrees(
    text: &str,
    drive: &Drive,
    column: &str,
    exact: impl Fn(f64) -> Option<f64>,
    limit: Option<f64>,
) -> Result<(), TestCaseError> {
    // at the limit a coordinate goes with the square root of the way left
    let tolerance = if limit.is_some() { 1e-3 } else { 1e-6 };
    let mut common: Vec<(u64, u64)> = Vec::new();
    for outputs in OUTPUTS {
        let mut s = begin(model(text), "linkage", options(&[column], 1e-6));
        let status = try_to(&mut s, Analysis::Kinematic, drive.duration, outputs);
        let (times, values) = (running::values(&s, "time"), running::values(&s, column));
        match limit {
            Some(limit) => stops(&s, status, *times.last().unwrap_or(&0.0), limit, drive)?,
            None => prop_assert_eq!(status, Status::Completed, "{}", s.run.record.stop_reason),
        }
        for (&t, &x) in times.iter().zip(values) {
            if let Some(expected) = exact(t) {
                prop_assert!(
                    (x - expected).abs() < tolerance,
                    "{outputs} outputs, {t}: {x} {expected}"
                );
            }
        }
        // the same bits wherever two of them put out the same time
        let bits = times
            .iter()
            .zip(values)
            .map(|(t, x)| (t.to_bits(), x.to_bits()));
        for (t, x) in bits.clone() {
            let other = common.iter().find(|c| c.0 == t);
            prop_assert!(
                other.is_none_or(|c| c.1 == x),
                "{outputs} outputs, {}",
                f64::from_bits(t)
            );
        }
        common.extend(bits);
    }
    Ok(())
}

fn stops(
    s: &Session,
    status: Status,
    end: f64,
    limit: f64,
    drive: &Drive,
) -> Result<(), TestCaseError> {
    let reason = &s.run.record.stop_reason;
    prop_assert_eq!(status, Status::Stopped, "the limit is at {}", limit);
    prop_assert!(
        (end - limit).abs() < 1e-6 * drive.duration,
        "{end} for {limit}: {reason}"
    );
    prop_assert!(
        reason.contains("MOTION/1") && reason.contains("JOINT/"),
        "{reason}"
    );
    Ok(())
}

fn drive() -> impl Strategy<Value = Drive> {
    let turns = prop_oneof![Just(0.3), Just(1.0), Just(2.5), Just(4.0)];
    let duration = prop_oneof![Just(0.01), Just(1.0), Just(50.0)];
    (0.0..TAU, turns, duration).prop_map(|(start, turns, duration)| Drive {
        start,
        turn: turns * TAU,
        duration,
    })
}

fn side() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), Just(-1.0)]
}

/// How far, as a part, a length is from the one with which branches meet.
fn near() -> impl Strategy<Value = f64> {
    (side(), -9.0..-3.0).prop_map(|(sign, power)| sign * 10f64.powf(power))
}

fn four_bar() -> impl Strategy<Value = FourBar> {
    let length = || 0.3..3.0;
    (length(), length(), length(), length(), side()).prop_map(
        |(crank, coupler, rocker, base, side)| FourBar {
            crank,
            coupler,
            rocker,
            base,
            side,
        },
    )
}

fn slider_crank() -> impl Strategy<Value = SliderCrank> {
    (
        0.1..2.0,
        0.1..4.0,
        prop_oneof![Just(0.0), -1.0..1.0],
        side(),
    )
        .prop_map(|(crank, rod, height, side)| SliderCrank {
            crank,
            rod,
            height,
            side,
        })
}

fn four_bar_agrees(bar: &FourBar, drive: &Drive) -> Result<(), TestCaseError> {
    let Some(text) = bar.text(drive) else {
        return Err(TestCaseError::reject("cannot be assembled"));
    };
    let exact = |t: f64| bar.end(drive.angle(t), bar.side).map(|p| p[0]);
    agrees(&text, drive, "DX(32,1)", exact, drive.reaches(bar.limits()))
}

fn slider_crank_agrees(crank: &SliderCrank, drive: &Drive) -> Result<(), TestCaseError> {
    let Some(text) = crank.text(drive) else {
        return Err(TestCaseError::reject("cannot be assembled"));
    };
    let exact = |t: f64| crank.slider(drive.angle(t), crank.side);
    agrees(
        &text,
        drive,
        "DX(41,1)",
        exact,
        drive.reaches(crank.limits()),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn four_bars_stay_on_their_branch(bar in four_bar(), drive in drive()) {
        four_bar_agrees(&bar, &drive)?;
    }

    #[test]
    fn four_bars_near_a_change_point_stay_on_their_branch(bar in four_bar(), off in near(), drive in drive()) {
        let rocker = (bar.crank + bar.base - bar.coupler) * (1.0 + off);
        prop_assume!(rocker > 0.2);
        four_bar_agrees(&FourBar { rocker, ..bar }, &drive)?;
    }

    #[test]
    fn slider_cranks_stay_on_their_branch(crank in slider_crank(), drive in drive()) {
        slider_crank_agrees(&crank, &drive)?;
    }

    #[test]
    fn slider_cranks_near_a_dead_point_stay_on_their_branch(crank in slider_crank(), off in near(), drive in drive()) {
        let rod = (crank.crank + crank.height.abs()) * (1.0 + off);
        slider_crank_agrees(&SliderCrank { rod, ..crank }, &drive)?;
    }

    /// Crank and rod of one length: where the crank is upright the branches meet, and the slider goes through the middle.
    #[test]
    fn equal_links_go_on_smoothly_where_branches_meet(length in 0.1..3.0, side in side(), drive in drive()) {
        let crank = SliderCrank { crank: length, rod: length, height: 0.0, side };
        let Some(text) = crank.text(&drive) else {
            return Err(TestCaseError::reject("upright at the start"));
        };
        let far = 1.0 + side * drive.start.cos().signum();
        let exact = |t: f64| Some(far * length * drive.angle(t).cos());
        agrees(&text, &drive, "DX(41,1)", exact, None)?;
    }
}

/// A four-bar as a user's file has it: 8 output steps landed on the other branch once.
#[test]
fn a_crank_ends_in_one_place_whatever_is_put_out_on_the_way() {
    let bar = FourBar {
        crank: 0.5,
        coupler: 2.06,
        rocker: 1.0,
        base: 2.0,
        side: 1.0,
    };
    let drive = Drive {
        start: 0.25 * TAU,
        turn: 1.5 * TAU,
        duration: 1.0,
    };
    let text = bar.text(&drive).expect("it can be assembled");
    let ends = [4, 6, 7, 8, 20].map(|outputs| {
        let mut s = begin(model(&text), "crank", options(&["AZ(41,12)"], 1e-6));
        running::go(&mut s, Analysis::Kinematic, 1.0, outputs);
        running::last(&s, "AZ(41,12)").to_bits()
    });
    assert!(ends.iter().all(|e| *e == ends[0]), "{ends:?}");
}

/// KINEMATICS/HMAX bounds the steps, and nothing else comes out.
#[test]
fn kinematics_hmax_bounds_the_steps() {
    let crank = SliderCrank {
        crank: 1.0,
        rod: 3.0,
        height: 0.0,
        side: 1.0,
    };
    let drive = Drive {
        start: 0.3,
        turn: TAU,
        duration: 1.0,
    };
    let text = crank.text(&drive).expect("it can be assembled");
    let steps = |text: &str| {
        let mut s = begin(model(text), "crank", options(&["DX(41,1)"], 1e-6));
        running::go(&mut s, Analysis::Kinematic, 1.0, 3);
        let exact = |t: f64| crank.slider(drive.angle(t), 1.0).unwrap_or(f64::NAN);
        assert!(running::off(&s, "DX(41,1)", exact) < 1e-10);
        s.run.record.counts.steps
    };
    assert!(steps(&text) < 40);
    let many = steps(&format!("{text}KINEMATICS/HMAX=0.002\n"));
    assert!((500..540).contains(&many), "{many}");
}

/// A slider that begins at the dead point of its crank, at rest, and is drawn inwards: the crank may go either way, and none of
/// both. No row of results stands where the coupler does not reach; where it cannot go on the run stops and names what is in the way.
#[test]
fn a_drive_that_begins_at_a_dead_point_opens_no_loop() {
    for (crank, coupler) in [(0.3, 0.8), (1.0, 3.0), (20.0, 55.0)] {
        let far = crank + coupler;
        for law in ["0.3*TIME**2", "0.2*(1-COS(TIME))", "-0.1*TIME**4"] {
            let text = format!(
                "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/22, PART=2, QP={crank},0,0\n\
                 PART/3, QG={crank},0,0, MASS=1, CM=3, IP=1,1,1\nMARKER/3, PART=3\nMARKER/32, PART=3, QP={coupler},0,0\n\
                 PART/4, QG={far},0,0, MASS=1, CM=4, IP=1,1,1\nMARKER/4, PART=4\nMARKER/41, PART=4, REULER=90D,90D,0\n\
                 MARKER/12, PART=1, REULER=90D,90D,0\nJOINT/1, REVOLUTE, I=2, J=1\nJOINT/2, REVOLUTE, I=3, J=22\n\
                 JOINT/3, TRANSLATIONAL, I=41, J=12\nJPRIM/4, INLINE, I=32, J=4\n\
                 MOTION/1, JOINT=3, TRANSLATIONAL, FUNCTION={far}-{crank}*({law})\n"
            );
            let options = options(&["DM(32,4)"], 1e-8);
            let mut s = begin(model(&text), "dead point", options);
            let status = try_to(&mut s, Analysis::Kinematic, 1.0, 10);
            let open = s
                .run
                .column("DM(32,4)")
                .unwrap()
                .iter()
                .fold(0.0_f64, |m, x| m.max(*x));
            assert!(
                open < 1e-6 * far,
                "{crank}, {law}: the loop is open by {open}"
            );
            let reason = &s.run.record.stop_reason;
            assert!(
                status == Status::Completed || reason.contains("JPRIM/4"),
                "{law}: {reason}"
            );
        }
    }
}
