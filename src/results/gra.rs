//! `.gra` files: the place of every part at every output, to six digits.
//!
//! Card, decoded from real files: a line of identification, the title, a line of counts (parts,
//! markers, graphics, –, joints, …); one line per part (ground first), per joint one line, per
//! marker two lines, then graphics. Then come frames. A frame begins with a line that holds one
//! number, its time, and has one line of six numbers per part other than ground (x y z of the
//! part's frame in ground, 3-1-3 angles in radians), followed by lines for force arrows, which are
//! skipped. The first frame, time −999999, is the model as it was read. A time of −555555 marks a
//! static equilibrium, which has no time of its own. Numbers stand in columns of 13 characters
//! after one blank, and may touch.

use super::format::TableText;
use super::number::{exponential, push_column};
use super::{Component, Entity, Kind, Run, Units, component_unit, malformed, number};
use super::{no_row, whole_lines};
use crate::diagnostic::Diagnostic;
use std::ops::Range;

const COMPONENTS: [&str; 6] = ["X", "Y", "Z", "PSI", "THETA", "PHI"];
const INPUT: f64 = -9.99999e5;
const STATIC: f64 = -5.55555e5;

/// Reads the trajectories of a `.gra` file; of one that was cut up to its last whole frame.
///
/// # Errors
/// When the contents are not of this format, with the line.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let (whole, mut is_cut) = whole_lines(bytes);
    let text = String::from_utf8_lossy(whole);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let lines: Vec<&str> = text.lines().collect();
    let (mut run, first) = head(&lines).map_err(|d| no_row(d, lines.len()))?;
    is_cut |= frames(&mut run, &lines, first)?;
    if is_cut && run.rows() == 0 {
        return Err(no_row(malformed(0, "no frame is whole"), lines.len()));
    }
    if is_cut {
        run.note_cut();
    }
    Ok(run)
}

/// Reads what stands before the first frame; returns a run without rows, and the place of the first
/// frame among the lines.
fn head(lines: &[&str]) -> Result<(Run, usize), Diagnostic> {
    let &[identification, title, counts] = lines
        .first_chunk::<3>()
        .ok_or_else(|| malformed(0, "too short for a .gra file"))?;
    if !identification.trim_start().starts_with("A.G") {
        return Err(malformed(
            1,
            "a .gra file begins with its version, such as `A.G8`",
        ));
    }
    let n_parts = (counts
        .split_whitespace()
        .next()
        .and_then(|w| w.parse::<usize>().ok()))
    .filter(|&n| n >= 1)
    .ok_or_else(|| malformed(3, "the number of parts should stand here"))?;
    if n_parts >= lines.len() {
        return Err(malformed(0, "fewer lines than parts"));
    }
    let mut run = Run::new("", title.trim(), units(identification));
    for (line, number) in lines.iter().zip(1..).skip(4).take(n_parts - 1) {
        let id = line
            .split_whitespace()
            .next()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| malformed(number, "a part's number should stand here"))?;
        add_part(&mut run, id);
    }
    let first = (lines
        .iter()
        .position(|line| lone_number(line) == Some(INPUT)))
    .ok_or_else(|| {
        malformed(
            0,
            "no frame with the model as it was read (time -9.99999E+05)",
        )
    })?;
    Ok((run, first))
}

/// Adds the columns of a part to the run.
fn add_part(run: &mut Run, id: u64) {
    let entity = format!("PART_{id}");
    let name = format!("{entity}_XFORM");
    let mut components = Vec::new();
    for component in COMPONENTS {
        let column = run.add_column(
            format!("{name}.{component}"),
            component_unit(component, &run.units),
        );
        components.push(Component {
            name: component.into(),
            column,
        });
    }
    run.entities.push(Entity {
        name,
        entity,
        kind: "Part".into(),
        id,
        components,
    });
}

/// Reads all frames from the line of the first on; returns whether the last one is not whole, which
/// is left out.
fn frames(run: &mut Run, lines: &[&str], first: usize) -> Result<bool, Diagnostic> {
    let n_parts = run.entities.len();
    let (mut at, mut last_time, mut kind) = (first, 0.0, None);
    let mut row = Vec::with_capacity(run.columns.len());
    while at < lines.len() {
        let Some(mark) = lone_number(lines[at]) else {
            at += 1; // force arrows, blank lines
            continue;
        };
        let now = match mark {
            INPUT => Kind::Input,
            STATIC => Kind::Static,
            _ => Kind::Dynamic,
        };
        last_time = if now == Kind::Dynamic {
            mark
        } else {
            last_time
        };
        row.clear();
        row.push(last_time);
        for part in 1..=n_parts {
            let Some(line) = lines.get(at + part) else {
                run.end();
                return Ok(true);
            };
            let numbers = columns(line).filter(|n| n.len() == COMPONENTS.len());
            row.extend(numbers.ok_or_else(|| {
                malformed(
                    at + part + 1,
                    "six numbers, the place of a part, should stand here",
                )
            })?);
        }
        if kind != Some(now) {
            run.end();
            run.begin(now);
            kind = Some(now);
        }
        run.push(&row);
        at += n_parts + 1;
    }
    run.end();
    Ok(false)
}

/// Reads the number of a line that holds nothing else.
fn lone_number(line: &str) -> Option<f64> {
    let text = line.trim();
    if text.len() <= 13 { number(text) } else { None }
}

/// Reads the numbers of a line of one blank and columns 13 wide.
pub(super) fn columns(line: &str) -> Option<Vec<f64>> {
    let line = line.trim_end();
    let cells = line
        .as_bytes()
        .get(1..)
        .filter(|_| line.is_ascii() && line.starts_with(' '))?;
    cells
        .chunks(13)
        .map(|cell| {
            std::str::from_utf8(cell)
                .ok()
                .and_then(|cell| number(cell.trim()))
        })
        .collect()
}

/// Reads the units from the code in the first line, such as `MMKGS_N_RACA`: length, mass, time,
/// force and angle in two characters each.
fn units(identification: &str) -> Units {
    let code = identification
        .split_whitespace()
        .rev()
        .nth(1)
        .unwrap_or_default();
    units_of_code(code)
}

/// Lengths: two characters of the code, unit, units per metre.
const LENGTHS: [(&str, &str, f64); 7] = [
    ("M_", "meter", 1.0),
    ("MM", "mm", 1e3),
    ("CM", "cm", 1e2),
    ("KM", "km", 1e-3),
    ("IN", "inch", 1e3 / 25.4),
    ("FT", "foot", 1e3 / 304.8),
    ("MI", "mile", 1.0 / 1609.344),
];
const MASSES: [(&str, &str); 5] = [
    ("KG", "kg"),
    ("G_", "gram"),
    ("LB", "pound_mass"),
    ("SL", "slug"),
    ("OZ", "ounce_mass"),
];
const TIMES: [(&str, &str); 4] = [
    ("S_", "sec"),
    ("MS", "millisec"),
    ("MI", "min"),
    ("HR", "hour"),
];
const FORCES: [(&str, &str); 5] = [
    ("N_", "newton"),
    ("KN", "knewton"),
    ("PF", "pound_force"),
    ("DY", "dyne"),
    ("KF", "kg_force"),
];
const ANGLES: [(&str, &str); 2] = [("RA", "rad"), ("DE", "deg")];

/// Returns the units of a code such as `M_KGS_N_RACA`; letters that are not known mean SI.
pub(super) fn units_of_code(code: &str) -> Units {
    let name = |at: usize, names: &[(&str, &str)]| {
        let short = code.get(at..at + 2).unwrap_or_default();
        let found = names.iter().find(|n| n.0 == short);
        found.or(names.first()).map_or("", |n| n.1).to_string()
    };
    Units {
        length: name(0, &LENGTHS.map(|(code, unit, _)| (code, unit))),
        mass: name(2, &MASSES),
        time: name(4, &TIMES),
        force: name(6, &FORCES),
        angle: name(8, &ANGLES),
    }
}

/// Returns the code of units and the units of length per metre, as the first lines of `.gra` and
/// `.req` files have them; `??` and 1 stand for a unit that has no code.
pub(super) fn code_of_units(units: &Units) -> String {
    let code = |unit: &str, names: &[(&'static str, &str)]| {
        let found = names.iter().find(|n| n.1 == unit);
        found.map_or("??", |n| n.0)
    };
    let per_metre = LENGTHS.iter().find(|l| l.1 == units.length);
    let per_metre = per_metre.map_or(1.0, |l| l.2);
    format!(
        "{}{}{}{}{}CA {}",
        code(&units.length, &LENGTHS.map(|(code, unit, _)| (code, unit))),
        code(&units.mass, &MASSES),
        code(&units.time, &TIMES),
        code(&units.force, &FORCES),
        code(&units.angle, &ANGLES),
        exponential(per_metre, 15)
    )
}

/// Appends numbers in columns of 13 characters after one blank, as a line.
pub(super) fn put_line(values: impl IntoIterator<Item = f64>, text: &mut Vec<u8>) {
    text.push(b' ');
    for x in values {
        let x = if x.is_finite() { x } else { 0.0 };
        push_column(x, text);
    }
    text.push(b'\n');
}

/// The date in files that have a place for one: the same run is the same file on every day.
pub(super) const NO_DATE: &str = "1970-01-01 00:00:00";

/// A `.gra` file that is being written: the frames of all parts, without markers and graphics.
#[derive(Debug, Default)]
pub struct Frames {
    /// per part: the columns of its six coordinates
    parts: Vec<[usize; 6]>,
}

impl Frames {
    fn frame(&self, run: &Run, time: f64, place: usize, text: &mut Vec<u8>) {
        put_line([time], text);
        for part in &self.parts {
            put_line(part.map(|column| run.value(column, place)), text);
        }
    }
}

impl TableText for Frames {
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>) {
        let mut ids = vec![1];
        for part in run.entities.iter().filter(|e| e.kind == "Part") {
            let column = |name: &str| part.components.iter().find(|c| c.name == name);
            let found = COMPONENTS.map(|name| column(name).map(|c| c.column));
            if let [Some(x), Some(y), Some(z), Some(psi), Some(theta), Some(phi)] = found {
                ids.push(part.id);
                self.parts.push([x, y, z, psi, theta, phi]);
            }
        }
        let code = code_of_units(&run.units);
        let mut head = format!(" A.G8    {NO_DATE}  {code}\n{:<80}\n", run.title);
        let counts = [ids.len(), 0, 0, 0, 0, 0, 0, 0, 0];
        head += &counts
            .iter()
            .fold(" ".to_owned(), |line, n| line + &format!("{n:>5}"));
        head.push('\n');
        for id in ids {
            head += &format!("{id:>11}{:>10}\n", 1);
        }
        text.extend_from_slice(head.as_bytes());
    }

    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>) {
        for row in rows {
            let place = row - run.released;
            let mut sequences = run.sequences.iter();
            let kind = sequences.find(|s| s.rows.contains(&row)).map(|s| s.kind);
            if row == 0 && kind != Some(Kind::Input) {
                self.frame(run, INPUT, place, text);
            }
            let time = match kind {
                Some(Kind::Input) => INPUT,
                Some(Kind::Static) => STATIC,
                _ => run.value(0, place),
            };
            self.frame(run, time, place, text);
        }
    }

    fn end(&mut self, _: &Run, _: &mut Vec<u8>) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO_PARTS: &str = " A.G8    2024-01-02 03:04:05  MMKGS_N_RACA 1.000000000000000E+03
two parts and a force
    3    1    1    0    1    0    0    0    1
          1         1
          4         1
          7         1
          1         1         1
          1         1  0.00000E+00  0.00000E+00  0.00000E+00       0
   0.00000E+00  0.00000E+00  0.00000E+00
  -9.99999E+05
   1.00000E+00  2.00000E+00  3.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
 -1.00000E-100-2.0000E+100  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
   9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00
  -5.55555E+05
   1.50000E+00  2.00000E+00  3.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
   4.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
   9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00
   1.00000E-02
   1.60000E+00  2.00000E+00  3.00000E+00  0.00000E+00  0.00000E+00  5.00000E-01
   4.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00
   9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00  9.00000E+00
";

    #[test]
    fn frames_become_rows_and_arrows_of_forces_are_left_out() {
        let run = read(TWO_PARTS.as_bytes()).unwrap();
        assert_eq!(run.column("PART_4_XFORM.X"), Some(&[1.0, 1.5, 1.6][..]));
        assert_eq!(run.column("PART_7_XFORM.X"), Some(&[-1e-100, 4.0, 4.0][..]));
        assert_eq!(run.column("PART_4_XFORM.PHI").unwrap()[2], 0.5);
        assert_eq!(
            run.sequences.iter().map(|s| s.kind).collect::<Vec<_>>(),
            [Kind::Input, Kind::Static, Kind::Dynamic]
        );
        assert_eq!(
            (run.units.length.as_str(), run.units.angle.as_str()),
            ("mm", "rad")
        );
        let marked = read(format!("\u{feff}{TWO_PARTS}").as_bytes()).unwrap();
        assert_eq!(marked.columns.len(), run.columns.len());
    }

    #[test]
    fn what_is_written_reads_back_to_six_digits() {
        let run = read(TWO_PARTS.as_bytes()).unwrap();
        let text = crate::results::format::text(&mut Frames::default(), &run);
        let back = read(text.as_bytes()).unwrap();
        assert_eq!(back.sequences, run.sequences);
        assert_eq!((&back.units, &back.title), (&run.units, &run.title));
        for (a, b) in run.columns.iter().zip(&back.columns) {
            assert_eq!((&a.name, &a.values), (&b.name, &b.values));
        }
    }
}
