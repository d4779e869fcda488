//! Laws of single elements: joints, rows, forces. One law, one file. A law sees frames and
//! velocities of markers only, never the coordinates behind them.

pub mod action;
pub mod beam;
pub mod bushing;
pub mod cam;
pub mod contact;
pub mod coupler;
pub mod field;
pub mod friction;
pub mod joint;
pub mod kinematic;
pub mod nodal_force;
pub mod row;
pub mod spring_damper;
