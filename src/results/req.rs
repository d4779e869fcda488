//! `.req` files: the components of requests at every output, to six digits.
//!
//! Card: a line of identification, the title, a line with the number of requests, the code of the
//! units and the units of length per metre; per request a line with its number, its kind (1
//! displacement, 2 velocity, 3 acceleration, 4 force, 5 expressions) and its markers I, J and RM.
//! Then per output a line with the time, and per request one with components 2, 3, 4, 6, 7 and 8:
//! magnitudes follow from these. A component that is not asked for is 0. Head and times are those
//! of real files; these had no requests, so the lines of requests follow descriptions of the format
//! and have not been compared.

use super::format::TableText;
use super::gra::{NO_DATE, code_of_units, columns, put_line, units_of_code};
use super::{Component, Entity, Kind, Requested, Run, component_unit, malformed};
use super::{no_row, whole_lines};
use crate::diagnostic::Diagnostic;
use crate::model::ElementKind;
use std::ops::Range;

/// Places of the components that are written.
const WRITTEN: [usize; 6] = [1, 2, 3, 5, 6, 7];

/// Components of the kinds of requests: displacement, velocity, acceleration, force, expressions;
/// those of [`WRITTEN`], then the magnitudes. Names are those of a run's own columns.
const NAMES: [[&str; 8]; 5] = [
    ["DX", "DY", "DZ", "PSI", "THETA", "PHI", "MAG", ""],
    ["VX", "VY", "VZ", "WX", "WY", "WZ", "MAG", "AMAG"],
    [
        "ACCX", "ACCY", "ACCZ", "WDTX", "WDTY", "WDTZ", "MAG", "AMAG",
    ],
    ["FX", "FY", "FZ", "TX", "TY", "TZ", "MAG", "AMAG"],
    ["F2", "F3", "F4", "F6", "F7", "F8", "", ""],
];

/// Reads the components of requests; of a file that was cut up to its last whole output.
///
/// # Errors
/// When the contents are not of this format, with the line.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let (whole, mut is_cut) = whole_lines(bytes);
    let text = String::from_utf8_lossy(whole);
    let lines: Vec<&str> = text.lines().collect();
    let mut run = head(&lines).map_err(|d| no_row(d, lines.len()))?;
    let n = run.requests.len();
    run.begin(Kind::Dynamic);
    let mut at = 3 + n;
    while at < lines.len() {
        if lines[at].trim().is_empty() {
            at += 1;
            continue;
        }
        if lines.len() - at <= n {
            is_cut = true;
            break;
        }
        let row = row(&lines, at, &run.requests)?;
        run.push(&row);
        at += n + 1;
    }
    run.end();
    if is_cut {
        run.note_cut();
    }
    Ok(run)
}

/// Reads what stands before the first output; returns a run without rows.
fn head(lines: &[&str]) -> Result<Run, Diagnostic> {
    let &[identification, title, counts] = lines
        .first_chunk::<3>()
        .ok_or_else(|| malformed(0, "too short for a .req file"))?;
    if !identification.trim_start().starts_with("A.R") {
        let what = "a .req file begins with its version, such as `A.R3`";
        return Err(malformed(1, what));
    }
    let mut words = counts.split_whitespace();
    let n = words.next().and_then(|w| w.parse::<usize>().ok());
    let n = n.ok_or_else(|| malformed(3, "the number of requests should stand here"))?;
    if n > lines.len() - 3 {
        return Err(malformed(0, "fewer lines than requests"));
    }
    let units = units_of_code(words.next().unwrap_or_default());
    let mut run = Run::new("", title.trim(), units);
    for (line, number) in lines.iter().zip(1..).skip(3).take(n) {
        let request = request(line);
        let request = request.ok_or_else(|| {
            malformed(
                number,
                "number, kind and markers of a request should stand here",
            )
        })?;
        add_request(&mut run, request);
    }
    Ok(run)
}

/// Reads the line of a request: number, kind, markers.
fn request(line: &str) -> Option<Requested> {
    let words: Option<Vec<u32>> = line.split_whitespace().map(|w| w.parse().ok()).collect();
    let &[id, kind, i, j, rm] = words?.as_slice() else {
        return None;
    };
    (1..=5).contains(&kind).then_some(Requested {
        id,
        kind,
        markers: [i, j, rm],
        columns: [None; 8],
    })
}

/// Adds the columns of a request; those of displacements, velocities, accelerations and forces have
/// their magnitudes.
fn add_request(run: &mut Run, mut request: Requested) {
    let name = format!("{}_{}", ElementKind::Request, request.id);
    let names = NAMES[request.kind as usize - 1];
    let magnitudes = match request.kind {
        1 => &[0][..],
        5 => &[],
        _ => &[0, 4],
    };
    let own = WRITTEN
        .iter()
        .zip(names)
        .chain(magnitudes.iter().zip(&names[6..]).map(|(c, n)| (c, *n)));
    let mut components = Vec::new();
    let wanted: Vec<(usize, &str)> = own.map(|(&c, name)| (c, name)).collect();
    for (place, component) in wanted {
        // a magnitude has the unit of the components that it is made of
        let unit = match place {
            0 if request.kind != 5 => component_unit(names[0], &run.units),
            4 if request.kind != 5 => component_unit(names[3], &run.units),
            _ => component_unit(component, &run.units),
        };
        let column = run.add_column(format!("{name}.{component}"), unit);
        request.columns[place] = Some(column);
        components.push(Component {
            name: component.to_owned(),
            column,
        });
    }
    run.entities.push(Entity {
        entity: name.clone(),
        name,
        kind: "Request".into(),
        id: u64::from(request.id),
        components,
    });
    run.requests.push(request);
}

/// Reads the line with a time and those of its requests, from line `at` on.
fn row(lines: &[&str], at: usize, requests: &[Requested]) -> Result<Vec<f64>, Diagnostic> {
    let time = columns(lines[at]).filter(|n| n.len() == 1);
    let what = "a time should stand here, alone in its line";
    let mut row = time.ok_or_else(|| malformed(at + 1, what))?;
    for ((request, line), k) in requests.iter().zip(&lines[at + 1..]).zip(at + 1..) {
        let numbers = columns(line).and_then(|n| <[f64; 6]>::try_from(n).ok());
        let what = "six numbers, the components of a request, should stand here";
        let own = numbers.ok_or_else(|| malformed(k + 1, what))?;
        row.extend(own);
        let magnitude = |n: &[f64]| n.iter().map(|x| x * x).sum::<f64>().sqrt();
        match request.kind {
            1 => row.push(magnitude(&own[..3])),
            5 => {}
            _ => row.extend([magnitude(&own[..3]), magnitude(&own[3..])]),
        }
    }
    Ok(row)
}

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
            put_line([run.value(0, place)], text);
            for request in &run.requests {
                let value = |component: usize| {
                    let column = request.columns[component];
                    column.map_or(0.0, |column| run.value(column, place))
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
    fn what_is_written_is_read_with_its_magnitudes() {
        let mut run = Run::new("r", "a title", Units::default());
        let places = WRITTEN.map(|k| (k, run.add_column(format!("c{k}"), "")));
        let mut velocity = Requested {
            id: 4,
            kind: 2,
            markers: [20, 10, 0],
            ..Requested::default()
        };
        places
            .iter()
            .for_each(|&(k, column)| velocity.columns[k] = Some(column));
        run.requests.push(velocity);
        run.begin(Kind::Dynamic);
        run.push(&[0.0, 3.0, 0.0, 4.0, 0.0, -2.0, 0.0]);
        run.push(&[0.5, 1.0, 2.0, 2.0, 6.0, 2.0, 3.0]);
        run.end();
        let text = crate::results::format::text(&mut Components, &run);
        let again = read(text.as_bytes()).unwrap();
        assert_eq!(again.title, "a title");
        assert_eq!(again.requests[0].markers, [20, 10, 0]);
        assert_eq!(again.column("REQUEST_4.MAG"), Some(&[5.0, 3.0][..]));
        assert_eq!(again.column("REQUEST_4.AMAG"), Some(&[2.0, 7.0][..]));
        assert_eq!(
            again.columns[again.find("REQUEST_4.WX").unwrap()].unit,
            "rad/sec"
        );
        // cut off
        let short = text.trim_end().rsplit_once('\n').unwrap().0;
        assert_eq!(read(short.as_bytes()).unwrap().rows(), 1);
    }

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
