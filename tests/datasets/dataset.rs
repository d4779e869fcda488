//! Reading and writing datasets and command files: each rule of the format as a claim.

use cognate::dataset::command::{Command, Script, SimulationKind};
use cognate::dataset::{self, Reading};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::internals::dataset::statement::STATEMENTS;
use cognate::model::*;
use std::collections::BTreeSet;
use std::path::Path;

/// A dataset with a title, a ground, a part with markers, and these statements.
fn reading(statements: &str) -> Reading {
    dataset::read_text(&format!(
        "a title\nPART/1, GROUND\nMARKER/1, PART=1\nMARKER/11, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\n\
         MARKER/2, PART=2\nMARKER/21, PART=2\n{statements}\nEND\n"
    ))
}

/// The model of these statements, in which nothing is wrong.
fn model(statements: &str) -> Model {
    let reading = reading(statements);
    assert!(
        reading.diagnostics.is_empty(),
        "{}",
        cognate::Error::from(reading.diagnostics)
    );
    reading.model
}

fn codes(statements: &str) -> Vec<&'static str> {
    reading(statements)
        .diagnostics
        .iter()
        .map(|d| d.code)
        .collect()
}

fn text_of(formula: &Formula) -> &str {
    match formula {
        Formula::Expression { text, .. } => text,
        Formula::User { .. } => "USER",
    }
}

// ------------------------------------------------------------------------------------------------------------ records

#[test]
fn the_first_line_is_the_title_whatever_it_holds() {
    assert_eq!(
        Model::from_text("!a comment\nPART/1,GROUND\nEND")
            .unwrap()
            .title,
        "!a comment"
    );
    assert_eq!(Model::from_text("\nPART/1,GROUND\nEND").unwrap().title, "");
}

#[test]
fn lines_may_end_in_any_way() {
    for end in ["\n", "\r\n", "\r"] {
        let text = [
            "t",
            "PART/1, GROUND",
            "MARKER/3",
            ", PART=1",
            "!",
            ", QP=1,2,3",
            "END",
            "",
        ]
        .join(end);
        assert_eq!(
            Model::from_text(&text).unwrap().markers[&3].qp,
            [1.0, 2.0, 3.0],
            "{end:?}"
        );
    }
}

#[test]
fn what_follows_end_is_not_read() {
    let m = Model::from_text("t\nPART/1,GROUND\nend\nJOINT/1, NONSENSE\n").unwrap();
    assert!(m.joints.is_empty());
}

#[test]
fn a_missing_end_is_a_warning() {
    let r = dataset::read_text("t\nPART/1,GROUND\n");
    assert_eq!(r.diagnostics[0].code, "missing_end");
    assert_eq!(r.diagnostics[0].severity, Severity::Warning);
}

#[test]
fn a_semicolon_ends_a_statement() {
    let m = model("MARKER/3, PART=2; MARKER/4, PART=2, QP=1,2,3;");
    assert_eq!(m.markers[&4].qp, [1.0, 2.0, 3.0]);
    assert!(m.markers.contains_key(&3));
}

#[test]
fn tabs_and_form_feeds_are_blanks() {
    assert_eq!(
        model("MARKER/3\t,\tPART\t=\t2 ,\x0cQP = 1 , 2\t,3").markers[&3].qp,
        [1.0, 2.0, 3.0]
    );
}

#[test]
fn bytes_outside_utf8_are_windows_1252_and_come_back_the_same() {
    let bytes = b"t\xe9 \x80 \x96 \x81\nPART/1, GROUND\n! gr\xfc\xdfe\nEND\n";
    let source = dataset::Source::from_bytes(None, bytes);
    assert_eq!(source.encoding, dataset::Encoding::Windows1252);
    let reading = dataset::read_source(source);
    assert_eq!(reading.model.title, "té € – \u{81}");
    let formatted = reading.dataset.formatted();
    assert_eq!(
        reading.dataset.source.encode(&formatted),
        b"t\xe9 \x80 \x96 \x81\nPART/1\n, GROUND\n! gr\xfc\xdfe\nEND\n"
    );
}

#[test]
fn columns_count_characters_of_however_many_bytes() {
    for (line, wrong) in [
        ("REQUEST/1, DISPLACEMENT, I=2, CNAMES=\"é\",\"ü\", J=x", "x"),
        ("REQUEST/1, F2=1+*2, CNAMES=\"é\"", "*2"),
        ("REQUEST/1, CNAMES=\"né\", F2=TIME\\F3=1+*2", "*2"),
        ("PART/2, MASS=1 !é\n, VX=é, VY=x", "é, VY"),
    ] {
        let text = format!("t\nPART/1, GROUND\nMARKER/2, PART=1\n{line}\nEND\n");
        let before = &text[..text.rfind(wrong).unwrap()];
        let place = (
            before.matches('\n').count() + 1,
            before.rsplit('\n').next().unwrap().chars().count() + 1,
        );
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        for bytes in [text.as_bytes(), &latin] {
            let reading = dataset::read_source(dataset::Source::from_bytes(None, bytes));
            let d = reading.diagnostics.iter().find(|d| d.line == place.0);
            let d = d.unwrap_or_else(|| panic!("{line}: {:?}", reading.diagnostics));
            assert_eq!((d.line, d.column), place, "{line}: {d}");
        }
    }
}

// ----------------------------------------------------------------------------------------------------------- comments

#[test]
fn a_comment_runs_to_the_end_of_its_line() {
    let m = model("MARKER/3, PART=2 !, QP=9,9,9\n, QP=1,2,3 ! and so on\n");
    assert_eq!(m.markers[&3].qp, [1.0, 2.0, 3.0]);
}

#[test]
fn an_exclamation_mark_in_quotes_is_no_comment() {
    let m = model("REQUEST/1, DISPLACEMENT, I=2, CNAMES=\"a!b\",\"c\", RESULTS_NAME=r");
    assert_eq!(m.requests[&1].cnames, ["a!b", "c"]);
    assert_eq!(m.requests[&1].results_name.as_deref(), Some("r"));
}

#[test]
fn the_last_view_name_before_a_statement_is_its_name() {
    let m = model(
        "!  adams_view_name='OLD'\n! ADAMS_VIEW_NAME = 'testrig.j'\n! adams_view_units='length'\nMARKER/3, PART=2\nMARKER/4, PART=2",
    );
    assert_eq!(m.markers[&3].place.name.as_deref(), Some("testrig.j"));
    assert_eq!(m.markers[&4].place.name, None);
}

// ----------------------------------------------------------------------------------------------------------- keywords

#[test]
fn keywords_are_read_in_any_case() {
    assert_eq!(
        model("joint/1, Revolute, i=21, J=11").joints[&1].kind,
        JointKind::Revolute
    );
}

#[test]
fn leading_zeros_of_numbers_mean_nothing() {
    let m = model("MARKER/0101, PART=02");
    assert_eq!(m.markers[&101].owner, MarkerOwner::Part(2));
}

#[test]
fn keywords_may_be_abbreviated() {
    let m = model(
        "REQ/1, D, I=21, C=a comment\nREQ/2, V, I=21\nREQ/3, A, I=21\nREQ/4, F, I=21, J=11\n\
         GRAPH/1, ELL, CM=2, XS=1, YS=2, ZS=3\nGRAPH/2, BOX, COR=1, X=1, Y=2, Z=3\n\
         SPRING/1, TRANSLATION, I=21, J=11, C=2, K=3\nVAR/1, FUN=1\nACCG/KGRAV=-9.8\nINT/WSTIFF, ERR=1E-5\n\
         EQUIL/ERR=1, IMB=2, TLIM=3, ALIM=4D, MAXIT=5, STAB=6",
    );
    assert!(matches!(
        m.requests[&1].kind,
        RequestKind::Displacement { i: 21, .. }
    ));
    assert!(matches!(m.requests[&2].kind, RequestKind::Velocity { .. }));
    assert!(matches!(
        m.requests[&3].kind,
        RequestKind::Acceleration { .. }
    ));
    assert!(matches!(m.requests[&4].kind, RequestKind::Force { .. }));
    assert_eq!(m.requests[&1].comment.as_deref(), Some("a comment"));
    assert_eq!(
        m.graphics[&1].shape,
        Shape::Ellipsoid {
            cm: 2,
            diameters: [1.0, 2.0, 3.0]
        }
    );
    assert_eq!(
        (m.spring_dampers[&1].damping, m.spring_dampers[&1].stiffness),
        (2.0, 3.0)
    );
    assert_eq!(m.gravity, [0.0, 0.0, -9.8]);
    assert_eq!(
        (m.integrator.method.as_deref(), m.integrator.error),
        (Some("WSTIFF"), Some(1e-5))
    );
    let e = &m.equilibrium;
    assert_eq!(
        [e.error, e.imbalance, e.tlimit, e.stability],
        [1.0, 2.0, 3.0, 6.0].map(Some)
    );
    assert!((e.alimit.unwrap() - 4f64.to_radians()).abs() < 1e-15);
}

#[test]
fn spellings_that_users_mix_mean_the_same() {
    let m = model(
        "SFORCE/1, ROTATION, I=21, J=11, FUNCTION=1\nSFORCE/2, ROTATIONAL, I=21, J=11, FUNCTION=1\n\
         JPRIM/1, PARALLEL, I=21, J=11\nJPRIM/2, PARALLEL_AXES, I=2, J=1\n\
         UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=MILLISECONDS",
    );
    assert!(m.sforces[&1].rotational && m.sforces[&2].rotational);
    assert_eq!(m.primitives[&1].kind, m.primitives[&2].kind);
    assert_eq!(m.units.unwrap().time, "MILLISECOND");
}

#[test]
fn arguments_come_in_any_order() {
    let a = model("JOINT/1, I=21, J=11, REVOLUTE, IC=30D,1");
    let b = model("JOINT/1, IC=30D,1, REVOLUTE, J=11, I=21");
    assert_eq!(a.joints, b.joints);
    assert_eq!(
        a.joints[&1].ic_rotation,
        [Some(30f64.to_radians()), Some(1.0)]
    );
}

#[test]
fn a_statement_without_number_may_have_arguments_on_the_next_line() {
    assert_eq!(
        model("ACCGRAV/\n, JGRAV = -9806.65").gravity,
        [0.0, -9806.65, 0.0]
    );
}

// ------------------------------------------------------------------------------------------------------- continuation

#[test]
fn comments_and_blank_lines_may_stand_inside_a_statement() {
    assert_eq!(
        model("MARKER/3\n! inside\n\n , PART=2\n   \n, QP=1,2\n!\n, 3").markers[&3].qp,
        [1.0, 2.0, 3.0]
    );
}

#[test]
fn an_ampersand_continues_with_or_without_a_comma() {
    let m = model("MARKER/3 & ! so\n, PART=2, &\n  QP=1,2,3");
    assert_eq!(m.markers[&3].qp, [1.0, 2.0, 3.0]);
}

#[test]
fn a_comma_at_the_end_continues_unless_a_statement_begins() {
    let m = model("MARKER/3, PART=2,\n QP=1,2,3\nMARKER/4, PART=2,\nMARKER/5, PART=2");
    assert_eq!(m.markers[&3].qp, [1.0, 2.0, 3.0]);
    assert!(m.markers.contains_key(&4) && m.markers.contains_key(&5));
}

#[test]
fn two_commas_across_a_line_end_make_no_empty_value() {
    let m = model("ARRAY/1, IC, NUMBERS = \n, 1, 2,\n, 3\nVARIABLE/1, FUNCTION=USER(1,2,\n, 3)");
    assert_eq!(m.arrays[&1].kind, ArrayKind::Ic(vec![1.0, 2.0, 3.0]));
    assert!(
        matches!(&m.variables[&1].function, Formula::User { constants, .. } if *constants == [1.0, 2.0, 3.0])
    );
}

// --------------------------------------------------------------------------------------------------------- expressions

#[test]
fn in_an_expression_a_leading_comma_only_continues() {
    let m = model("REQUEST/1, F2 = (DX(2,1)*DX(2,1) +\n, DY(2,1)*MAX(1,\n, 2))/\n, DM(2,1)\\");
    let RequestKind::Functions(f) = &m.requests[&1].kind else {
        panic!()
    };
    assert_eq!(
        text_of(f[1].as_ref().unwrap()),
        "(DX(2,1)*DX(2,1) + DY(2,1)*MAX(1, 2))/ DM(2,1)"
    );
}

#[test]
fn an_expression_may_begin_on_the_next_line() {
    assert_eq!(
        text_of(&model("VARIABLE/1\n, FUNCTION =\n, TIME").variables[&1].function),
        "TIME"
    );
}

#[test]
fn a_backslash_ends_an_expression() {
    let m = model("GFORCE/1, I=21, RM=1, FX=1\\FY=2\\ FZ=3\\\n, TX=4\\TY=5\\TZ=6");
    let texts: Vec<_> = m.gforces[&1]
        .force
        .iter()
        .chain(&m.gforces[&1].torque)
        .flatten()
        .map(text_of)
        .collect();
    assert_eq!(texts, ["1", "2", "3", "4", "5", "6"]);
}

#[test]
fn a_comma_before_an_argument_ends_an_expression() {
    let m = model("REQUEST/1, F8=MAX(1,2),C=RForce X Y Z");
    let RequestKind::Functions(f) = &m.requests[&1].kind else {
        panic!()
    };
    assert_eq!(text_of(f[7].as_ref().unwrap()), "MAX(1,2)");
    assert_eq!(m.requests[&1].comment.as_deref(), Some("RForce X Y Z"));
}

#[test]
fn a_slash_at_its_end_or_before_an_argument_ends_an_expression() {
    let m = model("VFORCE/1, I=21, RM=1, FX=1/2/FY=2/\n, FZ=3/");
    let texts: Vec<_> = m.vforces[&1].force.iter().flatten().map(text_of).collect();
    assert_eq!(texts, ["1/2", "2", "3"]);
}

#[test]
fn an_expression_knows_where_each_of_its_lines_stands() {
    let m = model("VARIABLE/1, FUNCTION = TIME +\n!\n  , 2*TIME");
    let f = &m.variables[&1].function;
    assert_eq!(text_of(f), "TIME + 2*TIME");
    assert_eq!(f.file_place(0), Some((8, 24)));
    assert_eq!(f.file_place(5), Some((8, 29)));
    assert_eq!(f.file_place(7), Some((10, 5)));
    assert_eq!(f.file_place(9), Some((10, 7)));
}

#[test]
fn routines_go_with_user_functions() {
    let m = model(
        "VARIABLE/1, ROUTINE=lib::a, FUNCTION=USER(1.5,-2,3D)\nVARIABLE/2, FUNCTION=USER()\\ROUTINE=lib::b",
    );
    let Formula::User { constants, routine } = &m.variables[&1].function else {
        panic!()
    };
    assert_eq!(constants[..2], [1.5, -2.0]);
    assert_eq!(routine.as_deref(), Some("lib::a"));
    assert!(
        matches!(&m.variables[&2].function, Formula::User { routine: Some(r), .. } if r == "lib::b")
    );
}

// --------------------------------------------------------------------------------------------------------------- values

#[test]
fn numbers_are_written_as_in_fortran_and_c() {
    let m = model(
        "ARRAY/1, IC, NUMBERS=1, -.5, 1.0E-02, 4.32e+09, +40.0E+03, 1.387778781E-014, 5., - 7",
    );
    let expected = vec![1.0, -0.5, 0.01, 4.32e9, 40e3, 1.387778781e-14, 5.0, -7.0];
    assert_eq!(m.arrays[&1].kind, ArrayKind::Ic(expected));
}

#[test]
fn the_suffix_d_means_degrees() {
    let m = model("MARKER/3, PART=2, REULER=90D, 1.5d, 2");
    assert_eq!(
        m.markers[&3].orientation,
        Orientation::Euler([90f64.to_radians(), 1.5f64.to_radians(), 2.0])
    );
}

#[test]
fn texts_run_to_a_comma_that_begins_an_argument() {
    let m = model(
        "STRING/1, STRING = v14.00. of it\nREQUEST/1, DISPLACEMENT, I=2, COMMENT=a - b. c, RM=1\nSTRING/2, STRING=C:\\path\\x, y",
    );
    assert_eq!(m.strings[&1].text, "v14.00. of it");
    assert_eq!(m.requests[&1].comment.as_deref(), Some("a - b. c"));
    assert_eq!(m.strings[&2].text, "C:\\path\\x, y");
}

#[test]
fn lists_with_colons_are_words() {
    let m = model(
        "PART/3, EXACT=X:PSI:THETA\nJOINT/1, REVOLUTE, I=21,J=11\nJOINT/2, CYLINDRICAL,I=2,J=1\nCOUPLER/1, JOINTS=1,2, TYPE=R:T, SCALES=18",
    );
    assert_eq!(m.parts[&3].exact, [true, false, false, true, true, false]);
    assert_eq!(m.couplers[&1].rotational, [Some(true), Some(false)]);
    assert_eq!(m.couplers[&1].scales, [1.0, 18.0]);
}

#[test]
fn the_consistency_factor_follows_from_the_units() {
    let ucf = |u: &str| model(&format!("UNITS/{u}")).units.unwrap().ucf;
    assert_eq!(
        ucf("FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND"),
        1.0
    );
    assert_eq!(
        ucf("FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND"),
        1000.0
    );
    assert_eq!(
        ucf("FORCE=KNEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND"),
        1000.0
    );
    assert_eq!(ucf("SYSTEM=CGS"), 1.0);
    assert!((ucf("SYSTEM=IPS") - 386.0885827).abs() < 1e-7);
    assert_eq!(ucf("UCF=12"), 12.0);
    assert_eq!(ucf("SYSTEM=NONE"), 1.0);
}

#[test]
fn slugs_and_slinches_are_consistent_with_pounds_of_force() {
    let u = Units::new("POUND_FORCE", "SLUG", "FOOT", "SECOND");
    assert!((u.ucf - 1.0).abs() < 1e-12);
    let u = Units::new("POUND_FORCE", "SLINCH", "INCH", "SECOND");
    assert!((u.ucf - 1.0).abs() < 1e-12);
    let u = Units::new("POUNDAL", "POUND_MASS", "FOOT", "SECOND");
    assert!((u.ucf - 1.0).abs() < 1e-12);
}

// ------------------------------------------------------------------------------------------------------------- elements

#[test]
fn a_motion_is_on_a_joint_or_between_markers() {
    let m = model(
        "JOINT/1, REVOLUTE, I=21, J=11\nMOTION/1, JOINT=1, ROTATION, VELOCITY, FUNCTION=TIME\\, ICDISP=30D\n\
         MOTION/2, I=2, B2, J=1, FUNCTION=0\nJOINT/2, REVOLUTE, I=2, J=1\nMOTION/3, JOINT=2, FUNCTION=1",
    );
    assert_eq!(m.motions[&1].driven, Driven::JointRotation(1));
    assert_eq!(m.motions[&1].level, Level::Velocity);
    assert_eq!(m.motions[&1].ic_displacement, Some(30f64.to_radians()));
    assert_eq!(
        m.motions[&2].driven,
        Driven::Markers {
            i: 2,
            j: 1,
            component: 4
        }
    );
    assert_eq!(m.motions[&3].driven, Driven::Joint(2));
}

#[test]
fn ic_of_a_joint_is_an_angle_or_a_distance_by_its_type() {
    let m = model(
        "JOINT/1, REVOLUTE, I=21, J=11, IC=10D\nJOINT/2, TRANSLATIONAL, I=2, J=1, IC=0, 0.2\n\
         MARKER/31,PART=2\nMARKER/32,PART=1\nJOINT/3, CYLINDRICAL, I=31, J=32, ICTRAN=1,2, ICROT=90D,3",
    );
    assert_eq!(m.joints[&1].ic_rotation, [Some(10f64.to_radians()), None]);
    assert_eq!(m.joints[&2].ic_translation, [Some(0.0), Some(0.2)]);
    assert_eq!(m.joints[&3].ic_translation, [Some(1.0), Some(2.0)]);
    assert_eq!(
        m.joints[&3].ic_rotation,
        [Some(90f64.to_radians()), Some(3.0)]
    );
}

#[test]
fn several_rows_of_a_spline_make_a_surface() {
    let m = model(
        "SPLINE/1, X=1,2,3,4\n, Y=10, 1,2,3,4\n, Y=20, 5,6,7,8\nSPLINE/2, X=1,2,3,4, Y=5,6,7,8, LINEAR_EXTRAPOLATE",
    );
    assert_eq!(m.splines[&1].z, [10.0, 20.0]);
    assert_eq!(
        m.splines[&1].y,
        [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]
    );
    assert!(m.splines[&2].linear_extrapolate && m.splines[&2].z.is_empty());
}

#[test]
fn matrices_are_by_rows_by_columns_or_sparse() {
    let m = model(
        "MATRIX/1, FULL=RORDER, ROWS=2, COLUMNS=3, VALUES=1,2,3,4,5,6\n\
         MATRIX/2, FULL=CORDER, ROWS=2, COLUMNS=3, VALUES=1,4,2,5,3,6\n\
         MATRIX/3, SPARSE, ROWS=2, COLUMNS=3, I=1,2, J=2,3, VALUES=2,6",
    );
    let full = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(m.matrices[&1].by_rows(), Some(full.clone()));
    assert_eq!(m.matrices[&2].by_rows(), Some(full));
    assert_eq!(
        m.matrices[&3].by_rows(),
        Some(vec![0.0, 2.0, 0.0, 0.0, 0.0, 6.0])
    );
}

#[test]
fn arguments_without_mechanics_are_kept_and_told() {
    let Reading {
        model: m,
        diagnostics,
        ..
    } = reading(
        "JOINT/1, REVOLUTE, I=21, J=11, DELTA_V = 0.01, MU_DYN_ROT=0.3\nMATERIAL/1, NAME=steel, DENSITY=7.8E-6",
    );
    let said: Vec<(&str, &str)> = (diagnostics.iter())
        .map(|d| (d.code, d.message.as_str()))
        .collect();
    let what = "accepted, and without effect here: JOINT DELTA_V; MATERIAL";
    assert_eq!(said, [("ignored", what)]);
    let extra = &m.joints[&1].place.extra;
    assert_eq!(extra[0], ("DELTA_V".to_owned(), "0.01".to_owned()));
    assert_eq!(
        m.others[&ElementKind::Material.id(1)].place.extra[0],
        ("NAME".to_owned(), "steel".to_owned())
    );
}

#[test]
fn elements_are_unique_by_kind_not_across_kinds() {
    assert!(codes("VARIABLE/1, FUNCTION=1\nJOINT/1, FIXED, I=21, J=11").is_empty());
    assert_eq!(
        codes("VARIABLE/1, FUNCTION=1\nVARIABLE/1, FUNCTION=2"),
        ["defined_twice"]
    );
}

#[test]
fn references_may_point_forward() {
    assert!(codes("SFORCE/1, ROTATION, I=99, J=11, FUNCTION=VARVAL(7)\nMARKER/99, PART=2\nVARIABLE/7, FUNCTION=1").is_empty());
}

// --------------------------------------------------------------------------------------------------------------- errors

#[test]
fn all_mistakes_of_a_file_are_reported_at_once() {
    let found = codes(
        "JOINT/1, REVOLUTED, I=21, J=11, X=3, QQ\nNONSENSE/2\nMARKER/3, PART=7, QP=1,z,3\nVARIABLE/1, FUNCTION=SIN(",
    );
    assert_eq!(
        found,
        [
            "unknown_argument",
            "unknown_argument",
            "unknown_argument",
            "unknown_statement",
            "unknown_element",
            "not_a_number",
            "unexpected_end"
        ]
    );
}

/// Returns true unless a message is about an argument that its statement has not, by the table.
fn is_placed(d: &Diagnostic) -> bool {
    let (Some(element), Some(argument)) = (&d.element, d.argument) else {
        return true;
    };
    let keyword = element.split('/').next().unwrap();
    let row = STATEMENTS
        .iter()
        .find(|s| s.keyword().eq_ignore_ascii_case(keyword));
    row.is_some_and(|row| row.arguments().iter().any(|a| a.keyword() == argument))
}

/// Each file of the folder holds one fault; what is printed stands beside it. With BLESS set the texts are written anew,
/// to be read before they are kept.
#[test]
fn each_bad_input_gets_its_message() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/errors");
    let mut seen = 0;
    let mut wrong = Vec::new();
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    files.sort();
    for path in files
        .iter()
        .filter(|p| p.extension().is_some_and(|e| e == "adm"))
    {
        let text = std::fs::read_to_string(path).unwrap();
        let found = dataset::read_text(&text).diagnostics;
        assert!(!found.is_empty(), "{} has a fault", path.display());
        for d in &found {
            assert!(is_placed(d), "{}: {d}", path.display());
        }
        let printed = format!("{}\n", cognate::Error::from(found));
        let beside = path.with_extension("txt");
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&beside, &printed).unwrap();
        }
        if std::fs::read_to_string(&beside).unwrap_or_default() != printed {
            wrong.push(format!("{}:\n{printed}", path.display()));
        }
        seen += 1;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 80, "{seen} bad inputs");
}

// -------------------------------------------------------------------------------------------------------------- writing

#[test]
fn formatting_keeps_comments_and_suffixes_where_they_are() {
    let r = dataset::read_text(
        "t\n! before\nMARKER/3,PART=1 ! owner\n!, QP=9,9,9\n, REULER=90D,0,1E-5,QP=1.50,0,0 ! place\nPART/1,GROUND\nVAR/1,FUN=1 ! end\n\n\nEND ! over\nrest\n",
    );
    assert_eq!(
        r.dataset.formatted(),
        "t\n! before\nMARKER/3\n, PART = 1 ! owner\n!, QP=9,9,9\n, REULER = 90D, 0, 1E-5\n, QP = 1.5, 0, 0 ! place\n\
         PART/1\n, GROUND\nVARIABLE/1\n, FUNCTION = 1 ! end\nEND ! over\nrest\n"
    );
}

#[test]
fn long_lists_and_expressions_are_broken_before_column_81() {
    let numbers: Vec<String> = (0..60).map(|k| format!("{}.125", k * k)).collect();
    let terms: Vec<String> = (1..40)
        .map(|k| format!("{k}E-3*SIN({k}*TIME)**2"))
        .collect();
    let statements = format!(
        "ARRAY/1, IC, NUMBERS={}\nVARIABLE/1, FUNCTION={}",
        numbers.join(","),
        terms.join("+")
    );
    let first = reading(&statements);
    let text = first.dataset.formatted();
    assert!(text.lines().all(|l| l.len() <= 80), "{text}");
    let second = dataset::read_text(&text);
    assert!(second.diagnostics.is_empty());
    assert_eq!(second.model.arrays[&1].kind, first.model.arrays[&1].kind);
    let bare = |m: &Model| text_of(&m.variables[&1].function).replace(' ', "");
    assert_eq!(bare(&second.model), bare(&first.model));
    assert_eq!(second.dataset.formatted(), text);
}

#[test]
fn a_statement_with_a_mistake_is_formatted_as_it_stands() {
    let r = dataset::read_text("t\nPART/1,   GROUNDD\nPART/2,GROUND\nEND\n");
    assert_eq!(
        r.dataset.formatted(),
        "t\nPART/1,   GROUNDD\nPART/2\n, GROUND\nEND\n"
    );
}

#[test]
fn a_model_built_by_a_program_is_written_and_read() {
    let mut m = Model {
        title: "built".into(),
        ..Model::default()
    };
    m.units = Some(Units::new("NEWTON", "KILOGRAM", "MILLIMETER", "SECOND"));
    m.parts.insert(
        1,
        Part {
            ground: true,
            ..Part::default()
        },
    );
    m.parts.insert(
        2,
        Part {
            mass: 0.1 + 0.2,
            cm: Some(2),
            ip: [1.0, 2.0, 2.5, 0.1, 0.0, 0.0],
            ..Part::default()
        },
    );
    for (id, part) in [(1, 1), (2, 2)] {
        m.markers.insert(
            id,
            Marker {
                owner: MarkerOwner::Part(part),
                ..Marker::default()
            },
        );
    }
    m.joints.insert(
        7,
        Joint {
            kind: JointKind::Hooke,
            i: 2,
            j: 1,
            ..Joint::default()
        },
    );
    m.joints.get_mut(&7).unwrap().place.name = Some("HOOKE_7".into());
    m.variables.insert(
        3,
        Variable {
            function: Formula::text("2*TIME"),
            ..Variable::default()
        },
    );
    m.gravity = [0.0, -9806.65, 0.0];
    m.integrator.method = Some("HHT".into());
    let again = Model::from_text(&m.to_text()).unwrap();
    assert_eq!(again.parts[&2].mass, 0.1 + 0.2);
    assert_eq!(again.parts[&2].ip, m.parts[&2].ip);
    assert_eq!(again.joints[&7].kind, JointKind::Hooke);
    assert_eq!(again.joints[&7].place.name.as_deref(), Some("HOOKE_7"));
    assert_eq!(
        (again.units, again.gravity, again.integrator),
        (m.units.clone(), m.gravity, m.integrator.clone())
    );
    assert_eq!(text_of(&again.variables[&3].function), "2*TIME");
}

// ------------------------------------------------------------------------------------------------------------- commands

fn script(text: &str) -> Script {
    Script::from_text(text).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_command_file_names_its_dataset_by_file_model() {
    for text in [
        "\n! comment\nfile/model=test_1\nstop\n",
        "FILE/MODEL=test_1\nSTOP",
    ] {
        let s = script(text);
        assert_eq!(s.model_file().unwrap().to_str(), Some("test_1.adm"));
        assert_eq!(s.steps.len(), 1);
    }
    let s = script("FILE/MODEL=bearing.adm, OUTPUT_PREFIX=sim_std\n");
    assert_eq!(s.model_file().unwrap().to_str(), Some("bearing.adm"));
    assert_eq!(s.output.as_deref(), Some("sim_std"));
}

#[test]
fn a_command_file_may_answer_the_old_prompts() {
    let s = script("Test14_ADAMS\nTest14_LIN\nSIMULATE/STATICS\nSTOP\n");
    assert_eq!(
        (s.model.as_deref(), s.output.as_deref()),
        (Some("Test14_ADAMS"), Some("Test14_LIN"))
    );
    assert_eq!(s.steps.len(), 2);
    assert_eq!(s.steps[0].line, 3);
    let s = script("model.adm\n\nSTOP\n");
    assert_eq!(
        (s.model.as_deref(), s.output.as_deref()),
        (Some("model.adm"), Some("model"))
    );
}

#[test]
fn simulations_are_typed() {
    let s = script(
        "\nsim/dyn, end=1.5, dtout=.005\nSIMULATE/KINEMATICS, DURATION=2, STEPS=50\nSIM/STAT\nsim/trans, end=1, steps=3\nsimulate/initial_conditions",
    );
    let all: Vec<_> = s
        .steps
        .iter()
        .filter_map(|s| match s.command {
            Command::Simulate(s) => Some(s),
            _ => None,
        })
        .collect();
    use SimulationKind::*;
    assert_eq!(
        all.iter().map(|s| s.kind).collect::<Vec<_>>(),
        [Dynamic, Kinematic, Static, Transient, InitialConditions]
    );
    assert_eq!((all[0].end, all[0].dtout), (Some(1.5), Some(0.005)));
    assert_eq!((all[1].duration, all[1].steps), (Some(2.0), Some(50)));
}

#[test]
fn commands_change_elements_by_the_table_of_statements() {
    let mut m = model(
        "JOINT/1, REVOLUTE, I=21, J=11\nMOTION/4, JOINT=1, ROTATION, VELOCITY, FUNCTION=2*TIME\nVARIABLE/5, IC=3, FUNCTION=0",
    );
    let s = script(
        "\nMOTION/4, DISPLACEMENT, FUNC = -16+STEP5(time,1.9,0,2,16)\nvar/5, fun=  4.76811838366190430e+000\naccg/kgrav=0\nMARKER/21, QP=1,2,3\nint/hht, err=1e-7\n",
    );
    m.gravity = [1.0, 2.0, 3.0];
    for step in &s.steps {
        m.apply(&step.command).unwrap_or_else(|e| panic!("{e}"));
    }
    assert_eq!(m.motions[&4].level, Level::Displacement);
    assert_eq!(m.motions[&4].driven, Driven::JointRotation(1));
    assert_eq!(
        text_of(&m.motions[&4].function),
        "-16+STEP5(time,1.9,0,2,16)"
    );
    assert_eq!(
        text_of(&m.variables[&5].function),
        "4.76811838366190430e+000"
    );
    assert_eq!(m.variables[&5].ic, Some(3.0));
    assert_eq!(m.gravity, [1.0, 2.0, 0.0]);
    assert_eq!(m.markers[&21].qp, [1.0, 2.0, 3.0]);
    assert_eq!(m.integrator.error, Some(1e-7));
}

#[test]
fn a_command_that_does_not_fit_leaves_the_model_as_it_was() {
    let mut m = model("JOINT/1, REVOLUTE, I=21, J=11\nVARIABLE/51, FUNCTION=0");
    let before = m.clone();
    for text in ["\nVARIABLE/52, FUN=1", "\nDEACTIVATE/JOINT, ID=2"] {
        let e = m.apply(&script(text).steps[0].command).unwrap_err();
        assert_eq!(e.first().code, "unknown_element");
        assert_eq!(m, before);
    }
    let e = m
        .apply(&script("\nVARIABLE/52, FUN=1").steps[0].command)
        .unwrap_err();
    assert_eq!(e.first().help, ["did you mean 51?"]);
}

#[test]
fn elements_are_switched_off_and_on_by_number_and_range() {
    let mut m = model(
        "JOINT/1, FIXED, I=21, J=11\nJOINT/5, FIXED, I=2, J=1\nSENSOR/1000, VALUE=1, GE, FUNCTION=TIME",
    );
    let s = script(
        "\nDEACTIVATE/JOINT, RANGE = 1, 10\ndeactivate/sensor, ID=1000\nACTIVATE/JOINT, ID=5\n",
    );
    for step in &s.steps {
        m.apply(&step.command).unwrap_or_else(|e| panic!("{e}"));
    }
    let off: Vec<_> = m.inactive.iter().map(ToString::to_string).collect();
    assert_eq!(off, ["JOINT/1", "SENSOR/1000"]);
}

#[test]
fn commands_continue_like_statements() {
    let s = script(
        "\nVARIABLE/1001, FUNC= -step5(time,0,0,2,20*PI) &\n -STEP5(TIME,2.0,0,4,20*PI)\nVARIABLE/9105 &\n, FUNCTION=STEP(TIME,0,0,1,1)\n",
    );
    let mut m = model("VARIABLE/1001, FUNCTION=0\nVARIABLE/9105, FUNCTION=0");
    for step in &s.steps {
        m.apply(&step.command).unwrap_or_else(|e| panic!("{e}"));
    }
    assert_eq!(
        text_of(&m.variables[&1001].function),
        "-step5(time,0,0,2,20*PI) -STEP5(TIME,2.0,0,4,20*PI)"
    );
    assert_eq!(text_of(&m.variables[&9105].function), "STEP(TIME,0,0,1,1)");
}

#[test]
fn mistakes_in_commands_are_reported_with_their_lines() {
    let e = Script::from_text("\nsim/dyn\nSIMULATE/DYNAMIC, END=1, DURATION=2\nfoo/bar\nDEACTIVATE/NOTHING, ID=1\nsim/dyn, end=1, steps=0\n").unwrap_err();
    let found: Vec<_> = e.diagnostics().iter().map(|d| (d.line, d.code)).collect();
    assert_eq!(
        found,
        [
            (2, "missing_argument"),
            (3, "excluded_argument"),
            (4, "unknown_statement"),
            (5, "unknown_statement"),
            (6, "unfit_value")
        ]
    );
}

#[test]
fn linear_save_and_reload_are_understood() {
    let s = script(
        "\nLINEAR/EIGENSOL, COORDS = 1, 25\nLINEAR/STATEMAT, FILE=a.mat\nSAVE/SYSTEM=s1\nRELOAD/SYSTEM=s1\n",
    );
    assert!(
        matches!(&s.steps[0].command, Command::Linear(l) if l.eigensolution && l.coords == [1, 25])
    );
    assert!(
        matches!(&s.steps[1].command, Command::Linear(l) if l.state_matrices && l.file.as_deref() == Some("a.mat"))
    );
    assert!(matches!(&s.steps[2].command, Command::Save(Some(f)) if f == "s1"));
    assert!(matches!(&s.steps[3].command, Command::Reload(Some(f)) if f == "s1"));
}

#[test]
fn simulations_of_a_log_that_nobody_commanded_become_commands() {
    let log = " command: simulate/initial_conditions\n\n command: var/1, fun=2\n\n  Begin Simulation\n\n\
               ****** Performing Dynamic Simulation using Gstiff I3 Integrator ******\n\
               0.00000E+00  1.0E-04  0  0  1  2.47\n5.00000E-03  5.0E-03  26  8  2  0:03\n\n  End Simulation\n\
               command: sim/dyn, end=1, steps=2\n Begin Simulation\n0.005 1 1 1 1 1\n1.0 1 1 1 1 1\n End Simulation\n command: stop\n";
    let s = Script::from_message_log_text(log).unwrap_or_else(|e| panic!("{e}"));
    let words: Vec<String> = s
        .steps
        .iter()
        .map(|s| match &s.command {
            Command::Simulate(x) => format!("{:?} {:?} {:?}", x.kind, x.end, x.steps),
            Command::Change(r) => r.element(),
            Command::Stop => "stop".into(),
            other => format!("{other:?}"),
        })
        .collect();
    assert_eq!(
        words,
        [
            "InitialConditions None None",
            "VARIABLE/1",
            "Dynamic Some(0.005) Some(1)",
            "Dynamic Some(1.0) Some(2)",
            "stop"
        ]
    );
}

// -------------------------------------------------------------------------------------------------------- hostile bytes

#[test]
fn deep_nesting_and_long_lines_are_read_in_reasonable_time() {
    let begun = std::time::Instant::now();
    for (text, codes) in [
        (
            format!(
                "t\nVARIABLE/1, FUNCTION={}1{}\nEND",
                "(".repeat(20_000),
                ")".repeat(20_000)
            ),
            &["limit_nesting"][..],
        ),
        (
            format!("t\n{}\nEND", ",".repeat(200_000)),
            &["unknown_statement"],
        ),
        (format!("t\nPART/1{}\nEND", "\n,".repeat(100_000)), &[]),
        (
            format!("t\nPART/1\n{}", "!\n".repeat(100_000)),
            &["missing_end"],
        ),
        (
            format!("t\nPART/1 {}", "&\n".repeat(100_000)),
            &["missing_end"],
        ),
        (
            format!("t\n{}", "PART/1;".repeat(20_000)),
            &["defined_twice", "missing_end"],
        ),
        (
            "t\nMATRIX/1, FULL=RORDER, ROWS=2000000000, COLUMNS=2000000000, VALUES=1\nEND"
                .to_string(),
            &["wrong_count"],
        ),
    ] {
        let diagnostics = dataset::read_text(&text).diagnostics;
        let mut found: BTreeSet<&str> = diagnostics.iter().map(|d| d.code).collect();
        assert!(found.remove("no_ground"), "{found:?}");
        assert!(found.into_iter().eq(codes.iter().copied()), "{codes:?}");
        // as commands it is read or refused, and neither takes long
        let _ = Script::from_text(&text);
    }
    // some seconds, nothing optimized; what grows with the square of the length takes minutes
    assert!(begun.elapsed().as_secs() < 120, "{:?}", begun.elapsed());
}

#[test]
fn every_kind_of_element_has_one_statement() {
    for &kind in ElementKind::ALL {
        let rows = STATEMENTS.iter().filter(|row| row.kind() == Some(kind));
        assert_eq!(rows.count(), 1, "{kind}");
    }
}

#[test]
fn what_is_missing_as_a_whole_stands_after_the_mistakes_it_may_follow_from() {
    for wrong in ["PRT/1, GROUND", "PART/1, GROUDN", "PART1, GROUND"] {
        let text = format!("t\n{wrong}\nMARKER/1, PART=1\nEND\n");
        let found = dataset::read_text(&text).diagnostics;
        let errors: Vec<_> = found
            .iter()
            .filter(|d| d.severity == Severity::Error)
            .collect();
        assert_eq!(errors[0].line, 2, "{found:?}");
    }
}

#[test]
fn a_file_that_is_no_text_is_refused_as_such() {
    let folder = std::env::temp_dir().join(format!("cognate_no_text_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let model = "t\nPART/1, GROUND\nEND\n";
    let wide: Vec<u8> = model.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (name, bytes, is_text) in [
        (
            "packed.adm",
            b"PK\x03\x04\x14\0\0\0\x08\0abc".to_vec(),
            false,
        ),
        (
            "random.adm",
            (0..4000u32).map(|k| (k * k % 65_521 % 256) as u8).collect(),
            false,
        ),
        (
            "stray.adm",
            b"t\n! a remark\0 of much\x01 text\nPART/1, GROUND\n! more\nEND\n".to_vec(),
            true,
        ),
        ("padded.adm", [model.as_bytes(), &[0; 40]].concat(), true),
        ("wide.adm", wide, true),
    ] {
        let file = folder.join(name);
        std::fs::write(&file, bytes).unwrap();
        match dataset::read(&file) {
            Ok(reading) => {
                let wrong = reading
                    .diagnostics
                    .iter()
                    .any(|d| d.severity == Severity::Error);
                assert!(is_text && !wrong, "{name}: {:?}", reading.diagnostics);
            }
            Err(e) => {
                assert!(!is_text, "{name}: {e}");
                assert_eq!(e.diagnostics()[0].code, "no_text");
            }
        }
        // commands are read through the same door
        let refused = Script::read(&file).err();
        let is_told = refused.is_some_and(|e| e.diagnostics()[0].code == "no_text");
        assert_eq!(is_told, !is_text, "{name}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn what_is_found_in_an_element_whose_data_was_not_understood_may_follow_from_that() {
    let curve = |more: &str| {
        let text = format!(
            "a curve\nPART/1, GROUND\nMATRIX/1, FULL=RORDER, ROWS=4, COLUMNS=3{more}\n\
             , VALUES=0,0,0,1,0,0,1,1,0,0,1,0\nCURVE/1, CLOSED, CURVE_POINTS, MATRIX=1\n\
             ARRAY/1, IC, NUMBERS=1{more}\nLSE/1, X=1, A=1\nEND\n"
        );
        let found = dataset::read_text(&text).diagnostics;
        let errors = found.iter().filter(|d| d.severity == Severity::Error);
        errors
            .map(|d| (d.element.clone().unwrap_or_default(), d.code))
            .collect::<Vec<_>>()
    };
    let of = |element: &str, found: &[(String, &str)]| found.iter().any(|d| d.0 == element);
    // its ends are apart, and the array is no state
    let found = curve("");
    assert!(of("CURVE/1", &found) && of("LSE/1", &found), "{found:?}");
    // as far as anybody can tell from what was read
    let found = curve(", WIDTH=3");
    let expected = [
        ("MATRIX/1", "unknown_argument"),
        ("ARRAY/1", "unknown_argument"),
    ];
    assert_eq!(found, expected.map(|(e, c)| (e.to_owned(), c)));
}

#[test]
fn an_angle_about_an_axis_square_to_that_of_the_joint_is_told_with_the_one_that_turns() {
    let doubts = |asked: &str| {
        let text = format!(
            "a shaft along x\nPART/1, GROUND\nMARKER/10, PART=1\nMARKER/11, PART=1, REULER=90D,90D,0D\n\
             PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, REULER=90D,90D,0D\n\
             PART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3\n\
             JOINT/1, REVOLUTE, I=21, J=11\nVARIABLE/1, FUNCTION={asked}\nEND\n"
        );
        let found = dataset::read_text(&text).model.doubts().into_iter();
        let found = found.filter(|d| d.code == "nothing_turns");
        found
            .map(|d| format!("{} | {}", d.message, d.help.join(" | ")))
            .collect::<Vec<_>>()
    };
    for (asked, said) in [
        (
            "WZ(21,11)",
            "FUNCTION: WZ(21,11) is zero for ever: JOINT/1 turns about x of ground | it turns by WX(21,11)",
        ),
        (
            "WX(20,10,21)",
            "FUNCTION: WX(20,10,21) is zero for ever: JOINT/1 turns about z of MARKER/21 | it turns by WZ(20,10,21)",
        ),
        (
            "2*AZ(20,10)",
            "FUNCTION: AZ(20,10) does not turn: JOINT/1 turns about x of MARKER/10 | it turns by AX(20,10)",
        ),
        (
            "WY(20)",
            "FUNCTION: WY(20) is zero for ever: JOINT/1 turns about x of ground | it turns by WX(20)",
        ),
    ] {
        assert_eq!(doubts(asked), [said], "{asked}");
    }
    for asked in [
        "WZ(21,11,11)",
        "WX(21,11)+WY(21,11)+WZ(21,11)",
        "AZ(21,11)",
        "AX(20,10)",
        // of axes that the joint does not hold, and of parts that it does not join
        "WZ(21,11,30)",
        "WZ(30,10)",
    ] {
        assert_eq!(doubts(asked), [""; 0], "{asked}");
    }
}

#[test]
fn a_force_between_markers_between_which_nothing_acts_is_told_with_what_acts_there() {
    let doubts = |asked: &str| {
        let text = format!(
            "asked\nPART/1, GROUND\nMARKER/1, PART=1\nMARKER/2, PART=1\nPART/2, MASS=1, CM=20, IP=1,1,1\n\
             MARKER/20, PART=2\nMARKER/21, PART=2\nMARKER/22, PART=1, FLOATING\n\
             JOINT/1, REVOLUTE, I=20, J=1\nVFORCE/1, I=21, JFLOAT=22, RM=1, FX=1\\FY=0\\FZ=0\n\
             SFORCE/1, TRANSLATION, I=21, J=2, ACTIONONLY, FUNCTION=1\n{asked}\nEND\n"
        );
        let found = dataset::read_text(&text)
            .diagnostics
            .into_iter()
            .filter(|d| d.code == "nothing_acts");
        found
            .map(|d| format!("{} {:?}", d.message, d.help))
            .collect::<Vec<_>>()
    };
    let there = [
        "REQUEST/1, FORCE, I=20, J=1",
        "REQUEST/1, FORCE, I=1, J=20, RM=2",
        "REQUEST/1, FORCE, I=21",
        "REQUEST/1, F2=FX(21,22)+TM(1,20)\\F3=FZ(21)",
    ];
    for asked in there {
        assert_eq!(doubts(asked), [""; 0], "{asked}");
    }
    let nowhere = [
        (
            "REQUEST/1, FORCE, I=20, J=2",
            "the FORCE",
            "JOINT/1 acts between MARKER/20 and MARKER/1",
        ),
        ("REQUEST/1, FORCE, I=20", "the FORCE", "without a reaction"),
        (
            "VARIABLE/1, FUNCTION=2*TY(21,1)",
            "FUNCTION: TY(21,1)",
            "nothing acts between MARKER/21 and MARKER/1",
        ),
        (
            "VARIABLE/1, FUNCTION=FM(20)",
            "FUNCTION: FM(20)",
            "without a reaction",
        ),
    ];
    for (asked, what, why) in nowhere {
        let found = doubts(asked);
        assert!(
            found.len() == 1 && found[0].contains(what) && found[0].contains(why),
            "{asked}: {found:?}"
        );
    }
}

/// The whole of a mistake is its statement: what names the element that the statement should make
/// is right.
#[test]
fn a_misspelled_statement_is_told_once() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/broken");
    let mut n = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let sound = std::fs::read_to_string(entry.expect("a file").path()).expect("a text");
        for (k, line) in sound.lines().enumerate().skip(1) {
            let Some((word, _)) = line.split_once('/').filter(|(w, _)| w.len() > 3) else {
                continue;
            };
            let (first, rest) = word.split_at(1);
            let swapped: String = rest.chars().rev().skip(rest.len() - 2).collect();
            for wrong in [
                format!("{first}{swapped}{}", &rest[2..]),
                format!("{word}Q"),
            ] {
                if wrong == word {
                    continue;
                }
                let text = sound.replacen(line, &line.replacen(word, &wrong, 1), 1);
                let found = dataset::read_text(&text).diagnostics;
                let mut errors = found.iter().filter(|d| d.severity == Severity::Error);
                let told = errors.next().map(|d| (d.code, d.line));
                assert_eq!(
                    told,
                    Some(("unknown_statement", k + 1)),
                    "{line} as {wrong}"
                );
                assert_eq!(errors.next(), None, "{line} as {wrong}");
                n += 1;
            }
        }
    }
    assert!(n > 150, "{n}");
}
