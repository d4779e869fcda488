//! Result files that other programs wrote read as their authors meant, and what we write reads back.
//!
//! Real files are found in the folder that COGNATE_CORPUS names; without it these tests are left out.

use crate::repository::root;
use crate::result_laws as laws;

use cognate::results::{self, Kind, Run, csv, res};
use std::path::{Path, PathBuf};

/// All files with this extension below the corpus; `None` when it is not here.
#[track_caller]
fn corpus(extension: &str) -> Option<Vec<PathBuf>> {
    let (mut folders, mut files) = (vec![crate::needs::corpus()?], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)
            .unwrap()
            .map(|e| e.unwrap().path())
        {
            if entry.is_dir() {
                folders.push(entry);
            } else if entry
                .extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(extension))
            {
                files.push(entry);
            }
        }
    }
    files.sort();
    Some(files)
}

fn named<'a>(files: &'a [PathBuf], end: &str) -> &'a Path {
    files
        .iter()
        .find(|f| f.ends_with(end))
        .unwrap_or_else(|| panic!("{end} is in the corpus"))
}

fn same_numbers(a: &Run, b: &Run) {
    assert_eq!(a.columns.len(), b.columns.len());
    for (a, b) in a.columns.iter().zip(&b.columns) {
        assert_eq!((&a.name, &a.unit), (&b.name, &b.unit));
        assert!(
            a.values
                .iter()
                .zip(&b.values)
                .all(|(a, b)| a.to_bits() == b.to_bits()),
            "{}",
            a.name
        );
        assert_eq!(a.values.len(), b.values.len());
    }
}

#[test]
fn every_real_res_file_reads_and_is_written_back_with_the_same_numbers() {
    let Some(files) = corpus("res") else { return };
    assert!(files.len() >= 5, "{files:?}");
    for file in files {
        let run = results::read(&file).unwrap_or_else(|d| panic!("{d}"));
        let back = res::read(res::write(&run).as_bytes())
            .unwrap_or_else(|d| panic!("{}: {d}", file.display()));
        same_numbers(&run, &back);
        assert_eq!(
            (&run.sequences, &run.entities),
            (&back.sequences, &back.entities),
            "{}",
            file.display()
        );
        println!(
            "{}: {} columns, {} rows",
            file.display(),
            run.columns.len(),
            run.rows()
        );
    }
}

#[test]
fn every_real_gra_file_reads_and_agrees_with_the_res_file_beside_it() {
    let Some(files) = corpus("gra") else { return };
    assert!(files.len() >= 9, "{files:?}");
    let mut compared = 0;
    for file in files {
        let run = results::read(&file).unwrap_or_else(|d| panic!("{d}"));
        assert!(run.rows() >= 2, "{}", file.display());
        let Ok(beside) = results::read(&file.with_extension("res")) else {
            continue;
        };
        for part in beside.entities.iter().filter(|e| e.kind == "Part") {
            for component in part
                .components
                .iter()
                .filter(|c| ["X", "Y", "Z"].contains(&c.name.as_str()))
            {
                let full = &beside.columns[component.column].values;
                let six_digits = run
                    .column(&format!("PART_{}_XFORM.{}", part.id, component.name))
                    .unwrap();
                let scale = full.iter().fold(1e-3, |m: f64, x| m.max(x.abs()));
                // The last row is the same moment in both files, whatever stands between.
                let (a, b) = (full[full.len() - 1], six_digits[six_digits.len() - 1]);
                assert!(
                    (a - b).abs() <= 1e-5 * scale,
                    "{} {}.{}: {a} {b}",
                    file.display(),
                    part.name,
                    component.name
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn the_smallest_complete_set_has_its_known_values() {
    let Some(files) = corpus("res") else { return };
    let run = results::read(named(&files, "models/rescale_analysis.res")).unwrap();
    assert_eq!(run.title, "Adams View model name: rescale_analysis");
    let kinds: Vec<_> = run
        .sequences
        .iter()
        .map(|s| (s.name.as_str(), s.kind, s.rows.len()))
        .collect();
    assert_eq!(
        kinds,
        [
            ("modelInput_001", Kind::Input, 1),
            ("static_001", Kind::Static, 1),
            ("initialConditions_001", Kind::InitialConditions, 1),
            ("dynamic_001", Kind::Dynamic, 500)
        ]
    );
    assert_eq!(
        run.column("PART_2_XFORM.PSI").unwrap()[1],
        -0.432_407_775_570_537_9
    );
    assert_eq!(
        run.column("JOINT_1.FY").unwrap()[502],
        67.317_818_223_981_42
    );
    assert_eq!(
        run.columns[run.find("JOINT_2.TZ").unwrap()].unit,
        "pound_force-inch"
    );
    assert_eq!(
        (run.units.length.as_str(), run.units.force.as_str()),
        ("inch", "pound_force")
    );
    let table = csv::read(csv::write(&run, true).as_bytes()).unwrap();
    assert_eq!(
        table.rows(),
        run.rows() - 1,
        "the model as it was read is left out"
    );
    assert_eq!(
        table.column("JOINT_1.FY").unwrap()[501],
        67.317_818_223_981_42
    );
}

#[test]
fn real_logs_and_ours_have_the_same_lines() {
    let Some(files) = corpus("msg") else { return };
    let real = std::fs::read_to_string(named(&files, "models/rescale_analysis.msg")).unwrap();
    let mut run = Run::new("rescale_analysis", "", Default::default());
    run.log = vec![
        results::Event::Command("SIMULATE/STATIC".into()),
        results::Event::Title("Adams View model name: rescale_analysis".into()),
        results::Event::Begin {
            kind: Kind::Dynamic,
            integrator: "GSTIFF".into(),
            formulation: "I3".into(),
            error: 1e-3,
        },
        results::Event::Progress {
            time: 0.0,
            step: 5e-4,
            evaluations: 0,
            steps: 0,
            order: 1,
            seconds: 0.0,
        },
        results::Event::Progress {
            time: 0.5,
            step: 0.01,
            evaluations: 55,
            steps: 55,
            order: 1,
            seconds: 0.0,
        },
        results::Event::End,
        results::Event::Finished {
            elapsed: 1.0,
            cpu: 1.0,
        },
    ];
    let ours = results::msg::write(&run);
    for line in ours.lines().filter(|l| !l.trim().is_empty()) {
        let known = real.lines().any(|r| r.trim_end() == line.trim_end());
        let own = [
            "cognate",
            "Performing Dynamic Simulation",
            "The integrator is",
            "Elapsed time",
        ]
        .iter()
        .any(|o| line.contains(o));
        assert!(known || own, "`{line}` is in no real log");
    }
}

/// Every file of a folder of this repository.
fn files_in(folder: &str) -> Vec<Vec<u8>> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(root(folder))
        .unwrap()
        .map(|f| f.unwrap().path())
        .collect();
    files.sort();
    files
        .into_iter()
        .map(|f| std::fs::read(f).unwrap())
        .collect()
}

#[test]
fn damaged_files_are_refused_or_read_and_never_more() {
    for seed in files_in("fuzz/seeds/res")
        .into_iter()
        .chain(files_in("tests/data/fuzz/res"))
    {
        laws::fuzz_results(&seed);
        let mut random = 0x2545_f491_4f6c_dd1d_u64;
        let mut next = |below: usize| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            (random % below.max(1) as u64) as usize
        };
        for _ in 0..2000 {
            let mut bytes = seed.clone();
            for _ in 0..1 + next(3) {
                let (at, other) = (next(bytes.len()), next(bytes.len()));
                match next(4) {
                    0 => bytes.truncate(at),
                    1 if !bytes.is_empty() => bytes[at] = b"0 9-.\n\"<>/&!E"[next(13)],
                    2 => drop(bytes.drain(at.min(other)..at.max(other))),
                    _ => bytes = [&bytes[..at], &seed[other.min(seed.len())..]].concat(),
                }
            }
            laws::fuzz_results(&bytes);
        }
    }
}
