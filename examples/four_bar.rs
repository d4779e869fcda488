//! A four-bar made by a program, which a closure drives.
//!
//! `cargo run --example four_bar`

use cognate::{Analysis, ModelBuilder, Options};

fn main() -> Result<(), cognate::Error> {
    let model = ModelBuilder::new("four-bar");
    model.units("MKS").gravity([0.0, -9.81, 0.0]);
    let ground = model.ground();
    let joints = [
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [3.0, 2.0, 0.0],
        [3.0, 0.0, 0.0],
    ];
    let bar = |name: &str, from: [f64; 3], to: [f64; 3]| {
        let middle = [0, 1, 2].map(|k| 0.5 * (from[k] + to[k]));
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let moment = length.powi(3) / 12.0;
        model
            .part(name)
            .mass(length)
            .inertia([moment; 3])
            .center(middle)
    };
    let crank = bar("crank", joints[0], joints[1]);
    let coupler = bar("coupler", joints[1], joints[2]);
    let rocker = bar("rocker", joints[2], joints[3]);

    let pivot = crank.at(joints[0]);
    model.revolute("a", &pivot, &ground);
    model.revolute("b", &crank.at(joints[1]), &coupler);
    model.revolute("c", &coupler.at(joints[2]), &rocker);
    model.revolute("d", &rocker.at(joints[3]), &ground);

    let motor = model.torque("motor", &pivot, &ground);
    motor.law([format!("WZ({pivot})")], |_time, [speed]| {
        50.0 * (2.0 - speed)
    });

    let mut session = model.session(Options::default())?;
    let speed = format!("WZ({pivot})");
    session.add_column(&speed)?;
    session.run_to(Analysis::Dynamic, 5.0, 100)?;
    let speeds = session.run.column(&speed).unwrap_or_default();
    println!("the crank turns with {:.3} rad/s after 5 s", speeds[100]);
    print!("{}", session.model.to_text());
    Ok(())
}
