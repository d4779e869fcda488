//! The width that output may take: COLUMNS, else that of the terminal, else an ordinary one.

/// Width where output goes to a file or another program, in characters.
const PIPED: usize = 100;
/// Narrowest and widest output, in characters.
const LIMITS: (usize, usize) = (40, 240);

/// Returns the width for tables, in characters.
pub fn columns() -> usize {
    let named = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok());
    let terminal = || console::Term::stdout().size_checked();
    let columns = named.or_else(|| terminal().map(|(_, columns)| usize::from(columns)));
    columns.unwrap_or(PIPED).clamp(LIMITS.0, LIMITS.1)
}

/// Returns the width for text that is read line by line, in characters.
pub fn reading() -> usize {
    columns().min(PIPED)
}
