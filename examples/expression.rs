//! An expression: its value, its inputs, its mistakes.
//!
//! `cargo run --example expression`

use cognate::expr::Expr;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let spring = Expr::parse("-25*(DM(10,20) - 10) - 2*VR(10,20)")?;
    for input in spring.inputs() {
        println!("reads {input}");
    }
    let force = spring.eval(&[("DM(10,20)", 12.0), ("VR(10,20)", 0.5)])?;
    println!("force {force}");

    // a mistake has a code, a place and advice
    let error = Expr::parse("2*STPE(TIME, 1, 0, 2, 1)").expect_err("a misspelt name");
    println!("{error}");
    assert_eq!((error.code(), error.first().column), ("unknown_name", 3));
    Ok(())
}
