//! `.res` files: every element's components at every output.
//!
//! Card of the XML form: `StepMap` lists entities and their components, each with a number. Each
//! `Step` of each `Data` block holds the values of all components in the order of their numbers,
//! whatever its line breaks. White space is free, attributes may be missing, and exponents may have
//! three digits. The writer puts components that belong to one element on one line, as other
//! programs do: scripts that split such lines at single blanks keep working. Nothing in a file
//! depends on the clock: same run, same bytes.
//!
//! The old text form is recognised by its first line.

mod read;
mod text;
mod write;

pub use read::read;
pub use write::{Steps, write};

/// The entity that holds columns which belong to no element.
const EXPRESSIONS: &str = "expressions";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Component, Entity, Kind, Run, Units, component_unit};

    /// Two parts in the order of solvers (all places, then all velocities), a request and an
    /// expression.
    fn example() -> Run {
        let mut run = Run::new(
            "four <bar>",
            "\"A&B\" model",
            Units {
                length: "mm".into(),
                ..Units::default()
            },
        );
        let mut parts = Vec::new();
        for part in ["PART_2", "PART_3"] {
            parts.push(Entity {
                name: format!("{part}_XFORM"),
                entity: part.into(),
                kind: "Part".into(),
                id: 2,
                components: vec![],
            });
        }
        for names in [["X", "Y"], ["VX", "VY"]] {
            for part in &mut parts {
                for name in names {
                    let column = run.add_column(
                        format!("{}.{name}", part.name),
                        component_unit(name, &run.units),
                    );
                    part.components.push(Component {
                        name: name.into(),
                        column,
                    });
                }
            }
        }
        let column = run.add_column("REQ.a<b", "");
        let components = vec![Component {
            name: "a<b".into(),
            column,
        }];
        parts.push(Entity {
            name: "REQ".into(),
            entity: "REQ".into(),
            kind: "Request".into(),
            id: 1,
            components,
        });
        run.entities = parts;
        run.add_column("DX(12,21)", "mm");
        for (kind, rows) in [(Kind::Input, 1), (Kind::Static, 1), (Kind::Dynamic, 2)] {
            run.begin(kind);
            for row in 0..rows {
                let values: Vec<f64> = (0..run.columns.len())
                    .map(|c| (c as f64 + 0.1) / 3.0 * f64::powi(-1e-3, row))
                    .collect();
                run.push(&values);
            }
            run.end();
        }
        run
    }

    #[test]
    fn what_is_written_reads_back() {
        let (run, back) = (example(), read(write(&example()).as_bytes()).unwrap());
        assert_eq!(run.columns, back.columns);
        assert_eq!(run.entities, back.entities);
        assert_eq!(
            (run.sequences, run.name, run.title, run.units),
            (back.sequences, back.name, back.title, back.units)
        );
    }

    #[test]
    fn values_go_by_the_numbers_of_components_not_by_their_place_in_the_map() {
        let text = "<Results><Analysis><StepMap><Entity name=\"P\"><Component name=\"Y\" id=\"3\"/><Component name=\"X\" id=\"2\"/></Entity>\
                    <Entity name=\"time\"><Component name=\"TIME\" id=\"1\"/></Entity></StepMap>\
                    <Data name=\"dynamic_001\"><Step type=\"dynamic\">0.5 \n 2.5E-001\t-3</Step></Data></Analysis></Results>";
        let run = read(text.as_bytes()).unwrap();
        assert_eq!(
            (run.column("time"), run.column("P.X"), run.column("P.Y")),
            (Some(&[0.5][..]), Some(&[0.25][..]), Some(&[-3.0][..]))
        );
        assert_eq!(run.sequences[0].kind, Kind::Dynamic);
    }

    #[test]
    fn components_left_out_of_the_map_leave_their_values_behind() {
        let text = "<Results><Analysis><StepMap><Entity name=\"time\"><Component name=\"TIME\" id=\"1\"/></Entity>\
                    <Entity name=\"P\"><Component name=\"X\" id=\"4\"/></Entity></StepMap>\
                    <Data name=\"dynamic_001\"><Step type=\"dynamic\">0 1 2 3</Step></Data></Analysis></Results>";
        assert_eq!(
            read(text.as_bytes()).unwrap().column("P.X"),
            Some(&[3.0][..])
        );
    }

    #[test]
    fn steps_have_the_shape_that_scripts_split_at_blanks() {
        let text = write(&example());
        let step: Vec<&str> = text
            .split("<Step type=\"static\">\n")
            .nth(1)
            .unwrap()
            .split("</Step>")
            .next()
            .unwrap()
            .lines()
            .collect();
        assert_eq!(
            step.len(),
            1 + 2 + 2 + 1 + 1,
            "time, places, velocities, request, expression"
        );
        assert!(step.iter().all(|l| l.trim() == *l && !l.contains("  ")));
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        let good = write(&example());
        let line_of =
            |from: &str, to: &str| read(good.replacen(from, to, 1).as_bytes()).map_err(|d| d.line);
        let line = |what: &str| 1 + good[..good.find(what).unwrap()].matches('\n').count();
        assert_eq!(line_of("</StepMap>", "</Step>"), Err(line("</StepMap>")));
        assert_eq!(line_of("id=\"3\"", "id=\"2\""), Err(line("</StepMap>")));
        assert_eq!(line_of("id=\"3\"", ""), Err(line("id=\"3\"")));
        assert!(matches!(line_of("</Step>", "1 2</Step>"), Err(n) if n >= line("</Step>")));
        assert!(line_of("</Step>", "&lt;</Step>").is_err());
        assert!(read(b"").is_err() && read(b"<Results/>").is_err() && read(b"\xff\xfe<<").is_err());
    }

    #[test]
    fn a_cut_file_is_never_a_panic() {
        let text = write(&example());
        for cut in 0..text.len() {
            let _ = read(&text.as_bytes()[..cut]);
        }
    }
}
