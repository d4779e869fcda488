//! Forces: laws of compliance, friction, contact; forces that jump. A module a claim's subject; see `tests/README.md`.
#![cfg(feature = "solver")]

#[path = "../common/contacts.rs"]
mod contacts;
#[path = "../common/curves.rs"]
mod curves;
#[path = "../common/running.rs"]
mod running;

mod branches;
mod contact;
mod contact_curves;
mod contact_geometry;
mod contact_laws;
mod contact_rapier;
mod contact_shells;
mod contact_wires;
mod directions;
mod forces;
mod friction;
mod pulses;
mod sliding;
