//! The language: what expressions are, what they are worth, and what is said of them. A module a claim's subject; see `tests/README.md`.

#[path = "../common/counting.rs"]
mod counting;
#[path = "../common/expressions.rs"]
#[allow(dead_code)]
mod expressions;

mod advice;
mod batches;
mod conformance;
mod elementary;
mod engine;
mod invariants;
mod language;
mod limits;
mod smoothness;
