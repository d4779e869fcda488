//! Scenes of the gallery through the library and through the command line: the same bytes. The
//! doors to Python and C compare theirs with the same command line, over the same list of scenes.

use super::command::{cognate, path, scratch};
use crate::repository::root;
use cognate::analysis::session::script::obey;
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::{Script, Simulate, SimulationKind};
use cognate::results::{Status, csv};
use cognate::setup::{Asked, prepare};
use cognate::{Model, Options, Session};

#[test]
fn the_library_and_the_command_line_write_the_same_bytes() {
    let root = root("");
    let scenes = std::fs::read_to_string(root.join("tests/data/doors.txt")).unwrap();
    assert_eq!(scenes.lines().count(), 10);
    let folder = scratch("doors", "folder", "");
    let out = folder.parent().unwrap();
    for scene in scenes.lines() {
        let commands = root.join(format!("examples/gallery/{scene}.acf"));
        let asked = ["run", path(&commands), "--out", path(out), "--name", scene];
        let done = cognate(&[&asked[..], &["--format", "csv", "--quiet"]].concat());
        assert_eq!(done.code, 0, "{scene}: {}", done.err);
        let written = std::fs::read_to_string(out.join(format!("{scene}.csv"))).unwrap();

        let script = Script::read(&commands).unwrap();
        let model = Model::read(script.model_file().unwrap()).unwrap();
        let mut session = Session::new(model, scene, Options::default());
        let status = obey(&mut session, &script.steps, |_, _| (), &mut Unwatched);
        assert_eq!(status, Ok(Status::Completed), "{scene}");
        assert_eq!(csv::write(&session.run, true), written, "{scene}");
    }
}

#[test]
fn the_library_obeys_the_set_up_beside_a_model_as_the_command_line_does() {
    let root = root("tests/data/loaded");
    let folder = scratch("doors_loaded", "folder", "");
    let out = folder.parent().unwrap();
    let dataset = root.join("loaded.adm");
    let commands = root.join("loaded.acf");
    let mut tables = Vec::new();
    for model in [&commands, &dataset] {
        let done = cognate(&[
            "run",
            path(model),
            "--out",
            path(out),
            "--name",
            "it",
            "--format",
            "csv",
            "--quiet",
        ]);
        assert_eq!(done.code, 0, "{}", done.err);
        tables.push(std::fs::read_to_string(out.join("it.csv")).unwrap());
    }
    let mut model = Model::read(&dataset).unwrap();
    let prepared = prepare(&dataset, &mut model, Asked::Kept).unwrap();
    let left_out = prepared.loads.as_ref().map(|loads| loads.left_out.clone());
    assert_eq!(left_out, Some(vec!["SFORCE/1".to_owned()]));
    let mut options = Options::default();
    prepared.setup.solve.complete(&mut options);
    let script = Script::read(&commands).unwrap();
    let single = prepared.setup.solve.simulations(None, None, None).unwrap();
    for (steps, table) in [script.steps, single].iter().zip(&tables) {
        let mut session = Session::new(model.clone(), "it", options.clone());
        let status = obey(&mut session, steps, |_, _| (), &mut Unwatched);
        assert_eq!(status, Ok(Status::Completed));
        assert_eq!(csv::write(&session.run, true), *table);
    }
    // a session that is asked for one simulation begins at rest as the set-up wants it
    let mut session = Session::new(model.clone(), "it", options);
    session.at_rest_first = prepared.setup.solve.at_rest_first;
    let simulate = Simulate {
        kind: SimulationKind::Transient,
        end: prepared.setup.solve.end,
        duration: None,
        steps: Some(40),
        dtout: None,
    };
    let status = session.simulate_as(&simulate, &mut Unwatched);
    assert_eq!(status, Ok(Status::Completed));
    assert_eq!(csv::write(&session.run, true), tables[1]);
}
