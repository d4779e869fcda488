//! The function language: from text to number.
//!
//! ```
//! use cognate::expr::Expr;
//! let f = Expr::parse("STEP5(TIME, 0, 0, 1, 10) * SIN(2*PI*TIME)")?;
//! let y = f.eval(&[("TIME", 0.25)])?;
//! assert_eq!(y, 1.03515625);
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! ```text
//! text ── check, parse ──▶ Ast ── compile ──▶ Program ──▶ numbers, derivatives, batches
//!                           └──── walk ──────────────────▶ the same number, or the reason for none
//! ```
//!
//! | step | file | |
//! |---|---|---|
//! | names | `functions/` `measures.rs` `interpolation/` | tables of the functions |
//! | | `signature.rs` `symbols.rs` | arguments of functions; meanings of names in each language |
//! | text | `token.rs` `check.rs` | tokens; one ordered pass finds the first mistake, with its place |
//! | | `expansion.rs` | texts in which names are replaced, and their places
//! | | `names.rs` | variables, constants and functions of a caller's own |
//! | | `advice.rs` `foreign.rs` | advice on mistakes; words of other languages |
//! | | `lint/` | warnings about what is legal but hardly meant |
//! | tree | `grammar/*.pest` `parse.rs` `ast.rs` `print.rs` | grammars, tree, and back to source |
//! | | `shape.rs` | trees that texts of the same kinds of tokens share |
//! | | `translate.rs` | expression functions in the language of direct entry |
//! | value | `walk.rs` | the reference evaluator; names the operation that has no value |
//! | program | `compile.rs` `program/` | shared, folded, straight-line code over any number |
//! | | `evaluator.rs` `shared.rs` | a program with its work space; one that threads share |
//! | | `calls.rs` | functions of a caller's own that are known by their numbers only |
//! | | `finite.rs` | operands without a finite value that an operation could lose |
//! | | `smoothness.rs` | places where it is not smooth, and the derivative that jumps there |
//!
//! Parsing finds every mistake with its place; compiling resolves names, folds constants and shares
//! equal parts; running allocates nothing.

mod advice;
pub mod ast;
mod calls;
mod check;
pub mod compile;
pub mod dimension;
mod evaluator;
mod expansion;
mod expression;
mod finite;
mod foreign;
pub mod functions;
pub mod interpolation;
pub mod lint;
pub mod measures;
mod names;
mod parse;
mod print;
pub mod program;
mod shape;
mod shared;
pub mod signature;
pub mod smoothness;
pub mod spline;
mod symbols;
mod token;
mod translate;
pub mod walk;

pub use check::{DEEPEST_NESTING, Limits, MOST_CHARACTERS};
pub use evaluator::Evaluator;
pub use expansion::Expansion;
pub use expression::{Expr, input_named};
pub use lint::lint;
pub use names::Names;
pub use parse::{parse, parse_with_limits};
pub use shared::{SharedEvaluator, are_finite};
pub use symbols::{Profile, Symbol, names, symbol};
