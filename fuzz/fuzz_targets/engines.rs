//! Random trees of both languages: the interpreter against generated code.

#![no_main]

#[allow(dead_code)]
#[path = "../../tests/common/expressions.rs"]
mod expressions;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| expressions::fuzz_engines(bytes));
