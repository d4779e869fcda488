//! Compliance: what the laws of SPRINGDAMPER, BUSHING, FIELD, BEAM and NFORCE must obey, whatever their numbers.
#![allow(non_snake_case)]

use crate::running;

use cognate::expr::measures::Measure;
use cognate::internals::physics::action::Law;
use cognate::internals::physics::beam::Section;
use cognate::internals::physics::field::Field;
use cognate::internals::physics::kinematic::kinematic;
use cognate::internals::space::{MarkerState, Mat3, Vec3, rotation};
use cognate::scalar::{Dual, Scalar};
use running::{Analysis, Session, last, refused, run, values};

fn solve(text: &str, columns: &[&str], analysis: Analysis, end: f64) -> Session {
    run(text, columns, analysis, (end, 20), 1e-10)
}

/// Numbers of a matrix by columns.
fn by_columns(k: &[[f64; 6]; 6]) -> String {
    let all: Vec<String> = (0..36).map(|n| format!("{:?}", k[n % 6][n / 6])).collect();
    all.join(",")
}

/// A symmetric, positive matrix that couples everything.
fn coupled(size: f64) -> [[f64; 6]; 6] {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let coupling = 0.1 * ((r * c) as f64 + (r + c) as f64).sin();
            size * if r == c {
                1.0 + 0.2 * r as f64
            } else {
                coupling
            }
        })
    })
}

/// A body that moves in a plane, with whatever acts on it between its marker 2 and marker 1 of ground.
const PLANAR: &str = "PART/2, MASS=2, CM=2, IP=0.4,0.5,0.6, QG=1.2,0.3,0, REULER=0.4,0,0, VX=0.5, VY=-0.4, WZ=3\n\
                      MARKER/2, PART=2\nJOINT/1, PLANAR, I=2, J=1\n";

/// `stored` + kinetic + ∫ `lost` keeps its value.
fn accounts_for_energy(text: &str, stored: &str, lost: &str) {
    let kinetic = "VM(2,1)**2+0.3*WZ(2,1)**2";
    let text = format!("{PLANAR}{text}DIFF/1, FUNCTION={lost}\nVARIABLE/1, FUNCTION={stored}\n");
    let total = format!("{kinetic}+VARVAL(1)+DIF(1)");
    let s = solve(
        &text,
        &[&total, "VARVAL(1)", "DIF(1)"],
        Analysis::Dynamic,
        3.0,
    );
    let total = values(&s, &total);
    let moved = values(&s, "VARVAL(1)");
    let swing = moved
        .iter()
        .fold(0.0, |m: f64, x| m.max((x - moved[0]).abs()));
    assert!(swing > 0.05, "nothing happens: {text}");
    for e in total {
        // a thousand times the local error that was asked for
        assert!(
            (e - total[0]).abs() < 1e-7 * total[0].abs().max(1.0),
            "{e} {total:?} {text}"
        );
    }
    if lost != "0" {
        let lost = values(&s, "DIF(1)");
        assert!(
            lost.windows(2).all(|w| w[1] >= w[0]) && lost[20] > 0.01,
            "{lost:?}"
        );
    }
}

#[test]
fn energy_of_a_spring_damper_is_accounted_for() {
    accounts_for_energy(
        "SPRINGDAMPER/1, TRANSLATION, I=2, J=1, K=40, C=0.7, LENGTH=0.8, FORCE=3\n",
        "20*(DM(2,1)-0.8)**2-3*DM(2,1)",
        "0.7*VR(2,1)**2",
    );
    // more than one turn
    accounts_for_energy(
        "SPRINGDAMPER/1, ROTATION, I=2, J=1, KT=0.02, CT=0.01, ANGLE=30D, TORQUE=0.1\n",
        "0.01*(AZ(2,1)-30D)**2-0.1*AZ(2,1)",
        "0.01*WZ(2,1)**2",
    );
}

#[test]
fn energy_of_a_bushing_is_accounted_for() {
    accounts_for_energy(
        "BUSHING/1, I=2, J=1, K=40,30,20, KT=1,2,3, C=0.7,0.6,0.5, CT=0.1,0.2,0.3, FORCE=1,2,3, TORQUE=0.1,0.2,0.3\n",
        "20*DX(2,1)**2+15*DY(2,1)**2+1.5*AZ(2,1)**2-DX(2,1)-2*DY(2,1)-0.3*AZ(2,1)",
        "0.7*VX(2,1)**2+0.6*VY(2,1)**2+0.3*WZ(2,1)**2",
    );
}

#[test]
fn energy_of_a_field_is_accounted_for() {
    let k = coupled(10.0);
    let x = ["(DX(2,1)-0.5)", "DY(2,1)", "(AZ(2,1)-0.1)"];
    let v = ["VX(2,1)", "VY(2,1)", "WZ(2,1)"];
    let form = |x: [&str; 3], factor: f64| {
        let mut sum = vec![];
        for (r, a) in [0, 1, 5].into_iter().zip(x) {
            for (c, b) in [0, 1, 5].into_iter().zip(x) {
                sum.push(format!("({:?})*{a}*{b}", factor * k[r][c]));
            }
        }
        sum.join("+")
    };
    let statement = |more: &str| {
        format!(
            "FIELD/1, I=2, J=1, KMATRIX={}, LENGTH=0.5,0,0,0,0,0.1, FORCE=1,0,0,0,0,-1{more}\n",
            by_columns(&k)
        )
    };
    let stored = format!("{}-DX(2,1)+AZ(2,1)", form(x, 0.5));
    accounts_for_energy(&statement(""), &stored, "0");
    accounts_for_energy(&statement(", CRATIO=0.01"), &stored, &form(v, 0.01));
    let c = by_columns(&k.map(|row| row.map(|x| 0.02 * x)));
    accounts_for_energy(
        &statement(&format!(", CMATRIX={c}")),
        &stored,
        &form(v, 0.02),
    );
}

const SECTION: Section = Section {
    length: 2.0,
    area: 0.01,
    second_moments: [2e-5, 1e-5, 3e-5],
    shear: [1.2, 1.1],
    youngs_modulus: 1e6,
    shear_modulus: 4e5,
};

fn beam(more: &str) -> String {
    let s = SECTION;
    let [jx, iyy, izz] = s.second_moments;
    format!(
        "BEAM/1, I=2, J=1, LENGTH=2, IXX={jx:?}, IYY={iyy:?}, IZZ={izz:?}, AREA=0.01, ASY=1.2, ASZ=1.1, EMODULUS=1E6, GMODULUS=4E5{more}\n"
    )
}

#[test]
fn energy_of_a_beam_is_accounted_for() {
    // Timoshenko's cantilever in the plane: P = 12 E I_zz ASY/(G A L²) is what shear adds
    let (e, g, area, i, l) = (1e6, 4e5, 0.01, 3e-5, 2.0);
    let p = 12.0 * e * i * 1.2 / (g * area * l * l);
    let mut k = [[0.0; 6]; 6];
    k[0][0] = e * area / l;
    k[1][1] = 12.0 * e * i / (l * l * l * (1.0 + p));
    k[1][5] = -6.0 * e * i / (l * l * (1.0 + p));
    k[5][1] = k[1][5];
    k[5][5] = (4.0 + p) * e * i / (l * (1.0 + p));
    let stored = format!(
        "0.5*({:?})*(DX(2,1)-2)**2+0.5*({:?})*DY(2,1)**2+({:?})*DY(2,1)*AZ(2,1)+0.5*({:?})*AZ(2,1)**2",
        k[0][0], k[1][1], k[1][5], k[5][5]
    );
    accounts_for_energy(&beam(", CRATIO=0"), &stored, "0");
    // a hundredth of the stiffness unless something else is said
    let lost = |r: f64| {
        format!(
            "({:?})*VX(2,1)**2+({:?})*VY(2,1)**2+({:?})*VY(2,1)*WZ(2,1)+({:?})*WZ(2,1)**2",
            r * k[0][0],
            r * k[1][1],
            2.0 * r * k[1][5],
            r * k[5][5]
        )
    };
    accounts_for_energy(&beam(""), &stored, &lost(0.01));
    accounts_for_energy(&beam(", CRATIO=0.003"), &stored, &lost(0.003));
    let triangle: Vec<String> = (0..6)
        .flat_map(|r| (0..=r).map(move |c| (r, c)))
        .map(|(r, c)| format!("{:?}", 0.002 * k[r][c]))
        .collect();
    accounts_for_energy(
        &beam(&format!(", CMATRIX={}", triangle.join(","))),
        &stored,
        &lost(0.002),
    );
}

/// Two bodies in space, with inertia like a ball's, and nothing but what acts between their markers 22 and 32.
const PAIR: &str = "PART/2, MASS=2, CM=2, IP=0.5,0.5,0.5, VX=0.3, WX=0.2, WY=-0.3, WZ=0.4\nMARKER/2, PART=2\n\
                    MARKER/22, PART=2, QP=0.1,0.2,0, REULER=0.1,0.2,0.3\nMARKER/23, PART=2, QP=0,0,0.3\n\
                    PART/3, MASS=1, CM=3, IP=0.2,0.2,0.2, QG=1,0.5,-0.3, VY=0.4, WX=0.5\nMARKER/3, PART=3\n\
                    MARKER/32, PART=3, QP=-0.2,0,0.1, REULER=-0.1,0.1,0\n";

fn nforce() -> String {
    let numbers: Vec<String> = (0..144)
        .map(|n| {
            let (r, c) = (n / 12, n % 12);
            let x = if r == c {
                8.0 + r as f64
            } else {
                (r as f64 - c as f64).abs().sin()
            };
            format!("{x:?}")
        })
        .collect();
    format!(
        "NFORCE/1, IMARKERS=22,23, J=32, KMATRIX=1, CRATIO=0.01, FORCE=2\n\
         MATRIX/1, FULL=RORDER, ROWS=12, COLUMNS=12, VALUES={}\n\
         MATRIX/2, FULL=CORDER, ROWS=12, COLUMNS=1, VALUES=1,2,3,0,0,0,0,0,0,0,0,1\n",
        numbers.join("\n,")
    )
}

#[test]
fn action_and_reaction_leave_no_momentum() {
    let field = format!(
        "FIELD/1, I=22, J=32, KMATRIX={}, CRATIO=0.02, FORCE=1,2,3,4,5,6\n",
        by_columns(&coupled(5.0))
    );
    let beam = "BEAM/1, I=22, J=32, LENGTH=1, IXX=2E-5, IYY=1E-5, IZZ=3E-5, AREA=0.001, EMODULUS=1E5, GMODULUS=4E4\n";
    let bushing = "BUSHING/1, I=22, J=32, K=4,5,6, KT=1,2,3, C=0.1,0.2,0.3, CT=0.1,0.2,0.3, FORCE=1,2,3, TORQUE=4,5,6\n";
    let spring = "SPRINGDAMPER/1, TRANSLATION, I=22, J=32, K=10, C=1, LENGTH=0.3\n\
                  SPRINGDAMPER/2, ROTATION, I=22, J=32, KT=3, CT=0.1\n";
    let momentum: Vec<String> = ["X", "Y", "Z"]
        .iter()
        .map(|k| format!("2*V{k}(2)+V{k}(3)"))
        .chain([("X", "Y", "Z"), ("Y", "Z", "X"), ("Z", "X", "Y")].map(|(k, a, b)| {
            format!("0.5*W{k}(2)+2*(D{a}(2)*V{b}(2)-D{b}(2)*V{a}(2))+0.2*W{k}(3)+D{a}(3)*V{b}(3)-D{b}(3)*V{a}(3)")
        }))
        .collect();
    let columns: Vec<&str> = momentum
        .iter()
        .map(String::as_str)
        .chain(["VM(2)"])
        .collect();
    for law in [field.as_str(), beam, bushing, spring, &nforce()] {
        let s = solve(&format!("{PAIR}{law}"), &columns, Analysis::Dynamic, 2.0);
        for column in &momentum {
            let all = values(&s, column);
            assert!(
                all.iter().all(|p| (p - all[0]).abs() < 1e-8),
                "{law} {column} {all:?}"
            );
        }
        assert!(
            (values(&s, "VM(2)")[0] - last(&s, "VM(2)")).abs() > 1e-3,
            "{law}"
        );
    }
}

#[test]
fn measures_of_an_element_give_action_and_reaction_with_the_moment_of_transfer() {
    let field = format!(
        "FIELD/1, I=22, J=32, KMATRIX={}\n",
        by_columns(&coupled(5.0))
    );
    let beam = "BEAM/1, I=22, J=32, LENGTH=1, IXX=2E-5, IYY=1E-5, IZZ=3E-5, AREA=0.001, EMODULUS=1E5, GMODULUS=4E4\n";
    for (name, law) in [("FIELD", field.as_str()), ("BEAM", beam)] {
        let of = |flag: u32, k: u32| format!("{name}(1,{flag},{k},0)");
        let mut columns: Vec<String> = (0..2)
            .flat_map(|f| (1..9).map(move |k| (f, k)))
            .map(|(f, k)| of(f, k))
            .collect();
        columns.extend(
            [
                "DX(22,32)",
                "DY(22,32)",
                "DZ(22,32)",
                "FX(22,32)",
                "TY(32,22)",
                &format!("{name}(1,0,2,32)"),
            ]
            .map(String::from),
        );
        let names: Vec<&str> = columns.iter().map(String::as_str).collect();
        let s = solve(&format!("{PAIR}{law}"), &names, Analysis::Dynamic, 0.5);
        let get = |c: &str| last(&s, c);
        let vector = |flag: u32, first: u32| Vec3([0, 1, 2].map(|k| get(&of(flag, first + k))));
        let d = Vec3(["DX(22,32)", "DY(22,32)", "DZ(22,32)"].map(get));
        let (f, t) = (vector(0, 2), vector(0, 6));
        let (fj, tj) = (vector(1, 2), vector(1, 6));
        assert!((f + fj).norm() < 1e-12 * f.norm());
        assert!((tj + t + d.cross(f)).norm() < 1e-12 * tj.norm());
        assert!(
            (get(&of(0, 1)) - f.norm()).abs() < 1e-12 && (get(&of(1, 5)) - tj.norm()).abs() < 1e-12
        );
        assert_eq!((get("FX(22,32)"), get("TY(32,22)")), (f.0[0], tj.0[1]));
        assert!(
            (get(&format!("{name}(1,0,2,32)")) - f.0[0]).abs() > 1e-6,
            "another frame"
        );
    }
}

#[test]
fn what_acts_on_the_markers_of_an_nforce_balances() {
    let at = |m: u32, k: u32| format!("NFORCE(1,{m},{k},0)");
    let mut columns: Vec<String> = [22, 23, 32]
        .iter()
        .flat_map(|&m| (2..9).map(move |k| at(m, k)))
        .collect();
    for m in [22, 23, 32] {
        columns.extend(["X", "Y", "Z"].map(|k| format!("D{k}({m})")));
    }
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let s = solve(
        &format!("{PAIR}{}", nforce()),
        &names,
        Analysis::Dynamic,
        0.5,
    );
    let vector = |m: u32, first: u32| Vec3([0, 1, 2].map(|k| last(&s, &at(m, first + k))));
    let (mut force, mut torque) = (Vec3::zero(), Vec3::zero());
    for m in [22, 23, 32] {
        let p = Vec3(["X", "Y", "Z"].map(|k| last(&s, &format!("D{k}({m})"))));
        force += vector(m, 2);
        torque += vector(m, 6) + p.cross(vector(m, 2));
    }
    assert!(vector(22, 2).norm() > 1.0 && force.norm() < 1e-12 && torque.norm() < 1e-12);
}

#[test]
fn without_deformation_there_is_no_force() {
    let k = by_columns(&coupled(5.0));
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1, QG=1,2,3, REULER=0.5,0.4,0.3\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=0.5,0,0\n\
         MARKER/4, PART=1, QP=1,2,3, REULER=0.5,0.4,0.3\nMARKER/5, PART=2, QP=0,0,0.7, REULER=90D,0,0\n\
         FIELD/1, I=2, J=4, KMATRIX={k}, CRATIO=0.1\nFIELD/2, I=5, J=4, KMATRIX={k}, CRATIO=0.1, LENGTH=0,0,0.7,0,0,90D\n\
         BEAM/1, I=3, J=4, LENGTH=0.5, IXX=1, IYY=1, IZZ=1, AREA=1, EMODULUS=1E3, GMODULUS=1E3\n\
         BUSHING/1, I=2, J=4, K=1,2,3, KT=1,2,3\nSPRINGDAMPER/1, TRANSLATION, I=5, J=4, K=100, LENGTH=0.7\n\
         SPRINGDAMPER/2, ROTATION, I=5, J=4, KT=100, ANGLE=90D\n"
    );
    let names = ["FIELD(1", "FIELD(2", "BEAM(1", "BUSH(1", "SPDP(1", "SPDP(2"];
    let columns: Vec<String> = names
        .iter()
        .flat_map(|n| [1, 5].map(|c| format!("{n},0,{c},0)")))
        .collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let s = solve(&text, &columns, Analysis::Dynamic, 0.1);
    for column in columns {
        // rounding of stiffnesses of at most 1e4
        assert!(values(&s, column)[0].abs() < 1e-11, "{column}");
    }
}

#[test]
fn a_beam_bends_as_the_cantilever_of_the_books() {
    let s = SECTION;
    let [jx, iyy, izz] = s.second_moments;
    let (l, e, g, a) = (s.length, s.youngs_modulus, s.shear_modulus, s.area);
    let (f, m) = (0.3, 0.2);
    let tip = "PART/2, MASS=1, CM=2, IP=1,1,1, QG=2,0,0\nMARKER/2, PART=2\n";
    let loaded = |force: &str| {
        let load = format!("GFORCE/1, I=2, JFLOAT=9, RM=1, {force}\nMARKER/9, PART=1, FLOATING\n");
        let columns = [
            "DX(2,1)", "DY(2,1)", "DZ(2,1)", "AX(2,1)", "AY(2,1)", "AZ(2,1)",
        ];
        let s = solve(
            &format!("{tip}{}{load}", beam("")),
            &columns,
            Analysis::Static,
            0.0,
        );
        columns.map(|c| last(&s, c))
    };
    let all = |force: &str, expected: [f64; 6]| {
        let x = loaded(force);
        for (x, e) in x.iter().zip(expected) {
            // the law is linear in these very numbers; what is left is where Newton's iteration ends
            assert!((x - e).abs() < 1e-9, "{force}: {x} instead of {e}");
        }
    };
    all("FX=0.3", [l + f * l / (e * a), 0.0, 0.0, 0.0, 0.0, 0.0]);
    let y = f * l.powi(3) / (3.0 * e * izz) + 1.2 * f * l / (g * a);
    all("FY=0.3", [l, y, 0.0, 0.0, 0.0, f * l * l / (2.0 * e * izz)]);
    let z = f * l.powi(3) / (3.0 * e * iyy) + 1.1 * f * l / (g * a);
    all(
        "FZ=0.3",
        [l, 0.0, z, 0.0, -f * l * l / (2.0 * e * iyy), 0.0],
    );
    all("TX=0.2", [l, 0.0, 0.0, m * l / (g * jx), 0.0, 0.0]);
    all(
        "TY=0.2",
        [
            l,
            0.0,
            -m * l * l / (2.0 * e * iyy),
            0.0,
            m * l / (e * iyy),
            0.0,
        ],
    );
    all(
        "TZ=0.2",
        [
            l,
            m * l * l / (2.0 * e * izz),
            0.0,
            0.0,
            0.0,
            m * l / (e * izz),
        ],
    );
}

#[test]
fn the_same_law_written_in_different_statements_moves_alike() {
    let body = "PART/2, MASS=2, CM=2, IP=0.4,0.5,0.6, QG=2.1,0.1,-0.1, VX=0.1, VY=-0.2, WZ=0.3, WX=0.1\nMARKER/2, PART=2\n";
    let columns = [
        "DX(2,1)", "DY(2,1)", "DZ(2,1)", "AX(2,1)", "AY(2,1)", "AZ(2,1)",
    ];
    let moved = |law: &str| {
        let s = solve(&format!("{body}{law}"), &columns, Analysis::Dynamic, 2.0);
        columns.map(|c| last(&s, c))
    };
    let alike = |a: [f64; 6], b: [f64; 6]| {
        // both within the error that was asked for
        assert!(
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-8),
            "{a:?} {b:?}"
        );
    };
    let k = SECTION.stiffness();
    let field = format!(
        "FIELD/1, I=2, J=1, KMATRIX={}, CRATIO=0.01, LENGTH=2,0,0,0,0,0\n",
        by_columns(&k)
    );
    alike(moved(&beam("")), moved(&field));
    let mut nforce = format!(
        "NFORCE/1, IMARKERS=2, J=1, KMATRIX=1, LENGTH=2, CMATRIX=3\nMATRIX/1, FULL=CORDER, ROWS=6, COLUMNS=6, VALUES={}\n",
        by_columns(&k)
    );
    nforce += &format!(
        "MATRIX/3, FULL=CORDER, ROWS=6, COLUMNS=6, VALUES={}\n",
        by_columns(&k.map(|r| r.map(|x| 0.01 * x)))
    );
    nforce += "MATRIX/2, FULL=RORDER, ROWS=1, COLUMNS=6, VALUES=2,0,0,0,0,0\n";
    alike(moved(&nforce), moved(&field));
    let diagonal: [[f64; 6]; 6] =
        std::array::from_fn(|r| std::array::from_fn(|c| if r == c { 1.0 + r as f64 } else { 0.0 }));
    alike(
        moved(&format!(
            "FIELD/1, I=2, J=1, KMATRIX={}, CRATIO=0.1, FORCE=6,5,4,3,2,1\n",
            by_columns(&diagonal)
        )),
        moved(
            "BUSHING/1, I=2, J=1, K=1,2,3, KT=4,5,6, C=0.1,0.2,0.3, CT=0.4,0.5,0.6, FORCE=6,5,4, TORQUE=3,2,1\n",
        ),
    );
    // a beam without bending is a bushing
    let rod = "BEAM/1, I=2, J=1, LENGTH=2, IXX=1E-5, AREA=1E-5, EMODULUS=1E6, GMODULUS=4E5, CRATIO=0.02\n";
    alike(
        moved(rod),
        moved("BUSHING/1, I=2, J=1, K=5,0,0, KT=2,0,0, C=0.1,0,0, CT=0.04,0,0, FORCE=10,0,0\n"),
    );
}

#[test]
fn virtual_work_is_symmetric_where_nothing_is_loaded() {
    let symmetric = |law: &Field| {
        // small twists of I (0–5) and J (6–11) about a pose without load, J anywhere
        let R_GJ = rotation::from_313(0.4, 0.7, -0.2);
        let p_GJ = Vec3([0.3, -0.2, 0.5]);
        let p_GI = p_GJ + R_GJ.apply(Vec3([law.free[0], law.free[1], law.free[2]]));
        let state = |R: Mat3<f64>, p: Vec3<f64>, first: usize| {
            let unit = |k: usize| Dual::<12>::variable(0.0, first + k);
            let turn = Vec3([unit(3), unit(4), unit(5)]);
            let columns = [0, 1, 2].map(|k| {
                let c = Vec3::constant(R.column(k));
                c + turn.cross(c)
            });
            MarkerState {
                R_GM: Mat3::from_columns(columns[0], columns[1], columns[2]),
                p_GM: Vec3::constant(p) + Vec3([unit(0), unit(1), unit(2)]),
                ..MarkerState::ground()
            }
        };
        let (i, j) = (state(R_GJ, p_GI, 0), state(R_GJ, p_GJ, 6));
        let ground = MarkerState::ground();
        let angle = |m: Measure| kinematic(m, &i, &j, &ground, &ground).unwrap();
        let action = law.action(&i, &j, angle);
        let reaction = action.reaction(i.p_GM, j.p_GM);
        let all: Vec<Dual<12>> = [action.force, action.torque, reaction.force, reaction.torque]
            .iter()
            .flat_map(|v| v.0)
            .collect();
        for (r, q) in all.iter().enumerate() {
            assert!(q.re.abs() < 1e-9);
            for (c, other) in all.iter().enumerate() {
                let (a, b) = (q.eps[c], other.eps[r]);
                assert!((a - b).abs() < 1e-9 * 1e4, "{r} {c}: {a} {b}");
            }
        }
        assert!(all[0].eps[0] < -1.0 && (Dual::<12>::zero() - all[0]).eps[6] < 0.0);
    };
    let field = |stiffness: [[f64; 6]; 6], free: [f64; 6]| Field {
        stiffness,
        damping: [[0.0; 6]; 6],
        free,
        preload: [0.0; 6],
    };
    symmetric(&field(SECTION.stiffness(), [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    symmetric(&field(coupled(50.0), [0.5, 0.2, -0.1, 0.0, 0.0, 0.0]));
}

#[test]
fn a_matrix_that_does_not_fit_is_told() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
                NFORCE/7, IMARKERS=2, J=1, KMATRIX=1\nMATRIX/1, FULL=RORDER, ROWS=2, COLUMNS=2, VALUES=1,2,3,4\n";
    let told = refused(text, Analysis::Dynamic);
    assert_eq!(told.element.as_deref(), Some("NFORCE/7"));
    assert!(
        told.message
            .contains("MATRIX/1 is 2 × 2, but 6 × 6 numbers"),
        "{}",
        told.message
    );
}

#[test]
fn forces_that_are_nothing_change_no_bit_and_are_read_as_zero() {
    let spring = "SPRINGDAMPER/1, I=2, J=1, TRANSLATION, K=30, C=0.2, LENGTH=1\n";
    let places = ["DX(2,1)", "DY(2,1)", "AZ(2,1)", "VX(2,1)", "WZ(2,1)"];
    let bare = solve(
        &format!("{PLANAR}{spring}"),
        &places,
        Analysis::Dynamic,
        2.0,
    );
    for (idle, read) in [
        (
            "SPRINGDAMPER/2, I=2, J=1, TRANSLATION, K=0, C=0, LENGTH=1",
            "SPDP(2,0,{},0)",
        ),
        (
            "SPRINGDAMPER/2, I=2, J=1, ROTATION, KT=0, CT=0, ANGLE=1",
            "SPDP(2,0,{},0)",
        ),
        (
            "SFORCE/1, I=2, J=1, TRANSLATION, FUNCTION=0",
            "SFORCE(1,0,{},0)",
        ),
        (
            "SFORCE/1, I=2, J=1, TRANSLATION, ACTIONONLY, FUNCTION=2-2",
            "SFORCE(1,0,{},0)",
        ),
        (
            "SFORCE/1, I=2, J=1, ROTATION, FUNCTION=SIN(0)",
            "SFORCE(1,0,{},0)",
        ),
    ] {
        let actions: Vec<String> = (2..=8)
            .filter(|k| *k != 5)
            .map(|k| read.replace("{}", &k.to_string()))
            .collect();
        let columns: Vec<&str> = places
            .into_iter()
            .chain(actions.iter().map(String::as_str))
            .collect();
        let text = format!("{PLANAR}{spring}{idle}\n");
        let with = solve(&text, &columns, Analysis::Dynamic, 2.0);
        for place in places {
            assert_eq!(
                values(&with, place),
                values(&bare, place),
                "{idle}: {place}"
            );
        }
        for action in &actions {
            assert!(
                values(&with, action).iter().all(|x| *x == 0.0),
                "{idle}: {action}"
            );
        }
    }
}

/// Markers apart along what a BUSHING leaves free make no force; the doubt says so.
#[test]
fn a_bushing_whose_markers_are_apart_is_doubted_by_the_force_that_this_makes() {
    let told = |place: &str, stiffness: &str| {
        let text = format!(
            "BUSHING\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0,90D,0\nPART/2, MASS=1, CM=2, IP=1,1,1, QG={place}\n\
             MARKER/2, PART=2\nBUSHING/1, I=2, J=1, K={stiffness}, KT=1,1,1\nEND\n"
        );
        let all = cognate::dataset::read_text(&text).diagnostics.into_iter();
        let mut all = all.filter(|d| d.message.contains("its markers are"));
        all.next().map(|d| d.message)
    };
    // z of the J marker is −y of ground
    for (place, stiffness, force) in [
        ("0,2,0", "5,5,0", None),
        ("0,2,0", "5,5,3", Some("6")),
        ("3,0,0", "5,0,0", Some("15")),
        ("3,0,0", "0,7,7", None),
        ("3,4,0", "2,9,2", Some("10")),
    ] {
        let found = told(place, stiffness);
        let free = || "along what it leaves free".to_owned();
        let ending = force.map_or_else(free, |f| format!("so that it begins with a force of {f}"));
        let fits = found.as_ref().is_some_and(|f| f.ends_with(&ending));
        assert!(fits, "{place} {stiffness}: {found:?} {ending:?}");
    }
}

/// Elements that are told to read angles where these are no rotations.
fn told_of_angles(s: &Session) -> Vec<String> {
    let all = s
        .run
        .record
        .warnings
        .iter()
        .filter(|w| w.code == "large_angles");
    all.filter_map(|w| w.subject.as_ref().map(ToString::to_string))
        .collect()
}

#[test]
fn laws_of_angles_are_doubted_where_markers_turn_about_two_axes_and_not_about_one() {
    let model = |law: &str, torque: [f64; 3]| {
        let [x, y, z] = torque;
        format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/9, PART=1, FLOATING\n{law}\
             GFORCE/9, I=2, JFLOAT=9, RM=1, FX=0\\FY=0\\FZ=0\\TX={x:?}\\TY={y:?}\\TZ={z:?}\n"
        )
    };
    let diagonal = |k: [f64; 6]| {
        by_columns(&std::array::from_fn(|r| {
            std::array::from_fn(|c| if r == c { k[r] } else { 0.0 })
        }))
    };
    let stiff = diagonal([9.0, 9.0, 9.0, 5.0, 5.0, 5.0]);
    let bushing = "BUSHING/1, I=2, J=1, K=9,9,9, KT=5,5,5, CT=2,2,2\n".to_owned();
    let field = format!("FIELD/1, I=2, J=1, CRATIO=0.5, KMATRIX={stiff}\n");
    for (law, name) in [(&bushing, "BUSHING/1"), (&field, "FIELD/1")] {
        for (torque, is_told) in [
            ([9.0, 9.0, 0.0], true),
            ([0.0, 9.0, -9.0], true),
            ([9.0, 0.0, 0.0], false),
            ([0.0, 9.0, 0.0], false),
            ([0.0, 0.0, 9.0], false),
            ([0.4, 0.4, 9.0], false),
            ([0.4, 0.4, 0.4], false),
        ] {
            let s = run(&model(law, torque), &[], Analysis::Dynamic, (0.6, 20), 1e-5);
            let told = told_of_angles(&s);
            assert_eq!(
                told,
                if is_told { vec![name] } else { vec![] },
                "{torque:?}"
            );
        }
    }
    // at rest, too
    let s = run(
        &model(&bushing, [4.0, 4.0, 0.0]),
        &[],
        Analysis::Static,
        (0.0, 1),
        1e-6,
    );
    assert_eq!(told_of_angles(&s), ["BUSHING/1"]);
    // a law of ways alone, or of velocities, reads no angle
    for law in [
        "BUSHING/1, I=2, J=1, K=9,9,9, CT=2,2,2\n".to_owned(),
        format!(
            "FIELD/1, I=2, J=1, KMATRIX={}\n",
            diagonal([9.0, 9.0, 9.0, 0.0, 0.0, 0.0])
        ),
    ] {
        let s = run(
            &model(&law, [9.0, 9.0, 0.0]),
            &[],
            Analysis::Dynamic,
            (0.6, 20),
            1e-5,
        );
        assert_eq!(told_of_angles(&s), [""; 0]);
    }
}
