//! Files that end too early: of a run that was killed, of a full disk, of a copy that broke off.
//! Their whole rows are read, and it is said that there may have been more.

use super::{Run, malformed};
use crate::diagnostic::{Cause, Diagnostic};

/// Returns the whole lines of a text, and whether there is a last line without its end: a number
/// may lack its last digits there.
pub(super) fn whole_lines(bytes: &[u8]) -> (&[u8], bool) {
    let end = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |k| k + 1);
    let (whole, rest) = bytes.split_at(end);
    (whole, !rest.trim_ascii().is_empty())
}

/// Returns the mistake in what stands before the first row, in a text of so many whole lines: at
/// its very end it is that there is no more.
pub(super) fn no_row(mistake: Diagnostic, n_lines: usize) -> Diagnostic {
    match mistake.line == 0 || mistake.line > n_lines {
        true => {
            let what = format!("ends before its first row: {}", mistake.message);
            Diagnostic {
                message: what,
                ..malformed(0, "")
            }
        }
        false => mistake,
    }
}

impl Run {
    /// Notes that the file of this run is cut off: what is held are its whole rows.
    pub(super) fn note_cut(&mut self) {
        let is_noted = |d: &Diagnostic| d.is(Cause::CutOff);
        if self.record.doubts.iter().any(is_noted) {
            return;
        }
        let what = match self.rows() {
            0 => "is cut off before the end of its first row".to_owned(),
            1 => "is cut off: its one whole row is read".to_owned(),
            n => format!("is cut off: its {n} whole rows are read"),
        };
        self.record
            .doubts
            .push(Diagnostic::warning(Cause::CutOff, what));
    }
}
