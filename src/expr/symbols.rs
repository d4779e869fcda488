//! The meaning of names: one table of constants, functions, measures and interpolations per
//! language, made from their own tables.

use super::ast::{Callee, Constant, Dialect};
use super::functions::Function;
use super::interpolation::Interpolation;
use super::measures;
use super::signature::{self, Argument, Kind};
use crate::arrange::Arrange;
use std::cmp::Ordering;
use std::sync::OnceLock;

/// The program whose habits are followed beyond the common language.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Profile {
    /// no limits but those that keep the reader safe
    #[default]
    Adams,
    /// the limits of I-DEAS (nesting, symbols, elements, length), and AKIMA as another name of
    /// AKISPL
    Ideas,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// a named number, never followed by parentheses
    Constant(Constant),
    /// the arithmetic IF
    If,
    /// a function with arguments
    Callee(Callee),
}

/// Names of a language in the order of [`compare`], with their meaning.
type Table = Vec<(&'static str, Symbol)>;

/// Returns the meaning of a name, in upper or lower case.
pub fn symbol(name: &str, dialect: Dialect, profile: Profile) -> Option<Symbol> {
    let table = table(dialect);
    match table.binary_search_by(|entry| compare(entry.0, name)) {
        Ok(k) => Some(table[k].1),
        Err(_) if is_akima(name, dialect) && profile == Profile::Ideas => {
            Some(Symbol::Callee(Callee::Interpolation(Interpolation::Akispl)))
        }
        Err(_) => None,
    }
}

/// Returns every name of a language with its meaning, in alphabetical order: for completion,
/// highlighting and near names.
pub fn names(dialect: Dialect) -> &'static [(&'static str, Symbol)] {
    table(dialect)
}

fn is_akima(name: &str, dialect: Dialect) -> bool {
    dialect == Dialect::Function && name.eq_ignore_ascii_case("AKIMA")
}

/// Returns the table of a language, made at the first call.
fn table(dialect: Dialect) -> &'static Table {
    static TABLES: [OnceLock<Table>; 2] = [OnceLock::new(), OnceLock::new()];
    TABLES[dialect as usize].get_or_init(|| {
        let functions = Function::ALL.iter().filter(|f| f.row().dialect == dialect);
        let mut table: Table = functions
            .map(|&f| (f.name(), Symbol::Callee(Callee::Function(f))))
            .collect();
        match dialect {
            Dialect::Expression => table.push(("t", Symbol::Constant(Constant::Time))),
            Dialect::Function => {
                table.push(("IF", Symbol::If));
                table.extend(CONSTANTS.map(|(name, c)| (name, Symbol::Constant(c))));
                table.extend(
                    measures::rows()
                        .iter()
                        .map(|r| (r.name, Symbol::Callee(Callee::Measure(r.measure)))),
                );
                table.extend(
                    Interpolation::ALL
                        .iter()
                        .map(|&f| (f.name(), Symbol::Callee(Callee::Interpolation(f)))),
                );
            }
        }
        table.arrange_by(|a, b| compare(a.0, b.0));
        table
    })
}

const CONSTANTS: [(&str, Constant); 5] = [
    ("TIME", Constant::Time),
    ("PI", Constant::Pi),
    ("DTOR", Constant::Dtor),
    ("RTOD", Constant::Rtod),
    ("MODE", Constant::Mode),
];

/// Compares in alphabetical order without regard to case.
fn compare(a: &str, b: &str) -> Ordering {
    a.bytes()
        .map(|b| b.to_ascii_uppercase())
        .cmp(b.bytes().map(|b| b.to_ascii_uppercase()))
}

impl Constant {
    /// Returns the name as it is written in a language.
    pub fn name(self, dialect: Dialect) -> &'static str {
        match (self, dialect) {
            (Constant::Time, Dialect::Expression) => "t",
            (Constant::Time, Dialect::Function) => "TIME",
            (Constant::Pi, _) => "PI",
            (Constant::Dtor, _) => "DTOR",
            (Constant::Rtod, _) => "RTOD",
            (Constant::Mode, _) => "MODE",
        }
    }
}

impl Callee {
    /// Returns the name as it is written.
    pub fn name(self) -> &'static str {
        match self {
            Callee::Function(f) => f.name(),
            Callee::Measure(m) => m.name(),
            Callee::Interpolation(f) => f.name(),
        }
    }
    /// Returns the fewest and the most arguments.
    pub fn arity(self) -> (usize, usize) {
        let range = match self {
            Callee::Function(f) => f.arity(),
            Callee::Measure(m) => return signature::arity(m.row().arguments),
            Callee::Interpolation(f) => f.arity(),
        };
        (*range.start(), *range.end())
    }
    /// Returns the arguments that have names of their own.
    pub fn arguments(self) -> &'static [Argument] {
        match self {
            Callee::Function(f) => f.row().parameters,
            Callee::Measure(m) => m.row().arguments,
            Callee::Interpolation(f) => f.row().parameters,
        }
    }
    /// Returns the kind of the `k`-th argument (`k` from 0).
    pub fn argument(self, k: usize) -> Kind {
        self.arguments().get(k).map_or(Kind::Number, |a| a.kind)
    }
    /// Returns the name of the `k`-th argument (`k` from 0).
    pub fn argument_name(self, k: usize) -> &'static str {
        self.arguments().get(k).map_or("the argument", |a| a.name)
    }
    /// Returns the name of the `k`-th of `count` arguments (`k` from 0), with a number where many
    /// have one name; empty where there is one argument only.
    pub fn role(self, k: usize, count: usize) -> String {
        let named = self.arguments();
        let further = match self {
            Callee::Function(f) => f.row().further.filter(|further| further.least > 0),
            Callee::Measure(_) | Callee::Interpolation(_) => None,
        };
        match (named.get(k), further) {
            _ if count < 2 => String::new(),
            (Some(argument), _) => argument.name.to_owned(),
            (None, Some(further)) => format!("{}{}", further.name, k - named.len()),
            (None, None) => String::new(),
        }
    }
    /// Prints the signature: `NAME(i[, j])`.
    pub fn signature(self) -> String {
        match self {
            Callee::Function(f) => f.signature(),
            Callee::Measure(m) => signature::signature(m.name(), m.row().arguments),
            Callee::Interpolation(f) => f.signature(),
        }
    }
    /// Returns whether the value depends on the past, so that a host has to keep a history.
    pub fn needs_history(self) -> bool {
        match self {
            Callee::Function(f) => f == Function::Delay,
            Callee::Measure(m) => m.needs_history(),
            Callee::Interpolation(_) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_means_one_thing() {
        for dialect in [Dialect::Function, Dialect::Expression] {
            for pair in names(dialect).windows(2) {
                assert_eq!(
                    compare(pair[0].0, pair[1].0),
                    Ordering::Less,
                    "{} {}",
                    pair[0].0,
                    pair[1].0
                );
            }
            for &(name, meaning) in names(dialect) {
                assert_eq!(
                    symbol(&name.to_lowercase(), dialect, Profile::Adams),
                    Some(meaning)
                );
            }
        }
    }

    #[test]
    fn the_languages_keep_their_names_apart() {
        let known = |name, dialect| symbol(name, dialect, Profile::Adams).is_some();
        assert!(known("TIME", Dialect::Function) && !known("TIME", Dialect::Expression));
        assert!(known("t", Dialect::Expression) && !known("t", Dialect::Function));
        assert!(!known("ln", Dialect::Function) && known("ln", Dialect::Expression));
        assert!(!known("AKIMA", Dialect::Function));
        assert!(symbol("akima", Dialect::Function, Profile::Ideas).is_some());
    }
}
