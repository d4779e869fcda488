//! The function language: from text to number.
//!
//! `text → Ast → Program → number`. Parsing finds every mistake with its place; compiling resolves names, folds constants
//! and shares equal parts; running allocates nothing.

mod advice;
pub mod ast;
mod check;
pub mod compile;
mod expression;
pub mod functions;
pub mod interpolation;
mod lint;
pub mod measures;
mod parse;
mod print;
pub mod program;
pub mod signature;
pub mod spline;
mod symbols;
mod token;
pub mod walk;

pub use check::{DEEPEST_NESTING, Limits, MOST_CHARACTERS};
pub use expression::{Expr, input_named};
pub use lint::lint;
pub use parse::{parse, parse_with_limits};
pub use symbols::{Profile, Symbol, names, symbol};
