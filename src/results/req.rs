//! Writing `.req` files: the components of requests at every output, to six digits.
//!
//! Card: a line of identification, the title, a line with the number of requests, the code of the
//! units and the units of length per metre; per request a line with its number, its kind (1
//! displacement, 2 velocity, 3 acceleration, 4 force, 5 expressions) and its markers I, J and RM.
//! Then per output a line with the time, and per request one with components 2, 3, 4, 6, 7 and 8:
//! magnitudes follow from these. A component that is not asked for is 0. Head and times are those
//! of real files; these had no requests, so the lines of requests follow descriptions of the format
//! and have not been compared.

use super::Run;
use super::format::TableText;
use super::gra::{NO_DATE, code_of_units, put_line};
use std::ops::Range;

/// Places of the components that are written.
const WRITTEN: [usize; 6] = [1, 2, 3, 5, 6, 7];

/// A `.req` file that is being written.
#[derive(Debug, Default)]
pub struct Components;

impl TableText for Components {
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>) {
        let mut head = format!(" A.R3    {NO_DATE}               0         0  3D\n");
        let (n, code) = (run.requests.len(), code_of_units(&run.units));
        head += &format!("{:<80}\n{n:>5}     {code}\n", run.title);
        for request in &run.requests {
            let [i, j, rm] = request.markers;
            let (id, kind) = (request.id, request.kind);
            head += &format!("{id:>11}{kind:>10}{i:>11}{j:>11}{rm:>11}\n");
        }
        text.extend_from_slice(head.as_bytes());
    }

    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>) {
        for row in rows {
            let place = row - run.released;
            put_line([run.columns[0].values[place]], text);
            for request in &run.requests {
                let value = |component: usize| {
                    let column = request.columns[component];
                    column.map_or(0.0, |column| run.columns[column].values[place])
                };
                put_line(WRITTEN.map(value), text);
            }
        }
    }

    fn end(&mut self, _: &Run, _: &mut Vec<u8>) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Requested, Units};

    #[test]
    fn each_output_has_its_time_and_six_numbers_a_request() {
        let mut run = Run::new("r", "a title", Units::default());
        let column = run.add_column("F2", "");
        run.requests.push(Requested {
            id: 7,
            kind: 5,
            columns: [None, Some(column), None, None, None, None, None, None],
            ..Requested::default()
        });
        run.begin(Kind::Dynamic);
        run.push(&[0.25, -3.5]);
        run.end();
        let text = crate::results::format::text(&mut Components, &run);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[2], "    1     M_KGS_N_RACA 1.000000000000000E+00");
        assert!(lines[3].starts_with("          7         5"), "{text}");
        assert_eq!(lines[4], "   2.50000E-01");
        assert!(
            lines[5].starts_with("  -3.50000E+00  0.00000E+00"),
            "{text}"
        );
        assert_eq!(lines.len(), 6);
    }
}
