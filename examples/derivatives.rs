//! Derivatives: rates in time by jets, and how a value changes with each input by dual numbers.
//!
//! `cargo run --example derivatives`

use cognate::expr::Expr;
use cognate::expr::interpolation::Bindings;
use cognate::expr::program::Work;
use cognate::scalar::{Dual, Jet};

fn main() -> Result<(), cognate::Error> {
    // x, ẋ and ẍ of a motion at TIME = 2
    let cubic = Expr::parse("TIME**3")?.compile(&Bindings::default())?;
    let mut rates = [Jet::variable(0.0)];
    cubic.eval(&[Jet::variable(2.0)], &mut Work::default(), &mut rates);
    println!("{:?}", rates[0]);

    // ∂F/∂DM and ∂F/∂VR of a spring with a damper, in one run
    let spring = Expr::parse("-25*(DM(1,2) - 10) - 2*VR(1,2)")?.compile(&Bindings::default())?;
    let inputs = [
        Dual {
            re: 12.0,
            eps: [1.0, 0.0],
        },
        Dual {
            re: 0.5,
            eps: [0.0, 1.0],
        },
    ];
    let mut force = [inputs[0]];
    spring.eval(&inputs, &mut Work::default(), &mut force);
    println!("force {} slopes {:?}", force[0].re, force[0].eps);
    assert_eq!((force[0].re, force[0].eps), (-51.0, [-25.0, -2.0]));
    Ok(())
}
