//! Laws of single elements: joints, rows, forces. One law, one file; each knows marker frames only and could not tell
//! which coordinates lie behind them.

pub mod action;
pub mod bushing;
pub mod coupler;
pub mod joint;
pub mod row;
pub mod spring_damper;
