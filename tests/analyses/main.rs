//! Analyses: integrators, runs against references, statics, modes, systems with states of their own. A module a claim's subject; see `tests/README.md`.
#![cfg(feature = "solver")]

#[path = "../common/counting.rs"]
mod counting;
#[path = "../problems/mod.rs"]
mod problems;
#[path = "../common/requests.rs"]
mod requests;
#[path = "../common/running.rs"]
mod running;

mod accuracy;
mod allocations;
mod building;
mod delays;
mod doors;
mod energy;
mod integrators;
mod limits;
mod linear;
mod loops;
mod messages;
mod methods_outside;
mod outputs;
mod rates;
mod references;
mod saved;
mod sessions;
mod statics;
mod sweeps;
mod swings;
mod systems;
