//! Readers that other people wrote read what we write. (`written.rs` has pandas for Parquet, `animation.rs` the validator of glTF.)
//!
//! `COGNATE_PYTHON` names a Python that has their packages; without it `python3` is asked.

use super::command::{cognate, path, scratch};
use super::needs;
use crate::repository::root;
use std::process::Command;

/// What adamspy says of a file of results and a log: rows, the last value, whether the run has finished, whether the log has errors.
const ADAMSPY: &str = "\
import sys
from adamspy.postprocess import xml, msg
results = xml.get_results(sys.argv[1])
print(len(results['time']), repr(results['time'][-1]), repr(results['slider']['VX'][-1]), sorted(results['crank']))
print(msg.check_if_finished(sys.argv[2]), msg.check_for_errors(sys.argv[2]), len(msg.get_runtime_summary(sys.argv[2])))
";

#[test]
fn adamspy_reads_results_and_log() {
    let python = std::env::var("COGNATE_PYTHON").unwrap_or_else(|_| "python3".into());
    let has_adamspy = ["-c", "from adamspy.postprocess import xml, msg"];
    if !needs::runs("adamspy", &python, &has_adamspy) {
        return;
    }
    let script = scratch("adamspy", "read.py", ADAMSPY);
    let out = script.with_file_name("out");
    let model = root("examples/slider_crank.acf");
    let run = [
        "run",
        path(&model),
        "--out",
        path(&out),
        "--format",
        "res,csv",
        "--quiet",
    ];
    let done = cognate(&run);
    assert_eq!(done.code, 0, "{}", done.err);
    let [res, log] = ["slider_crank.res", "slider_crank.msg"].map(|name| out.join(name));
    let output = Command::new(&python)
        .args([&script, &res, &log])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let why = String::from_utf8_lossy(&output.stderr);
    let table = std::fs::read_to_string(out.join("slider_crank.csv")).unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = table.lines().last().unwrap().split(',').collect();
    let column = names.iter().position(|name| *name == "slider.VX").unwrap();
    // it reads dynamic simulations alone: the second, of 200 rows
    let expected = format!(
        "200 2.0 {} ['AZ', 'TORQUE', 'WZ']\nTrue False 3\n",
        last[column]
    );
    assert_eq!(said, expected, "{why}");
}
