//! Which function of the model has no value where a simulation cannot go on: the operation, with its numbers.
//!
//! A step that fails is shortened until it ends just before the place where the function loses its value. So all functions are asked
//! there and a little later, along the rates that were found there.

use crate::expr::Expr;
use crate::expr::program::{Input, Work};
use crate::scene::Scene;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;

/// How much later, as parts of the time that the clock shows, or of a unit of it.
const LATER: [f64; 6] = [0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3];

/// "SFORCE/1 FUNCTION: SQRT of -0.01 has no value", for the numbers of the last state; `None`: all functions have values.
pub fn named(scene: &Scene, numbers: &[f64]) -> Option<String> {
    let rates = Equations::new(scene, numbers).rates();
    let unit = numbers[Layout::TIME].abs().max(1.0);
    LATER.iter().find_map(|later| {
        let dt = later * unit;
        let mut then = numbers.to_vec();
        then[Layout::TIME] += dt;
        for (y, rate) in then[scene.layout.y()].iter_mut().zip(&rates) {
            *y += if rate.is_finite() { rate * dt } else { 0.0 };
        }
        there(scene, &then)
    })
}

fn there(scene: &Scene, numbers: &[f64]) -> Option<String> {
    let at = Equations::new(scene, numbers);
    scene.formulas.iter().find_map(|f| {
        let inputs = f.program.inputs();
        if inputs
            .iter()
            .any(|i| matches!(i, Input::Delayed(_) | Input::Slot(_)))
        {
            return None;
        }
        let values: Vec<f64> = inputs.iter().map(|&i| at.input(i, &f.name)).collect();
        // what it reads has no value: that is the one to blame
        if !values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut out = [0.0];
        f.program.eval(&values, &mut Work::default(), &mut out);
        if out[0].is_finite() {
            return None;
        }
        let host = |input: Input| {
            let k = inputs.iter().position(|&i| i == input)?;
            Some(values[k])
        };
        let said = Expr::parse(&f.text)
            .ok()
            .and_then(|e| e.eval_with(&host).err());
        Some(match said {
            Some(d) if d.code == "domain" => format!("{}: {}", f.name, d.message),
            _ => format!("{} has no finite value", f.name),
        })
    })
}
