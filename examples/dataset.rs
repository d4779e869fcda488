//! A dataset: read, checked, run, and its results by the names of columns.
//!
//! `cargo run --example dataset`

use cognate::{Analysis, Model, Options, Session};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::read("examples/slider_crank.adm")?;
    for doubt in model.doubts() {
        println!("{doubt}");
    }
    let mut session = Session::new(model, "crank", Options::default());
    session.add_column("DX(41,22)")?;
    let status = session.run_to(Analysis::Dynamic, 2.0, 400)?;
    let x = session.run.column("DX(41,22)").ok_or("no such column")?;
    let unit = &session.run.units.length;
    println!(
        "{status:?}: from {:.3} {unit} to {:.3} {unit}",
        x[0], x[400]
    );
    Ok(())
}
