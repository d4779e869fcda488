//! Datasets and command files: reading, writing, mistakes. A module a claim's subject; see `tests/README.md`.
#![cfg(feature = "solver")]

#[path = "../common/meaning.rs"]
mod meaning;
#[path = "../common/models.rs"]
mod models;
#[path = "../common/running.rs"]
mod running;

mod command_effects;
mod command_files;
mod dataset;
mod dataset_laws;
mod effects;
mod includes;
mod odd;
mod view;
