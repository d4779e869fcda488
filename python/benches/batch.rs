//! The Rust figures that `batch.py` compares with: time of batches of one expression, in ns a
//! point, least of many runs, by number of points.

use cognate::expr::Expr;
use cognate::expr::interpolation::Bindings;
use std::time::Instant;

fn main() -> Result<(), cognate::Error> {
    for text in std::env::args().skip(1).filter(|a| a != "--bench") {
        let program = Expr::parse(&text)?.compile(&Bindings::default())?;
        let mut batch = program.batch();
        for n in [1_000, 10_000, 100_000, 1_000_000] {
            let times: Vec<f64> = (0..n).map(|k| f64::from(k) / f64::from(n)).collect();
            let mut least = f64::INFINITY;
            for _ in 0..(30_000_000 / n).clamp(20, 2000) {
                let begun = Instant::now();
                // an array of results each time, as Python makes one
                let mut out = vec![0.0; times.len()];
                batch.run(&[&times], &mut [&mut out])?;
                std::hint::black_box(&out);
                least = least.min(begun.elapsed().as_secs_f64());
            }
            println!("{n} {}", 1e9 * least / f64::from(n));
        }
    }
    Ok(())
}
