//! The codes of datasets in several files.

use super::Code;

/// The codes of datasets in several files.
pub static FILE_CODES: &[Code] = &[Code {
    name: "include",
    summary: "a file that a dataset includes, and that cannot be read into it",
    explanation: "\
`! cognate: INCLUDE leg.adm` on a line of its own stands for the statements of another dataset, without its title and its END. Its
name is relative to the file with that line, or absolute. The message says why the file cannot be taken: it is not there, it includes
itself, it is no dataset, or the line stands within a statement.

    ! cognate: INCLUDE parts/leg.adm     not `INCLUDE/parts/leg.adm`: Adams has no such statement, to it this is a comment
    PART/2, MASS=1
    ! cognate: INCLUDE leg.adm           not between the lines of a statement
    , IP=1,1,1

A text that comes from no file, as that of a program, includes nothing. Elements of all files share their numbers: of two with one
number the second is a mistake. An element is changed in the file in which it stands; `cognate export` writes one dataset of all.",
}];
