//! The function language: from text to number.
//!
//! `text → Ast → Program → number`. Parsing finds every mistake with its place; compiling resolves names, folds constants
//! and shares equal parts; running allocates nothing.

pub mod ast;
pub mod functions;
pub mod interpolation;
pub mod measures;
pub mod program;
pub mod signature;
pub mod spline;
