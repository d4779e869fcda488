//! Rows as they come: another thread reads the results while the simulation goes on.
//!
//! `cargo run --example stream`

use cognate::{Analysis, Model, Options, Session};
use std::sync::mpsc::channel;

fn main() -> Result<(), cognate::Error> {
    let model = Model::read("examples/slider_crank.adm")?;
    let mut session = Session::new(model, "crank", Options::default());
    session.add_column("DX(41,22)")?;
    let column = session.run.find("DX(41,22)").unwrap_or_default();
    let (sender, rows) = channel();
    session.stream(move |row| {
        // a reader that has gone wants no more rows
        let _ = sender.send((row[0], row[column]));
    });
    let reader = std::thread::spawn(move || {
        let (mut count, mut largest) = (0, f64::MIN);
        for (_time, x) in rows {
            (count, largest) = (count + 1, x.max(largest));
        }
        println!("{count} rows, the largest value {largest:.3}");
    });
    session.run_to(Analysis::Dynamic, 2.0, 400)?;
    drop(session); // ends the channel
    reader.join().unwrap_or_default();
    Ok(())
}
