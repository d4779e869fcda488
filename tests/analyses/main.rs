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

/// A pendulum of mass 2, hung by MARKER/21 on MARKER/1 at rest on the level, and further statements.
macro_rules! pendulum {
    ($more:literal) => {
        concat!(
            "pendulum\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=2, CM=20, IP=0.1,0.1,0.1\n",
            "MARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\nJOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\n",
            $more
        )
    };
}

mod accuracy;
mod allocations;
mod apart;
mod building;
mod clocks;
mod delays;
mod doors;
mod downstream;
mod energy;
mod flutter;
mod gates;
mod integrators;
mod limits;
mod linear;
mod loops;
mod messages;
mod methods_outside;
mod outputs;
mod rates;
mod recorded_again;
mod references;
mod rounding;
mod runaway;
mod saved;
mod sessions;
mod statics;
mod sweeps;
mod swings;
mod systems;
mod trials;
mod units;
