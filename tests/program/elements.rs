//! `cognate elements`: the elements of a dataset by their names, and changes of its text that leave the rest as it stands.

use super::command::{cognate, ok, path, scratch};

const BELT: &str = "\
a belt
PART/1, GROUND
MARKER/1, PART=1
MARKER/2, PART=1, QP=3,0,0
! the wheels
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
PART/3, QG=3,0,0, MASS=1, CM=30, IP=1,1,1
MARKER/30, PART=3
!      adams_view_name='first'
JOINT/1, REVOLUTE, I=20, J=1   ! a remark
JOINT/2, REVOLUTE, I=30, J=2
! adams_view_name='belt'
COUPLER/1
, JOINTS=1,2
, SCALES=2.5,-1
REQUEST/1, F2=JOINT(2,0,2,0)
END
";

#[test]
fn multi_joints_are_listed_shown_renamed_and_deleted() {
    let model = scratch("elements", "belt.adm", BELT);
    let list = cognate(&["elements", path(&model), "--kind", "coupler"]);
    assert_eq!(list.code, 0, "{}", list.err);
    let line = list.out.lines().find(|l| l.contains("COUPLER/1")).unwrap();
    assert!(
        line.contains("belt") && line.contains("JOINTS=JOINT/1 JOINTS=JOINT/2"),
        "{line}"
    );
    assert!(!list.out.contains("PART/"));
    let all = cognate(&["elements", path(&model), "--json"]);
    let all: serde_json::Value = serde_json::from_str(&all.out).unwrap();
    let joint = all
        .as_array()
        .unwrap()
        .iter()
        .find(|e| e["element"] == "JOINT/2");
    assert_eq!(
        joint.unwrap()["named_by"],
        serde_json::json!(["COUPLER/1", "REQUEST/1"])
    );
    let shown = cognate(&["elements", path(&model), "--show", "COUPLER/1"]).out;
    for part in [
        "COUPLER/1 'belt', line 14",
        ", SCALES=2.5,-1",
        "JOINT/1, JOINT/2",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    // another name, and nothing else, to the byte
    let out = model.with_file_name("out.adm");
    let change = |arguments: &[&str]| {
        let all = [&["elements", path(&model)], arguments, &["-o", path(&out)]].concat();
        let done = cognate(&all);
        (
            done.code,
            done.err,
            std::fs::read_to_string(&out).unwrap_or_default(),
        )
    };
    let (code, said, text) = change(&[
        "--rename",
        "COUPLER/1=chain drive",
        "--rename",
        "JOINT/2=second",
    ]);
    assert_eq!(code, 0, "{said}");
    let expected = BELT.replace("'belt'", "'chain drive'");
    let expected = expected.replace("JOINT/2, REV", "! adams_view_name='second'\nJOINT/2, REV");
    assert_eq!(text, expected);
    let (code, said, text) = change(&["--delete", "COUPLER/1"]);
    assert_eq!(code, 0, "{said}");
    let (before, rest) = BELT.split_once("! adams_view_name='belt'").unwrap();
    assert_eq!(
        text,
        [before, &rest[rest.find("REQUEST").unwrap()..]].concat()
    );
}

#[test]
fn an_element_that_others_name_stays() {
    let model = scratch("elements_stay", "belt.adm", BELT);
    let out = model.with_file_name("out.adm");
    let _ = std::fs::remove_file(&out);
    let delete = |elements: &[&str]| {
        let mut all = vec!["elements", path(&model), "-o", path(&out)];
        elements.iter().for_each(|e| all.extend(["--delete", e]));
        cognate(&all)
    };
    // by a number, and by a function
    let done = delete(&["JOINT/2"]);
    assert_eq!(done.code, 3);
    assert!(
        done.err
            .contains("JOINT/2 is named by COUPLER/1, REQUEST/1"),
        "{}",
        done.err
    );
    assert!(!out.exists());
    assert_eq!(delete(&["JOINT/2", "COUPLER/1", "REQUEST/1"]).code, 0);
    let unknown = delete(&["JOINT/7"]);
    assert!(
        unknown.code == 3 && unknown.err.contains("JOINT has 1, 2"),
        "{}",
        unknown.err
    );
    let itself = cognate(&[
        "elements",
        path(&model),
        "--delete",
        "COUPLER/1",
        "-o",
        path(&model),
    ]);
    assert_eq!(itself.code, 2, "an input is never overwritten");
    assert_eq!(
        cognate(&["elements", path(&model), "--delete", "COUPLER/1"]).code,
        2
    );
}

#[test]
fn an_assembly_is_shown_as_a_tree_of_its_instances() {
    let text = "\
a robot
! adams_view_name='base'
PART/1, GROUND
! adams_view_name='arm.rod'
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
! adams_view_name='arm.tool.tip'
PART/3, MASS=1, CM=30, IP=1,1,1
MARKER/30, PART=3
PART/7, MASS=1, CM=70, IP=1,1,1
MARKER/70, PART=7
! cognate: JOINT/4 hinge = REVOLUTE, base, arm
END
";
    let model = scratch("elements", "robot.adm", text);
    let tree = cognate(&["elements", path(&model), "--tree"]);
    assert_eq!(tree.code, 0, "{}", tree.err);
    let expected = "\
├ PART/7
├ arm
│ ├ rod  PART/2, JOINT/4 'hinge', JOINT/5 'arm_3'
│ └ tool
│   └ tip  PART/3, JOINT/5 'arm_3'
└ base  PART/1, ground, JOINT/4 'hinge'
";
    assert_eq!(tree.out, expected);
}

#[test]
fn a_file_that_includes_others_is_formatted_and_changed_alone() {
    let text = "all\nPART/1, GROUND\nMARKER/1, PART=1\n! cognate: INCLUDE included_bar.adm\nJOINT/1, REVOLUTE, I=2, J=1\nEND\n";
    let bar = "bar\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nEND\n";
    let file = scratch("including", "all.adm", text);
    let included = scratch("including", "included_bar.adm", bar);
    let out = scratch("including", "out.adm", "");
    let formatted = ok(&["fmt", path(&file)]).out;
    assert!(
        formatted.contains("\n! cognate: INCLUDE included_bar.adm\n"),
        "{formatted}"
    );
    assert!(!formatted.contains("PART/2"), "{formatted}");

    let over = cognate(&["fmt", path(&file), "-o", path(&included), "--overwrite"]);
    assert!(
        over.code != 0 && over.err.contains("is_input"),
        "{}",
        over.err
    );
    assert_eq!(std::fs::read_to_string(&included).unwrap(), bar);

    ok(&[
        "elements",
        path(&file),
        "--rename",
        "JOINT/1=hinge",
        "-o",
        path(&out),
        "--overwrite",
    ]);
    let renamed = text.replace("JOINT/1", "! adams_view_name='hinge'\nJOINT/1");
    assert_eq!(std::fs::read_to_string(&out).unwrap(), renamed);
    for change in [["--rename", "PART/2=bar"], ["--delete", "PART/2"]] {
        let command = [
            "elements",
            path(&file),
            change[0],
            change[1],
            "-o",
            path(&out),
            "--overwrite",
        ];
        let done = cognate(&command);
        assert!(done.code != 0, "{change:?}");
        let told = ["named by", "which this dataset includes"];
        assert!(told.iter().any(|t| done.err.contains(t)), "{}", done.err);
    }
    assert_eq!(std::fs::read_to_string(&out).unwrap(), renamed);
    let shown = ok(&["elements", path(&file), "--show", "PART/2"]).out;
    assert!(
        shown.starts_with(&format!("PART/2, line 2 of {}", path(&included))),
        "{shown}"
    );

    // a mistake in the included file is shown there
    std::fs::write(&included, bar.replace("MASS=1", "MASS=x")).unwrap();
    let done = cognate(&["check", path(&file)]);
    let told = done.out + &done.err;
    assert!(told.contains("included_bar.adm:2:14"), "{told}");
    assert!(told.contains("| PART/2, MASS=x"), "{told}");
}
