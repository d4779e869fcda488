//! Any bytes, taken as a file of results: `.res` in both forms, `.gra`, `.csv`.

#![no_main]

#[allow(dead_code)]
#[path = "../../tests/common/results.rs"]
mod results;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| results::fuzz_results(bytes));
