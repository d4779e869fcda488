//! Random trees of direct-entry functions: print, read, compile; walker against program.

#![no_main]

#[allow(dead_code)]
#[path = "../../tests/common/expressions.rs"]
mod expressions;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| expressions::fuzz_evaluate(bytes));
