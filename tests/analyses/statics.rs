//! Equilibria against closed forms: rest by contact, chains, arches, springs; what is said when there is none.

use crate::running;

use cognate::results::Status;
use running::{Analysis, GROUND, Session, begin, go, last, options, rest, try_to, whole};

fn data(name: &str) -> String {
    let path = format!(
        "{}/tests/data/references/{name}",
        env!("CARGO_MANIFEST_DIR")
    );
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn session(text: &str, columns: &[&str]) -> Session {
    begin(whole(text), "test", options(columns, 1e-6))
}

fn reference(name: &str) -> Vec<Vec<f64>> {
    let text = data(name);
    let rows = text.lines().skip(1);
    rows.map(|l| l.split(',').map(|x| x.parse().unwrap()).collect())
        .collect()
}

fn stable(s: &Session) {
    let found = &s.run.record.method;
    assert!(found.ends_with("EQUILIBRIUM, stable"), "{found}");
}

/// Why a model finds no equilibrium.
fn cannot_rest(text: &str) -> String {
    let mut s = session(text, &[]);
    let status = try_to(&mut s, Analysis::Static, 0.0, 1);
    assert_eq!(status, Status::NoEquilibrium);
    s.run.record.stop_reason
}

#[test]
fn a_sphere_rests_as_deep_as_its_weight_presses_it() {
    let text = data("static_sphere.adm");
    for row in reference("static_sphere.csv") {
        let k = format!("{:E}", row[0]);
        let mut s = session(&text.replace("1.0E8,", &format!("{k},")), &["DZ(2,1)"]);
        rest(&mut s);
        let z = last(&s, "DZ(2,1)");
        println!("k {k}: {z} in {:?}", s.run.record.counts);
        assert!((z - row[1]).abs() < 1e-12, "{z} against {}", row[1]);
        stable(&s);
    }
}

#[test]
fn a_sphere_falls_onto_the_plane_it_did_not_touch() {
    let text = data("static_sphere.adm");
    let text = text.replace(
        "MARKER/4, PART=1, QP=0.0,0.0,0.05",
        "MARKER/4, PART=1, QP=0.0,0.0,-3",
    );
    let text = text.replace(
        "MARKER/3, PART=2, QP=0.0,0.0,0.05",
        "MARKER/3, PART=2, QP=0.0,0.0,-3",
    );
    let text = text.replace("PART/2,", "PART/2, QG=0,0,3,");
    let mut s = session(&text, &["DZ(2,1)"]);
    rest(&mut s);
    println!("{:?}", s.run.record.counts);
    assert!((last(&s, "DZ(2,1)") - 4.997_872_941_970_745e-2).abs() < 1e-12);
}

#[test]
fn a_chain_hangs_as_it_should_from_a_start_like_a_v() {
    let columns: Vec<String> = (1..20)
        .flat_map(|k| {
            let m = 22 + 2 * k;
            [format!("DX({m},1)"), format!("DY({m},1)")]
        })
        .collect();
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut s = session(&data("static_hanging_chain.adm"), &names);
    rest(&mut s);
    println!("{:?} {}", s.run.record.counts, s.run.record.method);
    for row in &reference("static_hanging_chain.csv")[1..20] {
        let m = 22 + 2 * row[0] as usize;
        for (k, d) in ["DX", "DY"].iter().enumerate() {
            let value = last(&s, &format!("{d}({m},1)"));
            assert!(
                (value - row[1 + k]).abs() < 1e-12,
                "{d} of joint {}: {value}",
                row[0]
            );
        }
    }
}

/// Two springs of free length 1 along x meet in a mass that is pressed down: the arch snaps through.
fn arch(load: f64) -> String {
    format!(
        "{GROUND}PART/2, MASS=1, CM=2, QG=0,0.3,0\nMARKER/2, PART=2\n\
         MARKER/11, PART=1, QP=-1,0,0\nMARKER/12, PART=1, QP=1,0,0\n\
         MARKER/3, PART=2, QP=0,0,0, REULER=0,90D,0\nMARKER/4, PART=1, QP=0,0.3,0, REULER=0,90D,0\n\
         MARKER/5, PART=1\n\
         JPRIM/1, INPLANE, I=2, J=5\nJPRIM/2, ORIENTATION, I=2, J=5\n\
         SPRINGDAMPER/1, TRANSLATION, I=2, J=11, K=100, C=1, LENGTH=1.0440306508910551\n\
         SPRINGDAMPER/2, TRANSLATION, I=2, J=12, K=100, C=1, LENGTH=1.0440306508910551\n\
         VFORCE/1, I=2, JFLOAT=99, RM=1, FX=0\\FY=-{load}\\FZ=0\nMARKER/99, PART=1, FLOATING\n\
         END\n"
    )
}

#[test]
fn an_arch_holds_a_light_load_and_snaps_through_under_a_heavy_one() {
    let free = 1.044_030_650_891_055_f64;
    let balance = |y: f64| {
        let d = (1.0 + y * y).sqrt();
        2.0 * 100.0 * (free - d) * y / d
    };
    for load in [0.5, 20.0] {
        let mut s = session(&arch(load), &["DY(2,1)", "DX(2,1)"]);
        rest(&mut s);
        let y = last(&s, "DY(2,1)");
        println!(
            "{load}: y = {y} {} {:?}",
            s.run.record.method, s.run.record.counts
        );
        assert!((balance(y) - load).abs() < 1e-9, "{} at {y}", balance(y));
        assert!(last(&s, "DX(2,1)").abs() < 1e-9);
        assert_eq!(y > 0.0, load < 1.0);
        stable(&s);
    }
}

fn pendulum(angle: &str) -> String {
    format!(
        "{GROUND}PART/2, MASS=2, CM=2, IP=0.1,0.1,0.1, REULER={angle},0,0\nMARKER/2, PART=2, QP=0,-1.5,0\n\
         MARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\nEND\n"
    )
}

#[test]
fn a_pendulum_comes_to_hang_and_its_joint_carries_its_weight() {
    for angle in ["30D", "90D", "179D"] {
        let mut s = session(
            &pendulum(angle),
            &["DX(2,1)", "JOINT(1,0,3,0)", "JOINT(1,0,8,0)"],
        );
        rest(&mut s);
        assert!(last(&s, "DX(2,1)").abs() < 1e-12);
        assert!((last(&s, "JOINT(1,0,3,0)") - 2.0 * 9.81).abs() < 1e-12);
        stable(&s);
    }
}

#[test]
fn a_pendulum_that_stands_on_its_head_stays_and_is_said_to_be_unstable() {
    let mut s = session(&pendulum("180D"), &["DY(2,1)"]);
    rest(&mut s);
    assert!((last(&s, "DY(2,1)") - 1.5).abs() < 1e-12);
    assert!(
        s.run.record.method.contains("unstable in 1 direction"),
        "{}",
        s.run.record.method
    );
    assert_eq!(s.run.record.warnings.len(), 1);
}

#[test]
fn what_falls_forever_is_named_with_its_direction() {
    let text = format!(
        "{GROUND}PART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2\nACCGRAV/ZGRAV=-9.81\nEND\n"
    )
    .replace("ZGRAV", "KGRAV");
    let why = cannot_rest(&text);
    assert!(
        why.contains("force of 19.62 on")
            && why.contains("PART/2")
            && why.contains("(0.000000, 0.000000, -1.000000)"),
        "{why}"
    );
}

#[test]
fn after_rest_a_simulation_begins_there() {
    let mut s = session(&pendulum("20D"), &["DX(2,1)", "VX(2,1)"]);
    rest(&mut s);
    go(&mut s, Analysis::Dynamic, 1.0, 10);
    let x = s.run.column("DX(2,1)").unwrap();
    assert!(x[1..].iter().all(|x| x.abs() < 1e-12), "{x:?}");
    let kinds: Vec<&str> = s.run.sequences.iter().map(|q| q.name.as_str()).collect();
    assert_eq!(
        kinds,
        ["initialConditions_001", "static_001", "dynamic_001"]
    );
}

#[test]
fn differential_equations_come_to_rest_or_are_held() {
    let with = |hold: &str| {
        format!(
            "{GROUND}PART/2, MASS=1, CM=2\nMARKER/2, PART=2\nMARKER/3, PART=1\n\
             JPRIM/1, ORIENTATION, I=2, J=3\n\
             DIFF/1, IC=0.5{hold}, FUNCTION=DX(2,1)-2*DIF(1)\n\
             VFORCE/1, I=2, JFLOAT=9, RM=1, FX=1-4*DX(2,1)+DIF(1)\\FY=-DY(2,1)\\FZ=-DZ(2,1)\nMARKER/9, PART=1, FLOATING\nEND\n"
        )
    };
    let mut s = session(&with(""), &["DX(2,1)", "DIF(1)"]);
    rest(&mut s);
    // x = 2 y, 1 = 4 x − y
    assert!((last(&s, "DX(2,1)") - 2.0 / 7.0).abs() < 1e-12);
    assert!((last(&s, "DIF(1)") - 1.0 / 7.0).abs() < 1e-12);
    let mut s = session(&with(", STATIC_HOLD"), &["DX(2,1)", "DIF(1)"]);
    rest(&mut s);
    assert_eq!(last(&s, "DIF(1)"), 0.5);
    assert!((last(&s, "DX(2,1)") - 1.5 / 4.0).abs() < 1e-12);
}

#[test]
fn a_sequence_of_equilibria_follows_a_motion() {
    let text = pendulum("0D").replace(
        "ACCGRAV",
        "MARKER/7, PART=1, QP=0,0,0\nPART/3\nMARKER/8, PART=3\nMARKER/9, PART=3\nJOINT/2, TRANSLATIONAL, I=8, J=12\nMARKER/12, PART=1, REULER=90D,90D,0\nACCGRAV",
    );
    let text = text.replace("JOINT/1, REVOLUTE, I=3, J=1", "JOINT/1, REVOLUTE, I=3, J=9");
    let text = text.replace("MARKER/8, PART=3\n", "MARKER/8, PART=3, REULER=90D,90D,0\n");
    let text = text.replace(
        "ACCGRAV",
        "MOTION/1, JOINT=2, TRANSLATION, FUNCTION=TIME\nACCGRAV",
    );
    let mut s = session(&text, &["DX(2,1)", "DY(2,1)", "VX(2,1)"]);
    go(&mut s, Analysis::Static, 2.0, 4);
    let x = s.run.column("DX(2,1)").unwrap();
    for (a, b) in x[1..].iter().zip([0.5, 1.0, 1.5, 2.0]) {
        assert!((a - b).abs() < 1e-12, "{x:?}");
    }
    assert!(
        s.run.column("VX(2,1)").unwrap()[1..]
            .iter()
            .all(|v| *v == 0.0)
    );
    assert_eq!(s.run.sequences[1].name, "quasiStatic_001");
}

/// Between equilibria no time passes: what a rate drives stays where it is, and that is told; of a rate of zero, of a displacement,
/// and of a single equilibrium there is nothing to tell.
#[test]
fn a_rate_that_drives_nothing_between_equilibria_is_told() {
    let run = |function: &str, end: f64| {
        let text = format!(
            "RATE\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
             JOINT/1, REVOLUTE, I=2, J=1\nMOTION/1, JOINT=1, ROTATION, {function}\nEND\n"
        );
        let mut s = session(&text, &["AZ(2,1)"]);
        go(&mut s, Analysis::Static, end, 2);
        let told = s
            .run
            .record
            .warnings
            .iter()
            .filter(|w| w.sentence().contains("MOTION/1"));
        (told.count(), last(&s, "AZ(2,1)"))
    };
    assert_eq!(run("VELOCITY, FUNCTION=1", 1.0), (1, 0.0));
    assert_eq!(run("ACCELERATION, FUNCTION=TIME", 1.0), (1, 0.0));
    assert_eq!(run("VELOCITY, FUNCTION=0.0", 1.0), (0, 0.0));
    assert_eq!(run("VELOCITY, FUNCTION=1", 0.0), (0, 0.0));
    let (told, angle) = run("FUNCTION=TIME", 1.0);
    assert!(told == 0 && (angle - 1.0).abs() < 1e-12);
}

/// The hook of a crane as datasets write it: a state that is sought makes the force. It follows at once; a state that came to rest in its own time would be too
/// late for a spring so stiff, and the load would be thrown up and down.
#[test]
fn a_force_made_by_a_state_holds_a_load() {
    let text = "HOOK\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/KGRAV=-9.81\n\
                PART/2, MASS=1000, CM=2, IP=1,1,1, QG=0,0,0.5\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
                DIFF/1, IC=0, FUNCTION=IF(MODE-5: 0, -DIF(1)-1E7*(DZ(2,1)-0.2), 0)\n\
                SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=DIF(1)\nEND\n";
    let mut s = session(text, &["DZ(2,1)", "DIF(1)"]);
    rest(&mut s);
    println!("{:?}", s.run.record.counts);
    // a weight of 9810 N on 1e7 N/m; forces are balanced to 1e-13 of those there were
    assert!((last(&s, "DZ(2,1)") - (0.2 - 9.81e-4)).abs() < 1e-10);
    assert!((last(&s, "DIF(1)") - 9810.0).abs() < 1e-3);
    assert!(s.run.record.counts.steps < 60, "{:?}", s.run.record.counts);
}

/// Three arms of a rotor on stiff bushings: what lies 20 m from where it is held has its place rounded to 4e-15 m, which a stiffness of 1e9 makes a force
/// of 4e-6 and its lever a moment of 7e-5. The heaviest arm swings down by a moment of 0.2 all the same.
#[test]
fn a_rotor_of_stiff_arms_swings_down() {
    use std::fmt::Write;
    // the bushings at the axis, and two metres away from it
    for (radius, begin) in [(0.0, 37.0_f64), (2.0, 47.0)] {
        let mut text = "ROTOR\nPART/1, GROUND\nMARKER/10, PART=1, REULER=90D,90D,0D\n\
                        PART/2, MASS=50, CM=20, IP=10,10,10\nMARKER/20, PART=2\nMARKER/21, PART=2, REULER=90D,90D,0D\n\
                        JOINT/1, REVOLUTE, I=21, J=10\nACCGRAV/KGRAV=-9.80665\n"
            .to_string();
        for (k, mass) in [100.0, 100.0, 100.001].into_iter().enumerate() {
            let (s, c) = (120.0 * k as f64 + begin).to_radians().sin_cos();
            let (p, inward) = (k + 3, radius - 20.0);
            write!(
                text,
                "PART/{p}, MASS={mass}, CM={p}0, IP=1000,1000,10, QG=0,{},{}\nMARKER/{p}0, PART={p}\n\
                 MARKER/{p}1, PART={p}, QP=0,{},{}\nMARKER/{p}2, PART=2, QP=0,{},{}\n\
                 BUSHING/{p}, I={p}1, J={p}2, K=1E9,1E9,1E9, KT=1E8,1E8,1E8\n",
                20.0 * c,
                20.0 * s,
                inward * c,
                inward * s,
                radius * c,
                radius * s,
            )
            .unwrap();
        }
        let mut s = session(&(text + "END\n"), &["DZ(50)", "DY(50)"]);
        rest(&mut s);
        let record = &s.run.record;
        println!("{} {:?}", record.method, record.counts);
        assert!(record.method.contains("stable"), "{}", record.method);
        // the heaviest arm hangs down, as well as its moment of 0.2 per radian is told from the rounding of 7e-5
        let (z, y) = (last(&s, "DZ(50)"), last(&s, "DY(50)"));
        assert!(z < -19.9 && y.abs() < 20.0 * 2e-3, "{y} {z}");
        assert!(record.counts.steps < 200, "{:?}", record.counts);
    }
}

/// A part that turns about a point on a bushing, and a state that only reads.
fn read_by(function: &str) -> String {
    let state = if function.is_empty() {
        String::new()
    } else {
        format!("DIFF/1, IC=-1.5, FUNCTION={function}\n")
    };
    format!(
        "{GROUND}MARKER/10, PART=1, QP=0.31,0.73,-0.27\nMARKER/11, PART=1, QP=1.1,-0.4,0.6\n\
         PART/2, MASS=2, CM=20, IP=0.3,0.4,0.5, QG=0.14,1.02,-0.68\nMARKER/20, PART=2, QP=0.57,0.21,0.71\n\
         MARKER/21, PART=2, QP=0.17,-0.29,0.41\nMARKER/22, PART=2, QP=0.77,-0.59,0.61, REULER=0.4,0.7,-0.3\n\
         JPRIM/1, ATPOINT, I=21, J=10\nACCGRAV/IGRAV=3, JGRAV=-9, KGRAV=2\n\
         BUSHING/1, I=22, J=11, K=30,40,20, KT=5,8,4, FORCE=1,-2,1\n{state}END\n"
    )
}

#[test]
fn a_state_that_only_reads_does_not_keep_a_mechanism_from_its_rest() {
    let columns = ["DX(20)", "DY(20)", "DZ(20)"];
    let found = |text: &str| {
        let mut s = session(text, &columns);
        rest(&mut s);
        stable(&s);
        columns.map(|c| last(&s, c))
    };
    let alone = found(&read_by(""));
    // distances that the joint keeps, so that only rounding changes them; what moves; angles
    let read = [
        "DM(20,21)",
        "DY(21)",
        "DX(21)-3*DZ(21)",
        "DM(22,11)",
        "DX(20)*DZ(20)",
        "AX(20)",
        "PITCH(22)",
        "-DIF(1)**3",
    ];
    for read in read {
        for (own, gain) in [(1.1, 0.3), (0.013, 1.9), (700.0, 900.0)] {
            let text = read_by(&format!("-{own}*DIF(1)+{gain}*({read})"));
            let with = found(&text);
            for (a, b) in alone.iter().zip(with) {
                assert!((a - b).abs() < 1e-9, "{read}, {own}: {b} against {a}");
            }
        }
    }
}

#[test]
fn what_integrates_a_velocity_winds_up_until_it_holds_the_load() {
    let text = format!(
        "{GROUND}PART/2, MASS=2, CM=2, IP=1,1,1, QG=0,0,3\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\nACCGRAV/KGRAV=-9.81\n\
         DIFF/1, IC=0.25, FUNCTION=VZ(2,1)\nSFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=-1E4*DIF(1)\nEND\n"
    );
    let mut s = session(&text, &["DZ(2,1)", "DIF(1)"]);
    rest(&mut s);
    println!("{} {:?}", s.run.record.method, s.run.record.counts);
    let wound = -2.0 * 9.81 / 1e4;
    assert!((last(&s, "DIF(1)") - wound).abs() < 1e-12);
    // it sinks by as much as it winds up
    assert!((last(&s, "DZ(2,1)") - (3.0 + wound - 0.25)).abs() < 1e-9);
    stable(&s);
}

#[test]
fn of_what_moves_the_load_that_nothing_carries_is_named() {
    // the light part is pushed against a stop it can reach; the heavy one, tied to a third, has nothing below
    let text = format!(
        "{GROUND}PART/2, MASS=1E-3, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=5-1E-3*DZ(2,1)\n\
         PART/3, MASS=10, CM=3, IP=1,1,1, QG=5,0,0\nMARKER/3, PART=3\nPART/4, MASS=1, CM=4, IP=1,1,1, QG=5,1,0\nMARKER/4, PART=4\n\
         MARKER/5, PART=4, QP=0,-1,0\nBUSHING/1, I=5, J=3, K=1E5,1E5,1E5, KT=1E3,1E3,1E3\nACCGRAV/KGRAV=-9.81\nEND\n"
    );
    let why = cannot_rest(&text);
    assert!(
        why.contains("force of 98.1 on")
            && why.contains("on PART/3")
            && why.contains("(0.000000, 0.000000, -1.000000)")
            && why.contains("nothing carries it"),
        "{why}"
    );
}

/// A part on a hinge with friction, held by a beam: what is left at rest is rounding, and little of the loads alone.
const HELD_BY_A_BEAM: &str = "\
a beam in kN, t, cm, ms
UNITS/FORCE=KNEWTON, MASS=TONNE, LENGTH=CENTIMETER, TIME=MILLISECOND
PART/1, GROUND
MARKER/1001, PART=1, QP=0.0,0.0,0.0, REULER=0.0,0.0,0.0
PART/2, MASS=0.00013971780233207936, CM=1002, IP=0.06585109564022029,0.06501122407159378,0.03939399507502695,0.0020914810493940224,0.0002563556583389809,-0.005341030167415254
, QG=23.17571595696437,51.041051226916935,5.422380477715105, REULER=-1.5183884976305717,2.1848559460833212,-1.2539039820108102
MARKER/1002, PART=2, QP=14.832555622298443,-7.373677385439673,12.314031797767377
ACCGRAV/IGRAV=0.00028808349811592585, JGRAV=-0.0003912404637200311, KGRAV=-0.0008522322439695804
MARKER/1003, PART=2, QP=12.596438034751639,7.905400981269309,44.38486164416224, REULER=1.1329158184570145,0.6684959442649572,-0.2387477208563088
MARKER/1004, PART=1, QP=-6.982176392502631,38.006349300082036,-27.9209791869309, REULER=-1.7734698122406423,2.840598740660216,-0.5779452063164725
JOINT/1, REVOLUTE, I=1003, J=1004
FRICTION/1, JOINT=1, MU_STATIC=0.26244764421640465, MU_DYNAMIC=0.2018828032433882, STICTION_TRANSITION_VELOCITY=0.017706716876741784, MAX_STICTION_DEFORMATION=0.1
, PIN_RADIUS=7.495068006882363, FRICTION_ARM=7.495068006882363, BENDING_REACTION_ARM=30.0
MARKER/1005, PART=2, QP=2.6422262006549597,25.808681131400945,13.95758310532118, REULER=-2.326334236419932,0.325664568227154,-2.859518166535659
MARKER/1006, PART=1, QP=-1.1439340909024487,73.52868646089786,6.249267819564519, REULER=-1.3750152981608705,1.8851163118266112,-0.09156691439858555
BEAM/1, I=1005, J=1006, LENGTH=50.0, AREA=3.925372290543761, IXX=2.452346519489396, IYY=1.226173259744698, IZZ=1.5940252376681074
, ASY=1.1, ASZ=1.2, EMODULUS=235.71944184464618, GMODULUS=90.66132378640236, CRATIO=1.4511609643632384
END
";

#[test]
fn what_is_at_rest_is_found_at_rest_once_more() {
    let mut s = begin(
        whole(HELD_BY_A_BEAM),
        "test",
        options(&["AZ(1003,1004)"], 1e-6),
    );
    for _ in 0..3 {
        go(&mut s, Analysis::Static, 0.0, 1);
    }
    assert!(s.run.record.counts.steps < 200, "{:?}", s.run.record.counts);
}

#[test]
fn what_is_at_rest_stays_so_in_any_units() {
    // a part on a hinge with friction, held by a beam; units of length, of time and of mass in those of a metre, a second, a kilogram
    for (long, short, heavy) in [
        (1.0_f64, 1.0, 1.0),
        (100.0, 1000.0, 0.001),
        (1000.0, 1.0, 1.0),
        (39.37, 1.0, 2.2),
    ] {
        let force = heavy * long / (short * short);
        let [area, bending, elastic] = [
            4e-4 * long * long,
            1.2e-8 * long.powi(4),
            2.36e9 * force / (long * long),
        ];
        let inertia = 0.006 * heavy * long * long;
        let text = format!(
            "{GROUND}PART/2, MASS={}, CM=20, IP={inertia},{inertia},{inertia}, QG={},0,0\nMARKER/20, PART=2, QP={},{},0\nMARKER/21, PART=2\n\
             MARKER/11, PART=1, QP={},0,0\nJOINT/1, REVOLUTE, I=21, J=11\nFRICTION/1, JOINT=1, MU_STATIC=0.26, MU_DYNAMIC=0.2, \
             PIN_RADIUS={}, FRICTION_ARM={}, BENDING_REACTION_ARM={}\nMARKER/22, PART=2, QP={},0,0\nMARKER/12, PART=1\n\
             BEAM/1, I=22, J=12, LENGTH={}, AREA={area}, IXX={bending}, IYY={bending}, IZZ={bending}, EMODULUS={elastic}, GMODULUS={}\n\
             ACCGRAV/JGRAV={}\nEND\n",
            0.14 * heavy,
            0.2 * long,
            0.1 * long,
            0.03 * long,
            0.2 * long,
            0.05 * long,
            0.05 * long,
            0.3 * long,
            0.3 * long,
            0.5 * long,
            elastic / 2.6,
            -9.81 * long / (short * short),
        );
        let mut s = session(&text, &["DY(20,11)"]);
        for _ in 0..4 {
            go(&mut s, Analysis::Static, 0.0, 1);
        }
        let drops = &s
            .run
            .columns
            .iter()
            .find(|c| c.name == "DY(20,11)")
            .expect("a column")
            .values;
        let rest = &drops[drops.len() - 3..];
        assert!(
            rest.iter().all(|y| (y - rest[0]).abs() < 1e-9 * long),
            "{rest:?}"
        );
    }
}

/// A weight that has to sink by 49 on its spring, in steps of at most TLIMIT: where that is too short for all steps there are, it
/// is named.
#[test]
fn a_limit_of_steps_is_obeyed_and_named_where_it_ends_the_search() {
    let text = |limit: f64| {
        format!(
            "{GROUND}PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\nACCGRAV/KGRAV=-9.81\n\
             SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=-0.2*DZ(2,1)\nEQUILIBRIUM/TLIMIT={limit}\nEND\n"
        )
    };
    let mut s = session(&text(0.5), &["DZ(2,1)"]);
    rest(&mut s);
    assert!((last(&s, "DZ(2,1)") + 49.05).abs() < 1e-9);
    assert!(s.run.record.counts.steps >= 98, "{:?}", s.run.record.counts);
    let why = cannot_rest(&text(1e-3));
    assert!(why.contains("TLIMIT"), "{why}");
}
