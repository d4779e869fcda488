//! One model many times: a number changes from run to run, and nothing is compiled again.
//!
//! `cargo run --example many_runs`

use cognate::model::Formula;
use cognate::{Analysis, ModelBuilder, Options};

fn main() -> Result<(), cognate::Error> {
    let model = ModelBuilder::new("a mass on a spring");
    let ground = model.ground();
    let mass = model
        .part("mass")
        .mass(2.0)
        .inertia([1.0; 3])
        .center([0.0; 3]);
    let (i, j) = (mass.at([0.0; 3]), ground.at([0.0; 3]));
    model.translational("guide", &i, &j);
    let stiffness = model.variable("stiffness", "100");
    let spring = model.force("spring", &mass.at([0.0, 0.0, 1.0]), &j);
    spring.function(&format!("-VARVAL({stiffness})*DZ({i},{j})+1"));

    let options = Options {
        keep_start: true,
        ..Options::default()
    };
    let mut session = model.session(options)?;
    let (way, number) = (format!("DZ({i},{j})"), stiffness.number());
    session.add_column(&way)?;
    session.will_change([number]);
    for k in [100.0, 200.0, 400.0] {
        session.reset();
        session.model.variables.entry(number).or_default().function = Formula::text(k.to_string());
        session.run_to(Analysis::Dynamic, 2.0, 200)?;
        let way = session.run.column(&way).unwrap_or_default();
        let largest = way.iter().copied().fold(0.0, f64::max);
        println!("stiffness {k}: the largest displacement is {largest:.6}");
    }
    Ok(())
}
