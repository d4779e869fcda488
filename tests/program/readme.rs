//! What the README says in Rust compiles and does what it says.

use std::fmt::Debug;

/// Whatever went wrong, in words.
struct Wrong(String);

impl<E: Debug> From<E> for Wrong {
    fn from(e: E) -> Self {
        Wrong(format!("{e:?}"))
    }
}

#[rustfmt::skip]
fn an_expression() -> Result<f64, Wrong> {
use cognate::expr::Expr;

let f = Expr::parse("STEP5(TIME, 0, 0, 1, 10) * SIN(2*PI*TIME)")?;
let y = f.eval(&[("TIME", 0.25)])?;
    Ok(y)
}

#[rustfmt::skip]
fn a_model() -> Result<Vec<f64>, Wrong> {
use cognate::analysis::{session::{Analysis, Options, Session}, watch::Unwatched};

let model = cognate::model::Model::read("examples/slider_crank.adm")?;
let mut session = Session::new(model, "crank", Options { columns: vec!["DX(41,22)".into()], ..Options::default() });
session.simulate(Analysis::Dynamic, 2.0, 400, &mut Unwatched)?;
let x = session.run.column("DX(41,22)");
    Ok(x.ok_or("no such column")?.to_vec())
}

#[test]
fn the_lines_of_the_readme_are_those_that_are_run_here() {
    let (readme, here) = (include_str!("../../README.md"), include_str!("readme.rs"));
    let mut blocks = 0;
    for block in readme.split("```rust\n").skip(1) {
        blocks += 1;
        for line in block.split("```").next().unwrap_or("").lines() {
            assert!(here.lines().any(|l| l == line), "{line}");
        }
    }
    assert_eq!(blocks, 2);
}

#[test]
fn an_expression_is_three_lines() {
    let y = an_expression().unwrap_or_else(|e| panic!("{}", e.0));
    // STEP5 a quarter of the way, times the sine of a right angle
    let s: f64 = 0.25;
    let step = 10.0 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    approx::assert_relative_eq!(y, step, max_relative = 1e-14);
}

#[test]
fn a_model_is_read_solved_and_looked_at() {
    let x = a_model().unwrap_or_else(|e| panic!("{}", e.0));
    // the start and 400 steps; from the crank pin to the slider along x: what the rod of 150 allows
    assert_eq!(x.len(), 401);
    assert!(x.iter().all(|x| x.abs() <= 150.0 + 1e-6) && x[0] != x[400]);
}
