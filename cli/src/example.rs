//! Examples of functions of the model: a call, and its value for markers that are written down
//! beside it.
//!
//! The value is computed from the markers by the code that answers expressions; where only a model
//! has a value, its meaning is said in words.

use super::card::Example;
use super::data::Data;
use cognate::expr::measures::{Family, Measure};
use cognate::expr::program::Input;
use cognate::expr::signature::Kind;
use cognate::model::ElementKind;

/// The markers of all examples: number and state, as a file for --markers has them.
const MARKERS: [(u32, &str); 4] = [
    (
        1,
        r#"{"r": [3, 4, 12], "v": [1, 2, -1], "w": [0.5, 0.25, 2], "a": [0, 0, 9], "al": [1, 0.5, 0.25], "e313": [0.5, 0.4, 0.3]}"#,
    ),
    (2, r#"{"r": [0, 0, 2], "w": [0, 0, 1]}"#),
    (3, r#"{"r": [1, 0, 0], "e313": [1.5, 0, 0]}"#),
    (4, r#"{"w": [0, 1, 0]}"#),
];

/// The element of a model that examples ask.
const ELEMENT: u32 = 7;

/// The markers as the text of a file for --markers.
pub fn markers() -> String {
    let list: Vec<String> = (MARKERS.iter())
        .map(|(id, state)| format!("\"{id}\": {state}"))
        .collect();
    format!("{{{}}}", list.join(",\n   "))
}

/// The example of a function of the model.
pub fn of_measure(measure: Measure) -> Example {
    let mut arguments = [0; 4];
    for (number, argument) in arguments.iter_mut().zip(measure.row().arguments) {
        *number = match (argument.name, argument.kind) {
            ("i" | "at", _) => 1,
            ("j", _) => 2,
            ("k", _) => 3,
            ("l", _) => 4,
            ("comp", _) if measure == Measure::Vtorq => 6,
            ("comp", _) => 2,
            ("system", _) => 6,
            ("component" | "n" | "index", _) => 1,
            (_, Kind::Identifier { zero: false, .. }) => ELEMENT,
            _ => 0,
        };
    }
    let count = measure.row().arguments.len();
    let list: Vec<String> = arguments[..count].iter().map(u32::to_string).collect();
    let input = Input::Measure(measure, arguments);
    Example {
        expression: format!("{}({})", measure.name(), list.join(", ")),
        value: data().value(input, 0.0),
        meaning: meaning(measure),
    }
}

fn data() -> Data {
    let mut data = Data::default();
    for (id, state) in MARKERS {
        // a test reads them all
        let _ = data.add_marker(id, state);
    }
    data
}

/// The value of an example in words.
fn meaning(measure: Measure) -> String {
    let element = (measure.row().arguments.first()).and_then(|a| match a.kind {
        Kind::Identifier { element, .. } => Some(element),
        _ => None,
    });
    let name = element.map_or(String::new(), |e| {
        ElementKind::from(e).id(ELEMENT).to_string()
    });
    match (measure.row().family, measure) {
        (Family::Displacement | Family::Velocity | Family::Acceleration, _) => {
            "MARKER/1 seen from MARKER/2".into()
        }
        (Family::GenericForce, _) => {
            "of all forces on MARKER/1 from elements between it and MARKER/2".into()
        }
        (Family::ElementForce, Measure::Friction) => format!("x of the force of {name}"),
        (Family::ElementForce, Measure::Nforce) => {
            format!("x of the force of {name} on MARKER/1, in the axes of ground")
        }
        (Family::ElementForce, Measure::Vtorq) => {
            format!("x of the torque of {name} on its I marker, in the axes of ground")
        }
        (Family::ElementForce, _) => {
            format!("x of the force of {name} on its I marker, in the axes of ground")
        }
        (Family::System, Measure::Aryval | Measure::Pinval | Measure::Pouval) => {
            format!("first entry of {name}")
        }
        (Family::System, Measure::Dif1) => format!("rate of {name}"),
        (Family::System, _) => format!("value of {name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_marker_function_has_a_value_for_the_markers_shown() {
        assert_eq!(data().markers.len(), MARKERS.len());
        for &measure in Measure::ALL {
            let example = of_measure(measure);
            let kinematic = matches!(
                measure.row().family,
                Family::Displacement | Family::Velocity | Family::Acceleration
            );
            assert_eq!(example.value.is_some(), kinematic, "{}", example.expression);
            assert_ne!(
                example.value,
                Some(0.0),
                "{} shows nothing",
                example.expression
            );
            let text = cognate::expr::Expr::parse(&example.expression);
            assert!(text.is_ok(), "{text:?}");
        }
    }

    #[test]
    fn values_are_those_of_the_geometry() {
        let value = |m| of_measure(m).value.unwrap();
        assert!((value(Measure::Dm) - 125.0_f64.sqrt()).abs() < 1e-14);
        // along the x axis of marker 3, which is turned by 1.5 about z
        let along = 3.0 * 1.5_f64.cos() + 4.0 * 1.5_f64.sin();
        assert!((value(Measure::Dx) - along).abs() < 1e-14);
        assert_eq!(value(Measure::Wz), 1.0);
    }
}
