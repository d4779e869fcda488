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
