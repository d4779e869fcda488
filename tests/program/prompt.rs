//! A model at the prompt: values at any time, runs, plots, pictures, and its elements.

use super::command::{path, scratch, session};

/// A point mass that falls, and a request that reads the past.
const FALL: &str = "\
a fall
ACCGRAV/JGRAV=-10
PART/1, GROUND
PART/2, MASS=1, CM=2, IP=1,1,1, VX=3
! adams_view_name='middle'
MARKER/2, PART=2
REQUEST/1, F2=DY(2)
END
";

/// The answers to some lines, one after the other.
fn answers(test: &str, lines: &[&str]) -> Vec<String> {
    let mark = |k: usize| format!("{}\n", 880_000_000 + k);
    let numbered = lines.iter().enumerate();
    let input: String = numbered
        .map(|(k, line)| format!("{line}\n{}", mark(k)))
        .collect();
    let (mut rest, _) = session(&input, test);
    let mut all = Vec::new();
    for k in 0..lines.len() {
        let (answer, others) = rest.split_once(&mark(k)).expect("an answer to each line");
        all.push(answer.to_owned());
        rest = others.to_owned();
    }
    all
}

#[test]
fn expressions_have_the_values_of_the_model_at_any_time() {
    let model = scratch("prompt", "fall.adm", FALL);
    let load = format!(":load {}", path(&model));
    let said = answers(
        "prompt_values",
        &[
            "DY(2)",
            &load,
            "DY(2)",
            ":time 0.5",
            "DY(2)",
            "2*VY(2) + TIME",
            ":let v = VX(2)",
            "v**2",
            ":run 2 20",
            ":time 1.5",
            "DY(2)",
            ":time 1.23",
            "DY(2)",
            "DY(3)",
            "DELAY(DY(2), 0.5, 0)",
        ],
    );
    let value = |k: usize| {
        said[k]
            .trim()
            .parse::<f64>()
            .unwrap_or_else(|_| panic!("{k}: {}", said[k]))
    };
    assert!(said[0].contains("missing_value"), "{}", said[0]);
    assert!(
        said[1].contains("a fall") && said[1].contains("1 REQUEST"),
        "{}",
        said[1]
    );
    assert_eq!(value(2), 0.0);
    assert!((value(4) + 1.25).abs() < 1e-6, "{}", said[4]);
    assert!((value(5) + 9.5).abs() < 1e-6, "{}", said[5]);
    assert!((value(7) - 9.0).abs() < 1e-9);
    assert!(
        said[8].contains("completed") && said[8].contains("2.0"),
        "{}",
        said[8]
    );
    // of a row of the run, and between two
    assert!((value(10) + 11.25).abs() < 1e-6);
    assert!((value(12) + 5.0 * 1.23 * 1.23).abs() < 1e-6);
    assert!(said[13].contains("MARKER/3 does not exist"), "{}", said[13]);
    assert!((value(14) + 5.0 * 0.73 * 0.73).abs() < 1e-3, "{}", said[14]);
    // what needs no model has its rates, the others do not
    let input = format!(
        "{load}
:time 1.5
:derivative 1
DY(2)
TIME**2
"
    );
    let (all, code) = session(&input, "prompt_rates");
    assert!(
        all.contains("error[unavailable]") && all.contains("d/dt    3"),
        "{all}"
    );
    assert_eq!(code, 3);
}

#[test]
fn a_model_is_looked_at_changed_and_saved() {
    let model = scratch("prompt_changes", "fall.adm", FALL);
    let folder = model.parent().unwrap();
    let at = |name: &str| path(&folder.join(name)).to_owned();
    for file in ["later.svg", "fall.png", "saved.adm"] {
        let _ = std::fs::remove_file(at(file));
    }
    let said = answers(
        "prompt_changes",
        &[
            ":verify",
            &format!(":load {}", path(&model)),
            ":verify",
            ":list marker",
            ":show MARKER/2",
            ":delete MARKER/2",
            ":delete REQUEST/1",
            ":rename MARKER/2 centre of mass",
            ":list",
            ":plot DY(2)",
            ":run",
            ":run 1 50",
            ":plot DY(2)",
            ":plot DY(2) 0.5 1",
            &format!(":plot DY(2) {}", at("fall.png")),
            ":time 1",
            &format!(":draw {}", at("later.svg")),
            &format!(":save {}", at("saved.adm")),
            ":info",
        ],
    );
    assert!(said[0].contains(":load FILE"), "{}", said[0]);
    assert!(said[2].contains("freedom: 6"), "{}", said[2]);
    assert!(
        said[3].contains("MARKER/2") && said[3].contains("middle") && !said[3].contains("PART/2 "),
        "{}",
        said[3]
    );
    assert!(
        said[4].contains("named by PART/2, REQUEST/1"),
        "{}",
        said[4]
    );
    assert!(said[5].contains("element_in_use"), "{}", said[5]);
    assert_eq!((said[6].as_str(), said[7].as_str()), ("", ""));
    assert!(
        said[8].contains("centre of mass") && !said[8].contains("REQUEST"),
        "{}",
        said[8]
    );
    assert!(
        said[9].contains("there is no run") && said[10].contains(":run END"),
        "{} {}",
        said[9],
        said[10]
    );
    assert!(
        said[12].lines().count() > 10 && said[12].contains("DY(2)"),
        "{}",
        said[12]
    );
    assert_ne!(said[12], said[13]);
    assert!(
        said[18].contains("completed") && said[18].contains("up to 1"),
        "{}",
        said[18]
    );
    assert!(std::fs::read(at("later.svg")).unwrap().starts_with(b"<svg"));
    assert!(
        std::fs::read(at("fall.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    let saved = std::fs::read_to_string(at("saved.adm")).unwrap();
    let expected = FALL
        .replace("REQUEST/1, F2=DY(2)\n", "")
        .replace("'middle'", "'centre of mass'");
    assert_eq!(saved, expected);
}
