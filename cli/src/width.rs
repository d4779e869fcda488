//! The width that output may take: COLUMNS, else that of the terminal, else an ordinary one.

/// Width where output goes to a file or another program, in characters.
const PIPED: usize = 100;
/// Narrowest and widest output, in characters.
const LIMITS: (usize, usize) = (40, 240);

/// Returns the width that is named or that the terminal has; `None` where there is neither.
fn known() -> Option<usize> {
    let named = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok());
    let terminal = || terminal_size::terminal_size_of(std::io::stdout());
    named.or_else(|| terminal().map(|(terminal_size::Width(n), _)| usize::from(n)))
}

/// Returns the width for tables, in characters.
pub fn columns() -> usize {
    known().unwrap_or(PIPED).clamp(LIMITS.0, LIMITS.1)
}

/// Returns the width for pictures, in characters.
pub fn picture() -> usize {
    /// Width where output goes to a file, and the widest.
    const USUAL: (usize, usize) = (80, 120);
    known().unwrap_or(USUAL.0).clamp(LIMITS.0, USUAL.1)
}

/// Returns the width for text that is read line by line, in characters.
pub fn reading() -> usize {
    columns().min(PIPED)
}
