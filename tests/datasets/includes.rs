//! Datasets in several files: `! cognate: INCLUDE` has the statements of another file, every mistake stands in its own file, and no file is lost or made part of another.

use cognate::dataset::{self, Reading, Source};
use cognate::disk;
use cognate::model::ElementKind;
use proptest::prelude::*;

/// Reads a dataset of several files, the first of which includes the others.
fn read(files: &[(&str, &str)]) -> Reading {
    for (name, text) in files {
        disk::give(*name, *text);
    }
    dataset::read(files[0].0).unwrap()
}

/// File, line and message of all that is said.
fn told(reading: &Reading) -> Vec<(String, usize, String)> {
    let all = reading.diagnostics.iter();
    all.map(|d| {
        (
            d.file.clone().unwrap_or_default(),
            d.line,
            d.message.clone(),
        )
    })
    .collect()
}

const UNITS: &str = "UNITS/SYSTEM=MKS\n";
const GROUND: &str = "PART/1, GROUND\nMARKER/1, PART=1\n";
const BAR: &str = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n";
const HINGE: &str = "JOINT/1, REVOLUTE, I=2, J=1\nACCGRAV/JGRAV=-9.81\n";

#[test]
fn a_dataset_of_files_is_the_dataset_of_their_statements() {
    let whole = dataset::read_text(&format!("title\n{UNITS}{GROUND}{BAR}{HINGE}END\n"));
    let reading = read(&[
        (
            "one/all.adm",
            &format!(
                "title\n{UNITS}! cognate: INCLUDE parts/ground.adm\n  !  COGNATE:include 'bar.adm'\n{HINGE}END\n"
            ),
        ),
        (
            "one/parts/ground.adm",
            &format!("ground\n{GROUND}END\nMARKER/9, PART=1\n"),
        ),
        (
            "one/bar.adm",
            &format!("bar, whose end is that of the file\n{}", BAR.trim_end()),
        ),
    ]);
    let errors = told(&reading);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert_eq!(
        (errors[0].0.as_str(), errors[0].1),
        ("one/parts/ground.adm", 5),
        "text behind END is told there"
    );
    assert_eq!(reading.model.to_text(), whole.model.to_text());
}

#[test]
fn a_file_includes_files_of_its_own_folder_and_of_others() {
    let reading = read(&[
        ("two/a.adm", "a\n! cognate: INCLUDE deep/b.adm\nEND\n"),
        (
            "two/deep/b.adm",
            &format!(
                "b\n{UNITS}{GROUND}! cognate: INCLUDE ../c.adm\n! cognate: INCLUDE ./d.adm\nEND\n"
            ),
        ),
        ("two/c.adm", &format!("c\n{BAR}END\n")),
        ("two/deep/d.adm", &format!("d\n{HINGE}END\n")),
    ]);
    assert!(reading.diagnostics.is_empty(), "{:?}", told(&reading));
    assert_eq!(
        (reading.model.parts.len(), reading.model.joints.len()),
        (2, 1)
    );
}

#[test]
fn mistakes_stand_in_their_file_at_their_line_and_excerpt() {
    let reading = read(&[
        (
            "three/a.adm",
            &format!(
                "a\n{UNITS}{GROUND}! cognate: INCLUDE b.adm\nVARIABLE/1, FUNCTION=SINN(TIME)\nMOTION/1, JOINT=7, FUNCTION=0\nEND\n"
            ),
        ),
        (
            "three/b.adm",
            &format!(
                "b\n! é\n{BAR}JOINT/1, REVOLUTE, I=2, J=9\nVARIABLE/2,\n  FUNCTION=COSS(TIME)\nPART/2, MASS=x\nEND\n"
            ),
        ),
    ]);
    let found: Vec<(String, usize)> = told(&reading)
        .into_iter()
        .map(|(file, line, _)| (file, line))
        .collect();
    let at = |file: &str, line: usize| (format!("three/{file}.adm"), line);
    for place in [at("a", 6), at("a", 7), at("b", 5), at("b", 7), at("b", 8)] {
        assert!(found.contains(&place), "{place:?}: {:?}", told(&reading));
    }
    for d in &reading.diagnostics {
        let text = String::from_utf8(disk::read(d.file.as_deref().unwrap()).unwrap()).unwrap();
        let Some(span) = d.span else { continue };
        let line = text[..span.start].matches('\n').count() + 1;
        assert_eq!(line, d.line, "the span is one of its own file: {d}");
    }
    // what is found later, by the element
    let joint = reading.dataset.locate(
        cognate::diagnostic::Diagnostic::error("bug", "later").element(ElementKind::Joint.id(1)),
    );
    assert_eq!(
        (joint.file.as_deref(), joint.line),
        (Some("three/b.adm"), 5)
    );
}

#[test]
fn what_cannot_be_included_is_told_at_its_line_and_the_rest_is_read() {
    let first = |line: &str, more: &[(&str, &str)]| {
        let text = format!("a\n{GROUND}! cognate: INCLUDE {line}\nEND\n");
        let mut files = vec![("four/a.adm", text.as_str())];
        files.extend(more);
        let reading = read(&files);
        assert_eq!(reading.model.markers.len(), 1);
        let d = reading.diagnostics[0].clone();
        assert_eq!(d.code, "include", "{d}");
        (d.file.unwrap(), d.line, d.message)
    };
    let a = |message: &str| ("four/a.adm".to_owned(), 4, message.to_owned());
    let (file, line, message) = first("none.adm", &[]);
    assert_eq!((file.as_str(), line), ("four/a.adm", 4));
    assert!(
        message.contains("four/none.adm cannot be opened"),
        "{message}"
    );
    let (.., message) = first("/nowhere/none.adm", &[]);
    assert!(
        message.contains("/nowhere/none.adm cannot be opened"),
        "{message}"
    );
    assert_eq!(first("", &[]), a("the name of a file is expected"));
    assert_eq!(first("a.adm", &[]), a("a.adm includes itself"));
    assert_eq!(
        first("../four/./a.adm", &[]),
        a("../four/./a.adm includes itself")
    );
    let back = ("four/b.adm", "b\n! cognate: INCLUDE c/../a.adm\nEND\n");
    assert_eq!(
        first("b.adm", &[back]),
        ("four/b.adm".into(), 2, "c/../a.adm includes itself".into())
    );
    let view = first("model.cmd", &[("four/model.cmd", "!\nmodel create\n")]);
    assert_eq!(
        view,
        a("model.cmd is a command file of Adams View, no dataset")
    );
    let onward = ("four/onward.adm", "c\n! a comment\n, MASS=1\nEND\n");
    let (file, line, _) = first("onward.adm", &[onward]);
    assert_eq!((file.as_str(), line), ("four/onward.adm", 2));
    for (text, place) in [
        ("d\nMARKER/3, PART=1\n! adams_view_name='x'\nEND\n", 3),
        ("d\nMARKER/3, PART=1 &\n", 2),
    ] {
        let (file, line, _) = first("ended.adm", &[("four/ended.adm", text)]);
        assert_eq!((file.as_str(), line), ("four/ended.adm", place));
    }
    // all at once
    let both = read(&[(
        "four/both.adm",
        "a\n! cognate: INCLUDE x.adm\nPART/1, GROUND\n! cognate: INCLUDE y.adm\nEND\n",
    )]);
    let lines: Vec<usize> = told(&both).iter().map(|t| t.1).collect();
    assert_eq!(lines, [2, 4]);
}

#[test]
fn an_include_stands_between_statements_on_a_line_of_its_own() {
    disk::give("five/bar.adm", format!("b\n{BAR}END\n"));
    for (text, line, part) in [
        (
            "a\nPART/3, MASS=1\n! cognate: INCLUDE bar.adm\n, CM=2\nEND\n",
            3,
            "within a statement",
        ),
        (
            "a\nPART/3, &\n! cognate: INCLUDE bar.adm\n CM=2\nEND\n",
            3,
            "within a statement",
        ),
        (
            "a\nPART/1, GROUND\n! adams_view_name='bar'\n! cognate: INCLUDE bar.adm\nPART/3\nEND\n",
            4,
            "a name stands above",
        ),
        (
            "a\nPART/1, GROUND ! cognate: INCLUDE bar.adm\nEND\n",
            2,
            "a line of its own",
        ),
    ] {
        let reading = read(&[("five/a.adm", text)]);
        let found = reading.diagnostics.iter().find(|d| d.code == "include");
        let d = found.unwrap_or_else(|| panic!("{text}: {:?}", told(&reading)));
        assert!(d.line == line && d.message.contains(part), "{text}: {d}");
        assert!(!reading.model.parts.contains_key(&2));
    }
    // the title is a title, and what follows END is not read
    let reading = read(&[(
        "five/a.adm",
        "! cognate: INCLUDE bar.adm\nPART/1, GROUND\nEND\n! cognate: INCLUDE bar.adm\n",
    )]);
    assert_eq!(reading.model.parts.len(), 1);
}

#[test]
fn a_text_without_a_file_includes_none() {
    let reading = dataset::read_text("a\nPART/1, GROUND\n! cognate: INCLUDE bar.adm\nEND\n");
    let d = &reading.diagnostics[0];
    assert_eq!((d.code, d.line, d.file.as_deref()), ("include", 3, None));
    assert!(d.message.contains("without a file"), "{d}");
}

#[test]
fn files_within_files_and_many_of_them_end() {
    let deep = |k: usize| format!("six/deep{k}.adm");
    for k in 0..40 {
        disk::give(
            deep(k),
            format!("d\n! cognate: INCLUDE deep{}.adm\nEND\n", k + 1),
        );
    }
    let reading = dataset::read(deep(0)).unwrap();
    assert!(
        reading
            .diagnostics
            .iter()
            .any(|d| d.message.contains("within each other")),
        "{:?}",
        told(&reading)
    );
    // each includes the next one nine times: nine to the tenth files, if nobody counted them
    for k in 0..10 {
        disk::give(
            format!("six/wide{k}.adm"),
            "w\n".to_owned()
                + &format!("! cognate: INCLUDE wide{}.adm\n", k + 1).repeat(9)
                + "END\n",
        );
    }
    let reading = dataset::read("six/wide0.adm").unwrap();
    assert!(
        reading
            .diagnostics
            .iter()
            .any(|d| d.message.contains("1000 in all"))
    );
}

#[test]
fn the_text_of_a_dataset_stays_that_of_its_file() {
    let own = format!(
        "a\n! cognate: INCLUDE bar.adm\n{GROUND}! adams_view_name='hinge'\n{HINGE}END\nbehind\n"
    );
    let reading = read(&[
        ("seven/a.adm", &own),
        ("seven/bar.adm", &format!("bar\n{BAR}END\n")),
    ]);
    let data = &reading.dataset;
    assert_eq!(data.to_text(), own);
    let [joint, part] = [ElementKind::Joint.id(1), ElementKind::Part.id(2)];
    assert_eq!(
        data.renamed(joint, "pivot"),
        Some(own.replace("'hinge'", "'pivot'"))
    );
    let without = own.replace(
        "! adams_view_name='hinge'\nJOINT/1, REVOLUTE, I=2, J=1\n",
        "",
    );
    assert_eq!(data.without(joint), Some(without));
    assert_eq!(
        (data.renamed(part, "bar"), data.without(part)),
        (None, None)
    );
    assert_eq!(data.included_file_of(part), Some("seven/bar.adm"));
    assert_eq!(data.included_file_of(joint), None);
    let alone = dataset::read_alone(Source::from_text(Some("seven/a.adm"), own.as_str()));
    assert!(
        alone
            .dataset
            .formatted()
            .contains("\n! cognate: INCLUDE bar.adm\n")
    );
    assert!(!alone.dataset.formatted().contains("PART/2"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_lines_in_several_files_make_the_reader_panic(
        lines in proptest::collection::vec(0..9_usize, 0..12),
        more in proptest::collection::vec(0..9_usize, 0..8),
        ends in 0..3_usize,
    ) {
        const LINES: [&str; 9] = [
            "! cognate: INCLUDE b.adm", "PART/2, MASS=1", ", IP=1,1,1", "END", "", "é ! x", "PART/1, &", "! adams_view_name='n'",
            "\t!cognate:INCLUDE",
        ];
        let end = ["\n", "\r\n", "\r"][ends];
        let text = |lines: &[usize]| lines.iter().map(|&k| format!("{}{end}", LINES[k])).collect::<String>();
        disk::give("eight/b.adm", text(&more));
        let own = text(&lines);
        disk::give("eight/a.adm", own.as_str());
        let reading = dataset::read("eight/a.adm").unwrap();
        prop_assert_eq!(reading.dataset.to_text(), own.as_str());
        for d in &reading.diagnostics {
            let file = d.file.as_deref().unwrap_or("eight/a.adm");
            let text = if file == "eight/a.adm" { own.clone() } else { text(&more) };
            let n = Source::from_text(None, text.as_str()).place(text.len()).0;
            prop_assert!(d.line <= n, "{d}");
            if let Some(span) = d.span {
                prop_assert!(text.get(span.start..).is_some(), "{d}");
            }
        }
    }
}
