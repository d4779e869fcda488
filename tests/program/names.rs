//! Elements in what `check` and `verify` say: as the file names them.

use crate::command::{cognate, path, scratch};

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
