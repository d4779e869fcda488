//! `cognate plot`: which curves, which axes, which numbers.

use super::command::{cognate, path, scratch};

/// A table of a fall: displacement, velocity, and a pure number.
fn fall(test: &str, name: &str, g: f64) -> std::path::PathBuf {
    let mut text = "time,drop.X,drop.V,n\nsec,mm,mm/sec,-\n".to_owned();
    for k in 0..=100 {
        let t = f64::from(k) * 0.01;
        text += &format!("{t},{},{},{k}\n", 0.5 * g * t * t, g * t);
    }
    scratch(test, name, &text)
}

#[test]
fn two_units_have_an_axis_at_either_side_and_three_have_panels() {
    let table = fall("plot_axes", "a.csv", 9.0);
    let picture = table.with_file_name("a.svg");
    let draw = |columns: &[&str]| {
        let mut arguments = vec!["plot", path(&table), "--out", path(&picture)];
        columns.iter().for_each(|c| arguments.extend(["--y", c]));
        let done = cognate(&arguments);
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read_to_string(&picture).unwrap()
    };
    let two = draw(&["drop.X", "drop.V"]);
    assert!(
        two.contains("drop.X [mm]")
            && two.contains("drop.V [mm/sec]")
            && two.contains("drop.V (right)")
    );
    assert!(two.contains("height=\"540\""));
    let three = draw(&["drop.X", "drop.V", "n"]);
    assert!(!three.contains("(right)") && three.contains("height=\"750\""));
}

#[test]
fn runs_are_laid_over_each_other_and_named_by_their_files() {
    let a = fall("plot_over", "a.csv", 9.0);
    let b = fall("plot_over", "b.csv", 8.0);
    let picture = a.with_file_name("over.svg");
    let done = cognate(&[
        "plot",
        path(&a),
        "--over",
        path(&b),
        "--y",
        "drop.X",
        "--out",
        path(&picture),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let text = std::fs::read_to_string(&picture).unwrap();
    assert!(text.contains("drop.X (a)") && text.contains("drop.X (b)"));
    let same = cognate(&["plot", path(&a), "--over", path(&b), "--out", path(&b)]);
    assert_eq!(same.code, 2, "an input is never overwritten");
}

#[test]
fn slope_integral_and_statistics_are_those_of_the_fall() {
    let table = fall("plot_numbers", "a.csv", 9.0);
    let numbers = |arguments: &[&str]| -> serde_json::Value {
        let mut all = vec!["plot", path(&table), "--statistics", "--json"];
        all.extend(arguments);
        let done = cognate(&all);
        assert_eq!(done.code, 0, "{}", done.err);
        serde_json::from_str(&done.out).unwrap()
    };
    let slope = numbers(&["--y", "drop.V", "--as", "derivative"]);
    assert_eq!(slope[0]["unit"], "mm/sec**2");
    assert!((slope[0]["mean"].as_f64().unwrap() - 9.0).abs() < 1e-9);
    let way = numbers(&["--y", "drop.V", "--as", "integral"]);
    assert_eq!(way[0]["unit"], "mm");
    assert!((way[0]["last"].as_f64().unwrap() - 4.5).abs() < 1e-9);
    let all = numbers(&[]);
    assert_eq!(all.as_array().unwrap().len(), 3);
    assert_eq!(all[1]["largest"]["at"], 1.0);
}

#[test]
fn columns_are_listed_and_json_is_read_like_csv() {
    let table = fall("plot_json", "a.csv", 9.0);
    let document = table.with_file_name("a.json");
    assert_eq!(cognate(&["convert", path(&table), path(&document)]).code, 0);
    let [csv, json] = [&table, &document].map(|file| cognate(&["plot", path(file), "--list"]).out);
    assert!(
        csv == json && csv.contains("drop.V") && csv.contains("mm/sec"),
        "{csv}{json}"
    );
}

#[test]
fn pictures_have_the_format_that_their_names_say() {
    let table = fall("plot_formats", "a.csv", 9.0);
    let formats = [
        ("svg", &b"<svg"[..]),
        ("png", b"\x89PNG"),
        ("PDF", b"%PDF-"),
    ];
    for (ending, begins) in formats {
        let file = table.with_file_name(format!("a.{ending}"));
        let done = cognate(&["plot", path(&table), "--y", "drop.X", "--out", path(&file)]);
        assert_eq!(done.code, 0, "{}", done.err);
        let bytes = std::fs::read(&file).unwrap();
        assert!(bytes.starts_with(begins) && bytes.len() > 3000, "{ending}");
    }
    let file = table.with_file_name("a.txt");
    let done = cognate(&["plot", path(&table), "--out", path(&file)]);
    assert!(
        done.code == 3 && done.err.contains("picture_format"),
        "{}",
        done.err
    );
    assert!(!file.exists());
}

#[test]
fn bars_of_error_that_are_read_are_bands_and_no_columns() {
    let mut text = "time,x,x±\nsec,mm,mm\n".to_owned();
    (0..20).for_each(|k| text += &format!("{k},{},0.5\n", k * k));
    let table = scratch("plot_bands", "a.csv", &text);
    let picture = table.with_file_name("a.svg");
    let done = cognate(&["plot", path(&table), "--out", path(&picture)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let drawn = std::fs::read_to_string(&picture).unwrap();
    assert_eq!(
        (
            drawn.matches("<polygon").count(),
            drawn.matches("x±").count()
        ),
        (1, 0)
    );
    let statistics = cognate(&["plot", path(&table), "--statistics"]).out;
    assert!(!statistics.contains('±'), "{statistics}");
    // by its name it is a column as any other
    let asked = cognate(&["plot", path(&table), "--y", "x±", "--statistics"]).out;
    assert!(asked.contains("x±"), "{asked}");
}

#[test]
fn columns_that_are_not_shown_are_told() {
    let names: Vec<String> = (0..20).map(|k| format!("c{k}")).collect();
    let row = |t: f64| {
        (0..20)
            .map(|k| format!(",{}", t * f64::from(k)))
            .collect::<String>()
    };
    let text = format!("time,{}\n0{}\n1{}\n", names.join(","), row(0.0), row(1.0));
    let table = scratch("plot_told", "a.csv", &text);
    let picture = table.with_file_name("a.svg");
    let few = cognate(&["plot", path(&table), "--out", path(&picture)]);
    assert!(few.err.contains("the first 8 of 20 columns"), "{}", few.err);
    let one = cognate(&["plot", path(&table), "--y", "c3", "--out", path(&picture)]);
    assert!(!one.err.contains("columns"), "{}", one.err);
}

#[test]
fn a_slope_over_a_column_says_over_which_and_options_without_effect_are_refused() {
    let table = fall("plot_over_column", "a.csv", 9.0);
    let told = |shown: &str, more: &[&str]| {
        let args = [
            "plot",
            path(&table),
            "--y",
            "drop.X",
            "--as",
            shown,
            "--statistics",
        ];
        cognate(&[&args[..], more].concat()).out
    };
    assert!(told("derivative", &["--x", "drop.V"]).contains("d(drop.X)/d(drop.V)  mm/(mm/sec)"));
    assert!(told("integral", &["--x", "drop.V"]).contains("∫drop.X d(drop.V)"));
    for over_time in [&[][..], &["--x", "time"]] {
        assert!(told("derivative", over_time).contains("d(drop.X)/dt  mm/sec"));
        assert!(told("integral", over_time).contains("∫drop.X dt"));
    }
    let picture = table.with_file_name("none.svg");
    let _ = std::fs::remove_file(&picture);
    for more in [
        &["--statistics", "--out", path(&picture)][..],
        &["--list", "--out", path(&picture)],
        &["--end", "0.5"],
    ] {
        let done = cognate(&[&["plot", path(&table)], more].concat());
        assert_eq!(done.code, 2, "{more:?}: {}", done.err);
        assert!(!picture.exists(), "{more:?}");
    }
}
