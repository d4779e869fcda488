//! What a table of results costs to write and to read, beside a plain copy of its numbers to a file.
//!
//! 200 000 rows of 61 columns: sums of sines, as mechanisms yield them, whose digits are as many as those of any number. Each format
//! writes the whole run as `cognate run` does; the copy writes the 98 MB of the numbers as they are in memory. Medians of runs that
//! alternate; the last column is what one number takes.
//!
//! `cargo bench --bench writing`, or `cargo bench --bench writing -- 20000` with another number of rows.

use cognate::results::format::{FORMATS, Style};
use cognate::results::{Kind, Run, Units};
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

const ROWS: usize = 200_000;
const COLUMNS: usize = 61;
const REPEATS: usize = 3;

fn example(rows: usize) -> Run {
    let mut run = Run::new("bench", "sines", Units::default());
    for c in 1..COLUMNS {
        run.add_column(format!("REQUEST_{c}.X"), "mm");
    }
    run.begin(Kind::Dynamic);
    let mut row = [0.0; COLUMNS];
    for k in 0..rows {
        let t = 1e-3 * k as f64;
        for (c, x) in row.iter_mut().enumerate() {
            let w = c as f64;
            *x = if c == 0 {
                t
            } else {
                w.sqrt() * (w * t).sin() + 0.3 * (7.1 * t).cos()
            };
        }
        run.push(&row);
    }
    run.end();
    run
}

/// Writes the numbers as they are in memory; returns the bytes.
fn copy(run: &Run, place: &Path) -> u64 {
    let mut file = File::create(place).expect("a file");
    let mut bytes = 0;
    for column in &run.columns {
        let own: Vec<u8> = column.values.iter().flat_map(|x| x.to_ne_bytes()).collect();
        file.write_all(&own).expect("the copy");
        bytes += own.len() as u64;
    }
    bytes
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

fn main() {
    let asked = std::env::args().skip(1).find_map(|a| a.parse().ok());
    let run = example(asked.unwrap_or(ROWS));
    let numbers = (run.rows() * run.columns.len()) as f64;
    let dir = std::env::temp_dir().join(format!("cognate-writing-{}", std::process::id()));
    std::fs::create_dir_all(&dir).expect("a folder");
    let written: Vec<_> = FORMATS.iter().filter(|row| row.sink.is_some()).collect();
    let mut copies = Vec::new();
    let mut times = vec![(Vec::new(), Vec::new(), 0); written.len()];
    let mut copied = 0;
    for _ in 0..REPEATS {
        let clock = Instant::now();
        copied = copy(&run, &dir.join("copy"));
        copies.push(clock.elapsed().as_secs_f64());
        for (row, (write, read, bytes)) in written.iter().zip(&mut times) {
            let place = dir.join(format!("table.{}", row.name));
            let Some(new) = row.sink else { continue };
            let clock = Instant::now();
            let mut sink = new(Style::default(), &place);
            sink.rows(&run, run.held()).expect("rows");
            let finished = sink.finish(&run).expect("a file");
            write.push(clock.elapsed().as_secs_f64());
            *bytes = finished.bytes;
            if let Some(reader) = row.read {
                let clock = Instant::now();
                let contents = std::fs::read(&finished.part).expect("the file");
                let back = reader(&contents).expect("the table");
                read.push(clock.elapsed().as_secs_f64());
                // a `.gra` file of a run that has no model as it was read makes one of its first row
                assert_eq!(back.table_rows().count(), run.table_rows().count());
            }
            std::fs::remove_file(finished.part).expect("the file");
        }
    }
    let copy = median(copies);
    println!(
        "{} rows × {COLUMNS} columns; a copy: {copy:.3} s, {} MB",
        run.rows(),
        copied >> 20
    );
    println!("format     write s  / copy    read s  / copy      MB   ns/number written");
    for (row, (write, read, bytes)) in written.iter().zip(times) {
        let w = median(write);
        let read = match read.is_empty() {
            true => format!("{:>9} {:>7}", "-", "-"),
            false => {
                let r = median(read);
                format!("{r:>9.3} {:>7.1}", r / copy)
            }
        };
        let per_number = 1e9 * w / numbers;
        println!(
            "{:8} {w:>9.3} {:>7.1} {read} {:>7} {per_number:>9.1}",
            row.name,
            w / copy,
            bytes >> 20
        );
    }
    std::fs::remove_dir_all(dir).expect("the folder");
}
