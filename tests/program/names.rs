//! Elements by their names: in what `check` and `verify` say as the file names them, and at every door by one resolver.

use crate::command::{cognate, path, scratch};
use cognate::Session;
use cognate::analysis::session::{Chosen, Options, check_column};
use cognate::analysis::sweep::Sweep;
use cognate::diagnostic::Diagnostic;
use cognate::internals::motion::MarkerMeasure;
use cognate::internals::report::mechanism::Pair;
use cognate::model::{ElementKind, Model};
use cognate::setup::Load;

/// Statements under the names that Adams View writes above them.
fn named(statements: &str) -> String {
    let lines = statements
        .lines()
        .map(|line| match line.split_once([',', '\\']) {
            Some((head, _)) if head.contains('/') => {
                let name = head.replace('/', "_").to_lowercase();
                format!("!                   adams_view_name='the_{name}'\n{line}\n")
            }
            _ => format!("{line}\n"),
        });
    format!("NAMED\n{}END\n", lines.collect::<String>())
}

/// The elements in a text that stand there without their names; excerpts of the file are no sentences.
fn nameless(said: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in said.lines().filter(|l| {
        !l.trim_start()
            .starts_with(|c: char| c == '|' || c.is_ascii_digit())
    }) {
        let words: Vec<&str> = line.split_whitespace().collect();
        for (k, word) in words.iter().enumerate() {
            let id = word.trim_matches([',', ':', ';', '.', '(', ')']);
            let is_id = id.split_once('/').is_some_and(|(kind, n)| {
                kind.chars().all(|c| c.is_ascii_uppercase() || c == '_') && n.parse::<u32>().is_ok()
            });
            let has_name = words
                .get(k + 1)
                .is_some_and(|next| next.starts_with("'the_"));
            if is_id && !has_name {
                found.push(format!("{id}: {line}"));
            }
        }
    }
    found
}

/// A four-bar with axes that are parallel, one joint too many, and a part that falls.
const FOUR_BAR: &str = "PART/1, GROUND
MARKER/11, PART=1
MARKER/14, PART=1, QP=4,0,0
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2, QP=0,0.5,0
MARKER/21, PART=2
MARKER/22, PART=2, QP=0,1,0
PART/3, MASS=1, CM=30, IP=1,1,1
MARKER/30, PART=3, QP=2,2,0
MARKER/32, PART=3, QP=0,1,0
MARKER/33, PART=3, QP=4,3,0
PART/4, MASS=1, CM=40, IP=1,1,1
MARKER/40, PART=4, QP=4,1.5,0
MARKER/43, PART=4, QP=4,3,0
MARKER/44, PART=4, QP=4,0,0
PART/5, MASS=1, CM=50, IP=1,1,1
MARKER/50, PART=5, QP=9,9,9
JOINT/1, REVOLUTE, I=21, J=11
JOINT/2, REVOLUTE, I=32, J=22
JOINT/3, REVOLUTE, I=43, J=33
JOINT/4, REVOLUTE, I=44, J=14
";

#[test]
fn elements_have_the_names_of_the_file_in_all_that_is_said() {
    let cases: [(&str, &str, &[&str]); 17] = [
        (
            "sound",
            "",
            &["redundant: ", "not unique: ", "free: ", "advice: "],
        ),
        (
            "driven_twice",
            "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\nMOTION/2, JOINT=1, ROTATION, FUNCTION=0\n",
            &["already"],
        ),
        (
            "undriven",
            "MOTION/1, JOINT=1, TRANSLATION, FUNCTION=TIME\n",
            &["JOINT/1"],
        ),
        (
            "two_drives",
            "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\nMOTION/4, JOINT=4, ROTATION, FUNCTION=-2*TIME\n",
            &["MOTION/4"],
        ),
        (
            "coupler",
            "COUPLER/1, JOINTS=1,1, SCALES=1,1\n",
            &["stands twice"],
        ),
        (
            "scales",
            "COUPLER/1, JOINTS=1,4, SCALES=1,0\n",
            &["couples nothing"],
        ),
        (
            "of_another",
            "PART/6, MASS=1, CM=40, IP=1,1,1\n",
            &["MARKER/40"],
        ),
        (
            "screw",
            "MARKER/51, PART=5, REULER=0,20D,0\nMARKER/15, PART=1, QP=9,9,9\n\
             JOINT/5, CYLINDRICAL, I=50, J=15\nJOINT/6, SCREW, I=51, J=15, PITCH=1\n",
            &["20 deg apart"],
        ),
        (
            "pins",
            "MARKER/51, PART=5, REULER=0,20D,0\nMARKER/15, PART=1, QP=9,9,9\nJOINT/5, UNIVERSAL, I=51, J=15\n",
            &["should cross"],
        ),
        (
            "torque",
            "MARKER/16, PART=1, REULER=0,20D,0\nSFORCE/1, ROTATION, I=50, J=16, FUNCTION=1\n",
            &["its torque is about", "no joint between"],
        ),
        (
            "line_of_action",
            "MARKER/15, PART=1, QP=2,0,0\nGEAR/1, JOINTS=1,4, CV=15\n",
            &["no velocity along"],
        ),
        (
            "gear_of_another",
            "MARKER/25, PART=2, QP=2,0,0, REULER=0,-90D,0\nGEAR/1, JOINTS=1,4, CV=25\n",
            &["GEAR/1"],
        ),
        (
            "reads_itself",
            "VARIABLE/1, FUNCTION=VARVAL(2)\nVARIABLE/2, FUNCTION=VARVAL(1)+1\n\
             MOTION/1, JOINT=1, ROTATION, FUNCTION=VARVAL(1)\n",
            &["depends on itself"],
        ),
        (
            "same_part",
            "MARKER/51, PART=5\nJOINT/9, REVOLUTE, I=50, J=51\n",
            &["both its markers"],
        ),
        (
            "law",
            "JOINT/7, SPHERICAL, I=50, J=17\nMARKER/17, PART=1, QP=9,9,9\nJPRIM/1, PERPENDICULAR, I=50, J=17\n\
             FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, FRICTION_FORCE_PRELOAD=1\n",
            &["FRICTION_FORCE_PRELOAD"],
        ),
        (
            "stands_twice",
            "MARKER/18, PART=1\nMARKER/28, PART=2\nJOINT/8, REVOLUTE, I=28, J=18\n",
            &["is the same joint"],
        ),
        (
            "floating",
            "MARKER/60, PART=1, FLOATING\nJOINT/6, SPHERICAL, I=50, J=60\n",
            &["MARKER/60"],
        ),
    ];
    for (case, more, parts) in cases {
        let file = scratch(
            "names",
            &format!("{case}.adm"),
            &named(&format!("{FOUR_BAR}{more}")),
        );
        let out = file.with_extension("out");
        let commands: [&[&str]; 3] = [
            &["check", path(&file)],
            &["verify", path(&file)],
            &[
                "run",
                path(&file),
                "--end",
                "0.01",
                "--steps",
                "1",
                "-o",
                path(&out),
            ],
        ];
        let said = commands.map(|command| {
            let done = cognate(command);
            done.out + &done.err
        });
        let said = said.concat();
        assert!(
            parts.iter().all(|part| said.contains(part)),
            "{case}: {said}"
        );
        assert_eq!(nameless(&said), Vec::<String>::new(), "{case}: {said}");
    }
}

/// Parts, joints and markers whose names have dots, blanks, letters beyond ASCII, cases; and some that two elements have.
const DOORS: &str = "DOORS
ACCGRAV/JGRAV=-9.81
!  adams_view_name='ground'
PART/1, GROUND
!  adams_view_name='post'
MARKER/1, PART=1
!  adams_view_name='slider'
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
!  adams_view_name='tip'
MARKER/21, PART=2, QP=1,0,0
!  adams_view_name='arm.rod'
PART/3, MASS=1, CM=30, IP=1,1,1
MARKER/30, PART=3
!  adams_view_name='tip'
MARKER/31, PART=3, QP=1,0,0
!  adams_view_name='Pleuel groß'
PART/4, MASS=1, CM=40, IP=1,1,1
MARKER/40, PART=4
!  adams_view_name='twin'
PART/5, MASS=1, CM=50, IP=1,1,1
MARKER/50, PART=5
!  adams_view_name='twin'
PART/6, MASS=1, CM=60, IP=1,1,1
MARKER/60, PART=6
!  adams_view_name='slider'
JOINT/1, REVOLUTE, I=20, J=1
!  adams_view_name='crank bearing'
JOINT/2, REVOLUTE, I=30, J=1
!  adams_view_name='motor'
MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME
!  adams_view_name='gain'
VARIABLE/3, FUNCTION=2
END
";

/// The number that a door finds under a name, or what it says.
type Answer = Result<u32, String>;

/// Asks one door for a name.
type Door<'a> = &'a dyn Fn(&str) -> Answer;

fn said(d: impl Into<cognate::Error>) -> String {
    let d = d.into().into_first();
    [&[d.message], &d.help[..]].concat().join("; ")
}

/// Returns the number after the first `KEYWORD/`, or in the first `(…` of a text.
fn number(text: &str) -> u32 {
    let digits = text
        .split(|c: char| !c.is_ascii_digit())
        .find(|d| !d.is_empty());
    digits.and_then(|d| d.parse().ok()).unwrap_or(u32::MAX)
}

#[test]
fn every_door_gives_a_name_the_same_answer() {
    let model = Model::from_text(DOORS).unwrap();
    let one = |all: Vec<Diagnostic>| said(all);
    // doors that take markers
    let markers: [(&str, Door<'_>); 6] = [
        ("find_of", &|name| {
            model
                .find_of(&[ElementKind::Marker], name)
                .map(|id| id.number)
                .map_err(said)
        }),
        ("expression", &|name| {
            model
                .numbered(&format!("DX({name})"))
                .map(|n| number(&n.text))
                .map_err(one)
        }),
        ("motion", &|name| {
            let found = MarkerMeasure::of(&model, &format!("DX({name})"));
            found
                .map(|m| number(&format!("{:?}", m.unwrap())))
                .map_err(one)
        }),
        ("dimension", &|name| {
            Pair::of(&model, &format!("{name},1"))
                .map(|p| p.i)
                .map_err(said)
        }),
        ("column", &|name| {
            let wrong = check_column(&model, &format!("DX({name})"));
            match wrong.is_empty() {
                true => model
                    .numbered(&format!("DX({name})"))
                    .map(|n| number(&n.text))
                    .map_err(one),
                false => Err(one(wrong)),
            }
        }),
        ("session", &|name| {
            let mut session = Session::new(model.clone(), "doors", Options::default());
            let column = format!("DX({name})");
            session.add_column(&column).map_err(said)?;
            model
                .numbered(&column)
                .map(|n| number(&n.text))
                .map_err(one)
        }),
    ];
    for (name, number) in [
        ("20", Ok(20)),
        ("MARKER/20", Ok(20)),
        ("marker/20", Ok(20)),
        ("MARKER_20", Ok(20)),
        ("slider.cm", Ok(20)),
        ("SLIDER.CM", Ok(20)),
        ("PART/2.cm", Ok(20)),
        ("slider.tip", Ok(21)),
        ("slider.MARKER_21", Ok(21)),
        ("arm.rod.tip", Ok(31)),
        (".doors.arm.rod.tip", Ok(31)),
        ("Pleuel groß.cm", Ok(40)),
        ("'PLEUEL groß'.cm", Ok(40)),
        ("post", Ok(1)),
        (
            "tip",
            Err(
                "several elements are called `tip`; say which: MARKER/21 (slider.tip), MARKER/31 (arm.rod.tip)",
            ),
        ),
        ("twin.cm", Err("several elements are called `twin.cm`")),
        ("slider.tpi", Err("did you mean slider.tip")),
        ("99", Err("MARKER/99 does not exist")),
        ("JOINT/1", Err("no MARKER")),
        ("slider", Err("several")),
    ] {
        for (door, answer) in &markers {
            match (number, answer(name)) {
                (Ok(number), answer) => assert_eq!(answer, Ok(number), "{door}: {name}"),
                // the numbers themselves are checked when the model is compiled
                (Err(_), Ok(found)) => assert_eq!((found, name), (99, "99"), "{door}: {name}"),
                (Err(_), Err(_)) if name == "slider" => {}
                (Err(part), Err(said)) => assert!(said.contains(part), "{door}: {name}: {said}"),
            }
        }
    }
}

#[test]
fn doors_that_take_elements_give_a_name_the_same_answer() {
    let model = Model::from_text(DOORS).unwrap();
    let element = |name: &str| {
        model
            .find_element(name)
            .map(|id| id.to_string())
            .map_err(said)
    };
    let only = |name: &str| -> Result<String, String> {
        let chosen: Chosen = name.parse()?;
        match chosen.in_model(&model).map_err(said)? {
            Chosen::Element(id) => Ok(id.to_string()),
            other => Err(format!("{other:?}")),
        }
    };
    let sweep = |name: &str| -> Result<String, String> {
        let mut sweep = Sweep::new(model.clone(), Vec::new());
        sweep.parameter(name).map_err(said)?;
        Ok(sweep.parameters()[0].name().to_owned())
    };
    for (name, id) in [
        ("PART/2", "PART/2"),
        ("arm.rod", "PART/3"),
        ("pleuel GROß", "PART/4"),
        ("crank bearing", "JOINT/2"),
        ("'crank bearing'", "JOINT/2"),
        ("motor", "MOTION/1"),
        ("MOTION_1", "MOTION/1"),
    ] {
        assert_eq!(element(name).as_deref(), Ok(id), "{name}");
        assert_eq!(only(name).as_deref(), Ok(id), "{name}");
    }
    for (name, parameter) in [
        ("PART/3.MASS", "PART/3.MASS"),
        ("arm.rod.MASS", "PART/3.MASS"),
        // of the part and the joint of this name it is the part that has a mass
        ("slider.MASS", "PART/2.MASS"),
        ("slider.tip.QP(1)", "MARKER/21.QP(1)"),
        ("gain", "VARIABLE/3"),
        ("motor", "MOTION/1"),
        ("ACCGRAV.JGRAV", "ACCGRAV.JGRAV"),
    ] {
        assert_eq!(sweep(name).as_deref(), Ok(parameter), "{name}");
    }
    for (name, part) in [
        ("twin", "say which: PART/5, PART/6"),
        ("moter", "did you mean motor?"),
        ("PART/9", "PART has 1, 2, 3, 4, 5, 6"),
    ] {
        for said in [element(name), only(name), sweep(&format!("{name}.MASS"))] {
            let said = said.unwrap_err();
            assert!(
                said.contains(part) || name == "PART/9" && said.contains("does not exist"),
                "{name}: {said}"
            );
        }
    }
    let load = |name: &str| {
        Load::named(&model, name)
            .map(|l| l.to_string())
            .map_err(said)
    };
    assert_eq!(load("motor").as_deref(), Ok("MOTION/1"));
    assert_eq!(load(" GRAVITY").as_deref(), Ok("gravity"));
    assert!(load("arm.rod").unwrap_err().contains("is no load"));
    // components of elements are columns
    for (column, is_one) in [
        ("crank bearing.FX", true),
        ("'crank bearing'.angle", true),
        ("JOINT/2.FX", true),
        ("motor.TZ", true),
        ("twin_2_XFORM.X", true),
        ("arm.rod_XFORM.VX", true),
        ("arm.rod.PSI", true),
        // two sets of the body have it
        ("arm.rod.VX", false),
        ("crank baering.FX", false),
    ] {
        let wrong = check_column(&model, column);
        assert_eq!(wrong.is_empty(), is_one, "{column}: {wrong:?}");
    }
    let wrong = check_column(&model, "crank baering.FX");
    assert!(said(wrong).contains("did you mean crank bearing.FX"));
}

#[test]
fn lines_of_ours_and_statements_answer_with_the_names_of_elements() {
    let read = |line: &str| {
        cognate::dataset::read_text(&DOORS.replace("END\n", &format!("{line}\nEND\n")))
    };
    for (line, told) in [
        ("! cognate: IC crank bearing, ANGLE=30D", None),
        ("! cognate: IC slider.tip, X=1", None),
        (
            "! cognate: IC crank baering, ANGLE=30D",
            Some("did you mean crank bearing?"),
        ),
        ("! cognate: RIGID whole = slider, 'Pleuel groß'", None),
        (
            "! cognate: RIGID whole = slider, plauel groß",
            Some("did you mean Pleuel groß?"),
        ),
        ("! cognate: SPRINGDAMPER/1 back = crank bearing, KT=2", None),
        (
            "SFORCE/1, I=21, J=1, TRANSLATION, FUNCTION=DX(slider.tip, ground)",
            Some("by their numbers: DX(21, 0)"),
        ),
    ] {
        let reading = read(line);
        let errors = reading
            .diagnostics
            .iter()
            .filter(|d| d.severity == cognate::diagnostic::Severity::Error);
        let errors: Vec<String> = errors.map(ToString::to_string).collect();
        match told {
            None => assert!(errors.is_empty(), "{line}: {errors:?}"),
            Some(part) => assert!(errors.concat().contains(part), "{line}: {errors:?}"),
        }
    }
}

#[test]
fn names_on_the_command_line_are_told_at_their_places() {
    let file = scratch("doors_of_names", "m.adm", DOORS);
    let out = file.with_file_name("out");
    let run = [
        "run",
        path(&file),
        "--end",
        "0.1",
        "--steps",
        "2",
        "--quiet",
        "--out",
        path(&out),
    ];
    let with = |more: &[&str]| cognate(&[&run[..], more].concat());
    let column = with(&[
        "--column",
        "DX(slider.tip, ground)",
        "--column",
        "crank bearing.FX",
    ]);
    assert_eq!(column.code, 0, "{}", column.err);
    let table = std::fs::read_to_string(out.join("m.csv")).unwrap();
    assert!(
        table.starts_with("time,\"DX(slider.tip, ground)\",crank bearing.FX"),
        "{table}"
    );
    let wrong = with(&["--column", "1+DX(slider.tpi)"]);
    assert_eq!(wrong.code, 3, "{}", wrong.err);
    for part in [
        "--column",
        "1+DX(slider.tpi)",
        "^^^^^^^^^^",
        "did you mean slider.tip",
    ] {
        assert!(wrong.err.contains(part), "{part}: {}", wrong.err);
    }
    for (arguments, part) in [
        (
            &["draw", path(&file), "--highlight", "moter"][..],
            "--highlight",
        ),
        (
            &["draw", path(&file), "--dimension", "slider.tpi,1"],
            "--dimension",
        ),
        (
            &[
                "sweep",
                path(&file),
                "--end",
                "0.1",
                "--set",
                "slidre.MASS=1,2",
                "--measure",
                "max(motor.TZ)",
            ],
            "--set",
        ),
        (&["loads", "drive", path(&file), "moter", "slow"], "LOAD"),
    ] {
        let done = cognate(arguments);
        assert_ne!(done.code, 0, "{arguments:?}");
        assert!(
            done.err.contains(part) && done.err.contains("did you mean"),
            "{arguments:?}: {}",
            done.err
        );
    }
    let made = cognate(&[
        "group",
        "function",
        path(&file),
        "slow",
        "--direct",
        "0.1*TIME",
    ]);
    assert_eq!(made.code, 0, "{}", made.err);
    for load in ["motor", "MOTION/1"] {
        let done = cognate(&["loads", "drive", path(&file), load, "slow"]);
        assert_eq!(done.code, 0, "{load}: {}", done.err);
    }
    let setup = std::fs::read_to_string(file.with_extension("toml")).unwrap();
    assert_eq!(setup.matches("= \"slow\"").count(), 1, "{setup}");
}

#[test]
fn a_pattern_is_all_columns_of_an_element_and_a_run_has_its_name() {
    let file = scratch("patterns", "m.adm", DOORS);
    let out = file.with_file_name("out");
    for name in ["a", "b"] {
        let run = [
            "run",
            path(&file),
            "--end",
            "0.1",
            "--steps",
            "2",
            "--quiet",
            "--out",
            path(&out),
            "--name",
            name,
        ];
        let done = cognate(&[&run[..], &["--format", "res"]].concat());
        assert_eq!(done.code, 0, "{}", done.err);
    }
    let [a, b] = ["a", "b"].map(|name| out.join(name));
    let done = cognate(&[
        "plot",
        path(&a),
        "--y",
        "crank bearing.*",
        "--over",
        path(&b),
        "--statistics",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    for part in ["crank bearing.FX (a)", "crank bearing.TZ (b)"] {
        assert!(done.out.contains(part), "{part}: {}", done.out);
    }
    let page = file.with_file_name("page.html");
    let done = cognate(&[
        "animate",
        path(&a),
        "--model",
        path(&file),
        "--over",
        path(&b),
        "-o",
        path(&page),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let done = cognate(&["plot", path(&a), "--y", "crank bearng.*"]);
    assert!(
        done.code != 0 && done.err.contains("there is no column"),
        "{}",
        done.err
    );
}

#[test]
fn commands_are_found_by_their_meaning() {
    let file = scratch("meaning", "m.adm", DOORS);
    let out = file.with_file_name("out");
    for verb in ["run", "solve", "simulate"] {
        let done = cognate(&[
            verb,
            path(&file),
            "--end",
            "0.1",
            "--steps",
            "2",
            "--quiet",
            "--out",
            path(&out),
        ]);
        assert_eq!(done.code, 0, "{verb}: {}", done.err);
    }
    let table = out.join("m.csv");
    let done = cognate(&["graph", path(&table), "--statistics"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let help = cognate(&["help"]);
    assert!(
        help.code == 0 && help.out.contains("sweep"),
        "{}{}",
        help.out,
        help.err
    );
    let help = cognate(&["help", "run"]);
    assert!(
        help.code == 0 && help.out.contains("--only"),
        "{}{}",
        help.out,
        help.err
    );
}

#[test]
fn two_elements_of_one_name_are_told_and_a_builder_refuses_them() {
    let file = scratch("twice", "m.adm", DOORS);
    let checked = cognate(&["check", path(&file)]);
    for part in [
        "name_twice",
        "PART/6",
        "`twin`",
        "PART/5",
        "line 21",
        "twin_2",
    ] {
        assert!(
            checked.out.contains(part) || checked.err.contains(part),
            "{part}: {}{}",
            checked.out,
            checked.err
        );
    }
    let builder = cognate::ModelBuilder::new("twice");
    for _ in 0..2 {
        let rod = builder
            .part("rod")
            .mass(1.0)
            .inertia([1.0; 3])
            .center([0.5, 0.0, 0.0]);
        let pin = rod.at([0.0; 3]).named("pin");
        builder.revolute("hinge", &pin, &builder.ground());
    }
    let told = builder.build().unwrap_err().to_string();
    for part in [
        "PART/3 'rod'",
        "PART/2 has this name already",
        "JOINT/2 'hinge'",
        "JOINT/1 has",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    // a marker of each part may be called so
    assert!(!told.contains("MARKER"), "{told}");
}
