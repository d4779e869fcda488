//! Any bytes, taken as text of either language.

#![no_main]

#[allow(dead_code)]
#[path = "../../tests/common/expressions.rs"]
mod expressions;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| expressions::fuzz_parse(bytes));
