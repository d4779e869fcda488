//! `cognate sweep`: tables of many runs, what is refused before anything runs, designs from files.

use super::command::{cognate, path, scratch};
use cognate::results;

const DROP: &str = "\
DROP
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/9, PART=1, FLOATING
PART/2, MASS=1, CM=2, IP=1,1,1
MARKER/2, PART=2
VARIABLE/3, FUNCTION=1
VFORCE/1, I=2, JFLOAT=9, FX=VARVAL(3), FY=0, FZ=0
END
";

#[test]
fn a_grid_is_a_table_that_plot_and_parquet_know() {
    let model = scratch("sweep_grid", "drop.adm", DROP);
    let out = model.with_file_name("table.parquet");
    for file in ["table.csv", "table.parquet", "table.sweep.json"] {
        let _ = std::fs::remove_file(model.with_file_name(file));
    }
    let sweep = || {
        cognate(&[
            "sweep",
            path(&model),
            "--end",
            "1",
            "--steps",
            "10",
            "--set",
            "VARIABLE/3=1:2:3",
            "--set",
            "PART/2.MASS=1,4",
            "--measure",
            "last(DX(2))",
            "--measure",
            "max(abs(VX(2)))",
            "--out",
            path(&out),
        ])
    };
    let done = sweep();
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.out.contains("max(abs(VX(2)))"), "{}", done.out);
    let csv = out.with_extension("csv");
    for file in [&csv, &out] {
        let table = results::read(file).unwrap();
        assert_eq!(table.rows(), 6);
        let units: Vec<&str> = table.columns.iter().map(|c| c.unit.as_str()).collect();
        assert_eq!(units, ["", "", "", "meter", "meter/sec", "", ""]);
        let [force, mass, way] =
            ["VARIABLE/3", "PART/2.MASS", "last(DX(2))"].map(|n| table.column(n).unwrap());
        for k in 0..6 {
            assert!((way[k] - 0.5 * force[k] / mass[k]).abs() < 1e-6);
        }
    }
    let before = std::fs::read(&csv).unwrap();
    let again = sweep();
    assert!(
        again.err.contains("has 6 of 6 runs already"),
        "{}",
        again.err
    );
    assert_eq!(std::fs::read(&csv).unwrap(), before);
    let plot = |more: &[&str]| {
        let axes = ["--x", "VARIABLE/3", "--y", "last(DX(2))"];
        let plot = cognate(&[&["plot", path(&csv)], &axes[..], more].concat());
        assert_eq!(plot.code, 0, "{}", plot.err);
        plot.out
    };
    assert!(plot(&["--list"]).contains("max(abs(VX(2)))"));
    // a curve for each mass, from the least force on
    let shown = plot(&[]);
    for name in ["PART/2.MASS = 1", "PART/2.MASS = 4"] {
        assert!(shown.contains(name), "{shown}");
    }
}

#[test]
fn mistakes_are_told_all_at_once_before_anything_runs() {
    let model = scratch("sweep_mistakes", "drop.adm", DROP);
    let out = model.with_file_name("none.csv");
    let ask = |more: &[&str]| {
        let mut all = vec!["sweep", path(&model), "--end", "1", "--out", path(&out)];
        all.extend(more);
        cognate(&all)
    };
    let done = ask(&[
        "--set",
        "PART/2.MAS5=1,2",
        "--set",
        "VARIABLE/3=0:1",
        "--measure",
        "max(DX(22))",
    ]);
    assert_eq!(done.code, 3, "{}", done.err);
    for said in [
        "did you mean MASS",
        "no number of values",
        "MARKER/22 does not exist",
    ] {
        assert!(done.err.contains(said), "{}", done.err);
    }
    let latin = ask(&[
        "--design",
        "latin",
        "--set",
        "VARIABLE/3=0:1",
        "--measure",
        "max(DX(2))",
    ]);
    assert!(
        latin.code == 3 && latin.err.contains("--runs"),
        "{}",
        latin.err
    );
    let kind = ask(&["--design", "gird", "--measure", "max(DX(2))"]);
    assert!(kind.code == 3 && kind.err.contains("gird"), "{}", kind.err);
    assert!(!out.exists());
}

#[test]
fn commands_run_each_time_and_may_not_undo_what_is_set() {
    let model = scratch("sweep_commands", "drop.adm", DROP);
    let commands = |more: &str| {
        let text = format!(
            "\nfile/model=drop\n{more}simulate/dynamic, end=1, steps=4\nsimulate/dynamic, end=2, steps=4\n"
        );
        scratch("sweep_commands", "drop.acf", &text)
    };
    let out = model.with_file_name("table.csv");
    let _ = std::fs::remove_file(&out);
    let points = scratch("sweep_commands", "points.csv", "PART/2.MASS\n1\n-1\n4\n");
    let ask = |file: &std::path::Path| {
        cognate(&[
            "sweep",
            path(file),
            "--design",
            path(&points),
            "--measure",
            "last(DX(2))",
            "--threads",
            "2",
            "--out",
            path(&out),
        ])
    };
    let done = ask(&commands(""));
    assert!(
        done.code == 0 && done.err.contains("1 of 3 runs failed"),
        "{}",
        done.err
    );
    let text = std::fs::read_to_string(&out).unwrap();
    let status: Vec<&str> = text
        .lines()
        .skip(2)
        .filter_map(|l| l.split(',').nth(3))
        .collect();
    assert_eq!(status, ["0", "4", "0"], "{text}");
    let way = results::read(&out)
        .unwrap()
        .column("last(DX(2))")
        .unwrap()
        .to_vec();
    assert!(
        (way[0] - 2.0).abs() < 1e-5 && way[1].is_nan() && (way[2] - 0.5).abs() < 1e-5,
        "{way:?}"
    );
    let undone = ask(&commands("part/2, mass=3\n"));
    assert!(
        undone.code == 3 && undone.err.contains("line 3"),
        "{}",
        undone.err
    );
}

#[test]
fn columns_of_the_results_are_measured_by_their_names() {
    let request = "REQUEST/1, COMMENT=drop, F2=-DX(2)\\, CNAMES=\"\",\"X\",\"\",\"\",\"\",\"\",\"\",\"\", RESULTS_NAME=drop\nEND\n";
    let model = scratch("sweep_columns", "drop.adm", &DROP.replace("END\n", request));
    let out = model.with_file_name("table.csv");
    let _ = std::fs::remove_file(&out);
    let ask = |measures: &[&str]| {
        let mut all = vec![
            "sweep",
            path(&model),
            "--end",
            "1",
            "--set",
            "PART/2.MASS=1",
            "--out",
            path(&out),
        ];
        all.extend(measures.iter().flat_map(|m| ["--measure", *m]));
        cognate(&all)
    };
    let near = ask(&["max(abs(drop.XX))"]);
    assert!(
        near.code == 3 && near.err.contains("did you mean drop.X"),
        "{}",
        near.err
    );
    let done = ask(&["max(abs(drop.X))", "max(drop.X)", "min(ABS(-DX(2)))"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let table = results::read(&out).unwrap();
    let of = |name: &str| table.column(name).unwrap()[0];
    assert!((of("max(abs(drop.X))") - 0.5).abs() < 1e-6);
    assert_eq!([of("max(drop.X)"), of("min(ABS(-DX(2)))")], [0.0, 0.0]);
}

#[test]
fn a_hypercube_is_the_same_for_the_same_seed() {
    let model = scratch("sweep_latin", "drop.adm", DROP);
    let table = |name: &str, seed: &str| {
        let out = model.with_file_name(name);
        let _ = std::fs::remove_file(&out);
        let done = cognate(&[
            "sweep",
            path(&model),
            "--end",
            "1",
            "--set",
            "VARIABLE/3=0:1",
            "--set",
            "PART/2.MASS=1:2",
            "--design",
            "latin",
            "--runs",
            "5",
            "--seed",
            seed,
            "--measure",
            "max(DX(2))",
            "--out",
            path(&out),
        ]);
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read(&out).unwrap()
    };
    assert_eq!(table("a.csv", "1"), table("b.csv", "1"));
    assert_ne!(table("a.csv", "1"), table("c.csv", "2"));
}
