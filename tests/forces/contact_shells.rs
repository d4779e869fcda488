//! CONTACT with shells in files: the convex hull of their points touches.
#![cfg(feature = "geometry")]

use crate::running;

use running::{Analysis, Session, go, last, mistakes, session};
use std::path::PathBuf;

/// A folder of this test's own, with files.
fn folder(test: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder
}

const SIZE: [f64; 3] = [0.4, 0.3, 0.2];

/// Corners of a brick about its middle, and a point within.
fn brick() -> Vec<[f64; 3]> {
    let corner = |c: usize| [0, 1, 2].map(|k| SIZE[k] * if c >> k & 1 == 0 { -0.5 } else { 0.5 });
    (0..8).map(corner).chain([[0.01, 0.02, 0.03]]).collect()
}

fn shl() -> String {
    let points = brick()
        .into_iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"));
    format!("9 1 1.0\n{}4 1 2 4 3\n", points.collect::<String>())
}

fn obj() -> String {
    let points = brick()
        .into_iter()
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    points.collect()
}

fn stl() -> String {
    let points = brick();
    let facet = |k: usize| {
        let corner = |n: usize| {
            let [x, y, z] = points[(k + n) % points.len()];
            format!("  vertex {x} {y} {z}\n")
        };
        format!(
            "facet normal 0 0 0\n outer loop\n{}{}{} endloop\nendfacet\n",
            corner(0),
            corner(1),
            corner(2)
        )
    };
    format!(
        "solid brick\n{}endsolid\n",
        (0..points.len()).map(facet).collect::<String>()
    )
}

/// A tilted brick falls onto another that lies on ground, and that onto a plane.
fn falling(shape: &str) -> String {
    let side = |id: u32, cm: u32| match shape {
        "BOX" => {
            let [x, y, z] = SIZE;
            format!(
                "MARKER/{id}00, PART={id}, QP={},{},{}\nGRAPHICS/{id}, BOX, CORNER={id}00, X={x}, Y={y}, Z={z}\n",
                -x / 2.0,
                -y / 2.0,
                -z / 2.0
            )
        }
        other => format!("GRAPHICS/{id}, {other}, RM={cm}\n"),
    };
    format!(
        "ACCGRAV/KGRAV=-9.81\n\
         PART/2, MASS=2, CM=2, IP=0.02,0.03,0.04, QG=0,0,0.101\nMARKER/2, PART=2\n\
         PART/3, MASS=1, CM=3, IP=0.01,0.015,0.02, QG=0.05,0.03,0.4, REULER=0.3,0.2,0.1\nMARKER/3, PART=3\n\
         {}{}GRAPHICS/1, PLANE, RM=1\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=100, DMAX=1E-3\n\
         CONTACT/2, IGEOM=3, JGEOM=2, IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=100, DMAX=1E-3\n",
        side(2, 2),
        side(3, 3)
    )
}

fn run(text: &str, folder: PathBuf, columns: &[&str], end: f64) -> Session {
    let mut s = session(text, columns, 1e-8);
    s.folders = vec![folder];
    go(&mut s, Analysis::Dynamic, end, 20);
    s
}

#[test]
fn a_brick_from_a_file_falls_as_the_box_does() {
    let files = [
        ("brick.shl", shl()),
        ("brick.obj", obj()),
        ("brick.stl", stl()),
    ];
    let files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (*n, t.as_str())).collect();
    let folder = folder("bricks", &files);
    let columns = ["DZ(3,1)", "DX(3,1)", "DZ(2,1)", "WX(3,1)"];
    let box_run = run(&falling("BOX"), folder.clone(), &columns, 0.3);
    assert!(last(&box_run, "DZ(3,1)") < 0.33, "they have met");
    for shape in [
        "SHELL, FILE=brick.shl",
        "EXTERNAL, FILE=brick.shl",
        "EXTERNAL, FILE=C:\\models\\brick.obj",
        "EXTERNAL, FILE=brick.stl",
    ] {
        let s = run(&falling(shape), folder.clone(), &columns, 0.3);
        for c in columns {
            // both ask for 1e-8; impacts of a tilted brick magnify that a thousandfold
            let (a, b) = (last(&s, c), last(&box_run, c));
            assert!((a - b).abs() < 1e-5, "{shape} {c}: {a} {b}");
        }
        let hull = |w: &&String| w.contains("convex hull") && w.contains("8 corners of");
        assert_eq!(s.run.record.warned().iter().filter(hull).count(), 2);
    }
}

#[test]
fn a_shell_that_cannot_be_used_says_why_and_what_to_do() {
    let folder = folder(
        "odd_shells",
        &[
            ("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"),
            ("short.shl", "8 6\n0 0 0\n"),
            ("text.stl", "no solid\n"),
            ("other.dat", "1 2 3\n"),
        ],
    );
    for (file, said) in [
        ("flat.obj", "no volume"),
        ("short.shl", "1 of 8 points"),
        ("text.stl", "no point"),
        ("other.dat", "STL, OBJ and SHL"),
        ("nowhere.stl", "no such file"),
        ("gear.xmt_txt", "CAD kernel"),
    ] {
        let text = falling(&format!("EXTERNAL, FILE={file}"));
        let mut s = session(&text, &[], 1e-6);
        s.folders = vec![folder.clone()];
        let errors = mistakes(&mut s, Analysis::Dynamic);
        let d = &errors[0];
        assert_eq!(
            (d.code, d.element.as_deref()),
            ("unsupported", Some("CONTACT/1"))
        );
        assert!(
            d.message.contains(said) && d.message.contains(file),
            "{}",
            d.message
        );
        assert!(d.message.contains("export it as STL"), "{}", d.message);
    }
}

#[test]
fn a_pyramid_of_a_file_rests_on_the_plane_with_its_weight() {
    let folder = folder(
        "pyramid",
        &[("p.obj", "v 1 1 0\nv -1 1 0\nv -1 -1 0\nv 1 -1 0\nv 0 0 2\n")],
    );
    let s = run(
        "ACCGRAV/KGRAV=-10\nPART/2, MASS=3, CM=2, IP=1,1,1, QG=0,0,0.01\nMARKER/2, PART=2, QP=0,0,0.5\nMARKER/20, PART=2\n\
         GRAPHICS/2, SHELL, RM=20, FILE=p.obj\nGRAPHICS/1, PLANE, RM=1\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=3E4, EXPONENT=1, DAMPING=1000, DMAX=1E-4\n",
        folder,
        &["DZ(20,1)", "CONTACT(1,0,4,0)"],
        3.0,
    );
    // four corners carry m g = 30: each 7.5 = k δ
    assert!((last(&s, "DZ(20,1)") + 7.5 / 3e4).abs() < 1e-9);
    assert!((last(&s, "CONTACT(1,0,4,0)") - 30.0).abs() < 1e-4);
}
