//! The page of `cognate animate` in a browser: whatever the model, it is shown, it draws something at every time, and it says how
//! fast it plays; where it cannot be shown it says so in the middle of the screen. Without Chromium these tests skip.

use super::command::{cognate, path, scratch};
use crate::repository::root;
use cognate::Model;
use cognate::internals::report::mechanism::page::page_of_run;
use cognate::results::{Component, Entity, Kind, Run, Units};
use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;

/// What the pages do in a browser; `None`: there is none.
fn opened(arguments: &[&str], pages: &[PathBuf]) -> Option<Vec<Value>> {
    if !root("assets/viewer/node_modules").is_dir() {
        println!("skipped: run npm ci in assets/viewer");
        return None;
    }
    let pages = pages.iter().map(|page| path(page));
    let done = Command::new("node")
        .arg(root("assets/viewer/open.mjs"))
        .args(arguments.iter().copied().chain(pages))
        .output();
    let Ok(done) = done else {
        println!("skipped: there is no node");
        return None;
    };
    let text = String::from_utf8(done.stdout).unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{text}{said}");
    let found: Value = serde_json::from_str(&text).unwrap();
    if let Some(why) = found["skipped"].as_str() {
        println!("skipped: {why}");
        return None;
    }
    found.as_array().cloned()
}

/// A page is shown without complaints, and draws something at each of its times.
fn is_shown(found: &Value) {
    let page = &found["page"];
    assert_eq!(found["ready"], true, "{page}: {found}");
    assert_eq!(found["errors"], Value::Array(Vec::new()), "{page}");
    assert_eq!(found["requests"], Value::Array(Vec::new()), "{page}");
    let drawn = found["drawn"].as_array().unwrap();
    assert!(!drawn.is_empty(), "{page}");
    for part in drawn {
        assert!(part.as_f64() > Some(1e-4), "{page}: {drawn:?}");
    }
}

/// A run of balls that swing and turn in rows, without solving.
fn swinging(bodies: u32, rows: u32) -> (Model, Run) {
    let side = f64::from(bodies).sqrt().ceil();
    let mut text = "Many bodies\nPART/1, GROUND\n".to_owned();
    let mut run = Run::new("many", "", Units::default());
    for n in 2..2 + bodies {
        text += &format!("PART/{n}, MASS=1, CM={n}, IP=1,1,1\nMARKER/{n}, PART={n}\n");
        let name = format!("PART_{n}");
        let components = ["X", "Y", "Z", "PSI", "THETA", "PHI"].map(|c| Component {
            name: c.into(),
            column: run.add_column(format!("{name}_XFORM.{c}"), ""),
        });
        run.entities.push(Entity {
            name: format!("{name}_XFORM"),
            entity: name,
            kind: "Part".into(),
            id: u64::from(n),
            components: components.to_vec(),
        });
    }
    run.begin(Kind::Dynamic);
    for k in 0..rows {
        let t = f64::from(k) * 1e-2;
        let mut row = vec![t];
        for n in 0..bodies {
            let swing = (3.0 * t + f64::from(n)).sin();
            let (x, y) = (f64::from(n) % side, (f64::from(n) / side).floor());
            row.extend([x + 0.3 * swing, y, 0.3 * swing, t, 1.0 + 0.5 * swing, 0.2]);
        }
        run.push(&row);
    }
    run.end();
    (Model::from_text(&format!("{text}END\n")).unwrap(), run)
}

fn page_of(folder: &str, bodies: u32, rows: u32) -> PathBuf {
    let (model, run) = swinging(bodies, rows);
    let page = page_of_run(&model, &run, &Default::default()).unwrap();
    scratch(folder, &format!("{bodies}_bodies_{rows}_rows.html"), &page)
}

#[test]
fn pages_of_up_to_two_thousand_bodies_and_rows_are_shown_and_say_how_fast_they_play() {
    let sizes = [
        (1, 1),
        (1, 2),
        (2, 3),
        (14, 5),
        (15, 5),
        (16, 5),
        (130, 4),
        (700, 3),
        (2000, 3),
        (1, 2000),
        (20, 2000),
    ];
    let pages = sizes.map(|(bodies, rows)| page_of("viewer_sizes", bodies, rows));
    let Some(found) = opened(&["--times", "6", "--play", "--sizes", "900x600"], &pages) else {
        return;
    };
    assert_eq!(found.len(), pages.len());
    for found in &found {
        is_shown(found);
        if found["rows"].as_u64() > Some(1) {
            assert!(found["rate"][0].as_f64() > Some(0.0), "{found}");
            assert!(
                found["rate"][1].as_str().unwrap().ends_with("pictures/s"),
                "{found}"
            );
        }
    }
}

#[test]
fn every_page_of_the_gallery_is_shown_at_every_time() {
    let mut names: Vec<PathBuf> = std::fs::read_dir(root("examples/gallery"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|file| file.extension().is_some_and(|e| e == "acf"))
        .collect();
    names.sort();
    assert!(names.len() >= 16);
    let pages: Vec<PathBuf> = names
        .iter()
        .map(|model| {
            let page =
                scratch("viewer_gallery", "x", "").with_file_name(model.file_stem().unwrap());
            let page = page.with_extension("html");
            let done = cognate(&["animate", path(model), "-o", path(&page)]);
            assert_eq!(done.code, 0, "{}", done.err);
            page
        })
        .collect();
    let Some(found) = opened(&["--times", "9"], &pages) else {
        return;
    };
    assert_eq!(found.len(), pages.len());
    found.iter().for_each(is_shown);
}

#[test]
fn a_phone_and_a_notebook_show_the_picture_and_the_time() {
    let model = root("examples/gallery/slider_crank.acf");
    let page = scratch("viewer_layout", "x", "").with_file_name("page.html");
    let done = cognate(&["animate", path(&model), "-o", path(&page)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let sizes = "390x844,1366x768,1280x640,1280x800";
    let Some(found) = opened(&["--sizes", sizes, "--times", "2"], &[page]) else {
        return;
    };
    assert_eq!(found.len(), 4);
    for found in &found {
        is_shown(found);
        let layout = &found["layout"];
        assert!(layout["wider"].as_f64() <= Some(0.0), "{found}");
        assert_eq!(layout["play"], true, "{found}");
        let [width, height] = [0, 1].map(|k| layout["stage"][k].as_f64().unwrap());
        assert!(width * height > 0.35, "{found}");
    }
}

#[test]
fn a_page_that_cannot_be_shown_says_so_in_the_middle_of_the_screen() {
    let good = page_of("viewer_failure", 3, 4);
    let text = std::fs::read_to_string(&good).unwrap();
    let mark = "type=\"application/octet-stream\">";
    let at = text.find(mark).unwrap() + mark.len();
    let torn = format!(
        "{}{}",
        &text[..at + 400],
        &text[text.find("</script>").unwrap()..]
    );
    let torn = scratch("viewer_failure", "torn.html", &torn);
    let sizes = ["--sizes", "1280x800,390x844"];
    let Some(found) = opened(&sizes, &[torn]) else {
        return;
    };
    for found in found {
        assert_eq!(found["ready"], false);
        let middle = found["layout"]["middle"].as_str().unwrap();
        assert!(middle.contains("could not be shown"), "{found}");
    }
    // without a graphics card there are curves and values, and a word in the place of the picture
    for found in opened(
        &[&sizes[..], &["--without", "webgl"]].concat(),
        std::slice::from_ref(&good),
    )
    .unwrap()
    {
        assert_eq!(found["ready"], true, "{found}");
        assert_eq!(found["drawn"], Value::Null);
    }
    let found = opened(&["--without", "webgl"], std::slice::from_ref(&good)).unwrap();
    let middle = found[0]["layout"]["middle"].as_str().unwrap();
    assert!(middle.contains("No picture"), "{found:?}");
    let found = opened(&["--without", "script"], &[good]).unwrap();
    let middle = found[0]["layout"]["middle"].as_str().unwrap();
    assert!(middle.contains("needs JavaScript"), "{found:?}");
}

#[test]
fn the_page_runs_its_own_script_and_no_other() {
    let good = page_of("viewer_policy", 2, 3);
    let text = std::fs::read_to_string(&good).unwrap();
    let foreign = "<script>document.title='taken'; fetch('https://example.org/')</script>";
    let with = text.replace("</body>", &format!("{foreign}</body>"));
    let page = scratch("viewer_policy", "foreign.html", &with);
    let Some(found) = opened(&["--times", "1"], &[page]) else {
        return;
    };
    assert_eq!(found[0]["ready"], true, "{found:?}");
    assert_eq!(found[0]["requests"], Value::Array(Vec::new()));
    let errors = found[0]["errors"].as_array().unwrap();
    assert!(
        errors.len() == 1
            && errors[0]
                .as_str()
                .unwrap()
                .contains("Content Security Policy"),
        "{errors:?}"
    );
}

#[test]
fn an_element_is_struck_out_while_it_is_switched_off_and_not_before() {
    let model = "A pendulum\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nACCGRAV/JGRAV=-9.80665\n\
        PART/1, GROUND\nMARKER/10, PART=1\nPART/2, QG=1,0,0, MASS=2, CM=21, IP=0.01,0.01,0.01\n\
        MARKER/20, PART=2, QP=-1,0,0\nMARKER/21, PART=2\nJOINT/1, REVOLUTE, I=20, J=10\n\
        SPRINGDAMPER/1, TRANSLATIONAL, I=21, J=10, K=100, C=1, LENGTH=0.8\nEND\n";
    let model = scratch("viewer_off", "m.adm", model);
    let commands = "FILE/MODEL=m\nSIMULATE/DYNAMICS, END=0.2, STEPS=4\nDEACTIVATE/SPRINGDAMPER, ID=1\n\
        SIMULATE/DYNAMICS, END=0.4, STEPS=4\nACTIVATE/SPRINGDAMPER, ID=1\nSIMULATE/DYNAMICS, END=0.6, STEPS=4\nSTOP\n";
    let commands = scratch("viewer_off", "m.acf", commands);
    let page = model.with_extension("html");
    let done = cognate(&["animate", path(&commands), "-o", path(&page)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let drawn = |at: &str| {
        let picture = model.with_extension(format!("{at}.svg"));
        let done = cognate(&[
            "draw",
            path(&commands),
            "--at",
            at,
            "--no-forces",
            "-o",
            path(&picture),
        ]);
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read_to_string(picture).unwrap()
    };
    // the line of a spring bends at each winding
    let has_spring = |text: &str| {
        text.lines()
            .any(|l| l.contains("fill=\"none\"") && l.matches('L').count() > 10)
    };
    assert!(has_spring(&drawn("0.1")) && !has_spring(&drawn("0.3")) && has_spring(&drawn("0.5")));
    let Some(found) = opened(&["--times", "1000"], &[page]) else {
        return;
    };
    is_shown(&found[0]);
    let off: Vec<bool> = found[0]["off"]
        .as_array()
        .unwrap()
        .iter()
        .map(|off| off[0] == "SPRINGDAMPER/1")
        .collect();
    let changes: Vec<bool> = off.chunk_by(|a, b| a == b).map(|same| same[0]).collect();
    assert_eq!(changes, [false, true, false], "{off:?}");
    assert!(off.iter().filter(|off| **off).count() >= 4, "{off:?}");
}

#[test]
fn the_page_saves_its_picture_and_its_film() {
    let page = page_of("viewer_saves", 3, 100);
    let Some(found) = opened(&["--save", "--times", "1", "--sizes", "640x480"], &[page]) else {
        return;
    };
    let (picture, film) = (&found[0]["picture"], &found[0]["film"]);
    assert!(
        picture["begins"].as_str().unwrap().starts_with("\u{89}PNG"),
        "{picture}"
    );
    assert_eq!(picture["name"], "many.png");
    assert!(picture["size"].as_u64() > Some(3000), "{picture}");
    let name = film["name"].as_str().unwrap();
    assert!(name == "many.webm" || name == "many.mp4", "{film}");
    let begins = film["begins"].as_str().unwrap();
    assert!(
        begins.starts_with("\u{1a}E\u{df}\u{a3}") || begins.contains("ftyp"),
        "{film}"
    );
    assert!(film["size"].as_u64() > Some(3000), "{film}");
    assert_eq!(found[0]["errors"], Value::Array(Vec::new()));
}
