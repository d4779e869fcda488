//! Laws of single elements: joints, rows, forces. One law, one file; each knows marker frames only and could not tell
//! which coordinates lie behind them.

pub mod action;
pub mod beam;
pub mod bushing;
pub mod cam;
pub mod contact;
pub mod coupler;
pub mod field;
pub mod friction;
pub mod joint;
pub mod nodal_force;
pub mod row;
pub mod spring_damper;
