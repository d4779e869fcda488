//! Plants: inputs (PINPUT) from a table over time are those inputs written into the model, and a table that does not fit is refused with all of its mistakes.

use super::command::{cognate, ok, path, scratch};
use super::running::{Analysis, begin, go, last, model, options_by};

use cognate::disk;
use cognate::model::{Formula, Model};
use cognate::setup::{Between, drive_inputs, undriven_inputs};
use std::path::Path;

/// A mass that slides along z between a spring and a damper, pushed by two inputs; the second one counts by its square.
const PLANT: &str = "PART/2, MASS=2, CM=2, IP=1,1,1\n! adams_view_name='moved'\nMARKER/2, PART=2\nMARKER/3, PART=1\n\
     JOINT/1, TRANSLATIONAL, I=2, J=3\n\
     ! adams_view_name='push'\nVARIABLE/7, FUNCTION=PUSH\nVARIABLE/8, FUNCTION=GAIN\nVARIABLE/9, FUNCTION=DZ(2,3)\n\
     SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=VARVAL(7)+VARVAL(8)**2-30*DZ(2,3)-2*VZ(2,3)\n\
     ! adams_view_name='controls.ctrl_pinput'\nPINPUT/1, VARIABLES=7,8\nPOUTPUT/1, VARIABLES=9\n";

/// The plant with these functions of its inputs.
fn plant(push: &str, gain: &str) -> Model {
    model(&PLANT.replace("PUSH", push).replace("GAIN", gain))
}

/// The plant driven by a table.
fn driven(name: &str, table: &str, between: Between) -> Model {
    let mut model = plant("0", "0");
    disk::give(name, table);
    drive_inputs(&mut model, Path::new(name), between).unwrap_or_else(|e| panic!("{e}\n{table}"));
    model
}

/// The displacement at the end of a run.
fn end_of(model: Model, method: &str, error: f64, end: f64) -> f64 {
    let mut s = begin(model, "plant", options_by(&["DZ(2,3)"], method, error));
    go(&mut s, Analysis::Dynamic, end, 7);
    last(&s, "DZ(2,3)")
}

/// Samples as a chain of IF: straight between them, or held; held outside.
fn written(samples: &[(f64, f64)], between: Between) -> String {
    let mut text = format!("{:?}", samples[samples.len() - 1].1);
    for pair in samples.windows(2).rev() {
        let [(a, u), (b, v)] = [pair[0], pair[1]];
        let piece = match between {
            Between::Linear => format!("{u:?}+{:?}*(TIME-{a:?})", (v - u) / (b - a)),
            Between::Held => format!("{u:?}"),
        };
        text = format!("IF(TIME-{b:?}: {piece}, {text}, {text})");
    }
    let (first, held) = samples[0];
    format!("IF(TIME-{first:?}: {held:?}, {text}, {text})")
}

const PUSH: [(f64, f64); 5] = [(0.1, 3.0), (0.5, -4.0), (0.75, 8.0), (1.2, 8.0), (1.6, 0.5)];
const GAIN: [(f64, f64); 5] = [(0.1, 1.0), (0.5, 0.0), (0.75, 2.0), (1.2, -1.0), (1.6, 1.5)];

/// The table of both.
fn both() -> String {
    let rows = PUSH.iter().zip(&GAIN);
    let rows = rows.map(|((t, u), (_, v))| format!("{t},{u},{v}\n"));
    "TIME,push,IN2\n".to_owned() + &rows.collect::<String>()
}

#[test]
fn a_plant_driven_by_a_table_is_the_plant_with_its_inputs_written_out() {
    for between in [Between::Linear, Between::Held] {
        let [push, gain] = [PUSH, GAIN].map(|samples| written(&samples, between));
        let known = end_of(plant(&push, &gain), "DOP853", 1e-12, 2.0);
        for (method, error) in [
            ("AUTO", 1e-6),
            ("RADAU5", 1e-6),
            ("DOP853", 1e-6),
            ("DOP853", 1e-10),
        ] {
            let name = format!("written-{between:?}-{method}.csv");
            let model = driven(&name, &both(), between);
            let off = (end_of(model, method, error, 2.0) - known).abs() / known.abs();
            assert!(
                off < 10.0 * error,
                "{between:?} by {method} at {error:e}: {off:e}"
            );
        }
    }
}

/// Samples of noise, at times that are nowhere equally spaced.
fn noise(n: usize, end: f64) -> Vec<(f64, f64)> {
    let mut state = 7_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let step = end / n as f64;
    (0..n)
        .map(|k| ((k as f64 + 0.8 * random()) * step, 200.0 * random() - 100.0))
        .collect()
}

#[test]
fn noise_of_two_thousand_samples_is_met_within_the_request() {
    let samples = noise(2000, 2.0);
    let rows = samples.iter().map(|(t, u)| format!("{t},{u}\n"));
    let table = "time,push\nsec,-\n".to_owned() + &rows.collect::<String>();
    for between in [Between::Linear, Between::Held] {
        // Duhamel's integral of each piece in closed form, through the states at its ends
        let known = oscillator(&samples, between, 2.0);
        for method in ["AUTO", "RADAU5", "DOP853"] {
            let model = driven(&format!("noise-{between:?}-{method}.csv"), &table, between);
            let found = end_of(model, method, 1e-6, 2.0);
            let off = (found - known).abs() / known.abs();
            assert!(
                off < 1e-5,
                "{between:?} by {method}: {found}, not {known}: {off:e}"
            );
        }
    }
}

/// The displacement of the plant at a time, by many small steps of the classical method of Runge and Kutta in each piece.
fn oscillator(samples: &[(f64, f64)], between: Between, end: f64) -> f64 {
    let mut state = [0.0, 0.0];
    let mut pieces = vec![((0.0, samples[0].1), (samples[0].0, samples[0].1))];
    pieces.extend(samples.windows(2).map(|pair| (pair[0], pair[1])));
    let last = samples[samples.len() - 1];
    pieces.push((last, (end, last.1)));
    for ((a, u), (b, v)) in pieces {
        let rate = |t: f64, [z, w]: [f64; 2]| {
            let push = match between {
                Between::Linear if b > a => u + (v - u) * (t - a) / (b - a),
                _ => u,
            };
            [w, (push - 30.0 * z - 2.0 * w) / 2.0]
        };
        let h = (b - a) / 8.0;
        for k in 0..8 {
            let t = a + f64::from(k) * h;
            let moved = |s: [f64; 2], r: [f64; 2], h: f64| [s[0] + h * r[0], s[1] + h * r[1]];
            let k1 = rate(t, state);
            let k2 = rate(t + h / 2.0, moved(state, k1, h / 2.0));
            let k3 = rate(t + h / 2.0, moved(state, k2, h / 2.0));
            let k4 = rate(t + h, moved(state, k3, h));
            for (k, rates) in [(1.0, k1), (2.0, k2), (2.0, k3), (1.0, k4)] {
                state = moved(state, rates, k * h / 6.0);
            }
        }
    }
    state[0]
}

#[test]
fn every_name_of_an_input_gives_the_same_run() {
    let run = |name: &str| {
        let table = format!("TIME,{name}\n0,1\n0.5,7\n1,-3\n");
        end_of(
            driven("names.csv", &table, Between::Linear),
            "AUTO",
            1e-6,
            1.5,
        )
    };
    let known = run("push");
    for name in [
        "VARIABLE/7",
        "PUSH",
        "push.Q",
        "IN1",
        "in1",
        "PINPUT/1.IN1",
        "PINPUT_1.IN1",
        "controls.ctrl_pinput.IN1",
    ] {
        assert_eq!(run(name), known, "{name}");
    }
    assert!(run("IN2") != known);
}

#[test]
fn a_table_is_read_as_results_are_with_units_quotes_and_decimal_commas() {
    let known = driven("plain.csv", "TIME,push\n0,1.5\n0.5,7\n1,-3", Between::Held);
    for (k, table) in [
        "time,push\nsec,-\n0,1.5\n0.5,7\n1,-3\n",
        "\"Time\",\"push\"\r\n\r\n 0 , 1.5\r\n5E-1,7.0\r\n1D0,-3\r\n",
        "TIME;push\n0;1,5\n0,5;7\n1;-3\n",
        "\u{feff}TIME,push\n0,1.5\n0.5,7\n1,-3\n",
    ]
    .into_iter()
    .enumerate()
    {
        let read = driven(&format!("style{k}.csv"), table, Between::Held);
        assert_eq!(read.to_text(), known.to_text(), "{table}");
    }
}

#[test]
fn all_mistakes_of_a_table_are_told_at_once_each_with_its_line() {
    let mut model = plant("0", "0");
    let table = "t,push,IN3,VARIABLE/9,hold,push\n0,1,2,3,4\n0.2,1,x,3,4,5\n0.2,1,inf,3,4,5\n0.1,,2,3,4,5\n";
    disk::give("mistaken.csv", table);
    let before = model.to_text();
    let error = drive_inputs(&mut model, Path::new("mistaken.csv"), Between::Linear).unwrap_err();
    let told = error.diagnostics();
    let lines: Vec<usize> = told.iter().map(|d| d.line).collect();
    assert_eq!(lines, [1, 1, 1, 1, 1, 2, 3, 4, 4, 5, 5], "{error}");
    for (d, part) in told.iter().zip([
        "`t`",
        "`IN3`",
        "`VARIABLE/9`",
        "`hold`",
        "both VARIABLE/7",
        "5 cells",
        "`x`",
        "`inf`",
        "0.2 follows 0.2",
        "``",
        "0.1 follows 0.2",
    ]) {
        assert!(d.message.contains(part), "{part}: {}", d.message);
        assert_eq!(
            (d.code, d.file.as_deref()),
            ("input_table", Some("mistaken.csv"))
        );
    }
    assert_eq!(
        model.to_text(),
        before,
        "a model is driven by a whole table or not at all"
    );
}

#[test]
fn a_table_of_nothing_but_mistakes_tells_some_and_counts_the_others() {
    let mut model = plant("0", "0");
    disk::give(
        "hostile.csv",
        "TIME,push\n".to_owned() + &"x,y\n".repeat(1000),
    );
    let error = drive_inputs(&mut model, Path::new("hostile.csv"), Between::Linear).unwrap_err();
    let told = error.diagnostics();
    assert_eq!(told.len(), 20);
    // the first of them would be a row of units
    assert_eq!(
        told[19].help,
        ["the table has at least 1978 further mistakes"]
    );
}

#[test]
fn a_model_without_inputs_and_a_table_without_samples_are_refused() {
    for (text, table, part) in [
        ("", "TIME,push\n0,1\n", "no PINPUT"),
        (PLANT, "", "no row of names"),
        (PLANT, "TIME\n0\n", "no column behind TIME"),
        (PLANT, "TIME,push\n", "no sample"),
        (
            PLANT,
            "TIME,push\nmillisecond,-\n0,1\n",
            "the unit of the model",
        ),
    ] {
        let mut model = model(
            &format!("UNITS/SYSTEM=MKS\n{text}")
                .replace("PUSH", "0")
                .replace("GAIN", "0"),
        );
        disk::give("empty.csv", table);
        let error = drive_inputs(&mut model, Path::new("empty.csv"), Between::Held).unwrap_err();
        assert!(error.to_string().contains(part), "{part}: {error}");
    }
}

#[test]
fn only_inputs_that_stay_constant_or_user_are_told_without_a_table() {
    let told = |push: &str, gain: &str| undriven_inputs(&plant(push, gain)).map(|d| d.message);
    assert_eq!(told("SIN(TIME)", "DZ(2,3)"), None);
    let one = told("0", "TIME").unwrap();
    assert!(one.starts_with("VARIABLE/7 'push' is an input"), "{one}");
    let two = told("USER(1,2)", "2*3").unwrap();
    assert!(
        two.starts_with("VARIABLE/7 'push' and VARIABLE/8 are inputs"),
        "{two}"
    );
    let mut none = plant("0", "0");
    none.plant_inputs.clear();
    assert_eq!(undriven_inputs(&none), None);
}

#[test]
fn what_was_said_by_user_is_given_by_the_table() {
    let mut model = plant("USER(1)", "0");
    disk::give("user.csv", "TIME,IN1\n0,2\n");
    let note = drive_inputs(&mut model, Path::new("user.csv"), Between::Held).unwrap();
    assert!(matches!(
        model.variables[&7].function,
        Formula::Expression { .. }
    ));
    assert!(
        note.message.contains("VARIABLE/8 has no column"),
        "{}",
        note.message
    );
    let off = end_of(model, "AUTO", 1e-8, 1.0) - end_of(plant("2", "0"), "AUTO", 1e-8, 1.0);
    assert!(off.abs() < 1e-9, "{off}");
}

#[test]
fn rows_that_say_the_same_and_another_order_of_columns_change_nothing() {
    let [push, gain] = [noise(14, 2.0), noise(28, 2.0)];
    for n in [1, 2, 3, 5, 14] {
        let rows: Vec<[f64; 3]> = (0..n)
            .map(|k| [push[k].0, push[k].1, 0.02 * gain[k].1])
            .collect();
        for between in [Between::Linear, Between::Held] {
            let end = |head: &str, rows: &[[f64; 3]], order: [usize; 3]| {
                let line = |row: &[f64; 3]| {
                    let [a, b, c] = order.map(|k| row[k]);
                    format!("{a:?},{b:?},{c:?}\n")
                };
                let table = head.to_owned() + &rows.iter().map(line).collect::<String>();
                end_of(driven("law.csv", &table, between), "AUTO", 1e-7, 2.0)
            };
            let plain = end("TIME,IN1,IN2\n", &rows, [0, 1, 2]);
            assert_eq!(
                plain,
                end("TIME,IN2,IN1\n", &rows, [0, 2, 1]),
                "{n} {between:?}"
            );

            let mut more: Vec<[f64; 3]> = Vec::new();
            for pair in rows.windows(2) {
                let middle = [0, 1, 2].map(|c| match between {
                    Between::Held if c > 0 => pair[0][c],
                    _ => 0.5 * (pair[0][c] + pair[1][c]),
                });
                more.extend([pair[0], middle]);
            }
            more.push(rows[n - 1]);
            let finer = end("TIME,IN1,IN2\n", &more, [0, 1, 2]);
            let off = (finer - plain).abs() / plain.abs();
            assert!(off < 1e-6, "{n} {between:?}: {off:e}");
        }
    }
}

/// The dataset of the plant at rest and its table, as files of a test's own.
fn files(test: &str, table: &str) -> (String, String) {
    let text = format!(
        "{}{}END\n",
        super::running::GROUND,
        PLANT.replace("PUSH", "0").replace("GAIN", "0")
    );
    let dataset = scratch(test, "plant.adm", &text);
    let table = scratch(test, "inputs.csv", table);
    (path(&dataset).to_owned(), path(&table).to_owned())
}

#[test]
fn a_run_says_where_the_inputs_of_its_plants_come_from_and_records_them() {
    let (dataset, table) = files("plant_run", "TIME,push,IN2\n0,1,0\n1,3,2\n");
    let without = ok(&[
        "run",
        &dataset,
        "--end",
        "1",
        "-o",
        "-",
        "--column",
        "PINVAL(1,1)",
    ]);
    let said = "VARIABLE/7 'push' and VARIABLE/8 are inputs of a plant and stay";
    assert!(without.err.contains(said), "{}", without.err);
    let quiet = ok(&[
        "run", &dataset, "--end", "1", "-o", "-", "--quiet", "--column", "TIME",
    ]);
    assert_eq!(quiet.err, "");

    let out = path(std::path::Path::new(&dataset).parent().unwrap()).to_owned();
    let run = [
        "run", &dataset, "--end", "2", "--steps", "4", "--input", &table, "--out", &out,
    ];
    let options = [
        "--format",
        "csv,res,json",
        "--column",
        "PINVAL(1,1)",
        "--column",
        "POUVAL(1,1)",
        "--overwrite",
    ];
    let done = ok(&[&run[..], &options].concat());
    assert!(
        done.err.contains("straight between 2 samples from 0 to 1"),
        "{}",
        done.err
    );
    assert!(!done.err.contains("stay"), "{}", done.err);
    let results = cognate::results::read(format!("{out}/plant.res").as_ref()).unwrap();
    let at = |column: &str| {
        results
            .column(column)
            .unwrap_or_else(|| panic!("no {column}"))
            .to_vec()
    };
    assert_eq!(at("controls.ctrl_pinput.IN1"), [1.0, 2.0, 3.0, 3.0, 3.0]);
    assert_eq!(at("PINPUT/1.IN2"), [0.0, 1.0, 2.0, 2.0, 2.0]);
    let text = std::fs::read_to_string(format!("{out}/plant.res")).unwrap();
    let set = "<Entity name=\"ctrl_pinput\" entity=\"controls.ctrl_pinput\" entType=\"Plant_Input\" objectId=\"1\">\n<Component name=\"IN1\"";
    assert!(text.contains(set), "as Adams writes it: {text}");
    let table = cognate::results::read(format!("{out}/plant.csv").as_ref()).unwrap();
    assert_eq!(
        table.column("PINVAL(1,1)").unwrap(),
        [1.0, 2.0, 3.0, 3.0, 3.0]
    );
    assert_eq!(table.column("POUVAL(1,1)").unwrap(), at("POUTPUT_1.OUT1"));
}

#[test]
fn mistakes_of_a_table_end_a_run_before_anything_is_written() {
    let (dataset, table) = files("plant_refused", "TIME,pull\n0,1\n0,2\n");
    let out = path(std::path::Path::new(&dataset).parent().unwrap()).to_owned();
    let done = cognate(&[
        "run",
        &dataset,
        "--end",
        "1",
        "--input",
        &table,
        "--out",
        &format!("{out}/none"),
    ]);
    assert_eq!(done.code, 3, "{}", done.err);
    for part in [
        "inputs.csv:1:1",
        "`pull` is no input",
        "inputs.csv:3:1",
        "0 follows 0",
    ] {
        assert!(done.err.contains(part), "{part}: {}", done.err);
    }
    assert!(!std::path::Path::new(&out).join("none").exists());
    // a command that drives what the table drives
    let inputs = scratch("plant_refused", "push.csv", "TIME,push\n0,1\n1,2\n");
    let commands = format!(
        "file/model={dataset}\nsim/dyn, end=1, steps=1\nvariable/7, function=8\nsim/dyn, end=2, steps=1\n"
    );
    let commands = scratch("plant_refused", "again.acf", &commands);
    let done = cognate(&["run", path(&commands), "--input", path(&inputs)]);
    assert!(
        done.code == 3 && done.err.contains("a command changes VARIABLE/7"),
        "{}",
        done.err
    );
    let done = cognate(&["run", &dataset, "--end", "1", "--input-hold"]);
    assert_eq!(done.code, 2, "{}", done.err);
    let done = cognate(&["run", &dataset, "--end", "1", "--input", "nowhere.csv"]);
    assert!(
        done.code == 3 && done.err.contains("cannot be opened"),
        "{}",
        done.err
    );
}

#[test]
fn a_sweep_and_a_linear_system_have_the_inputs_of_the_table() {
    let (dataset, table) = files("plant_sweep", "TIME,push,IN2\n0,1,3\n1,3,3\n");
    let out = format!("{dataset}.csv");
    let _ = std::fs::remove_file(&out);
    let measure = [
        "--measure",
        "last(PINVAL(1,1))",
        "--set",
        "PART/2.MASS=1,2",
        "--out",
        &out,
    ];
    let done = ok(&[
        &["sweep", &dataset, "--end", "0.5", "--input", &table][..],
        &measure,
    ]
    .concat());
    assert!(
        done.err.contains("push' and VARIABLE/8 follow"),
        "{}",
        done.err
    );
    let rows = cognate::results::read(out.as_ref()).unwrap();
    assert_eq!(rows.column("last(PINVAL(1,1))").unwrap(), [2.0, 2.0]);

    // a parameter that the table drives
    let both = cognate(&[
        "sweep",
        &dataset,
        "--end",
        "0.5",
        "--input",
        &table,
        "--measure",
        "last(PINVAL(1,1))",
        "--set",
        "VARIABLE/7=1,2",
        "--out",
        &out,
        "--overwrite",
    ]);
    assert!(
        both.code == 3 && both.err.contains("a parameter changes VARIABLE/7"),
        "{}",
        both.err
    );

    // the square of the second input has the slope of twice its value, over a mass of 2
    let b = |more: &[&str]| {
        let done = ok(&[&["linear", &dataset, "--static", "--json"][..], more].concat());
        let value: serde_json::Value = serde_json::from_str(&done.out).unwrap();
        let entry = |k: usize| value["B"][1][k].as_f64().unwrap();
        [entry(0), entry(1)]
    };
    assert_eq!(b(&[]), [0.5, 0.0]);
    assert_eq!(b(&["--input", &table]), [0.5, 3.0]);
}

#[test]
fn a_configuration_of_a_recorded_run_has_its_inputs() {
    let (dataset, table) = files("plant_configuration", "TIME,push\n0,1\n1,3\n");
    let out = path(std::path::Path::new(&dataset).parent().unwrap()).to_owned();
    let results = format!("{out}/held.res");
    let run = [
        "run",
        &dataset,
        "--end",
        "0.5",
        "--input",
        &table,
        "--input-hold",
        "--name",
        "held",
        "--out",
        &out,
    ];
    ok(&[&run[..], &["--format", "res,json", "--overwrite"]].concat());
    let record = std::fs::read_to_string(format!("{out}/held.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["inputs"]["file"], table.as_str());
    assert_eq!(record["inputs"]["held"], true);
    let later = format!("{out}/later.adm");
    ok(&[
        "configuration",
        &results,
        "--at",
        "0.5",
        "-o",
        &later,
        "--overwrite",
    ]);
    let later = Model::read(&later).unwrap();
    let results = cognate::results::read(results.as_ref()).unwrap();
    let end = *results.column("PART/2_XFORM.Z").unwrap().last().unwrap();
    assert!(
        (later.parts[&2].qg[2] - end).abs() < 1e-9,
        "{:?} {end}",
        later.parts[&2].qg
    );
}

#[test]
fn a_table_in_the_unit_of_time_of_the_model_moves_the_same_plant() {
    let of = |units: &str, damping: &str, table: &str, end: f64| {
        let text = PLANT.replace("PUSH", "0").replace("GAIN", "0");
        let text = text.replace("-2*VZ", &format!("-{damping}*VZ"));
        let units = format!("UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME={units}\n");
        let mut model = model(&(units + &text));
        disk::give("units.csv", table);
        drive_inputs(&mut model, Path::new("units.csv"), Between::Linear).unwrap();
        end_of(model, "AUTO", 1e-9, end)
    };
    let seconds = of("SECOND", "2", "TIME,push\nsec,N\n0,1\n0.5,7\n1,-3\n", 1.5);
    let table = "TIME,push\nmillisecond,N\n0,1\n500,7\n1000,-3\n";
    let milliseconds = of("MILLISECOND", "2000", table, 1500.0);
    let off = (seconds - milliseconds).abs() / seconds.abs();
    assert!(off < 1e-8, "{seconds} {milliseconds}");
}
