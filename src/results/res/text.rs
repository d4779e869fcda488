//! Reading `.res` files of the old text form: places, velocities and accelerations of rigid parts.
//!
//! Card: blocks of lines, each opened by a title in columns 1–40 and closed by a line `!`. `RIGID
//! PARTS MAP` says for each part on which line of an output block its records stand, counted from
//! the title. `NAME MAP` names the parts. Each `ANALYSIS OUTPUT BLOCK` holds one time. Numbers
//! stand in columns of 12 characters and may touch. Orientation is given by Euler parameters e0 …
//! e3. Records of other elements are not read: their layout is not known.

use crate::diagnostic::{Diagnostic, counted};
use crate::results::gra::units_of_code;
use crate::results::{Component, Entity, Kind, Run, component_unit, malformed, no_row, number};

const FIRST_TITLE: &str = "FILE TYPE AND SOURCE";
const RECORDS: [&[&str]; 3] = [
    &["X", "Y", "Z", "E0", "E1", "E2", "E3"],
    &["VX", "VY", "VZ", "WX", "WY", "WZ"],
    &["ACCX", "ACCY", "ACCZ", "WDX", "WDY", "WDZ"],
];

/// Returns whether a text begins like this format.
pub(super) fn recognise(text: &str) -> bool {
    text.trim_start().starts_with(FIRST_TITLE)
}

/// A block: its title, the 1-based line of that, and the lines up to, not including, its `!`.
struct Block<'a> {
    title: &'a str,
    line: usize,
    lines: &'a [&'a str],
}

impl Block<'_> {
    /// Returns the `width` numbers on a line counted from the title.
    fn record(&self, line: usize, width: usize) -> Result<Vec<f64>, Diagnostic> {
        let text = (line.checked_sub(1))
            .and_then(|l| self.lines.get(l))
            .ok_or_else(|| {
                malformed(
                    self.line,
                    format!("this block has no line {line}, where RIGID PARTS MAP places a record"),
                )
            })?;
        columns(text)
            .filter(|numbers| numbers.len() == width)
            .ok_or_else(|| {
                malformed(
                    self.line + line,
                    format!("a line of {} is expected here", counted(width, "number")),
                )
            })
    }
}

/// Reads the records of rigid parts.
pub(super) fn read(text: &str) -> Result<Run, Diagnostic> {
    let lines: Vec<&str> = text.lines().collect();
    let (blocks, is_cut) = blocks(&lines);
    let block = |title: &str| blocks.iter().find(|b| b.title == title);
    let code = block(FIRST_TITLE)
        .and_then(|b| b.lines.first())
        .and_then(|l| l.split_whitespace().rev().nth(1))
        .unwrap_or_default();
    let title = block("DATA SET TITLE")
        .and_then(|b| b.lines.first())
        .map_or("", |l| l.trim());
    let mut run = Run::new("", title, units_of_code(code));

    let map = block("RIGID PARTS MAP").ok_or_else(|| {
        no_row(
            malformed(0, "there is no block RIGID PARTS MAP"),
            lines.len(),
        )
    })?;
    let records = add_parts(&mut run, map, block("NAME MAP"))?;
    let mut kind = None;
    let mut row = Vec::new();
    for output in blocks.iter().filter(|b| b.title == "ANALYSIS OUTPUT BLOCK") {
        let now = kind_of(output.lines.first().copied().unwrap_or_default());
        if kind != Some(now) {
            run.end();
            run.begin(now);
            kind = Some(now);
        }
        row.clear();
        let time = output.lines.get(1).and_then(|l| number(l.trim()));
        row.push(time.ok_or_else(|| {
            malformed(
                output.line,
                "the time should stand two lines below this title",
            )
        })?);
        for &(line, width) in &records {
            row.extend(output.record(line, width)?);
        }
        run.push(&row);
    }
    run.end();
    if run.rows() == 0 {
        let what = "there is no ANALYSIS OUTPUT BLOCK";
        return Err(no_row(malformed(0, what), lines.len()));
    }
    if is_cut {
        run.note_cut();
    }
    Ok(run)
}

/// Returns the blocks that are closed, and whether a last one is not.
fn blocks<'a>(lines: &'a [&'a str]) -> (Vec<Block<'a>>, bool) {
    let mut blocks = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        if lines[at].trim().is_empty() {
            at += 1;
            continue;
        }
        let Some(end) = (at + 1..lines.len()).find(|&i| lines[i].trim() == "!") else {
            return (blocks, true);
        };
        let title = lines[at]
            .get(..40)
            .unwrap_or(lines[at])
            .trim_end()
            .trim_end_matches(|c: char| c.is_ascii_digit())
            .trim();
        blocks.push(Block {
            title,
            line: at + 1,
            lines: &lines[at + 1..end],
        });
        at = end + 1;
    }
    (blocks, false)
}

/// Adds the columns of all parts. Returns, for each record in their order, the line of an output
/// block and the count of numbers.
fn add_parts(
    run: &mut Run,
    map: &Block<'_>,
    names: Option<&Block<'_>>,
) -> Result<Vec<(usize, usize)>, Diagnostic> {
    let saved: String = map
        .lines
        .first()
        .map(|l| l.chars().skip(8).collect())
        .unwrap_or_default();
    let saved = [
        true,
        saved.get(3..6) == Some("YES"),
        saved.get(6..9) == Some("YES"),
    ];
    let mut parts = Vec::new();
    for (line, number) in map.lines.iter().zip(map.line + 1..).skip(1) {
        let numbers: Option<Vec<u64>> = line.split_whitespace().map(|w| w.parse().ok()).collect();
        match numbers.as_deref() {
            Some([id, places @ ..]) if places.len() == 3 && parts.len() < 1_000_000 => {
                parts.push((*id, [places[0], places[1], places[2]]))
            }
            _ => {
                return Err(malformed(
                    number,
                    "a part's number and its three record lines should stand here",
                ));
            }
        }
    }
    // a line holds one record: otherwise a small block with a large map would take any memory
    let mut places: Vec<u64> = parts
        .iter()
        .flat_map(|p| p.1.iter().zip(saved).filter(|s| s.1).map(|s| *s.0))
        .collect();
    places.sort_unstable();
    if places.windows(2).any(|w| w[0] == w[1]) {
        return Err(malformed(
            map.line,
            "two records of the map stand on one line",
        ));
    }
    let mut records = Vec::new();
    for (id, _) in &parts {
        let entity = name_of(*id, names);
        run.entities.push(Entity {
            name: format!("{entity}_XFORM"),
            entity,
            kind: "Part".into(),
            id: *id,
            components: Vec::new(),
        });
    }
    // all places first, then all velocities, then all accelerations, as in the XML form
    for (kind, components) in RECORDS.iter().enumerate().filter(|&(kind, _)| saved[kind]) {
        for (index, (_, places)) in parts.iter().enumerate() {
            records.push((
                usize::try_from(places[kind]).unwrap_or(usize::MAX),
                components.len(),
            ));
            for component in *components {
                let name = format!("{}.{component}", run.entities[index].name);
                let column = run.add_column(name, component_unit(component, &run.units));
                run.entities[index].components.push(Component {
                    name: (*component).into(),
                    column,
                });
            }
        }
    }
    Ok(records)
}

/// Returns the last part of the name that the map gives to a rigid part.
fn name_of(id: u64, names: Option<&Block<'_>>) -> String {
    let is_it = |line: &str| {
        line.contains("RIGID PART")
            && line.get(..20).and_then(|n| n.trim().parse().ok()) == Some(id)
    };
    let full = names
        .and_then(|b| b.lines.windows(2).find(|w| is_it(w[0])))
        .map(|w| w[1].trim());
    full.and_then(|name| name.rsplit('.').next())
        .filter(|n| !n.is_empty())
        .map_or_else(|| format!("PART_{id}"), str::to_owned)
}

/// Reads the kind of analysis from the first line of an output block.
fn kind_of(line: &str) -> Kind {
    let text = line.to_ascii_uppercase();
    let known = [
        ("INPUT", Kind::Input),
        ("INITIAL", Kind::InitialConditions),
        ("QUASI", Kind::QuasiStatic),
        ("STATIC", Kind::Static),
        ("KINEMATIC", Kind::Kinematic),
    ];
    known
        .into_iter()
        .find(|(word, _)| text.contains(word))
        .map_or(Kind::Dynamic, |k| k.1)
}

/// Reads the numbers of a line of columns 12 wide.
fn columns(line: &str) -> Option<Vec<f64>> {
    let line = line.trim_end();
    if !line.is_ascii() {
        return None;
    }
    line.as_bytes()
        .chunks(12)
        .map(|cell| {
            std::str::from_utf8(cell)
                .ok()
                .and_then(|cell| number(cell.trim()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = "FILE TYPE AND SOURCE                           6
ADAMS RESULTS FILE       MMKGS_N_RACA 0.100000000000000E+04
ADAMS VERSION - 10.0                    A.RE7
nobody
nowhere
never
!
DATA SET TITLE                                 3
a title

!
RIGID PARTS MAP                                4
       2YESYESNO 
                   2       5       7       9
                   3       6       8      10
!
NAME MAP                                       6
       2YES
                   2RIGID PART                 1
.M.arm
                   3RIGID PART                 1
.M.leg
!
ANALYSIS OUTPUT BLOCK                          7
       1DYNAMIC             one
 1.00000e-02


 1.00000e+00 2.00000e+00-3.00000e+00 1.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00
 4.00000e+00 5.00000e+00-6.00000e+00 0.00000e+00 1.00000e+00 0.00000e+00 0.00000e+00
 7.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00-8.00000e+00
 9.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00
!
";

    #[test]
    fn parts_are_read_by_the_lines_their_map_names() {
        let run = read(SAMPLE).unwrap();
        let at = |name: &str| run.column(name).unwrap()[0];
        assert_eq!(
            (
                at("time"),
                at("arm_XFORM.Z"),
                at("leg_XFORM.Z"),
                at("leg_XFORM.E1")
            ),
            (0.01, -3.0, -6.0, 1.0)
        );
        assert_eq!(
            (at("arm_XFORM.VX"), at("arm_XFORM.WZ"), at("leg_XFORM.VX")),
            (7.0, -8.0, 9.0)
        );
        assert_eq!(run.columns[1].unit, "mm");
        assert!(run.column("arm_XFORM.ACCX").is_none());
    }

    #[test]
    fn a_record_placed_beyond_its_block_is_told_at_the_block() {
        for place in ["50", "18446744073709551615", "0"] {
            let text = SAMPLE.replace("       2       5 ", &format!("       2       {place} "));
            assert_ne!(text, SAMPLE);
            assert_eq!(read(&text).unwrap_err().line, 24, "{place}");
        }
    }
}
