//! Command files as other systems and people leave them: notes after STOP, unanswered prompts, paths of other machines.

use cognate::dataset::command::{Command, Script};
use std::path::{Path, PathBuf};

/// A folder of its own for what a test writes.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("command_files_{name}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn what_follows_stop_is_not_read() {
    for tail in [
        "",
        "STOP",
        "STOP\n",
        "  stop ! done\nthe third run is the good one (see mail) = / \" &\n",
        "STOP\r\nSIMULATE/DYNAMIC, END=2\r\n",
    ] {
        let text = format!("FILE/MODEL=a\nSIMULATE/DYNAMIC, END=1, STEPS=2\n{tail}");
        let script = Script::from_text(&text).unwrap_or_else(|e| panic!("{tail:?}: {e}"));
        let runs = script.steps.iter();
        let runs = runs.filter(|s| matches!(s.command, Command::Simulate(_)));
        assert_eq!(runs.count(), 1, "{tail:?}");
    }
    // what STOP continues, or what begins with it, is no end
    for (text, runs) in [
        (
            "SIMULATE/DYNAMIC, END=1\nSIMULATE/DYNAMIC, &\nDURATION=1\n",
            2,
        ),
        (
            "SIMULATE/DYNAMIC, END=1\n! STOP\nSIMULATE/DYNAMIC, END=2\n",
            2,
        ),
    ] {
        let script = Script::from_text(&format!("FILE/MODEL=a\n{text}")).expect("a script");
        assert_eq!(script.steps.len(), runs, "{text}");
    }
}

#[test]
fn results_are_named_like_the_dataset_where_the_second_prompt_is_not_answered() {
    for (first, second, named) in [
        ("test", "", Some("test")),
        ("test.adm", "   ", Some("test")),
        ("models/test.ADM", "", Some("test")),
        ("test", "other", Some("other")),
    ] {
        let text = format!("{first}\n{second}\nSIMULATE/DYNAMIC, END=1\nSTOP\n");
        let script = Script::from_text(&text).expect("a script");
        assert_eq!(script.output.as_deref(), named, "{text:?}");
        assert_eq!(script.model.as_deref(), Some(first));
    }
    let script = Script::from_text("test\nSIMULATE/DYNAMIC, END=1\n").expect("a script");
    assert_eq!(script.output, None);
}

#[test]
fn a_path_of_another_machine_is_the_file_beside_the_command_file() {
    let folder = folder("paths");
    for name in ["plant.adm", "run.acf"] {
        std::fs::write(folder.join(name), "").expect("written");
    }
    for (model, found) in [
        ("plant", "plant.adm"),
        (r"C:\users\me\plant", "plant.adm"),
        (r"D:\a b\PLANT.ADM", "plant.adm"),
        ("/home/me/plant.adm", "plant.adm"),
    ] {
        let text = format!("FILE/MODEL={model}\nSIMULATE/DYNAMIC, END=1\nSTOP\n");
        std::fs::write(folder.join("run.acf"), text).expect("written");
        let script = Script::read(folder.join("run.acf")).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(script.model_file(), Some(folder.join(found)), "{model}");
    }
    // one that is nowhere is told as it was written
    let text = "FILE/MODEL=C:\\none\\such\nSTOP\n";
    std::fs::write(folder.join("run.acf"), text).expect("written");
    let script = Script::read(folder.join("run.acf")).expect("a script");
    let file = script.model_file().expect("a name");
    assert!(file.display().to_string().contains("none"), "{file:?}");
}

/// Returns what is doubted of commands: codes, with the numbers of the lines.
fn doubts(text: &str) -> Vec<(&'static str, usize)> {
    let script = Script::from_text(text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
    let found = script.diagnostics.iter();
    found.map(|d| (d.code, d.line)).collect()
}

#[test]
fn commands_after_stop_are_told_and_notes_are_not() {
    let head = "FILE/MODEL=a\nSIMULATE/DYNAMIC, END=1\nSTOP\n";
    for notes in [
        "",
        "! SIMULATE/DYNAMIC\n",
        "see mail / tuesday\n",
        "run 3/4 = good\n",
        "STOP\n",
    ] {
        assert_eq!(doubts(&format!("{head}{notes}")), [], "{notes:?}");
    }
    for lost in [
        "SIMULATE/DYNAMIC, END=2\n",
        "\n! more\n  sim/stat\nSTOP\n",
        "PART/2, MASS=1\n",
    ] {
        let found = doubts(&format!("{head}{lost}"));
        assert!(
            matches!(found[..], [("beyond_end", 4..=6)]),
            "{lost:?}: {found:?}"
        );
    }
}

#[test]
fn commands_behind_the_stop_of_a_called_file_are_told() {
    let folder = folder("stop");
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write("inner.acf", "FILE/MODEL=a\nSIMULATE/DYNAMIC, END=1\nSTOP\n");
    write(
        "outer.acf",
        "FILE/COMMAND=inner.acf\nSIMULATE/DYNAMIC, END=2\nSTOP\n",
    );
    write("last.acf", "FILE/COMMAND=inner.acf\nSTOP\n");
    let codes = |name: &str| -> Vec<&str> {
        let script = Script::read(folder.join(name)).expect("a script");
        script.diagnostics.iter().map(|d| d.code).collect()
    };
    assert_eq!(codes("outer.acf"), ["beyond_end"]);
    assert_eq!(codes("last.acf"), [""; 0]);
    assert_eq!(codes("inner.acf"), [""; 0]);
}

#[test]
fn commands_that_solve_nothing_are_told() {
    let folder = folder("nothing");
    let file = folder.join("nothing.acf");
    for (text, is_told) in [
        ("FILE/MODEL=a\nSTOP\n", true),
        ("FILE/MODEL=a\nPART/2, MASS=1\n", true),
        ("FILE/MODEL=a\nSTOP\nSIMULATE/DYNAMIC, END=1\n", true),
        ("FILE/MODEL=a\nSIMULATE/DYNAMIC, END=1\n", false),
        ("FILE/MODEL=a\nLINEAR/EIGENSOL\nSTOP\n", false),
    ] {
        std::fs::write(&file, text).expect("a file");
        let script = Script::read(&file).expect("a script");
        let told = script.diagnostics.iter().any(|d| d.code == "no_simulation");
        assert_eq!(told, is_told, "{text:?}");
    }
}

#[test]
fn an_error_that_leaves_no_digit_is_doubted_where_a_command_asks_for_it() {
    let ask = |error: &str| {
        doubts(&format!(
            "\nINTEGRATOR/GSTIFF, ERROR={error}\nSIM/DYN, END=1\n"
        ))
    };
    assert_eq!(ask("1E-3"), []);
    assert_eq!(ask("1E3"), [("unlikely_magnitude", 2)]);
}

#[test]
fn states_are_kept_beside_the_results_whatever_folder_is_named() {
    assert_eq!(doubts("\nSIM/DYN, END=1\nSAVE/SYSTEM=x\n"), []);
    for folder in ["SAVE/SYSTEM=/other/x", "SAVE/SYSTEM=a\\x.sav"] {
        let found = doubts(&format!("\nSIM/DYN, END=1\n{folder}\n"));
        assert_eq!(found, [("no_effect", 3)], "{folder}");
    }
    for refused in ["SAVE/FILE=x", "RELOAD/", "SAVE/SYSTEM=\"\""] {
        let said = Script::from_text(&format!("\nSIM/DYN, END=1\n{refused}\n"));
        assert!(said.is_err(), "{refused}");
    }
}

#[test]
fn a_number_out_of_range_is_refused_where_it_stands_in_commands_and_datasets() {
    let wrong = [
        ("INTEGRATOR", "ERROR", "-1"),
        ("INTEGRATOR", "HMAX", "0"),
        ("INTEGRATOR", "HMIN", "-1E-9"),
        ("INTEGRATOR", "HINIT", "0.0"),
        ("INTEGRATOR", "KMAX", "0"),
        ("INTEGRATOR", "MAXIT", "0"),
        ("EQUILIBRIUM", "ERROR", "-1E-4"),
        ("EQUILIBRIUM", "IMBALANCE", "0"),
        ("EQUILIBRIUM", "TLIMIT", "-2"),
        ("EQUILIBRIUM", "ALIMIT", "-1D"),
        ("EQUILIBRIUM", "MAXIT", "0"),
        ("EQUILIBRIUM", "STABILITY", "-1"),
        ("KINEMATICS", "HMAX", "-1"),
        ("IC", "ERROR", "0"),
    ];
    for (statement, argument, value) in wrong {
        let line = format!("{statement}/{argument}={value}");
        let error = Script::from_text(&format!("FILE/MODEL=a\n{line}\n")).expect_err(&line);
        let text = format!("t\nPART/1, GROUND\n{line}\nEND\n");
        let in_dataset = cognate::Model::from_text(&text).expect_err(&line);
        for (error, at) in [(error, 2), (in_dataset, 3)] {
            let [d] = &error.into_diagnostics()[..] else {
                panic!("{line}: not one mistake")
            };
            assert_eq!((d.code, d.line), ("unfit_value", at), "{line}");
            assert_eq!(d.column, line.len() - value.len() + 1, "{line}");
            assert!(d.message.starts_with(argument), "{}", d.message);
        }
        let least = value.strip_prefix('-').unwrap_or("1");
        let right = format!("{statement}/{argument}={least}");
        assert!(
            Script::from_text(&format!("FILE/MODEL=a\n{right}\n")).is_ok(),
            "{right}"
        );
    }
    for (command, column) in [
        ("SIMULATE/DYNAMIC, END=1, STEPS=0", 32),
        ("SIMULATE/DYNAMIC, END=1, DTOUT=-1", 32),
        ("SIMULATE/DYNAMIC, DURATION=0", 28),
        ("DEACTIVATE/JOINT, RANGE=5,1", 1),
        ("LINEAR/EIGENSOL, COORDS=0", 1),
        ("LINEAR/EIGENSOL, COORDS=3,2", 1),
    ] {
        let error = Script::from_text(&format!("FILE/MODEL=a\n{command}\n")).expect_err(command);
        let [d] = &error.into_diagnostics()[..] else {
            panic!("{command}: not one mistake")
        };
        assert_eq!(
            (d.code, d.line, d.column),
            ("unfit_value", 2, column),
            "{command}"
        );
    }
}

#[test]
fn a_text_that_looks_like_an_argument_with_a_colon_is_doubted() {
    let doubts = |request: &str| -> Vec<&'static str> {
        let text = format!("t\nPART/1, GROUND\nREQUEST/1, F2=TIME\\, {request}\nEND\n");
        let reading = cognate::dataset::read_text(&text);
        reading.diagnostics.iter().map(|d| d.code).collect()
    };
    for doubted in [
        "CNAMES=\"\",\"x\", RESULTS_NAME:block",
        "CNAMES=\"\", x, results_n:block",
        "COMMENT=a block, RESULTS_NAME:block",
    ] {
        assert!(doubts(doubted).contains(&"ambiguous_argument"), "{doubted}");
    }
    for meant in [
        "CNAMES=\"\",\"x\", RESULTS_NAME=block",
        "CNAMES=\"\",\"RESULTS_NAME:block\"",
        "COMMENT=a block, see: page 3",
        "COMMENT=RESULTS_NAME:block",
    ] {
        assert!(!doubts(meant).contains(&"ambiguous_argument"), "{meant}");
    }
}
