//! Many points at once: a program compiled once runs over columns of numbers.
//!
//! `cargo run --example batch`

use cognate::expr::Expr;
use cognate::expr::interpolation::Bindings;

fn main() -> Result<(), cognate::Error> {
    let program = Expr::parse("STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)")?;
    let mut batch = program.compile(&Bindings::default())?.batch();
    let times: Vec<f64> = (0..=1000).map(|k| k as f64 / 1000.0).collect();
    let mut values = vec![0.0; times.len()];
    batch.run(&[&times], &mut [&mut values])?;
    let largest = values.iter().copied().fold(f64::MIN, f64::max);
    println!("the largest of {} values is {largest:.3}", values.len());
    Ok(())
}
