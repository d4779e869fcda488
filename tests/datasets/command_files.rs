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
