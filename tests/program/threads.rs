//! Mechanisms that nothing couples on several threads: the same bytes in every file of results.

use super::command::{ok, path, scratch};
use std::fmt::Write as _;

#[test]
fn threads_change_no_byte_of_the_results_and_the_log_tells_of_mechanisms_apart() {
    let mut model = "balls\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\n\
                     ACCGRAV/KGRAV=-9.81\n"
        .to_string();
    for k in 1..=24 {
        let (p, m, height) = (10 + k, 100 + k, 0.2 + 0.3 * (0.618 * f64::from(k)).fract());
        write!(
            model,
            "PART/{p}, MASS=1, CM={m}, IP=1,1,1, QG={k},0,{height}\nMARKER/{m}, PART={p}\n\
             SFORCE/{k}, TRANSLATION, ACTIONONLY, I={m}, J=1, FUNCTION=IMPACT(DZ({m},1),VZ({m},1),0.1,1E5,1.5,20,1E-4)\n\
             REQUEST/{k}, DISPLACEMENT, I={m}, J=1\n"
        )
        .expect("text");
    }
    let model = scratch("threads", "balls.adm", &(model + "END\n"));
    let run = |threads: &str| {
        let out = model.with_file_name(format!("out{threads}"));
        let _ = std::fs::remove_dir_all(&out);
        let args = [
            "run",
            path(&model),
            "--end",
            "1",
            "--steps",
            "50",
            "--format",
            "csv,res,json",
        ];
        let more = ["--threads", threads, "--out", path(&out), "--quiet"];
        ok(&[&args[..], &more].concat());
        let read = |name| std::fs::read(out.join(name)).expect("results");
        let log = String::from_utf8(read("balls.msg")).expect("text");
        assert!(log.contains("24 mechanisms that nothing couples"), "{log}");
        [read("balls.csv"), read("balls.res")]
    };
    let one = run("1");
    for threads in ["2", "7"] {
        assert!(run(threads) == one, "{threads} threads");
    }
}
