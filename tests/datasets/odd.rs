//! Datasets and command files that are odd but legal, in the ways that manuals allow and that people's files show: each means the same pendulum,
//! reads without a mistake, is written as it was read, keeps its meaning when it is formatted, and moves as the plain one does.

use crate::running;

use cognate::dataset::Source;
use cognate::dataset::command::Script;
use cognate::dataset::{Reading, read_source, read_text};
use cognate::diagnostic::Severity;
use meaning::{difference, meaning};
use running::{Options, begin, last, obeys, options};

use crate::meaning;

const PLAIN: &str = "PART/1, GROUND
MARKER/1, PART=1
MARKER/10, PART=1
PART/2, MASS=2, CM=20, IP=0.1,0.1,0.1
MARKER/20, PART=2, QP=1,0,0
MARKER/21, PART=2
JOINT/1, REVOLUTE, I=21, J=10
ACCGRAV/JGRAV=-9.81
REQUEST/1, DISPLACEMENT, I=20, J=1
END
";

fn plain() -> String {
    format!("a pendulum\n{PLAIN}")
}

/// The plain pendulum with a piece of its text replaced.
fn with(from: &str, to: &str) -> String {
    let text = plain();
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

/// The plain pendulum with statements before its end.
fn and(more: &str) -> String {
    with("END\n", &format!("{more}\nEND\n"))
}

const CONTINUED: &str = "continuation in odd places
PART/1
,GROUND
MARKER/1, PART=1
MARKER/10,
 PART=1
PART/2,
 MASS=2,
, CM=20, IP=0.1
,0.1,
,0.1
MARKER/20
, PART
, =2, QP=1,0
,0
MARKER/21, PART=&
2
JOINT/1, REVOLUTE,&
I=21,&
, J=10
ACCGRAV/
, JGRAV
, = -9.81
REQUEST/1
, DISPLACEMENT, I=20
, J=1
END
";

const COMMENTED: &str = "comments everywhere
PART/1, GROUND ! the ground
MARKER/1 ! first
! between
, PART=1 ! after

!
MARKER/10
!                   adams_view_name='in the middle'
, PART=1
PART/2 ! two
! a

! b
, MASS=2 ! mass, with = signs, and , commas & more
, CM=20, IP=0.1,0.1,0.1
MARKER/20, PART=2, QP=1,0,0!no blank
MARKER/21, PART=2
JOINT/1, REVOLUTE & ! goes on
, I=21, J=10
ACCGRAV/JGRAV=-9.81
VARIABLE/1, FUNCTION = DX(20,1) + ! first half
! nothing
, DY(20,1)
REQUEST/1, DISPLACEMENT, I=20, J=1, COMMENT=a remark ! not part of it
END
";

const ABBREVIATED: &str = "abbreviations
PAR/1, GRO
MARK/1, PA=1
MARK/10, PA=1
PAR/2, MA=2, CM=20, IP=0.1,0.1,0.1
MARK/20, PA=2, Q=1,0,0
MARK/21, PA=2
JOI/1, REV, I=21, J=10
ACCG/J=-9.81
VAR/1, FUNC=AZ(21,10)
REQ/1, D, I=20, J=1, C=angle
REQ/2, V, I=20, J=1
INT/ERR=1e-10
EQUI/ERR=1e-3, IMB=1e-3, TLIM=2, ALIM=5D
END
";

const NUMBERS: &str = "numbers
PART/01, GROUND
MARKER/0001, PART=001
MARKER/10, PART=1, REULER=+0.d,-0D,0.0D
PART/2, MASS=2., CM=20, IP=.1,1.E-1,+0.1e+0
MARKER/20, PART=2, QP=1.0E+000,-0,0.
MARKER/21, PART=2, REULER=360D,0,0
JOINT/1, REVOLUTE, I=21, J=10
ACCGRAV/JGRAV=-.981E1
REQUEST/1, DISPLACEMENT, I=20, J=1
END
";

const BY_POINTS: &str = "axes by points
PART/1, GROUND
MARKER/1, PART=1
MARKER/10, PART=1, ZP=0,0,1
PART/2, MASS=2, CM=20, IP=0.1,0.1,0.1, QG=0,0,0, ZG=0,0,1, XG=1,0,0
MARKER/20, PART=2, QP=1,0,0, XP=2,0,0, ZP=1,0,1
MARKER/21, PART=2, XP=1,0,0, USEXP
JOINT/1, REVOLUTE, I=21, J=10
ACCGRAV/JGRAV=-9.81
REQUEST/1, DISPLACEMENT, I=20, J=1
END
";

/// What is read and has no influence here.
const SETTINGS: &str = "NOLIST
OUTPUT/REQSAVE, NOPRINT, NOSEPARATOR
RESULTS/FORMATTED, XRF
DEBUG/EPRINT
PREFERENCES/SOLVER=FORTRAN
LSOLVER/CALAHAN
ENVIRONMENT/NAME=A, VALUE=b
IC/ERROR=1E-8
KINEMATICS/ERROR=1E-6
STRING/1, STRING = v14.00. a/b
MATERIAL/1, NAME=steel, DENSITY=7.8E-6, YOUNGS_MODULUS=2e5, POISSONS_RATIO=.29
GRAPHICS/1, CYLINDER, CM=20, LENGTH=1, RADIUS=.2, SIDES=20, SEG=20
GRAPHICS/2, OUTLINE=1,10,20
GRAPHICS/3, EXTERNAL, RM=20, FILE=a b.xmt_txt, ELEMENT=b 1
REQUEST/3, F2=TIME\\ CNAMES=\"\",\"a, b=c\",\"!\", CUNITS=\"mm\"
LIST";

/// Expressions that end, go on and branch in all ways; none of them pushes.
const EXPRESSIONS: &str = "MARKER/31, PART=1, FLOATING
GFORCE/1, I=20, JFLOAT=31, RM=10, FX= -0*VX(20,1,1)\\
FY=-0.1*
, 0*VY(20,1,1)\\ FZ=0\\
, TX=0\\
! between
 TY=0\\TZ=
, -0*WZ(20,1)\\
REQUEST/2, F2=DX(20,1)\\F3=
, DY(20,1)\\
, F4 = DZ(20,1), COMMENT=places
VARIABLE/1, FUNCTION=IF(TIME-1: 0, 1
, , 2)
VARIABLE/2, FUNCTION = IF ( TIME :
, IF(TIME-2:1,
, 2,3), 4 , 5 )
VARIABLE/3, FUNCTION=SIN(TIME) &
 + COS(TIME)&
, *2";

fn users() -> String {
    let many: Vec<String> = (0..30).map(|k| format!("{k}.5")).collect();
    format!(
        "SFORCE/9, ROTATION, I=21, J=10, FUNCTION=USER({})\\\n, ROUTINE=lib::sub\n\
         VARIABLE/3, FUNCTION=USER(1.7172509E+07,\n, -2, 3.,\n, 4)\n\
         REQUEST/7, FUNCTION=USER(1,2)\\ROUTINE=abg::req\n\
         GSE/1, NS=0, NO=2, U=5, Y=6, FUNCTION=USER(1)\nARRAY/5, U, SIZE=1, VARIABLES=3\nARRAY/6, Y, SIZE=2",
        many.join(",")
    )
}

fn long_lists() -> String {
    let numbers: Vec<String> = (0..3000)
        .map(|k| (0.5 * f64::from(k)).to_string())
        .collect();
    let x: Vec<String> = (0..500).map(|k| k.to_string()).collect();
    let y: Vec<String> = (0..500).map(|k| (k % 7).to_string()).collect();
    format!(
        "ARRAY/1, IC, SIZE=3000, NUMBERS={}\nSPLINE/1, X={}, Y={}\nVARIABLE/1, FUNCTION=ARYVAL(1,3000)+CUBSPL(TIME,0,1)",
        numbers.join(", "),
        x.join(","),
        y.join(",\n, ")
    )
}

/// Statements in the opposite order: all are referred to before they are defined.
fn backwards() -> String {
    let mut lines: Vec<&str> = PLAIN.trim_end_matches("END\n").lines().collect();
    lines.reverse();
    format!("backwards\n{}\nEND\n", lines.join("\n"))
}

/// (what is odd, the text)
fn texts() -> Vec<(&'static str, String)> {
    vec![
        ("small letters", plain().to_lowercase()),
        ("tabs", plain().replace(", ", "\t,\t").replace('=', "\t=\t")),
        ("line ends of Windows", plain().replace('\n', "\r\n")),
        ("line ends of old", plain().replace('\n', "\r")),
        ("line ends of both kinds", with("\nMARKER", "\r\nMARKER")),
        ("continued lines", CONTINUED.into()),
        ("comments", COMMENTED.into()),
        ("abbreviations", ABBREVIATED.into()),
        ("no END", with("END\n", "")),
        ("no end of the last line", plain().trim_end().into()),
        ("a mark of byte order", format!("\u{FEFF}{}", plain())),
        ("numbers", NUMBERS.into()),
        ("expressions", and(EXPRESSIONS)),
        ("programs", and(&users())),
        ("long lists", and(&long_lists())),
        ("settings", and(SETTINGS)),
        ("backwards", backwards()),
        ("no PART", with("MARKER/20, PART=2, ", "MARKER/20, ")),
        ("axes by points", BY_POINTS.into()),
        (
            "no inertia",
            with(", IP=0.1,0.1,0.1", ", IP=0.1,0.1,0.1,0,0,0"),
        ),
        ("MMKS", with("ACCGRAV", "UNITS/SYSTEM=MMKS\nACCGRAV")),
        (
            "small units",
            with(
                "ACCGRAV",
                "units/force=Newton,mass=Kilogram,length=Meter,time=Second\nACCGRAV",
            ),
        ),
        (
            "short units",
            with(
                "ACCGRAV",
                "UNITS/FORCE=NEWT, MASS=KILOG,\n, LENGTH=MILLI, TIME=SEC\nACCGRAV",
            ),
        ),
        (
            "odd units",
            with(
                "ACCGRAV",
                "UNITS/FORCE=KILOGRAM_FORCE, MASS=SLUG,\n, LENGTH=MILE, TIME=HOUR\nACCGRAV",
            ),
        ),
        (
            "a factor of units",
            with("ACCGRAV", "UNITS/UCF=1000\nACCGRAV"),
        ),
        (
            "what follows END",
            format!("{}\nthis is, not =/ %$\nPART/1\n", plain()),
        ),
        ("the end of DOS", format!("{}\u{1A}", plain())),
        ("END with a remark", with("END\n", "end ! done\n")),
        ("END in a comment", with("REQUEST", "! END\n!END\nREQUEST")),
        ("semicolons", with("QP=1,0,0\n", "QP=1,0,0; ")),
        (
            "blanks",
            plain()
                .replace("JOINT/1,", "JOINT / 1 ,")
                .replace("=-9.81", " = - 9.81"),
        ),
        (
            "the type last",
            with("REVOLUTE, I=21, J=10", "I=21, J=10, REVOLUTE"),
        ),
        ("the largest number", with("JOINT/1,", "JOINT/2147483647,")),
        ("a form feed", with("JOINT", "\u{0C}JOINT")),
    ]
}

fn read(what: &str, bytes: &[u8]) -> Reading {
    let source = Source::from_bytes(None, bytes);
    let reading = read_source(source);
    let mut wrong = reading.diagnostics.iter();
    let wrong = wrong.find(|d| d.severity == Severity::Error);
    assert!(wrong.is_none(), "{what}: {}", wrong.unwrap());
    reading
}

/// Where the bob is at the end of a short run.
fn moved(what: &str, reading: Reading) -> [f64; 2] {
    let columns = ["DX(20,1)", "DY(20,1)"];
    let options = Options {
        zero_user: true,
        ..options(&columns, 1e-10)
    };
    let mut session = begin(reading.model, what, options);
    let script = Script::from_text("\nsim/dyn, end=0.4, steps=2\n").unwrap();
    obeys(&mut session, &script);
    columns.map(|c| last(&session, c))
}

fn same(what: &str, bytes: &[u8], expected: [f64; 2]) {
    let reading = read(what, bytes);
    let written = reading.dataset.source.encode(reading.dataset.to_text());
    assert_eq!(written, bytes, "{what} is written as it was read");
    let formatted = reading.dataset.formatted();
    let again = read_text(&formatted);
    let (a, b) = (meaning(&reading.model), meaning(&again.model));
    assert!(a == b, "{what}: {}", difference(&a, &b));
    assert_eq!(
        formatted,
        again.dataset.formatted(),
        "{what} formatted twice"
    );
    let found = moved(what, reading);
    for (x, y) in found.iter().zip(expected) {
        // both runs ask for 1e-10
        assert!((x - y).abs() < 1e-8, "{what}: {found:?}, not {expected:?}");
    }
}

#[test]
fn odd_datasets_mean_what_the_plain_one_means() {
    let expected = moved("plain", read("plain", plain().as_bytes()));
    assert!(expected[1] < -0.1, "it falls: {expected:?}");
    let all = texts();
    assert!(all.len() > 30);
    for (what, text) in all {
        same(what, text.as_bytes(), expected);
    }
    let text = with(
        "JOINT",
        "! Schäkel 20°\n!  adams_view_name='Gelenk_ä'\nJOINT",
    );
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    same("Latin-1", &latin, expected);
    for big_endian in [false, true] {
        let wide = |text: &str| -> Vec<u8> {
            let bytes = |unit: u16| match big_endian {
                true => unit.to_be_bytes(),
                false => unit.to_le_bytes(),
            };
            text.encode_utf16().flat_map(bytes).collect()
        };
        same("UTF-16", &wide(&text), expected);
        same(
            "UTF-16 with its mark",
            &wide(&format!("\u{FEFF}{text}")),
            expected,
        );
    }
    same(
        "UTF-8 with its mark",
        format!("\u{FEFF}{text}").as_bytes(),
        expected,
    );
}

#[test]
fn bytes_that_are_not_quite_utf_16_come_back_as_they_were() {
    let odd: [&[u8]; 6] = [
        b"\xFF\xFEa\0b",
        b"\xFF\xFEa\0\x00\xD8",
        b"\xFE\xFF",
        b"t\0u\0\xFF\xDF",
        b"\0\0\0\0",
        b"P\0\0A\0R\0T",
    ];
    for bytes in odd {
        let source = Source::from_bytes(None, bytes);
        assert_eq!(source.encode(&source.text), bytes);
        read_source(source);
    }
}

#[test]
fn command_files_may_be_utf_16_too() {
    let folder = std::env::temp_dir().join("cognate_odd_commands");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("wide.acf");
    for text in [
        "\nfile/model=p\nsim/dyn, end=1\n",
        "file/model=p\nsim/dyn, end=1\n",
    ] {
        for mark in ["", "\u{FEFF}"] {
            let units = format!("{mark}{text}").encode_utf16().collect::<Vec<_>>();
            let bytes: Vec<u8> = units.iter().flat_map(|u| u.to_le_bytes()).collect();
            std::fs::write(&file, bytes).unwrap();
            let script = Script::read(&file).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(
                (script.model.as_deref(), script.steps.len()),
                (Some("p"), 1)
            );
            std::fs::write(&file, format!("{mark}{text}")).unwrap();
            let script = Script::read(&file).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(
                (script.model.as_deref(), script.steps.len()),
                (Some("p"), 1)
            );
        }
    }
}

/// (what is odd, the commands): all simulate the pendulum up to 0.4.
const COMMANDS: &[(&str, &str)] = &[
    (
        "small letters",
        "\nfile/model=p\nsim/dyn,end=.4,steps=4\nstop\n",
    ),
    (
        "line ends of Windows",
        "\r\nFILE/MODEL=p.adm , OUTPUT_PREFIX=pre\r\nSIMULATE/DYNAMIC, &\r\n  END=.4, &\r\n  DTOUT=.05\r\nSTOP\r\n",
    ),
    (
        "answers to prompts",
        "p\n\nSIMULATE/DYNAMICS, END=0.4, STEPS=2\nSTOP\n",
    ),
    (
        "one answer",
        "p\nSIMULATE/DYNAMICS, END=0.4, STEPS=2\nSTOP\n",
    ),
    ("no STOP", "FILE/MODEL=p\nSIM/DYN, DUR=0.4, STEP=2"),
    (
        "comments",
        "! first\n\n! second\nfile/model=p ! the model\nsim/dyn ! all\n, end=0.4 ! end\n!\n, steps=3\n\nstop ! here\nsim/dyn, end=9\n",
    ),
    (
        "a mark of byte order",
        "\u{FEFF}file/model=p\nsim/trans, end=0.4, steps=2\nstop\n",
    ),
    (
        "a mark before answers",
        "\u{FEFF}p\n\nsim/trans, end=0.4, steps=2\nstop\n",
    ),
    (
        "questions",
        "\nfile/model=p\ninfo/part\nlist/joint\ntime\nint/list\nequil/list\nsim/ic\nsim/dyn, end=.4, steps=2\nshow\nhelp\nstop\n",
    ),
    (
        "settings",
        "\nfile/model=p\noutput/reqsave\nresults/xrf\npreferences/solver=cxx\nequil/default\nic/err=1e-9\nsim/dyn,end=.4\nstop\n",
    ),
    (
        "pieces",
        "\nfile/model=p\nsim/dyn, end=.1, steps=2\nsim/dyn, end=.1, steps=2\nsim/dyn, dur=.1, dtout=.07\nsim/dyn, end=.4, dtout=1\nstop\n",
    ),
    (
        "off and on",
        "\nfile/model=p\ndeact/joint, id=1\nactivate/joint, range=1,5\nsim/dyn, end=.4, steps=2\nstop\n",
    ),
    (
        "changes",
        "\nfile/model=p\nmarker/20, qp=2,0,0\nmarker/20, qp=1,0,0\npart/2, mass=3\npart/2,\n, mass=2\naccgrav/jgrav=0\naccg/jgrav=-9.81\nsim/dyn,end=.4,steps=2\nstop\n",
    ),
];

#[test]
fn odd_command_files_do_what_plain_ones_do() {
    let expected = moved("plain", read("plain", plain().as_bytes()));
    for (what, text) in COMMANDS {
        let script = Script::from_text(text).unwrap_or_else(|e| panic!("{what}: {e}"));
        let model = script.model.as_deref().unwrap_or_default();
        assert!(model == "p" || model == "p.adm", "{what}: {model:?}");
        let columns = ["DX(20,1)", "DY(20,1)"];
        let options = options(&columns, 1e-10);
        let reading = read(what, plain().as_bytes());
        let mut session = begin(reading.model, what, options);
        obeys(&mut session, &script);
        assert!((session.time() - 0.4).abs() < 1e-12, "{what}");
        let found = columns.map(|c| last(&session, c));
        for (x, y) in found.iter().zip(expected) {
            assert!((x - y).abs() < 1e-8, "{what}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn a_dataset_is_found_whatever_the_case_of_its_name() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("odd_case");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("Pendulum_1.ADM"), plain()).unwrap();
    let file = folder.join("go.acf");
    std::fs::write(
        &file,
        "\nfile/model=pendulum_1\nsim/dyn, end=1, steps=2\nstop\n",
    )
    .unwrap();
    let script = Script::read(&file).unwrap();
    assert!(script.model_file().is_some_and(|f| f.exists()));
}
