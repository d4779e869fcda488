//! Mechanisms: constraints, how they are put together, counted, and moved. A module a claim's subject; see `tests/README.md`.
#![cfg(feature = "solver")]

#[path = "../common/curves.rs"]
mod curve_shapes;
#[path = "../common/running.rs"]
mod running;

mod alignment;
mod angles;
mod beginnings;
mod by_closures;
mod constraints;
mod continuation;
mod curves;
mod elements;
mod initial;
mod instances;
mod joints;
mod kinds_of_loops;
mod large;
mod laws;
mod leaps;
mod least_reactions;
mod left_out;
mod massless;
mod mechanisms;
mod misaligned;
mod ranks;
mod rolling;
mod rows_of_loops;
mod scene;
mod singular_passages;
mod turns;
mod verify;
