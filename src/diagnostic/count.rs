//! Counts in sentences: a number and its noun.

use std::fmt::Display;

/// Returns a count with its noun, in the plural where it is not one: "1 input", "0 inputs", "3
/// bodies", "2 axes".
///
/// The last word of `noun` is regular, or ends with -is.
///
/// # Examples
/// ```
/// use cognate::diagnostic::counted;
/// assert_eq!(counted(1, "input"), "1 input");
/// assert_eq!(counted(2, "redundant axis"), "2 redundant axes");
/// ```
pub fn counted<N: Display + PartialEq + From<u8>>(n: N, noun: &str) -> String {
    if n == N::from(1) {
        return format!("{n} {noun}");
    }
    let plural = match noun {
        _ if noun.ends_with("is") => format!("{}es", &noun[..noun.len() - 2]),
        _ if ["s", "x", "ch", "sh"].iter().any(|end| noun.ends_with(end)) => format!("{noun}es"),
        _ => match noun.strip_suffix('y') {
            Some(stem) if !stem.ends_with(['a', 'e', 'o', 'u']) => format!("{stem}ies"),
            _ => format!("{noun}s"),
        },
    };
    format!("{n} {plural}")
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn a_count_agrees_with_its_noun() {
        for (noun, plural) in [
            ("input", "inputs"),
            ("body", "bodies"),
            ("key", "keys"),
            ("axis", "axes"),
            ("mass", "masses"),
            ("branch", "branches"),
        ] {
            assert_eq!(counted(1, noun), format!("1 {noun}"));
            for n in [0_u32, 2, 21] {
                assert_eq!(counted(n, noun), format!("{n} {plural}"));
            }
        }
        assert_eq!(counted(1_000_000_u64, "step"), "1000000 steps");
    }
}
