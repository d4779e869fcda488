//! Any bytes, taken as a command file of Adams View.

#![no_main]

#[allow(dead_code)]
#[path = "../../tests/common/meaning.rs"]
mod meaning;
#[allow(dead_code)]
#[path = "../../tests/common/models.rs"]
mod models;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| models::fuzz_view(bytes));
